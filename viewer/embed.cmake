# SPDX-License-Identifier: Apache-2.0
# Builds the page in a folder of the build tree and writes a C++ file that includes each asset, compressed.
file(MAKE_DIRECTORY ${BUILD})
file(COPY ${SOURCE}/src ${SOURCE}/index.html ${SOURCE}/package.json ${SOURCE}/package-lock.json
     ${SOURCE}/vite.config.ts ${SOURCE}/tsconfig.json DESTINATION ${BUILD})
function(step)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${BUILD} RESULT_VARIABLE result OUTPUT_VARIABLE output
                  ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
endfunction()
# The libraries are fetched again only when the lock file names others.
file(SHA256 ${SOURCE}/package-lock.json lock)
set(stamp ${BUILD}/node_modules/.versine-${lock})
if(NOT EXISTS ${stamp})
  step(${NPM} ci --no-audit --no-fund)
  file(TOUCH ${stamp})
endif()
step(${NPM} run build)
set(types html "text/html; charset=utf-8" js "text/javascript; charset=utf-8" css "text/css; charset=utf-8"
    svg "image/svg+xml" woff2 "font/woff2")
set(blobs "")
set(entries "")
file(GLOB_RECURSE files RELATIVE ${BUILD}/dist ${BUILD}/dist/*)
foreach(name IN LISTS files)
  file(REMOVE ${BUILD}/dist/${name}.gz)
  execute_process(COMMAND gzip -9nk ${BUILD}/dist/${name})
  string(MAKE_C_IDENTIFIER ${name} id)
  string(REGEX REPLACE ".*\\." "" ending ${name})
  list(FIND types ${ending} at)
  math(EXPR at "${at} + 1")
  list(GET types ${at} type)
  string(APPEND blobs "__asm__(\".section .rodata\\n.global versine_${id}\\n.global versine_${id}_end\\nversine_${id}:\\n\"
        \".incbin \\\"${BUILD}/dist/${name}.gz\\\"\\nversine_${id}_end:\\n.previous\\n\");\n"
        "extern \"C\" const char versine_${id}[], versine_${id}_end[];\n")
  set(path "/${name}")
  if(name STREQUAL "index.html")
    set(path "/")
  endif()
  string(APPEND entries
    "      {\"${path}\", {{versine_${id}, static_cast<std::size_t>(versine_${id}_end - versine_${id})}, \"${type}\"}},\n")
endforeach()
file(WRITE ${OUTPUT} "// Made by viewer/embed.cmake.
#include \"versine/app/view_server.hpp\"
${blobs}
namespace versine::app {
const std::map<std::string, Asset, std::less<>>& view_assets() {
  static const std::map<std::string, Asset, std::less<>> assets{
${entries}  };
  return assets;
}
}  // namespace versine::app
")
