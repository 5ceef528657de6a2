# program: the command, its manual pages and completion.
install(TARGETS vantage RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
# The name under which Ames Stereo Pipeline starts the command `asp`.
file(CREATE_LINK vantage ${PROJECT_BINARY_DIR}/apps/vantage-asp SYMBOLIC)
install(FILES ${PROJECT_BINARY_DIR}/apps/vantage-asp DESTINATION ${CMAKE_INSTALL_BINDIR}
  COMPONENT program)
if(NOT VANTAGE_SANITIZE)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  set(reference_dir ${PROJECT_BINARY_DIR}/reference)
  file(GLOB reference_scripts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/reference/*.py)
  add_custom_command(OUTPUT ${reference_dir}/man/vantage.1.gz
    COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/cmake/reference/write.py
            ${VANTAGE_COMMAND} ${reference_dir}
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
