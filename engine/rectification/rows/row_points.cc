#include "engine/rectification/rows/row_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <optional>

#include "engine/image/intensity_rows.h"
#include "kernels/patch_products/patch_products.h"

namespace vantage {
namespace {

constexpr int kStrips = 20;
constexpr int kCells = 24;
/// Of the patches that are compared at full size.
constexpr int kRadius_px = 7;
constexpr int kSide_px = 2 * kRadius_px + 1;
/// Reduced pixels are this high, so that a few rows of offset do not matter, in this many rows.
constexpr int kBlockRows = 8;
constexpr int kBlocks = 3;
constexpr int kStripRows = kBlocks * kBlockRows;
constexpr int kCentreRow = kStripRows / 2;
static_assert(kRadius_px + kRowReach_px < kCentreRow);
constexpr int kUsualWidth = 400;  ///< of reduced images
constexpr int kReducedRadius = 8;
constexpr int kReducedSide = 2 * kReducedRadius + 1;
constexpr int kPeakRadius = 2;
/// Mean squared difference of neighbours, in grey levels, in the direction that has less of it.
constexpr float kMinTexture = 1;
constexpr float kMinReducedCorrelation = 0.4F;
constexpr float kClearMargin = 0.15F;
constexpr float kMinMargin = 0.05F;
constexpr float kMinCorrelation = 0.5F;
constexpr float kMaxPointDeviation_px = 0.33F;

using Row = std::vector<float>;

/// Rows around a row of the grid, of one image.
class Strip {
 public:
  Strip(const Photograph& photograph, int centre_y, int factor)
      : stride_(photograph.width() + kernels::kPatchPlaces),
        reduced_width_(photograph.width() / factor),
        rows_(static_cast<std::size_t>(kStripRows * stride_)),
        reduced_(static_cast<std::size_t>(kBlocks * reduced_stride())) {
    const float scale = 1 / static_cast<float>(factor * kBlockRows);
    Row sums(static_cast<std::size_t>(stride_));
    for (int block = 0; block < kBlocks; ++block) {
      std::fill(sums.begin(), sums.end(), 0.0F);
      for (int k = block * kBlockRows; k < (block + 1) * kBlockRows; ++k) {
        float* const row = rows_.data() + k * stride_;
        intensity_row(photograph, centre_y - kCentreRow + k, row);
        std::transform(sums.begin(), sums.end(), row, sums.begin(), std::plus());
      }
      float* const means = reduced_.data() + block * reduced_stride();
      for (int x = 0; x < reduced_width_; ++x) {
        const auto of_block = sums.begin() + x * factor;
        means[x] = scale * std::accumulate(of_block, of_block + factor, 0.0F);
      }
    }
  }
  /// Of full size, relative to the centre.
  [[nodiscard]] const float* row(int offset) const {
    return rows_.data() + (kCentreRow + offset) * stride_;
  }
  [[nodiscard]] int stride() const { return stride_; }
  [[nodiscard]] const float* reduced(int block) const {
    return reduced_.data() + block * reduced_stride();
  }
  [[nodiscard]] int reduced_width() const { return reduced_width_; }
  [[nodiscard]] int reduced_stride() const { return reduced_width_ + kernels::kPatchPlaces; }

 private:
  int stride_;
  int reduced_width_;
  std::vector<float> rows_;
  std::vector<float> reduced_;
};

/// A patch without its mean.
template <int kRows, int kColumns>
struct Patch {
  std::array<float, kRows * kColumns> values;
  float energy = 0;

