#include "engine/evaluation/view_evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "engine/error.h"

namespace vantage {
namespace {

constexpr int kWindow = 11;
constexpr double kWindowSigma = 1.5;
constexpr double kLevelRange = 255;
constexpr double kC1 = (0.01 * kLevelRange) * (0.01 * kLevelRange);
constexpr double kC2 = (0.03 * kLevelRange) * (0.03 * kLevelRange);

struct DifferenceSums {
  std::int64_t pixels = 0;
  double absolute = 0;
  double squared = 0;
};

DifferenceSums row_differences(const std::vector<double>& a, const std::vector<double>& b,
                               int channels, const std::uint8_t* mask) {
  DifferenceSums sums;
  const int width = static_cast<int>(a.size()) / channels;
  for (int x = 0; x < width; ++x) {
    if (mask != nullptr && mask[x] != 255) {
      continue;
    }
    ++sums.pixels;
    for (int i = x * channels; i < (x + 1) * channels; ++i) {
      const double difference = a[i] - b[i];
      sums.absolute += std::abs(difference);
      sums.squared += difference * difference;
    }
  }
  return sums;
}

std::array<double, kWindow> gaussian_window() {
  std::array<double, kWindow> weights{};
  double sum = 0;
  for (int i = 0; i < kWindow; ++i) {
    const int offset = i - kWindow / 2;
    const double distance = offset;
    weights[i] = std::exp(-distance * distance / (2 * kWindowSigma * kWindowSigma));
    sum += weights[i];
  }
  for (double& weight : weights) {
    weight /= sum;
  }
  return weights;
}

// Sums the structural similarities of the windows whose top row is y. `rows` holds the luma of the
// window's rows; windowed moments are separable, first along y, then along x.
class WindowRow {
 public:
  explicit WindowRow(int width) : width_(width) {
    for (auto& moment : moments_) {
      moment.resize(static_cast<std::size_t>(width));
    }
  }

  double sum_of_similarities(const std::array<const double*, kWindow>& a_rows,
                             const std::array<const double*, kWindow>& b_rows,
                             const std::array<double, kWindow>& weights) {
    for (auto& moment : moments_) {
      std::fill(moment.begin(), moment.end(), 0.0);
    }
    auto& [a_mean, b_mean, aa, bb, ab] = moments_;
    for (int j = 0; j < kWindow; ++j) {
      for (int x = 0; x < width_; ++x) {
        const double a = a_rows[j][x];
        const double b = b_rows[j][x];
        a_mean[x] += weights[j] * a;
        b_mean[x] += weights[j] * b;
        aa[x] += weights[j] * a * a;
        bb[x] += weights[j] * b * b;
        ab[x] += weights[j] * a * b;
      }
    }
    double sum = 0;
    for (int x = 0; x + kWindow <= width_; ++x) {
      std::array<double, 5> m{};
      for (int i = 0; i < kWindow; ++i) {
        for (std::size_t k = 0; k < m.size(); ++k) {
          m[k] += weights[i] * moments_[k][x + i];
        }
      }
      sum += similarity(m);
    }
    return sum;
  }

 private:
  // Equation (13) of the 2004 paper, from the windowed means of a, b, a², b², ab.
  static double similarity(const std::array<double, 5>& m) {
    const auto [a, b, aa, bb, ab] = m;
    const double covariance = ab - a * b;
    const double variances = (aa - a * a) + (bb - b * b);
    return ((2 * a * b + kC1) * (2 * covariance + kC2)) /
           ((a * a + b * b + kC1) * (variances + kC2));
  }

