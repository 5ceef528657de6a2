# What `cmake --install` puts where, and the package that find_package(Vantage) finds.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Vantage)

install(TARGETS vantage_kernels vantage_scheduler vantage_engine EXPORT VantageTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS vantage RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/kernels ${PROJECT_SOURCE_DIR}/scheduler
                  ${PROJECT_SOURCE_DIR}/engine
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vantage FILES_MATCHING PATTERN "*.h"
  # FFmpeg's headers and those of the JSON library are for .cc files.
  PATTERN libav_functions.h EXCLUDE
  PATTERN json_text.h EXCLUDE)
install(EXPORT VantageTargets NAMESPACE vantage:: DESTINATION ${package_dir})

configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/VantageConfig.cmake.in ${PROJECT_BINARY_DIR}/VantageConfig.cmake
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/VantageConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/VantageConfig.cmake
              ${PROJECT_BINARY_DIR}/VantageConfigVersion.cmake
  DESTINATION ${package_dir})
