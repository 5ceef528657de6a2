#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/rectification/rows/row_check.h"
#include "engine/remark.h"

namespace vantage {

/// How a pair is matched, for what is told of its rows.
struct RowUse {
  bool is_corrected = false;        ///< the right image was resampled
  bool expects_negative = false;    ///< most disparities should be negative
  std::string_view lines = "rows";  ///< or "columns" of a transposed pair
};

/// Whether rows correspond well enough to be matched, once what `use` says is done.
bool rows_correspond(const RowCheck& check, const RowUse& use);
/// Whether the images look exchanged, and should not.
bool looks_exchanged(const RowCheck& check, const RowUse& use);

/// A note on a correction; warnings of rows that are off by more than kMaxMoreBad_percent of the
/// pixels, and of images that look exchanged. Thread rule: pure.
std::vector<Remark> row_remarks(const RowCheck& check, const RowUse& use);

/// "rows are off by 0.52 px, which makes about 7 % more of the pixels wrong".
std::string cost_text(const VerticalError& error, std::string_view lines);
/// "0.15 px RMS (mean 0.02, 95 % within 0.30, at most 0.91; 240 points)".
std::string vertical_error_text(const VerticalError& error);
/// "left and right look exchanged, or shifted against each other: 97 % of 240 points have negative
/// disparities, -40:2 in all"; "upper and lower" of a pair whose `lines` are "columns".
std::string exchanged_text(const VerticalError& error, std::string_view lines = "rows");
/// The disparities that the pair shows, as whole numbers for `disparities`: "-3:17".
std::string disparities_text(const VerticalError& error);

}  // namespace vantage
