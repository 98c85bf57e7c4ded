# SPDX-License-Identifier: Apache-2.0
# GDAL brings a hundred libraries, which would take most of a program's start. Nothing links it: src/io/gdal.hpp loads it
# when a file first needs it. Building takes its headers, and the name under which the system knows the library.
find_package(GDAL 3.6 REQUIRED)
get_target_property(gdal_file GDAL::GDAL LOCATION)
file(REAL_PATH ${gdal_file} gdal_file)
if(NOT gdal_file MATCHES "(libgdal\\.so\\.[0-9]+)[^/]*$")
  message(FATAL_ERROR "GDAL is loaded as a shared library: found ${gdal_file}, expected libgdal.so.N")
endif()
set(VERSINE_GDAL_LIBRARY ${CMAKE_MATCH_1})

# versine_loads_gdal(<target>): what the sources that load it need.
function(versine_loads_gdal target)
  target_include_directories(${target} SYSTEM PRIVATE $<TARGET_PROPERTY:GDAL::GDAL,INTERFACE_INCLUDE_DIRECTORIES>)
  target_compile_definitions(${target} PRIVATE VERSINE_GDAL_LIBRARY="${VERSINE_GDAL_LIBRARY}")
endfunction()
