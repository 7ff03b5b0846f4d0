# An installation that others use with find_package(sphvv) and sphvv::analytic, sphvv::solver, sphvv::verification.
include(CMakePackageConfigHelpers)

install(TARGETS sphvv_analytic sphvv_solver sphvv_verification EXPORT sphvvTargets)
install(EXPORT sphvvTargets NAMESPACE sphvv:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sphvv)
foreach(room analytic solver verification)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sphvv
          FILES_MATCHING PATTERN "*.hpp" PATTERN tests EXCLUDE PATTERN fuzz EXCLUDE)
endforeach()
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/sphvvConfig.cmake.in ${PROJECT_BINARY_DIR}/sphvvConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sphvv)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sphvvConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/sphvvConfig.cmake ${PROJECT_BINARY_DIR}/sphvvConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sphvv)

# Installs into a scratch folder, then configures, builds and runs a program of somebody else's against it.
add_test(NAME cli.find_package
         COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR} -DCONSUMER=${PROJECT_SOURCE_DIR}/cmake/consumer
                 -DSCRATCH=${PROJECT_BINARY_DIR}/consumer -DGENERATOR=${CMAKE_GENERATOR} -DCXX=${CMAKE_CXX_COMPILER}
                 -P ${PROJECT_SOURCE_DIR}/cmake/consumer/run.cmake)
set_tests_properties(cli.find_package PROPERTIES LABELS cli)
