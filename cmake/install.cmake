# What `cmake --install` puts where, by component, and the package that find_package(Vantage) finds.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Vantage)

# program: the command, its manual pages and completion.
if(VANTAGE_BUILD_PROGRAM)
  include(cmake/install_program.cmake)
endif()

# development: static libraries, headers and the CMake package.
install(TARGETS vantage_kernels vantage_scheduler vantage_engine EXPORT VantageTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(CODE "set(SOURCE_DIR \"${PROJECT_SOURCE_DIR}\")
              set(INCLUDE_DIR \"${CMAKE_INSTALL_INCLUDEDIR}/vantage\")" COMPONENT development)
install(SCRIPT ${PROJECT_SOURCE_DIR}/cmake/install_headers.cmake COMPONENT development)
install(EXPORT VantageTargets NAMESPACE vantage:: DESTINATION ${package_dir} COMPONENT development)
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/VantageConfig.cmake.in ${PROJECT_BINARY_DIR}/VantageConfig.cmake
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/VantageConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/VantageConfig.cmake
              ${PROJECT_BINARY_DIR}/VantageConfigVersion.cmake
  DESTINATION ${package_dir} COMPONENT development)
