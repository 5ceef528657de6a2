#pragma once

#include <string>
#include <string_view>

namespace vantage {

/// A shared library opened on first use, because opening it is slow: it loads about a hundred
/// others. Define it at its point of use, as a `static const` of a function; it is never closed.
/// Thread rule: may be used concurrently.
class LateLibrary {
 public:
  /// Opens the library `file_name` (`libNAME.so.VERSION`) from the system's search path; an already
  /// loaded library is not loaded again. `without_it` says what is impossible without it: "cannot
  /// read videos". Throws Error when the library cannot be opened.
  LateLibrary(std::string file_name, std::string_view without_it);

  /// The function `name` (mangled for C++ functions). Throws Error when the library lacks it.
  template <typename FunctionPointer>
  [[nodiscard]] FunctionPointer function(const char* name) const {
    return reinterpret_cast<FunctionPointer>(address(name));
  }

 private:
  [[nodiscard]] void* address(const char* name) const;

  std::string file_name_;
  std::string without_it_;
  void* handle_;
};

}  // namespace vantage
