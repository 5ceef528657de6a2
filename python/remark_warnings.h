#pragma once

#include <pybind11/pybind11.h>

#include <set>
#include <span>
#include <string>

#include "engine/quoted_text.h"
#include "engine/remark.h"

namespace vantage::python {

/// Warns (warnings.warn) of remarks, once of each subject. Thread rule: with the GIL.
class RemarkWarnings {
 public:
  /// Of the line that called the function of the package. Throws where warnings are errors.
  void warn(std::span<const Remark> remarks) {
    for (const Remark& remark : remarks) {
      if (told_.emplace(remark.subject).second &&
          PyErr_WarnEx(PyExc_UserWarning, printable(remark.text).c_str(), 2) != 0) {
        throw pybind11::error_already_set();
      }
    }
  }

 private:
  std::set<std::string> told_;
};

}  // namespace vantage::python
