# What `cmake --install` puts where, by component, and the package that find_package(Vantage) finds.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Vantage)

# program: the command, its manual pages and completion.
install(TARGETS vantage RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
# The name under which Ames Stereo Pipeline starts the command `asp`.
file(CREATE_LINK vantage ${PROJECT_BINARY_DIR}/apps/vantage-asp SYMBOLIC)
install(FILES ${PROJECT_BINARY_DIR}/apps/vantage-asp DESTINATION ${CMAKE_INSTALL_BINDIR}
  COMPONENT program)
if(NOT CMAKE_CROSSCOMPILING AND NOT VANTAGE_SANITIZE)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  set(reference_dir ${PROJECT_BINARY_DIR}/reference)
  file(GLOB reference_scripts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/reference/*.py)
  add_custom_command(OUTPUT ${reference_dir}/man/vantage.1.gz
    COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/cmake/reference/write.py
            $<TARGET_FILE:vantage> ${reference_dir}
    DEPENDS vantage ${reference_scripts} COMMENT "Writing manual pages and completion" VERBATIM)
  add_custom_target(vantage_reference ALL DEPENDS ${reference_dir}/man/vantage.1.gz)
  # Optional: who builds the program alone may install it without them.
  install(DIRECTORY ${reference_dir}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1
    COMPONENT program OPTIONAL)
  install(FILES ${reference_dir}/bash/vantage
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program OPTIONAL)
  install(FILES ${reference_dir}/zsh/_vantage
    DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program OPTIONAL)
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
