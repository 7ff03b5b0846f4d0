# One night for a dashboard: configures, builds, runs the tests of the label "nightly" (every study of the nightly tier, then the
# comparison with baselines and history and the report) and submits the outcome to a CDash server, if one is named.
#
#   ctest -S scripts/dashboard.cmake
#   ctest -DSPHVV_CDASH=https://cdash.example.org/submit.php?project=sphvv -S scripts/dashboard.cmake
#
# Options, each as -DNAME=VALUE before -S: SPHVV_CDASH (address; none: nothing is submitted), SPHVV_BUILD (folder of the build;
# build/nightly of this tree), SPHVV_TARGET (what is built; the program, which is all that a night needs), SPHVV_LABEL (regular
# expression of test labels; nightly), SPHVV_TESTS (of test names; all), SPHVV_SITE, SPHVV_MODEL (Nightly, Experimental, …).
# Exit status: 0; another if anything was not built, failed or could not be submitted.
cmake_minimum_required(VERSION 3.25)

cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH CTEST_SOURCE_DIRECTORY)
function(default name value)
  if(NOT DEFINED ${name})
    set(${name} "${value}" PARENT_SCOPE)
  endif()
endfunction()
default(SPHVV_BUILD "${CTEST_SOURCE_DIRECTORY}/build/nightly")
default(SPHVV_LABEL "^nightly$")
default(SPHVV_TESTS ".")
default(SPHVV_TARGET sphvv)
default(SPHVV_MODEL Nightly)
if(NOT DEFINED SPHVV_SITE)
  cmake_host_system_information(RESULT SPHVV_SITE QUERY HOSTNAME)
endif()

set(CTEST_BINARY_DIRECTORY "${SPHVV_BUILD}")
set(CTEST_SITE "${SPHVV_SITE}")
set(CTEST_CMAKE_GENERATOR Ninja)
set(CTEST_BUILD_CONFIGURATION Release)
set(CTEST_CONFIGURATION_TYPE Nightly) # the tests that only a night runs
cmake_host_system_information(RESULT CTEST_BUILD_NAME QUERY OS_NAME)
find_program(CTEST_GIT_COMMAND git)
set(CTEST_NIGHTLY_START_TIME "00:00:00 UTC") # nightly runs of one day belong together
set(CTEST_UPDATE_VERSION_ONLY ON) # the revision is told, the tree stays as it is

set(failed "")
ctest_start(${SPHVV_MODEL})
if(CTEST_GIT_COMMAND AND EXISTS "${CTEST_SOURCE_DIRECTORY}/.git")
  ctest_update()
endif()
ctest_configure(OPTIONS "-DCMAKE_BUILD_TYPE=Release" RETURN_VALUE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "dashboard: the tree cannot be configured, see ${SPHVV_BUILD}/Testing")
endif()
ctest_build(TARGET ${SPHVV_TARGET} RETURN_VALUE status NUMBER_ERRORS errors)
if(NOT status EQUAL 0 OR errors GREATER 0)
  list(APPEND failed "the build failed")
else()
  ctest_test(INCLUDE_LABEL "${SPHVV_LABEL}" INCLUDE "${SPHVV_TESTS}" RETURN_VALUE status)
  if(NOT status EQUAL 0)
    list(APPEND failed "a test failed")
  endif()
endif()
if(SPHVV_CDASH)
  set(CTEST_SUBMIT_URL "${SPHVV_CDASH}")
  ctest_submit(RETRY_COUNT 1 RETRY_DELAY 2 RETURN_VALUE status CAPTURE_CMAKE_ERROR error)
  if(NOT status EQUAL 0 OR NOT error EQUAL 0)
    list(APPEND failed "nothing was submitted: the server ${SPHVV_CDASH} did not take it")
  endif()
else()
  message(STATUS "dashboard: no server is named (SPHVV_CDASH), so nothing is submitted")
endif()
if(failed)
  list(JOIN failed "; " sentence)
  message(FATAL_ERROR "dashboard: ${sentence}")
endif()
