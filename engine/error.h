#pragma once

#include <stdexcept>
#include <string>

#include "engine/quoted_text.h"

namespace vantage {

/// Something the engine cannot do with what it was given. what() is one line for the user: what
/// went wrong, where (file, frame or field), what was expected. Whatever names and values the
/// message quotes, it is printable().
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message) : std::runtime_error(printable(message)) {}
};

/// An option or a combination of options that is wrong whatever the data. Apps exit with 2.
class UsageError : public Error {
 public:
  using Error::Error;
};

}  // namespace vantage
