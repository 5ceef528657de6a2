#include "engine/rectification/rows/row_check.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/rectification/rows/row_points.h"
#include "engine/with_opencv.h"

namespace vantage {
namespace {

/// Of the features that count where rows are not nearly rectified.
constexpr int kFeatures = 1000;
constexpr int kFeatureSide_px = 640;
/// Features of repeated texture are mistaken for each other.
constexpr double kToldTurn_degrees = 0.005;
constexpr double kMinFeatureShare = 0.5;

}  // namespace

RowCheck check_rows(const Photograph& left, const Photograph& right, Execution* execution) {
  const std::vector<PointMatch> points = find_row_points(left, right, execution);
  RowCheck check{.rows = fit_rows(points, left.width(), left.height()), .error = std::nullopt};
  if (check.rows) {
    check.error = vertical_error(points);
    return check;
  }
  if (!has_opencv()) {
    return check;
  }
  check.error = vertical_error(match_features(
      left, right,
      {.kind = FeatureKind::kOrb, .max_features = kFeatures, .largest_side_px = kFeatureSide_px}));
  if (check.error && check.error->inliers < kMinFeatureShare * check.error->matches) {
    check.error.reset();
  }
  return check;
}

std::string row_text(const RowEstimate& rows, std::string_view lines) {
  const double offset_px = rows.field.offset_px();
  const double turn = rows.field.turn_degrees();
  const bool is_of_rows = lines == "rows";
  std::string text = fmt::format("right image {:.2f} px {}", std::abs(offset_px),
                                 offset_px >= 0 ? (is_of_rows ? "lower" : "to the right")
                                                : (is_of_rows ? "higher" : "to the left"));
  if (std::abs(turn) >= kToldTurn_degrees) {
    text += fmt::format(", turned {:.2f} degrees", is_of_rows ? turn : -turn);
  }
  if (rows.terms > 3) {
    text += fmt::format(", up to {:.1f} px at the border", rows.field.max_px());
  }
  return text;
}

std::optional<VerticalError> check_rectification(const Photograph& left, const Photograph& right,
                                                 Execution* execution) {
  return check_rows(left, right, execution).error;
}

}  // namespace vantage