  int width_;
  std::array<std::vector<double>, 5> moments_;
};

double mean_similarity(const Photograph& view, const Photograph& truth, Execution& execution) {
  const int window_rows = view.height() - kWindow + 1;
  const std::array<double, kWindow> weights = gaussian_window();
  std::vector<double> row_sums(static_cast<std::size_t>(window_rows));
  execution.for_each_band(window_rows, [&](int first_row, int end_row) {
    std::vector<std::vector<double>> view_luma(end_row - first_row + kWindow - 1);
    std::vector<std::vector<double>> truth_luma(view_luma.size());
    for (std::size_t i = 0; i < view_luma.size(); ++i) {
      read_level_row(view, first_row + static_cast<int>(i), 1, view_luma[i]);
      read_level_row(truth, first_row + static_cast<int>(i), 1, truth_luma[i]);
    }
    WindowRow windows(view.width());
    std::array<const double*, kWindow> view_rows{};
    std::array<const double*, kWindow> truth_rows{};
    for (int y = first_row; y < end_row; ++y) {
      for (int j = 0; j < kWindow; ++j) {
        view_rows[j] = view_luma[y - first_row + j].data();
        truth_rows[j] = truth_luma[y - first_row + j].data();
      }
      row_sums[y] = windows.sum_of_similarities(view_rows, truth_rows, weights);
    }
  });
  double sum = 0;
  for (const double row_sum : row_sums) {
    sum += row_sum;
  }
  return sum / (static_cast<double>(window_rows) * (view.width() - kWindow + 1));
}

}  // namespace

double psnr_db(double mean_squared_difference) {
  return mean_squared_difference == 0
             ? std::numeric_limits<double>::infinity()
             : 10 * std::log10(kLevelRange * kLevelRange / mean_squared_difference);
}

int compared_channels(const Photograph& a, const Photograph& b) {
  return std::min(a.channels(), b.channels()) >= 3 ? 3 : 1;
}

void read_level_row(const Photograph& photograph, int y, int channels,
                    std::vector<double>& levels) {
  std::visit(
      [&]<typename T>(const Image<T>& image) {
        constexpr double kScale = kGreyLevelsPerUnit<T>;
        const int stored = image.channels();
        const T* row = image.row(y);
        levels.resize(static_cast<std::size_t>(image.width()) * channels);
        for (int x = 0; x < image.width(); ++x) {
          const T* pixel = row + x * stored;
          if (channels == 1 && stored >= 3) {
            levels[x] = kScale * (0.299 * pixel[0] + 0.587 * pixel[1] + 0.114 * pixel[2]);
            continue;
          }
          for (int c = 0; c < channels; ++c) {
            levels[x * channels + c] = kScale * pixel[c];
          }
        }
      },
      photograph.pixels);
}

void require_equal_size(const char* what, int width, int height, const Photograph& truth) {
  if (width != truth.width() || height != truth.height()) {
    throw Error(fmt::format("{} is {}x{}, expected {}x{} as the other image", what, width, height,
                            truth.width(), truth.height()));
  }
}

ViewScores evaluate_view(const Photograph& view, const Photograph& truth, Execution& execution,
                         std::optional<ImageView<const std::uint8_t>> mask) {
  require_equal_size("the view", view.width(), view.height(), truth);
  if (mask) {
    require_equal_size("the mask", mask->width(), mask->height(), truth);
  }
  const int channels = compared_channels(view, truth);
  std::vector<DifferenceSums> rows(static_cast<std::size_t>(view.height()));
  execution.for_each_band(view.height(), [&](int first_row, int end_row) {
    std::vector<double> view_row;
    std::vector<double> truth_row;
    for (int y = first_row; y < end_row; ++y) {
      read_level_row(view, y, channels, view_row);
      read_level_row(truth, y, channels, truth_row);
      rows[y] = row_differences(view_row, truth_row, channels, mask ? mask->row(y) : nullptr);
    }
  });
  DifferenceSums total;
  for (const DifferenceSums& row : rows) {
    total.pixels += row.pixels;
    total.absolute += row.absolute;
    total.squared += row.squared;
  }
  if (total.pixels == 0) {
    throw Error("no pixels to compare, expected an image with pixels and a mask that is not empty");
  }

  const double values = static_cast<double>(total.pixels) * channels;
  ViewScores scores;
  scores.pixels = total.pixels;
  scores.mean_absolute_difference = total.absolute / values;
  scores.mean_squared_difference = total.squared / values;
  scores.psnr_db = psnr_db(scores.mean_squared_difference);
  if (view.width() >= kWindow && view.height() >= kWindow) {
    scores.ssim = mean_similarity(view, truth, execution);
  }
  return scores;
}

void ViewFlicker::add(const Photograph& view, const Photograph& truth,
                      std::optional<ImageView<const std::uint8_t>> mask) {
  require_equal_size("the view", view.width(), view.height(), truth);
  const int channels = compared_channels(view, truth);
  const bool has_last = !errors_.empty();
  if (has_last) {
    require_equal_size("the frame before", errors_.width(), errors_.height(), truth);
  }
  if (has_last && errors_.channels() != channels) {
    throw Error("the frame is grey or in colour, expected as the one before");
  }
  errors_.resize(view.width(), view.height(), channels);
  std::vector<double> view_row;
  std::vector<double> truth_row;
  for (int y = 0; y < view.height(); ++y) {
    read_level_row(view, y, channels, view_row);
    read_level_row(truth, y, channels, truth_row);
    float* errors = errors_.row(y);
    for (int x = 0; x < view.width(); ++x) {
      double change = 0;
      for (int i = x * channels; i < (x + 1) * channels; ++i) {
        const auto error = static_cast<float>(view_row[i] - truth_row[i]);
        change += std::abs(error - std::exchange(errors[i], error));
      }
      const bool is_masked =
          (mask && mask->row(y)[x] == 255) || (!mask_.empty() && mask_.at(x, y) == 255);
      for (int k = 0; has_last && k <= (is_masked ? 1 : 0); ++k) {
        levels_[k] += change;
        values_[k] += channels;
      }
    }
  }
  mask_ = mask ? Mask::copy_of(*mask) : Mask();
}

std::optional<double> ViewFlicker::mean_of(std::size_t pixels) const {
  return values_[pixels] == 0
             ? std::nullopt
             : std::optional(levels_[pixels] / static_cast<double>(values_[pixels]));
}

}  // namespace vantage
