#pragma once

#include <string>
#include <string_view>

namespace vantage {

/// A shared library that is opened only when something needs it, because opening it takes long: it
/// brings a hundred others along. Made where it is first used, as a `static const` of a function,
/// and never closed. Thread rule: may be used concurrently.
class LateLibrary {
 public:
  /// Opens the library of this file name, `libNAME.so.VERSION`, where the system looks for
  /// libraries; those that are open already are not opened again. `without_it` says what is
  /// impossible without it, "cannot read videos". Throws Error when the library cannot be opened.
  LateLibrary(std::string file_name, std::string_view without_it);

  /// The function that has this name, the mangled one of a C++ function. Throws Error when the
  /// library has none.
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
