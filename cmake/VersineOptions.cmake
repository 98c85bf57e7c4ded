# SPDX-License-Identifier: Apache-2.0
# Options of the build, with what each is for.
option(VERSINE_TESTS "Build the tests" ON)
option(VERSINE_BENCHMARKS "Build the kernel benchmarks" OFF)
option(VERSINE_VIEWER "Build the web viewer's page into the program (needs node and npm)" ON)
option(VERSINE_WERROR "Treat warnings as errors" ON)
option(VERSINE_SANITIZE "Build with address and undefined-behaviour sanitizers" OFF)
option(VERSINE_FUZZ "Build the fuzzing programs of the text readers (clang)" OFF)
option(VERSINE_COVERAGE "Build with coverage counters" OFF)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

find_program(VERSINE_CCACHE ccache)
if(VERSINE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Paths relative to the source folder let two checkouts share what they compile.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
      CCACHE_SLOPPINESS=pch_defines,time_macros ${VERSINE_CCACHE})
endif()
find_program(VERSINE_MOLD mold)
if(VERSINE_MOLD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_link_options(-fuse-ld=mold)
endif()

# AVX2 and FMA halve the time of the filter's dense kernels; 2013 and later processors have them.
# EIGEN_MAX_ALIGN_BYTES (VersineDomain.cmake) keeps Eigen's memory layout the same with and without them, so that
# libraries can be mixed.
include(CheckCXXSourceRuns)
check_cxx_source_runs(
  "int main() { return __builtin_cpu_supports(\"avx2\") && __builtin_cpu_supports(\"fma\") ? 0 : 1; }" VERSINE_HOST_HAS_AVX2)
if(VERSINE_HOST_HAS_AVX2)
  set(VERSINE_ARCH_DEFAULT x86-64-v3)
endif()
set(VERSINE_ARCH "${VERSINE_ARCH_DEFAULT}" CACHE STRING "Value of -march; empty for the compiler's own default")

# Tests spend little time in their own code, and much in being compiled.
set(VERSINE_TEST_OPTIMISATION $<$<CONFIG:Release>:-O1>)

add_library(versine_flags INTERFACE)
target_compile_options(versine_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual -Wno-psabi -Wno-missing-field-initializers
  -ffp-contract=fast -pthread
  $<$<BOOL:${VERSINE_WERROR}>:-Werror> $<$<BOOL:${VERSINE_ARCH}>:-march=${VERSINE_ARCH}>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 reports these inside Eigen and std::string where there is nothing (PR105329, PR105562).
  target_compile_options(versine_flags INTERFACE -Wno-maybe-uninitialized -Wno-restrict -Wno-array-bounds
                         -Wno-stringop-overflow -Wno-stringop-overread)
endif()
if(VERSINE_SANITIZE)
  target_compile_options(versine_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer -g1)
  target_link_options(versine_flags INTERFACE -fsanitize=address,undefined)
endif()
if(VERSINE_COVERAGE)
  target_compile_options(versine_flags INTERFACE --coverage)
  target_link_options(versine_flags INTERFACE --coverage)
endif()
