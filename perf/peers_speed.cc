// Kernels against OpenCV's functions for the same step, on equal data and one thread: box sums and
// Gaussians of cells, gradients, bicubic interpolation. Both sides of a table are interleaved in
// one run. Where both must give the same numbers, the program checks that they do. Prints tables;
// --json FILE writes the numbers.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "engine/image/image.h"
#include "engine/simd.h"
#include "kernels/bicubic_remap/bicubic_remap.h"
#include "kernels/candidates.h"
#include "kernels/cell_smoothing/cell_smoothing.h"
#include "kernels/column_sum/column_sum.h"
#include "kernels/gradient/gradient.h"
#include "kernels/row_sum/row_sum.h"
#include "perf/command_line.h"
#include "perf/figures.h"
#include "perf/interleaved.h"
#include "perf/tables.h"

namespace vantage::perf {
namespace {

/// A disparity space [x][d], which OpenCV treats as an image of 64 channels. Fits the level 2 and 3
/// caches.
constexpr int kCellColumns = 160;
constexpr int kCellRows = 96;
constexpr int kLanes = 64;
constexpr int kRowCells = kCellColumns * kLanes;
constexpr double kCells = static_cast<double>(kRowCells) * kCellRows;

/// Image size.
constexpr int kWidth = 1282;
constexpr int kHeight = 1110;
constexpr double kPixels = static_cast<double>(kWidth) * kHeight;

/// Integers, so that float sums are exact.
cv::Mat random_values(int rows, int columns, int type) {
  cv::Mat values(rows, columns, type);
  cv::RNG random(1);
  random.fill(values, cv::RNG::UNIFORM, 0, 256);
  if (values.depth() == CV_32F) {
    cv::Mat whole;
    values.convertTo(whole, CV_32S);
    whole.convertTo(values, CV_32F);
  }
  return values;
}

/// Ends the program if two results that must be equal differ by more than `max`.
void expect_equal(const std::string& what, const cv::Mat& a, const cv::Mat& b, double max) {
  cv::Mat b_converted;
  b.convertTo(b_converted, a.type());
  const double difference = cv::norm(a, b_converted, cv::NORM_INF);
  if (difference > max) {
    fmt::print(stderr, "peers_speed: {}: results differ by {}, expected at most {}\n", what,
               difference, max);
    std::exit(1);
  }
}

/// Sums over 9×9 windows of float costs, as integers.
class BoxSums {
 public:
  explicit BoxSums(const cv::Mat& costs) : costs_(costs) {}
  void run(cv::Mat& sums) {
    std::fill_n(column_sums_.row(0), kRowCells, 0);
    for (int y = 0; y < kRadius; ++y) {
      step(y, -1);
    }
    for (int y = 0; y < kCellRows; ++y) {
      step(y + kRadius, y - kRadius - 1);
      kernels::RowSum row;
      row.input = column_sums_.row(0);
      row.input_end = kCellColumns;
      row.output_end = kCellColumns;
      row.radius = kRadius;
      row.lanes = kLanes;
      row.output = sums.ptr<std::int32_t>(y);
      kernels::row_sum(row);
    }
  }
  static constexpr int kRadius = 4;

 private:
  void step(int entering, int leaving) {
    kernels::column_sum_row({entering < kCellRows ? costs_.ptr<float>(entering) : nullptr,
                             leaving >= 0 ? costs_.ptr<float>(leaving) : nullptr, 0, 1, kRowCells},
                            column_sums_.row(0), column_sums_.row(0));
  }

  const cv::Mat& costs_;
  Image<std::int32_t> column_sums_{kRowCells, 1};
};

/// A Gaussian over the rows, then along them.
class Gaussian {
 public:
  static constexpr int kRadius = 6;
  static constexpr double kSigma = 2;

