#include "engine/rectification/rows/row_track.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "engine/rectification/rows/row_correction.h"
#include "engine/rectification/rows/row_points.h"

namespace vantage {
namespace {

/// Of pairs whose fields differ from the common one.
constexpr int kDriftingPart = 4;

RowField mixed(const RowField& from, const RowField& to, double share) {
  RowField::Terms terms = from.coefficients_px();
  for (std::size_t i = 0; i < terms.size(); ++i) {
    terms[i] += share * (to.coefficients_px()[i] - terms[i]);
  }
  return {from.width(), from.height(), terms};
}

RowField without(const RowField& field, const RowField& other) {
  RowField::Terms terms = field.coefficients_px();
  for (std::size_t i = 0; i < terms.size(); ++i) {
    terms[i] -= other.coefficients_px()[i];
  }
  return {field.width(), field.height(), terms};
}

}  // namespace

RowField RowTrack::at(int pair) const {
  const auto next =
      std::find_if(keys.begin(), keys.end(), [pair](const Key& key) { return key.pair >= pair; });
  if (next == keys.begin()) {
    return keys.front().field;
  }
  if (next == keys.end()) {
    return keys.back().field;
  }
  const Key& before = *std::prev(next);
  return mixed(before.field, next->field,
               static_cast<double>(pair - before.pair) / (next->pair - before.pair));
}

void SequenceRowSurvey::add(int pair, const Photograph& left, Photograph& right,
                            Execution& execution) {
  if (width_ == 0) {
    width_ = left.width();
    height_ = left.height();
  }
  if (left.width() != width_ || left.height() != height_) {
    return;
  }
  const std::vector<PointMatch> points = find_row_points(left, right, &execution);
  const auto rows = fit_rows(points, width_, height_);
  if (!rows) {
    return;
  }
  samples_.push_back({pair, *rows});
  points_.insert(points_.end(), points.begin(), points.end());
  if (rows->pays()) {
    Photograph corrected;
    correct_rows(right, rows->field, corrected, execution);
    right = std::move(corrected);
  }
}

SequenceRows SequenceRowSurvey::result() const {
  SequenceRows result{.track = {},
                      .rows = fit_rows(points_, width_, height_),
                      .pairs = static_cast<int>(samples_.size())};
  const auto differs = [&](const Sample& sample) {
    return !result.rows || without(sample.rows.field, result.rows->field).rms_px() >
                               std::max(kMinCorrection_px, 3 * sample.rows.deviation_px);
  };
  const auto differing = std::count_if(samples_.begin(), samples_.end(), differs);
  const bool drifts = differing > 1 && kDriftingPart * differing >= result.pairs;
  if (drifts) {
    result.rows.reset();
    if (std::any_of(samples_.begin(), samples_.end(),
                    [](const Sample& sample) { return sample.rows.pays(); })) {
      for (const Sample& sample : samples_) {
        result.track.keys.push_back({sample.pair, sample.rows.field});
      }
    }
  } else if (result.rows && result.rows->pays()) {
    result.track.keys.push_back({0, result.rows->field});
  }
  return result;
}

}  // namespace vantage
