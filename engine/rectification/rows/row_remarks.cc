#include "engine/rectification/rows/row_remarks.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/with_opencv.h"

namespace vantage {
namespace {

std::string what_to_do(const RowCheck& check, std::string_view lines) {
  if (check.pays()) {
    return "`rows` auto corrects them";
  }
  return fmt::format("that is more than `rows` auto corrects{}",
                     lines == "rows" ? ", see 'vantage rectify'" : "");
}

}  // namespace

bool rows_correspond(const RowCheck& check, const RowUse& use) {
  return use.is_corrected || (check.rows && !check.pays()) || !check.error ||
         is_rectified(*check.error);
}

bool looks_exchanged(const RowCheck& check, const RowUse& use) {
  return check.error && check.error->looks_exchanged() && !use.expects_negative;
}

std::vector<Remark> row_remarks(const RowCheck& check, const RowUse& use) {
  using enum Remark::Kind;
  std::vector<Remark> remarks;
  if (!rows_correspond(check, use)) {
    remarks.push_back(
        {kWarning, "rectification",
         fmt::format("the pair is not rectified: {}; {}; {}", cost_text(*check.error, use.lines),
                     vertical_error_text(*check.error), what_to_do(check, use.lines))});
  }
  if (!check.rows && !has_opencv()) {
    remarks.push_back({kNote, "rectification",
                       "too few points tell whether rows correspond; features would, but this "
                       "build is without OpenCV"});
  }
  if (looks_exchanged(check, use)) {
    remarks.push_back({kWarning, "order", exchanged_text(*check.error, use.lines)});
  }
  if (use.is_corrected) {
    remarks.push_back({kNote, "rows",
                       fmt::format("{}: {}; corrected, points agree to {:.2f} px", use.lines,
                                   row_text(*check.rows, use.lines), check.rows->residual_px)});
  }
  return remarks;
}

std::string cost_text(const VerticalError& error, std::string_view lines) {
  return fmt::format("{} are off by {:.2f} px, which makes about {:.0f} % more of the pixels wrong",
                     lines, error.systematic_px, more_bad_percent(error.systematic_px));
}

std::string vertical_error_text(const VerticalError& error) {
  return fmt::format("{:.2f} px RMS (mean {:.2f}, 95 % within {:.2f}, at most {:.2f}; {} points)",
                     error.rms_px, error.mean_px, error.percentile_95_px, error.max_px,
                     error.inliers);
}

std::string exchanged_text(const VerticalError& error, std::string_view lines) {
  return fmt::format(
      "{} look exchanged, or shifted against each other: {:.0f} % of {} points have negative "
      "disparities, {} in all",
      lines == "columns" ? "upper and lower" : "left and right", 100 * error.negative_share,
      error.inliers, disparities_text(error));
}

std::string disparities_text(const VerticalError& error) {
  return fmt::format("{}:{}", static_cast<int>(std::floor(error.min_disparity_px)),
                     static_cast<int>(std::ceil(error.max_disparity_px)));
}

}  // namespace vantage
