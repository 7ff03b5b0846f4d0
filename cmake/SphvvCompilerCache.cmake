# Copies of this tree (of the tutorial, of the seeded faults) compile only what they differ in: paths below the source folder
# are taken as relative, so that a copy finds what the tree has compiled.
find_program(SPHVV_CCACHE ccache DOC "Keeps what has been compiled; none: everything is compiled anew")
if(SPHVV_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${SPHVV_CCACHE})
endif()
