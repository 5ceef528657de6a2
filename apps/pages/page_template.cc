#include "apps/pages/page_template.h"

namespace vantage::apps {

std::string filled_in(std::string_view page, const std::map<std::string_view, std::string>& parts) {
  std::string result;
  while (true) {
    const std::size_t begin = page.find("{{");
    result += page.substr(0, begin);
    if (begin == std::string_view::npos) {
      return result;
    }
    const std::size_t end = page.find("}}", begin);
    result += parts.at(page.substr(begin + 2, end - begin - 2));
    page.remove_prefix(end + 2);
  }
}

std::string json_in_html(std::string_view json) {
  std::string result;
  for (const char letter : json) {
    if (letter == '<') {
      result += "\\u003c";
    } else {
      result += letter;
    }
  }
  return result;
}

}  // namespace vantage::apps
