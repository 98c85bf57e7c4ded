# SPDX-License-Identifier: Apache-2.0
# Headers of libraries, parsed once instead of in every file: they are most of the time that a file takes to compile.
# Only headers from outside the project are in here, so that a change of ours rebuilds what includes it and no more.
option(VERSINE_PRECOMPILE "Parse the headers of libraries once (the check of our own headers never uses this)" ON)

set(common_headers
  <algorithm> <array> <chrono> <cmath> <filesystem> <fstream> <functional> <map> <memory> <numbers> <optional> <random>
  <ranges> <span> <sstream> <string> <string_view> <thread> <unordered_map> <variant> <vector>
  <Eigen/Dense> <fmt/format.h> <fmt/ranges.h> <nlohmann/json.hpp> <tl/expected.hpp>)

# versine_header_set(<name> OBJECT|EXECUTABLE LINK <targets> HEADERS <headers>): one set, shared by targets of one kind,
# since position-independent code for libraries and for programs differ.
function(versine_header_set name kind)
  cmake_parse_arguments(arg "" "" "LINK;HEADERS" ${ARGN})
  if(NOT VERSINE_PRECOMPILE)
    return()
  endif()
  set(file ${PROJECT_BINARY_DIR}/precompiled/${name}.cpp)
  set(text "// Only carries the precompiled headers.\n")
  if(kind STREQUAL "EXECUTABLE")
    string(APPEND text "int main() { return 0; }\n")
    add_executable(${name})
  else()
    add_library(${name} OBJECT)
  endif()
  file(CONFIGURE OUTPUT ${file} CONTENT "${text}")
  target_sources(${name} PRIVATE ${file})
  target_compile_features(${name} PUBLIC cxx_std_20)
  target_compile_definitions(${name} PRIVATE EIGEN_MAX_ALIGN_BYTES=16)
  target_link_libraries(${name} PRIVATE versine_flags ${arg_LINK})
  target_precompile_headers(${name} PRIVATE ${common_headers} ${arg_HEADERS})
endfunction()

function(versine_precompiled target set)
  if(VERSINE_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${set})
  endif()
endfunction()

set(common_libraries Eigen3::Eigen fmt::fmt tl::expected nlohmann_json::nlohmann_json)
versine_header_set(versine_library_headers OBJECT LINK ${common_libraries})
if(VERSINE_TESTS)
  versine_header_set(versine_test_headers EXECUTABLE LINK ${common_libraries} RapidCheck::rapidcheck GTest::gmock
                     HEADERS <gtest/gtest.h> <gmock/gmock.h>)
  if(VERSINE_PRECOMPILE)
    target_compile_options(versine_test_headers PRIVATE ${VERSINE_TEST_OPTIMISATION})
  endif()
endif()
versine_header_set(versine_program_headers EXECUTABLE LINK ${common_libraries} CLI11::CLI11 HEADERS <CLI/CLI.hpp>)

# Files of one library compiled eight at a time, which shares the headers and templates of our own, too. The dev preset
# compiles file by file: a change then costs one file, and a missing include is seen.
option(VERSINE_UNITY "Compile several files of a library at a time" ON)

# versine_unity(<target>): all files but the long ones, which would keep one core waiting for the other.
function(versine_unity target)
  if(VERSINE_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
    get_target_property(sources ${target} SOURCES)
    list(FILTER sources INCLUDE REGEX "run_segment_|landmark_adjustment|kernels|linear_chain|planning_chain|planning_test|planning_methods|joint_snooping|network_solver|network_osm|spatial_index")
    set_source_files_properties(${sources} TARGET_DIRECTORY ${target} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
endfunction()
