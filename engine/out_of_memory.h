#pragma once

#include <new>
#include <string>

namespace vantage {

/// A failed allocation and its purpose. what(): "out of memory for ...".
class OutOfMemory : public std::bad_alloc {
 public:
  explicit OutOfMemory(const std::string& purpose) : text_("out of memory for " + purpose) {}
  [[nodiscard]] const char* what() const noexcept override { return text_.c_str(); }

 private:
  std::string text_;
};

}  // namespace vantage