  explicit Gaussian(const cv::Mat& costs) : costs_(costs) {
    const cv::Mat taps = cv::getGaussianKernel(2 * kRadius + 1, kSigma, CV_32F);
    for (int k = 0; k <= kRadius; ++k) {
      weights_[static_cast<std::size_t>(k)] = taps.at<float>(kRadius + k);
    }
    std::fill_n(smoothed_.row(0), smoothed_.width(), 0.0F);
  }
  void run(cv::Mat& result) {
    float* const row = smoothed_.row(0) + kRadius * kLanes;
    std::array<const float*, 2 * kRadius + 1> runs{};
    for (int y = 0; y < kCellRows; ++y) {
      for (int k = -kRadius; k <= kRadius; ++k) {
        runs[static_cast<std::size_t>(k + kRadius)] =
            y + k >= 0 && y + k < kCellRows ? costs_.ptr<float>(y + k) : nullptr;
      }
      kernels::symmetric_sum({runs.data(), weights_.data(), kRadius, kRowCells}, row);
      for (int k = -kRadius; k <= kRadius; ++k) {
        runs[static_cast<std::size_t>(k + kRadius)] = row + k * kLanes;
      }
      kernels::symmetric_sum({runs.data(), weights_.data(), kRadius, kRowCells},
                             result.ptr<float>(y));
    }
  }

 private:
  const cv::Mat& costs_;
  std::array<float, kRadius + 1> weights_{};
  Image<float> smoothed_{kRowCells + 2 * kRadius * kLanes, 1};  // zeros on both sides
};

/// Sobel derivative along x. The image has readable margins.
class Gradient {
 public:
  static constexpr int kMargin = 32;

  explicit Gradient(const cv::Mat& image) {
    cv::copyMakeBorder(image, padded_, 2, 2, kMargin, kMargin, cv::BORDER_REFLECT_101);
  }
  void run(cv::Mat& result) {
    kernels::SeparableFilter filter;
    filter.down = {0, 1, 2, 1, 0};
    filter.along = {0, -1, 0, 1, 0};
    filter.width = kWidth;
    for (int y = 0; y < kHeight; ++y) {
      for (int k = 0; k < 5; ++k) {
        filter.rows[static_cast<std::size_t>(k)] = padded_.ptr<float>(y + k) + kMargin;
      }
      kernels::separable_filter_row(filter, work_.row(0), result.ptr<float>(y));
    }
  }

