#include "apps/submit/array_job.h"

#include <algorithm>
#include <cctype>

namespace vantage::apps {

std::string job_name(const std::filesystem::path& output) {
  constexpr std::size_t kMaxLength = 50;  // Kubernetes adds to it, and takes 63
  const std::filesystem::path folder = output.has_filename() ? output : output.parent_path();
  std::string name = "vantage-";
  for (const unsigned char letter : folder.filename().string()) {
    name += std::isalnum(letter) != 0 ? static_cast<char>(std::tolower(letter)) : '-';
  }
  name.resize(std::min(name.size(), kMaxLength));
  return name.substr(0, name.find_last_not_of('-') + 1);
}

}  // namespace vantage::apps
