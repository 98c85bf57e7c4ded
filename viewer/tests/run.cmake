# SPDX-License-Identifier: Apache-2.0
# Runs one test of the viewer, or says why it cannot.
find_program(CHROMIUM NAMES chromium chromium-browser google-chrome)
if(NOT NODE OR NOT CHROMIUM)
  if(DEFINED ENV{CI})
    message(FATAL_ERROR "node '${NODE}' and Chromium '${CHROMIUM}' must be there in continuous integration: make setup")
  endif()
  message("viewer test skipped: node '${NODE}', Chromium '${CHROMIUM}'; make setup installs both")
  return()
endif()
execute_process(COMMAND ${NODE} --test --test-reporter=spec ${SCRIPT} RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${SCRIPT} failed")
endif()
