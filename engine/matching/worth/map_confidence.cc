#include "engine/matching/worth/map_confidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "engine/image/intensity_rows.h"
#include "engine/matching/worth/confidence_table.h"

namespace vantage {
namespace {

// Windows are 5×5 pixels of these distances.
constexpr int kNear_px = 2;
constexpr int kFar_px = 8;
constexpr int kReach_px = 2 * kNear_px;
constexpr float kWindowPixels = 25;
constexpr int kSampleRows = 32;
constexpr int kSampleColumns = 64;

bool is_finite(float value) { return std::abs(value) <= std::numeric_limits<float>::max(); }

/// The grey levels of the rows of an image that rows [first, end) of a map are judged by.
class GreyRows {
 public:
  GreyRows(const Photograph& image, int first, int end)
      : width_(image.width()),
        first_(std::max(first - kReach_px, 0)),
        end_(std::min(end + kReach_px, image.height())),
        grey_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(end_ - first_)) {
    for (int y = first_; y < end_; ++y) {
      intensity_row(image, y, grey_.data() + offset(y));
    }
  }
  /// The nearest of the rows.
  [[nodiscard]] const float* row(int y) const {
    return grey_.data() + offset(std::clamp(y, first_, end_ - 1));
  }

 private:
  [[nodiscard]] std::size_t offset(int y) const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(y - first_);
  }
  int width_;
  int first_;
  int end_;
  std::vector<float> grey_;
};

/// Standard deviation of the values of a window.
class Deviation {
 public:
  void add(float value) {
    sum_ += value;
    squares_ += value * value;
  }
  [[nodiscard]] float value() const {
    const float mean = sum_ / kWindowPixels;
    return std::sqrt(std::max(squares_ / kWindowPixels - mean * mean, 0.0F));
  }

 private:
  float sum_ = 0;
  float squares_ = 0;
};

/// Value of a table at x, linear between its entries.
template <std::size_t N>
float look_up(const std::array<confidence_table::Entry, N>& table, float x) {
  const float inside = std::clamp(x, table.front().at, table.back().at);
  std::size_t i = 1;
  while (i + 1 < N && table[i].at < inside) {
    ++i;
  }
  const auto& [low, at_low] = table[i - 1];
  const auto& [high, at_high] = table[i];
  return at_low + (at_high - at_low) * ((inside - low) / (high - low));
}

/// What is found at a pixel.
struct Judgement {
  float score = std::numeric_limits<float>::quiet_NaN();  ///< NaN: its disparity is unknown
  bool is_flat = false;                                   ///< all pixels of its window are equal
  bool is_scene = true;                                   ///< it is not left out
};

/// Judges the pixels of rows [first, end) of a map.
class RowJudge {
 public:
  RowJudge(const FinishedMap& finished, int first, int end)
      : finished_(finished),
        disparity_px_(finished.map->disparity_px),
        width_(disparity_px_.width()),
        own_(*finished.image, first, end) {
    if (finished.other != nullptr) {
      other_.emplace(*finished.other, first, end);
    }
  }

  [[nodiscard]] Judgement judge(int x, int y) const {
    const float own_px = disparity_px_.at(x, y);
    if (!is_finite(own_px)) {
      return {};
    }
    namespace table = confidence_table;
    Judgement judgement = judge_window(x, y, own_px);
    if (finished_.has_mask && finished_.is_checked) {
      judgement.score += (is_unmatched(x, y) ? table::kUnmatched : 0.0F) +
                         look_up(table::kUnmatchedNear, unmatched_share(x, y, kNear_px)) +
                         look_up(table::kUnmatchedFar, unmatched_share(x, y, kFar_px));
    }
    return judgement;
  }

 private:
  [[nodiscard]] int row_at(int y) const { return std::clamp(y, 0, disparity_px_.height() - 1); }
  [[nodiscard]] int column_at(int x) const { return std::clamp(x, 0, width_ - 1); }
  [[nodiscard]] bool is_unmatched(int x, int y) const {
    return finished_.map->unmatched.at(x, y) != 0;
  }
  [[nodiscard]] float unmatched_share(int x, int y, int step_px) const {
    int count = 0;
    for (int i = -2; i <= 2; ++i) {
      const std::uint8_t* const row = finished_.map->unmatched.row(row_at(y + i * step_px));
      for (int j = -2; j <= 2; ++j) {
        count += row[column_at(x + j * step_px)] != 0 ? 1 : 0;
      }
    }
    return static_cast<float>(count) / kWindowPixels;
  }
  /// Column of the other image that shows column x.
  [[nodiscard]] float partner(int x, float px) const {
    return static_cast<float>(x) + (finished_.side == Side::kLeft ? -px : px);
  }

