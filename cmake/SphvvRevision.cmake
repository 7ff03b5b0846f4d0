# Run at every build: writes the source revision to OUT, and touches it only if it changed.
execute_process(COMMAND git -C ${SOURCE} rev-parse HEAD OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE
                RESULT_VARIABLE status ERROR_QUIET)
# A copy within another repository, as of a seeded fault in the folder of the build, is not what that one's revision names.
execute_process(COMMAND git -C ${SOURCE} rev-parse --show-prefix OUTPUT_VARIABLE prefix OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
set(clean true)
if(NOT status EQUAL 0 OR NOT prefix STREQUAL "")
  set(revision "unknown")
  set(clean false)
else()
  execute_process(COMMAND git -C ${SOURCE} status --porcelain OUTPUT_VARIABLE changes ERROR_QUIET)
  if(NOT changes STREQUAL "")
    set(clean false)
  endif()
endif()
set(text "#pragma once
#define SPHVV_VERSION \"${VERSION}\"
#define SPHVV_REVISION \"${revision}\"
#define SPHVV_TREE_CLEAN ${clean}
#define SPHVV_COMPILER \"${COMPILER}\"
#define SPHVV_FLAGS \"${FLAGS}\"
#define SPHVV_BUILD_TYPE \"${BUILD_TYPE}\"
")
file(CONFIGURE OUTPUT ${OUT} CONTENT "${text}")
