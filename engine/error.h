#pragma once

#include <stdexcept>
#include <string>

namespace vantage {

/// Something the engine cannot do with what it was given. what() is one line for the user: what
/// went wrong, where (file, frame or field), what was expected.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An option or a combination of options that is wrong whatever the data. Apps exit with 2.
class UsageError : public Error {
 public:
  using Error::Error;
};

}  // namespace vantage
