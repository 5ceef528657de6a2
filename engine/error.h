#pragma once

#include <stdexcept>
#include <string>

#include "engine/quoted_text.h"

namespace vantage {

/// The engine cannot process its input. what() is one line for the user: what went wrong, where
/// (file, frame or field) and what was expected. Quoted names and values are printable().
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message) : std::runtime_error(printable(message)) {}
};

/// An option, or a combination of options, that is invalid for any data. Apps exit with 2.
class UsageError : public Error {
 public:
  using Error::Error;
};

}  // namespace vantage