  Patch(const float* from, int stride) {
    for (int k = 0; k < kRows; ++k) {
      std::copy_n(from + k * stride, kColumns, values.begin() + k * kColumns);
    }
    const float mean =
        std::accumulate(values.begin(), values.end(), 0.0F) / static_cast<float>(values.size());
    for (float& value : values) {
      value -= mean;
      energy += value * value;
    }
  }
  /// Its products with the places from `other` on, of which `sums` has room for a multiple of
  /// kernels::kPatchPlaces.
  void multiply(const float* other, int stride, int count, float* sums) const {
    kernels::patch_products({values.data(), kRows, kColumns, other, stride}, count, sums);
  }
};

constexpr int padded(int count) {
  return (count + kernels::kPatchPlaces - 1) / kernels::kPatchPlaces * kernels::kPatchPlaces;
}

/// Sums over `count` neighbours; element x is of those from x on.
Row running_sums(const Row& values, std::size_t count) {
  Row sums(values.size() - count + 1);
  double sum = 0;
  for (std::size_t x = 0; x < values.size(); ++x) {
    sum += values[x];
    if (x + 1 >= count) {
      sums[x + 1 - count] = static_cast<float>(sum);
      sum -= values[x + 1 - count];
    }
  }
  return sums;
}

/// Smaller eigenvalue of the structure tensor of the patches around the centre row, of every second
/// row; element x is of the patch from column x on.
Row texture_of(const Strip& strip, std::size_t width) {
  std::array<Row, 3> products = {Row(width), Row(width), Row(width)};
  for (int k = -kRadius_px; k <= kRadius_px; k += 2) {
    const float* const row = strip.row(k);
    const float* const above = strip.row(k - 1);
    const float* const below = strip.row(k + 1);
    for (std::size_t x = 1; x + 1 < width; ++x) {
      const float along = row[x + 1] - row[x - 1];
      const float down = below[x] - above[x];
      products[0][x] += along * along;
      products[1][x] += down * down;
      products[2][x] += along * down;
    }
  }
  const Row xx = running_sums(products[0], kSide_px);
  const Row yy = running_sums(products[1], kSide_px);
  const Row xy = running_sums(products[2], kSide_px);
  Row smaller(xx.size());
  for (std::size_t x = 0; x < xx.size(); ++x) {
    const float half_difference = (xx[x] - yy[x]) / 2;
    smaller[x] = (xx[x] + yy[x]) / 2 - std::sqrt(half_difference * half_difference + xy[x] * xy[x]);
  }
  return smaller;
}

/// Columns with the most texture, one of each cell that has any.
std::vector<int> textured_columns(const Strip& strip, int width) {
  // Differences are of two pixels, in every second row.
  constexpr float kMin = kMinTexture * 4 * kSide_px * (kRadius_px + 1);
  const Row texture = texture_of(strip, static_cast<std::size_t>(width));
  const auto count = static_cast<int>(texture.size());
  std::vector<int> columns;
  for (int cell = 0; cell < kCells; ++cell) {
    const auto begin = texture.begin() + cell * count / kCells;
    const auto end = texture.begin() + (cell + 1) * count / kCells;
    const auto best = std::max_element(begin, end);
    if (best != end && *best > kMin) {
      columns.push_back(static_cast<int>(best - texture.begin()) + kRadius_px);
    }
  }
  return columns;
}

/// Centres of the likeliest partners in the right image's reduced strip.
class ReducedSearch {
 public:
  ReducedSearch(const Strip& left, const Strip& right)
      : left_(left), right_(right), width_(left.reduced_width()) {
    const auto width = static_cast<std::size_t>(width_);
    Row sums(width);
    Row squares(width);
    for (int block = 0; block < kBlocks; ++block) {
      const float* const row = right.reduced(block);
      for (std::size_t x = 0; x < width; ++x) {
        sums[x] += row[x];
        squares[x] += row[x] * row[x];
      }
    }
    sums = running_sums(sums, kReducedSide);
    energy_ = running_sums(squares, kReducedSide);
    for (std::size_t x = 0; x < sums.size(); ++x) {
      energy_[x] -= sums[x] * sums[x] / (kReducedSide * kBlocks);
    }
    scores_.resize(energy_.size() + kernels::kPatchPlaces);
  }

  /// One if it is clearly the best, two if not, none without a correlation.
  std::vector<int> partners(int centre) {
    const int from = centre - kReducedRadius;
    if (from < 0 || from + kReducedSide > width_) {
      return {};
    }
    const int begin = std::max(0, from - width_ / 3);
    const int end = std::min(width_ - kReducedSide, from + width_ / 4) + 1;
    correlate(from, begin, end);
    const auto best = std::max_element(scores_.begin() + begin, scores_.begin() + end);
    if (*best < kMinReducedCorrelation) {
      return {};
    }
    const auto at = static_cast<int>(best - scores_.begin());
    int second = -1;
    for (int x = begin; x < end; ++x) {
      if (std::abs(x - at) > kPeakRadius && (second < 0 || score(x) > score(second))) {
        second = x;
      }
    }
    std::vector<int> found = {at + kReducedRadius};
    if (second >= 0 && score(second) > *best - kClearMargin) {
      found.push_back(second + kReducedRadius);
    }
    return found;
  }

