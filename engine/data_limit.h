#pragma once

#include <sys/resource.h>

#include <cstddef>

namespace vantage {

/// Private writable memory of the process in bytes, which RLIMIT_DATA counts; 0: not known.
std::size_t data_bytes();

/// While it lives, the soft RLIMIT_DATA of the process does not apply; then it is higher by what
/// the process took meanwhile. For opening libraries: they do not count for the user's limit, and
/// some end the process where they get no memory. Thread rule: one object at a time.
class UnlimitedData {
 public:
  UnlimitedData();
  UnlimitedData(const UnlimitedData&) = delete;
  UnlimitedData& operator=(const UnlimitedData&) = delete;
  ~UnlimitedData();

 private:
  rlimit before_{};
  std::size_t bytes_before_ = 0;
  bool is_lifted_ = false;
};

}  // namespace vantage