  [[nodiscard]] Judgement judge_window(int x, int y, float own_px) const {
    Deviation texture;
    std::array<Deviation, 3> differences;  // to the partner a pixel to the left, itself, right
    int alike = 0;
    const float centre = own_.row(y)[x];
    std::array<int, 5> columns;
    for (int j = 0; j < 5; ++j) {
      columns[static_cast<std::size_t>(j)] = column_at(x + (j - 2) * kNear_px);
    }
    for (int i = -2; i <= 2; ++i) {
      const int row = row_at(y + i * kNear_px);
      const float* const map_row = disparity_px_.row(row);
      const float* const own_row = own_.row(row);
      const float* const other_row = other_ ? other_->row(row) : nullptr;
      for (const int column : columns) {
        const float px = is_finite(map_row[column]) ? map_row[column] : own_px;
        alike += std::abs(px - own_px) <= 1 ? 1 : 0;
        texture.add(own_row[column] - centre);
        if (other_row != nullptr) {
          add_differences(other_row, partner(column, px), own_row[column], differences);
        }
      }
    }
    namespace table = confidence_table;
    float score = look_up(table::kTexture, texture.value()) +
                  look_up(table::kAlike, static_cast<float>(alike) / kWindowPixels);
    if (other_) {
      const float at = partner(x, own_px);
      const float residual = differences[1].value();
      const float beside = std::min(differences[0].value(), differences[2].value());
      score += look_up(table::kResidual, residual) +
               look_up(table::kRelativeResidual,
                       (residual + table::kNoise) / (texture.value() + table::kNoise)) +
               look_up(table::kSharpness, (beside + table::kNoise) / (residual + table::kNoise)) +
               look_up(table::kOutside, std::max(-at, at - static_cast<float>(width_ - 1)));
    }
    return {.score = score, .is_flat = texture.value() == 0};
  }

  void add_differences(const float* other, float at, float grey,
                       std::array<Deviation, 3>& differences) const {
    const float inside = std::clamp(at, -2.0F, static_cast<float>(width_ + 1));
    const int left = static_cast<int>(std::floor(inside));
    const float part = inside - static_cast<float>(left);
    std::array<float, 4> at_border;
    const float* values = other + left - 1;
    if (left < 1 || left + 2 >= width_) {
      for (int k = 0; k < 4; ++k) {
        at_border[static_cast<std::size_t>(k)] = other[column_at(left - 1 + k)];
      }
      values = at_border.data();
    }
    for (std::size_t k = 0; k < 3; ++k) {
      differences[k].add(grey - (values[k] + part * (values[k + 1] - values[k])));
    }
  }

  const FinishedMap& finished_;
  const DisparityMap& disparity_px_;
  int width_;
  GreyRows own_;
  std::optional<GreyRows> other_;
};

/// A sample of the pixels that are not left out.
std::vector<Judgement> sample_of(const FinishedMap& finished, Execution& execution) {
  const Mask& left_out = finished.image->left_out;
  const int width = finished.map->disparity_px.width();
  const int height = finished.map->disparity_px.height();
  const int rows = std::min(height, kSampleRows);
  const int columns = std::min(width, kSampleColumns);
  std::vector<Judgement> sample(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  execution.executor().parallel_for(rows, [&](int i) {
    const int y = (2 * i + 1) * height / (2 * rows);
    const RowJudge judge(finished, y, y + 1);
    Judgement* const of_row = sample.data() + static_cast<std::ptrdiff_t>(i) * columns;
    for (int j = 0; j < columns; ++j) {
      const int x = (2 * j + 1) * width / (2 * columns);
      const bool is_scene = left_out.empty() || left_out.at(x, y) == 0;
      of_row[j] = is_scene ? judge.judge(x, y) : Judgement{.is_scene = false};
    }
  });
  std::erase_if(sample, [](const Judgement& one) { return !one.is_scene; });
  return sample;
}

/// What the map as a whole adds to the score of a pixel.
float score_of_map(const std::vector<Judgement>& sample) {
  double sum = 0;
  int known = 0;
  int flat = 0;
  for (const Judgement& one : sample) {
    if (!std::isnan(one.score)) {
      sum += static_cast<double>(one.score);
      ++known;
      flat += one.is_flat ? 1 : 0;
    }
  }
  if (known == 0) {
    return 0;
  }
  // Images without any contrast agree everywhere.
  const double without_contrast = std::max(static_cast<double>(flat) / known - 0.5, 0.0);
  return confidence_table::kIntercept + confidence_table::kOfMap * static_cast<float>(sum / known) -
         static_cast<float>(12 * without_contrast);
}

float confidence_of(const Judgement& pixel, float of_map) {
  return std::isnan(pixel.score) ? 0.0F
                                 : look_up(confidence_table::kLogistic, pixel.score + of_map);
}

}  // namespace

void map_confidence(const FinishedMap& finished, Execution& execution, Image<float>& confidence) {
  const DisparityMap& disparity_px = finished.map->disparity_px;
  const float of_map = score_of_map(sample_of(finished, execution));
  confidence.resize(disparity_px.width(), disparity_px.height());
  execution.for_each_band(disparity_px.height(), [&](int first, int end) {
    const RowJudge judge(finished, first, end);
    for (int y = first; y < end; ++y) {
      float* const row = confidence.row(y);
      for (int x = 0; x < disparity_px.width(); ++x) {
        row[x] = confidence_of(judge.judge(x, y), of_map);
      }
    }
  });
}

double mean_confidence(const FinishedMap& finished, Execution& execution) {
  const std::vector<Judgement> sample = sample_of(finished, execution);
  const float of_map = score_of_map(sample);
  double sum = 0;
  for (const Judgement& pixel : sample) {
    sum += static_cast<double>(confidence_of(pixel, of_map));
  }
  return sample.empty() ? 0 : sum / static_cast<double>(sample.size());
}

}  // namespace vantage