 private:
  [[nodiscard]] float score(int x) const { return scores_[static_cast<std::size_t>(x)]; }

  void correlate(int from, int begin, int end) {
    const Patch<kBlocks, kReducedSide> patch(left_.reduced(0) + from, left_.reduced_stride());
    patch.multiply(right_.reduced(0) + begin, right_.reduced_stride(), end - begin,
                   scores_.data() + begin);
    for (int x = begin; x < end; ++x) {
      const auto i = static_cast<std::size_t>(x);
      scores_[i] /= std::sqrt(std::max(patch.energy * energy_[i], 1e-3F));
    }
  }

  const Strip& left_;
  const Strip& right_;
  int width_;
  Row energy_;  ///< of the right image's patches without their mean, by first column
  Row scores_;
};

/// Where a patch agrees best at full size.
struct Peak {
  float correlation = -1;
  float x = 0;
  float row_offset = 0;
};

/// Correlations of a patch of the left image with those of the right one around a column.
class FullSearch {
 public:
  FullSearch(const Strip& left, const Strip& right, int width)
      : left_(left), right_(right), width_(width) {}

  /// None if the peak is at the edge of the search, or its row is not certain.
  std::optional<Peak> peak(int x, int partner, int reach) {
    const int begin = std::max(kRadius_px, partner - reach);
    const int columns = std::min(width_ - kRadius_px - 1, partner + reach) - begin + 1;
    if (columns < 3) {
      return std::nullopt;
    }
    columns_ = static_cast<std::size_t>(columns);
    correlate(x, begin);
    const auto best = std::max_element(scores_.begin(), scores_.end());
    const auto at = static_cast<std::size_t>(best - scores_.begin());
    const std::size_t column = at % columns_;
    const std::size_t row = at / columns_;
    if (*best < kMinCorrelation || row == 0 || row + 1 == kOffsets || column == 0 ||
        column + 1 == columns_) {
      return std::nullopt;
    }
    return vertex(at, static_cast<float>(begin) + static_cast<float>(column),
                  static_cast<float>(row) - kRowReach_px);
  }

 private:
  static constexpr std::size_t kOffsets = 2 * kRowReach_px + 1;

  /// The maximum of the paraboloid through the best correlation and its neighbours.
  [[nodiscard]] std::optional<Peak> vertex(std::size_t at, float x, float row_offset) const {
    const float* const centre = scores_.data() + at;
    const auto down = static_cast<std::ptrdiff_t>(columns_);
    const float xx = centre[-1] - 2 * centre[0] + centre[1];
    const float yy = centre[-down] - 2 * centre[0] + centre[down];
    const float xy =
        (centre[down + 1] - centre[down - 1] - centre[-down + 1] + centre[-down - 1]) / 4;
    const float dx = (centre[1] - centre[-1]) / 2;
    const float dy = (centre[down] - centre[-down]) / 2;
    const float determinant = xx * yy - xy * xy;
    if (xx >= 0 || determinant <= 0) {
      return std::nullopt;
    }
    const float right = (xy * dy - yy * dx) / determinant;
    const float below = (xy * dx - xx * dy) / determinant;
    // What disagrees is noise: how far it moves the maximum.
    const float curvature = determinant / -xx;  // along the ridge
    const float unexplained = (1 - centre[0] * centre[0]) / (centre[0] * kSide_px * kSide_px);
    if (std::abs(right) > 1 || std::abs(below) > 1 ||
        unexplained > kMaxPointDeviation_px * kMaxPointDeviation_px * curvature) {
      return std::nullopt;
    }
    return Peak{centre[0], x + right, row_offset + below};
  }

