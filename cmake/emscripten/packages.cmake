# The packages of the core for Emscripten: Debian's headers, which serve every processor; fmt is
# compiled in, and of Highway, which here has one instruction set, nothing else is needed.
# Links, because beside these headers lie those of the C library of this machine.
set(header_dir ${PROJECT_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${header_dir})
foreach(folder fmt hwy nlohmann)
  if(NOT EXISTS /usr/include/${folder})
    message(FATAL_ERROR "There is no /usr/include/${folder}")
  endif()
  file(CREATE_LINK /usr/include/${folder} ${header_dir}/${folder} SYMBOLIC)
endforeach()
foreach(package Eigen3::Eigen fmt::fmt PkgConfig::hwy nlohmann_json::nlohmann_json)
  add_library(${package} INTERFACE IMPORTED)
  target_include_directories(${package} SYSTEM INTERFACE ${header_dir} /usr/include/eigen3)
endforeach()
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)

add_compile_options(-msimd128 -mnontrapping-fptoint -mbulk-memory -fexceptions
  -include ${CMAKE_CURRENT_LIST_DIR}/standard_library.h)
add_link_options(-fexceptions)