 private:
  cv::Mat padded_;
  Image<float> work_{kWidth + 3 * kernels::kLaneMultiple, 1};
};

nlohmann::json box_sums(int rounds) {
  const cv::Mat costs = random_values(kCellRows, kCellColumns, CV_32FC(kLanes));
  cv::Mat whole;
  costs.convertTo(whole, CV_32S);
  cv::Mat sums(kCellRows, kCellColumns, CV_32SC(kLanes));
  cv::Mat whole_sums;
  cv::Mat float_sums;
  BoxSums own(costs);
  const cv::Size window(2 * BoxSums::kRadius + 1, 2 * BoxSums::kRadius + 1);
  const auto box = [&](const cv::Mat& from, cv::Mat& to) {
    cv::boxFilter(from, to, from.depth(), window, {-1, -1}, false, cv::BORDER_CONSTANT);
  };
  const auto timings = time_interleaved({{"cv::boxFilter, float", [&] { box(costs, float_sums); }},
                                         {"cv::boxFilter, int32", [&] { box(whole, whole_sums); }},
                                         {"column_sum_row, row_sum", [&] { own.run(sums); }}},
                                        rounds);
  expect_equal("box sums", whole_sums, sums, 0);
  expect_equal("box sums of floats", float_sums, sums, 0);
  return print_table("box sums 9x9 of cells, 160x96x64", timings, kCells);
}

nlohmann::json gaussians(int rounds) {
  const cv::Mat costs = random_values(kCellRows, kCellColumns, CV_32FC(kLanes));
  cv::Mat result(kCellRows, kCellColumns, CV_32FC(kLanes));
  cv::Mat peer_result;
  Gaussian own(costs);
  const cv::Size window(2 * Gaussian::kRadius + 1, 2 * Gaussian::kRadius + 1);
  const auto timings =
      time_interleaved({{"cv::GaussianBlur",
                         [&] {
                           cv::GaussianBlur(costs, peer_result, window, Gaussian::kSigma,
                                            Gaussian::kSigma, cv::BORDER_CONSTANT);
                         }},
                        {"symmetric_sum down and along", [&] { own.run(result); }}},
                       rounds);
  expect_equal("Gaussian", peer_result, result, 1e-3);
  return print_table("Gaussian, sigma 2, 13x13, of cells, 160x96x64", timings, kCells);
}

nlohmann::json gradients(int rounds) {
  const cv::Mat image = random_values(kHeight, kWidth, CV_32FC1);
  // The kernel may write up to one vector after the row.
  cv::Mat padded(kHeight, kWidth + Gradient::kMargin, CV_32FC1);
  cv::Mat result = padded.colRange(0, kWidth);
  cv::Mat peer_result;
  Gradient own(image);
  const auto timings = time_interleaved(
      {{"cv::Sobel, 3x3, float",
        [&] { cv::Sobel(image, peer_result, CV_32F, 1, 0, 3, 1, 0, cv::BORDER_REFLECT_101); }},
       {"separable_filter_row, 5x5 taps", [&] { own.run(result); }}},
      rounds);
  expect_equal("gradient", peer_result, result, 0);
  return print_table("derivative along x, 1282x1110", timings, kPixels, "pixel");
}

nlohmann::json remaps(int rounds, int channels) {
  const cv::Mat image = random_values(kHeight, kWidth, CV_8UC(channels));
  cv::Mat x(kHeight, kWidth, CV_32FC1);
  cv::Mat y(kHeight, kWidth, CV_32FC1);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {  // rotated by about a degree
      x.at<float>(row, column) = static_cast<float>(0.98 * column + 0.02 * row + 3.3);
      y.at<float>(row, column) = static_cast<float>(0.98 * row - 0.02 * column + 25.7);
    }
  }
  cv::Mat fixed_positions;
  cv::Mat fixed_fractions;
  cv::convertMaps(x, y, fixed_positions, fixed_fractions, CV_16SC2);
  cv::Mat peer_result;
  cv::Mat result(kHeight, kWidth, CV_8UC(channels));
  const auto own = [&] {
    kernels::RemapRow<std::uint8_t> row;
    row.pixels = image.ptr();
    row.stride = kWidth * channels;
    row.width = kWidth;
    row.height = kHeight;
    row.channels = channels;
    row.count = kWidth;
    for (int line = 0; line < kHeight; ++line) {
      row.x_px = x.ptr<float>(line);
      row.y_px = y.ptr<float>(line);
      kernels::remap_bicubic_row(row, result.ptr(line));
    }
  };
  const auto peer = [&](const cv::Mat& positions, const cv::Mat& others) {
    cv::remap(image, peer_result, positions, others, cv::INTER_CUBIC, cv::BORDER_CONSTANT);
  };
  const auto timings = time_interleaved(
      {{"cv::remap, float positions", [&] { peer(x, y); }},
       {"cv::remap, fixed positions made before", [&] { peer(fixed_positions, fixed_fractions); }},
       {"remap_bicubic_row, float positions", own}},
      rounds);
  return print_table(
      fmt::format("bicubic remap of 8 bits, {} channel{}, 1282x1110 (a = -3/4 there, -1/2 here)",
                  channels, channels > 1 ? "s" : ""),
      timings, kPixels, "pixel");
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) {
  using namespace vantage::perf;
  CommandLine line("Kernels against OpenCV's, on equal data and one thread");
  std::optional<std::string> json_path;
  int rounds = 15;
  line.rounds(rounds);
  line.json(json_path);
  line.parse(argc, argv);
  cv::setNumThreads(1);
  fmt::print("instruction set {}, one thread\n", vantage::instruction_set_in_use());
  nlohmann::json tables = nlohmann::json::array();
  tables.push_back(box_sums(rounds));
  tables.push_back(gaussians(rounds));
  tables.push_back(gradients(rounds));
  tables.push_back(remaps(rounds, 1));
  tables.push_back(remaps(rounds, 3));
  write_json(json_path, tables);
  return 0;
}
