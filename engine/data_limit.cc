#include "engine/data_limit.h"

#include <algorithm>
#include <fstream>
#include <string>

namespace vantage {

std::size_t data_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmData:")) {
      return std::stoull(line.substr(7)) * 1024;
    }
  }
  return 0;
}

UnlimitedData::UnlimitedData() {
  if (::getrlimit(RLIMIT_DATA, &before_) != 0 || before_.rlim_cur == before_.rlim_max) {
    return;
  }
  bytes_before_ = data_bytes();
  const rlimit lifted{.rlim_cur = before_.rlim_max, .rlim_max = before_.rlim_max};
  is_lifted_ = ::setrlimit(RLIMIT_DATA, &lifted) == 0;
}

UnlimitedData::~UnlimitedData() {
  if (is_lifted_) {
    const std::size_t bytes = data_bytes();
    const std::size_t taken = bytes > bytes_before_ ? bytes - bytes_before_ : 0;
    before_.rlim_cur = std::min<rlim_t>(before_.rlim_cur + taken, before_.rlim_max);
    (void)::setrlimit(RLIMIT_DATA, &before_);
  }
}

}  // namespace vantage
