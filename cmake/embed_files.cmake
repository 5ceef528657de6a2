# Writes a C++ file that holds text files: cmake -D OUTPUT=FILE.cc -D FOLDER=DIR -D NAMES=A,B -P …
#
# It defines the vantage::apps::embedded_file() of apps/pages/embedded_files.h for these names.
string(REPLACE "," ";" names "${NAMES}")
set(table "")
foreach(name IN LISTS names)
  file(READ "${FOLDER}/${name}" text)
  if(text MATCHES "\\)\\^file\\^\"")
    message(FATAL_ERROR "${name} holds )^file^\", which ends its text in the C++ file")
  endif()
  string(APPEND table "    {\"${name}\",\n     R\"^file^(${text})^file^\"},\n")
endforeach()
file(WRITE "${OUTPUT}" "// Made by cmake/embed_files.cmake.
#include \"apps/pages/embedded_files.h\"

#include <stdexcept>
#include <string>

namespace vantage::apps {
namespace {

struct File {
  std::string_view name;
  std::string_view text;
};
constexpr File kFiles[] = {
${table}};

}  // namespace

std::string_view embedded_file(std::string_view name) {
  for (const File& file : kFiles) {
    if (file.name == name) {
      return file.text;
    }
  }
  throw std::logic_error(\"no embedded file \" + std::string(name));
}

}  // namespace vantage::apps
")
