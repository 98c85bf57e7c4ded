# SPDX-License-Identifier: Apache-2.0
# Installs the build into a folder of its own, builds the consumer against it, and runs it.
set(root ${BUILD}/consumer)
file(REMOVE_RECURSE ${root})
function(step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
endfunction()
step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${root}/install)
step(${CMAKE_COMMAND} -S ${SOURCE} -B ${root}/build -G Ninja -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_BUILD_TYPE=Release
     -DCMAKE_PREFIX_PATH=${root}/install)
step(${CMAKE_COMMAND} --build ${root}/build)
step(${root}/build/consumer)
step(${root}/install/bin/versine --version)
