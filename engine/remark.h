#pragma once

#include <string>
#include <string_view>

namespace vantage {

/// What a call found in its input or result, what it assumed or corrected: for people. The program
/// prints remarks and writes them to its report; the Python module warns of warnings.
struct Remark {
  enum class Kind { kNote, kWarning };
  Kind kind = Kind::kNote;
  /// One word for all remarks of this origin: "rows", "noise", "range". Static storage. Where many
  /// pairs have the same, one of each kind and subject is told.
  std::string_view subject;
  std::string text;  ///< one line; names options as `name`

  [[nodiscard]] bool is_warning() const { return kind == Kind::kWarning; }
};

}  // namespace vantage
