# vantage_embed_pages(FILE.cc FOLDER...): a rule that writes FILE.cc, the text of all files in these
# folders of apps/pages (apps/pages/embedded_files.h).
function(vantage_embed_pages output)
  set(page_dir ${PROJECT_SOURCE_DIR}/apps/pages)
  list(TRANSFORM ARGN REPLACE "(.+)" "${page_dir}/\\1/*" OUTPUT_VARIABLE patterns)
  file(GLOB files RELATIVE ${page_dir} CONFIGURE_DEPENDS ${patterns})
  list(JOIN files "," names)
  list(TRANSFORM files PREPEND ${page_dir}/)
  set(script ${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake)
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -D OUTPUT=${output} -D FOLDER=${page_dir} -D NAMES=${names} -P ${script}
    DEPENDS ${files} ${script} VERBATIM)
endfunction()
