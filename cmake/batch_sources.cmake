# vantage_batch_sources(RESULT NAME FILE...): RESULT becomes what to compile in place of FILE...; NAME
# tells the batches of several targets of a folder apart.
#
# With VANTAGE_BATCH_SOURCES, files of one folder are compiled by the dozen, as one file that
# includes them: most of the time of a compilation goes into headers, which they share. Names in
# unnamed namespaces must then differ within a folder. Batches name their files relative to the
# checkout, so that checkouts in different places can share a compiler cache. A batch holds files of
# one folder, so that a new file changes few batches, unless VANTAGE_BATCH_ACROSS_FOLDERS is set.
set(vantage_batch_size 12)

function(vantage_batch_sources result name)
  if(NOT VANTAGE_BATCH_SOURCES)
    set(${result} ${ARGN} PARENT_SCOPE)
    return()
  endif()
  set(folders "")
  foreach(file IN LISTS ARGN)
    file(RELATIVE_PATH file ${PROJECT_SOURCE_DIR} ${file})
    get_filename_component(folder ${file} DIRECTORY)
    if(VANTAGE_BATCH_ACROSS_FOLDERS)
      set(folder ${name})
    endif()
    string(MAKE_C_IDENTIFIER ${folder} folder)
    list(APPEND folders ${folder})
    list(APPEND files_of_${folder} ${file})
  endforeach()
  list(REMOVE_DUPLICATES folders)
  set(batches "")
  foreach(folder IN LISTS folders)
    list(LENGTH files_of_${folder} count)
    # Batches of about equal size, none above the limit.
    math(EXPR number "(${count} + ${vantage_batch_size} - 1) / ${vantage_batch_size}")
    math(EXPR size "(${count} + ${number} - 1) / ${number}")
    math(EXPR last "${count} - 1")
    foreach(first RANGE 0 ${last} ${size})
      list(SUBLIST files_of_${folder} ${first} ${size} members)
      list(TRANSFORM members PREPEND "#include \"")
      list(TRANSFORM members APPEND "\"\n")
      list(JOIN members "" text)
      set(batch ${CMAKE_CURRENT_BINARY_DIR}/batches/${name}_${folder}_${first}.cc)
      file(CONFIGURE OUTPUT ${batch} CONTENT "${text}" @ONLY)
      list(APPEND batches ${batch})
    endforeach()
  endforeach()
  set(${result} ${batches} PARENT_SCOPE)
endfunction()
