#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/rectification/rows/row_field.h"
#include "engine/rectification/vertical_error.h"

namespace vantage {

/// What a look at a pair says of its rows.
struct RowCheck {
  /// None where too few points agree on a smooth field of a few pixels.
  std::optional<RowEstimate> rows;
  /// Of the same points; where they do not agree, of features found anywhere in both images, unless
  /// these do not agree either.
  std::optional<VerticalError> error;

  /// Whether the rows can be corrected, and it pays.
  [[nodiscard]] bool pays() const { return rows && rows->pays(); }
};

/// The rows of a pair that should be rectified. `execution`: null, one thread. Identical for any.
/// Thread rule: may be called concurrently.
RowCheck check_rows(const Photograph& left, const Photograph& right,
                    Execution* execution = nullptr);

/// "right image 1.3 px lower, turned 0.11 degrees"; `lines`: "rows", or "columns" of a transposed
/// pair.
std::string row_text(const RowEstimate& rows, std::string_view lines = "rows");

/// RowCheck::error.
std::optional<VerticalError> check_rectification(const Photograph& left, const Photograph& right,
                                                 Execution* execution = nullptr);

}  // namespace vantage