  void correlate(int x, int begin) {
    const Patch<kSide_px, kSide_px> patch(left_.row(-kRadius_px) + x - kRadius_px, left_.stride());
    const auto columns = static_cast<int>(columns_);
    std::vector<float> products(static_cast<std::size_t>(padded(columns)));
    scores_.resize(kOffsets * columns_);
    for (int row = 0; row < static_cast<int>(kOffsets); ++row) {
      patch.multiply(right_.row(row - kRowReach_px - kRadius_px) + begin - kRadius_px,
                     right_.stride(), columns, products.data());
      std::copy_n(products.begin(), columns, scores_.begin() + row * columns);
    }
    normalize(begin, patch.energy);
  }

  void normalize(int begin, float energy) {
    const std::size_t span = columns_ + kSide_px - 1;
    Row sums(span);
    Row squares(span);
    const auto add = [&](int offset, float sign) {
      const float* const row = right_.row(offset) + begin - kRadius_px;
      for (std::size_t c = 0; c < span; ++c) {
        sums[c] += sign * row[c];
        squares[c] += sign * row[c] * row[c];
      }
    };
    for (int k = -kRadius_px - kRowReach_px; k < kRadius_px - kRowReach_px; ++k) {
      add(k, 1);
    }
    for (int offset = -kRowReach_px; offset <= kRowReach_px; ++offset) {
      add(offset + kRadius_px, 1);
      const Row sum = running_sums(sums, kSide_px);
      const Row square = running_sums(squares, kSide_px);
      float* const score =
          scores_.data() + static_cast<std::size_t>(offset + kRowReach_px) * columns_;
      for (std::size_t c = 0; c < columns_; ++c) {
        const float other = square[c] - sum[c] * sum[c] / (kSide_px * kSide_px);
        score[c] /= std::sqrt(std::max(energy * other, 1e-3F));
      }
      add(offset - kRadius_px, -1);
    }
  }

  const Strip& left_;
  const Strip& right_;
  int width_;
  std::size_t columns_ = 0;
  Row scores_;  ///< [row offset][column]
};

std::vector<PointMatch> points_of_strip(const Photograph& left, const Photograph& right, int y,
                                        int factor) {
  const int width = left.width();
  const Strip left_strip(left, y, factor);
  const Strip right_strip(right, y, factor);
  ReducedSearch reduced(left_strip, right_strip);
  FullSearch full(left_strip, right_strip, width);
  std::vector<PointMatch> points;
  for (const int x : textured_columns(left_strip, width)) {
    std::optional<Peak> best;
    bool is_clear = true;
    for (const int partner : reduced.partners(x / factor)) {
      // The same place in the block.
      const auto found = full.peak(x, partner * factor + x % factor, factor + 1);
      if (found && best) {
        is_clear = std::abs(found->correlation - best->correlation) >= kMinMargin;
      }
      if (found && (!best || found->correlation > best->correlation)) {
        best = found;
      }
    }
    if (best && is_clear) {
      points.push_back({.left = {x, y}, .right = {best->x, y + double{best->row_offset}}});
    }
  }
  return points;
}

}  // namespace

std::vector<PointMatch> find_row_points(const Photograph& left, const Photograph& right,
                                        Execution* execution) {
  const int width = left.width();
  const int height = left.height();
  if (width != right.width() || height != right.height() || std::min(width, height) < 32) {
    return {};
  }
  const int factor = std::clamp((width + kUsualWidth / 2) / kUsualWidth, 2, 64);
  if (width / factor < kReducedSide) {
    return {};
  }
  const int span = height - kStripRows;
  const int strips = std::min(kStrips, span / kSide_px + 1);
  std::vector<std::vector<PointMatch>> found(static_cast<std::size_t>(strips));
  const auto look = [&](int strip) {
    const int y = kCentreRow + (strips == 1 ? span / 2 : strip * span / (strips - 1));
    found[static_cast<std::size_t>(strip)] = points_of_strip(left, right, y, factor);
  };
  if (execution != nullptr) {
    execution->executor().parallel_for(strips, look);
  } else {
    for (int strip = 0; strip < strips; ++strip) {
      look(strip);
    }
  }
  std::vector<PointMatch> points;
  for (const std::vector<PointMatch>& of_strip : found) {
    points.insert(points.end(), of_strip.begin(), of_strip.end());
  }
  return points;
}

}  // namespace vantage
