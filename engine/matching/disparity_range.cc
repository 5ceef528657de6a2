#include "engine/matching/disparity_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <vector>

#include "engine/error.h"
#include "engine/image/grey_levels.h"
#include "engine/matching/evidence_pair.h"

namespace vantage {
namespace {

// Wide and low: along the rows of a rectified pair a tile needs texture, down them surfaces such as
// roads change their disparity.
constexpr int kTileWidthPx = 32;
constexpr int kTileHeightPx = 16;
/// Images are reduced by whole factors, but not below this width.
constexpr int kLeastReducedWidthPx = 960;
/// Mean |g| of a tile below which it counts as uniform, grey levels over two pixels.
constexpr double kLeastContrast = 0.5;
/// A peak reaches this part of what a perfect match would, and stands out by that part from all
/// disparities that are more than kPeakRadiusPx away.
constexpr double kLeastAgreement = 0.3;
constexpr double kLeastDistinction = 0.15;
constexpr int kPeakRadiusPx = 2;
/// What the other image finds at the partner may differ by this.
constexpr int kPartnerTolerancePx = 2;
/// What a neighbouring tile finds may differ by this and this part of the disparity.
constexpr int kNeighbourTolerancePx = 3;
constexpr double kNeighbourToleranceRatio = 0.1;
/// The range is widened on both sides by this and this part of it.
constexpr int kMarginPx = 3;
constexpr double kMarginRatio = 0.1;

/// Grey levels, averaged over squares of `factor` pixels a side; what is left over at the right and
/// lower sides is dropped.
Photograph reduced(const Photograph& photograph, int factor, Execution& execution) {
  const int width = photograph.width() / factor;
  const int height = std::max(1, photograph.height() / factor);
  const int rows = std::min(factor, photograph.height());
  const float scale =
      1 / (kGreyLevelsPerUnit<float> * static_cast<float>(factor) * static_cast<float>(rows));
  Image<float> result(width, height);
  execution.for_each_band(height, [&](int first_row, int end_row) {
    std::vector<float> grey(static_cast<std::size_t>(photograph.width()));
    for (int y = first_row; y < end_row; ++y) {
      float* sums = result.row(y);
      std::fill_n(sums, width, 0.0F);
      for (int row = 0; row < rows; ++row) {
        grey_levels_row(photograph, y * factor + row, grey.data());
        for (int x = 0; x < width * factor; ++x) {
          sums[x / factor] += grey[static_cast<std::size_t>(x)];
        }
      }
      std::transform(sums, sums + width, sums, [&](float sum) { return sum * scale; });
    }
  });
  return {std::move(result)};
}

/// The tiles of one image and the disparities at which they respond most, where that is distinct.
class TilePeaks {
 public:
  TilePeaks(const EvidencePair& pair, Reference reference, DisparityRange search,
            Execution& execution)
      : width_(pair.width()),
        height_(pair.height()),
        direction_(reference == Reference::kLeft ? -1 : 1),
        columns_(std::max(1, width_ / kTileWidthPx)),
        rows_(std::max(1, height_ / kTileHeightPx)),
        peaks_(static_cast<std::size_t>(columns_ * rows_)) {
    execution.executor().parallel_for(columns_ * rows_, [&](int tile) {
      peaks_[static_cast<std::size_t>(tile)] =
          find_peak(pair, reference, block_of(tile % columns_, tile / columns_), search);
    });
  }

  /// Calls body(disparity, neighbour_agrees) for every tile with a distinct peak that the tiles of
  /// the other image confirm.
  template <typename Body>
  void for_each_confirmed(const TilePeaks& other, const Body& body) const {
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        const std::optional<int> peak = at(column, row);
        if (peak && other.confirms(partner_column(column, *peak), row, *peak)) {
          body(*peak, neighbour_agrees(column, row, *peak));
        }
      }
    }
  }

 private:
  [[nodiscard]] PixelBlock block_of(int column, int row) const {
    return {width_ * column / columns_, width_ * (column + 1) / columns_, height_ * row / rows_,
            height_ * (row + 1) / rows_};
  }
  [[nodiscard]] std::optional<int> at(int column, int row) const {
    if (column < 0 || column >= columns_ || row < 0 || row >= rows_) {
      return std::nullopt;
    }
    return peaks_[static_cast<std::size_t>(row * columns_ + column)];
  }
  /// Of the other image, where the middle of a tile has its partner; may lie outside.
  [[nodiscard]] int partner_column(int column, int disparity) const {
    const PixelBlock block = block_of(column, 0);
    const int x = (block.x_begin + block.x_end) / 2 + direction_ * disparity;
    return static_cast<int>(std::floor(static_cast<double>(x) * columns_ / width_));
  }
  [[nodiscard]] bool confirms(int column, int row, int disparity) const {
    for (int beside = column - 1; beside <= column + 1; ++beside) {
      const std::optional<int> peak = at(beside, row);
      if (peak && std::abs(*peak - disparity) <= kPartnerTolerancePx) {
        return true;
      }
    }
    return false;
  }
  [[nodiscard]] bool neighbour_agrees(int column, int row, int disparity) const {
    const double tolerance = kNeighbourTolerancePx + kNeighbourToleranceRatio * std::abs(disparity);
    for (int y = row - 1; y <= row + 1; ++y) {
      for (int x = column - 1; x <= column + 1; ++x) {
        const std::optional<int> peak = at(x, y);
        if ((x != column || y != row) && peak && std::abs(*peak - disparity) <= tolerance) {
          return true;
        }
      }
    }
    return false;
  }

  static std::optional<int> find_peak(const EvidencePair& pair, Reference reference,
                                      const PixelBlock& block, DisparityRange search) {
    const double contrast = pair.contrast(reference, block);
    const double area = static_cast<double>(block.x_end - block.x_begin) *
                        static_cast<double>(block.y_end - block.y_begin);
    if (!(contrast > kLeastContrast * area)) {
      return std::nullopt;
    }
    std::vector<double> responses;
    for (int disparity = search.min; disparity <= search.max; ++disparity) {
      responses.push_back(pair.evidence(reference, block, {disparity, 0}));
    }
    const auto peak = std::ranges::max_element(responses);
    double second = 0;
    for (auto response = responses.begin(); response != responses.end(); ++response) {
      if (std::abs(response - peak) > kPeakRadiusPx) {
        second = std::max(second, *response);
      }
    }
    if (*peak <= kLeastAgreement * contrast || *peak - second <= kLeastDistinction * contrast) {
      return std::nullopt;
    }
    return search.min + static_cast<int>(peak - responses.begin());
  }

  int width_;
  int height_;
  int direction_;
  int columns_;
  int rows_;
  std::vector<std::optional<int>> peaks_;
};

/// The least range that holds all values it is given.
struct Span {
  int least = std::numeric_limits<int>::max();
  int most = std::numeric_limits<int>::min();
  [[nodiscard]] bool empty() const { return most < least; }
  void include(int value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

/// In pixels of the images as they are.
Span peak_span(const Photograph& left, const Photograph& right, Execution& execution) {
  const EvidencePair pair(left, right, book_parameters(MatchMethod::kGradient), execution);
  const DisparityRange search{-pair.width() / 8, pair.width() / 3};
  const TilePeaks of_left(pair, Reference::kLeft, search, execution);
  const TilePeaks of_right(pair, Reference::kRight, search, execution);
  Span supported;
  Span confirmed;  // for images of hardly more than a tile
  const auto include = [&](int disparity, bool neighbour_agrees) {
    confirmed.include(disparity);
    if (neighbour_agrees) {
      supported.include(disparity);
    }
  };
  of_left.for_each_confirmed(of_right, include);
  of_right.for_each_confirmed(of_left, include);
  return supported.empty() ? confirmed : supported;
}

}  // namespace

DisparityRange estimate_disparity_range(const Photograph& left, const Photograph& right,
                                        Execution& execution) {
  const int factor = std::max(1, left.width() / kLeastReducedWidthPx);
  const bool equal_sizes = left.width() == right.width() && left.height() == right.height();
  const Span span = factor == 1 || !equal_sizes
                        ? peak_span(left, right, execution)
                        : peak_span(reduced(left, factor, execution),
                                    reduced(right, factor, execution), execution);
  if (span.empty()) {
    throw Error(
        "the images give no evidence for any range of disparities, expected texture that both of "
        "them show; give --disparities MIN:MAX");
  }
  const int margin =
      kMarginPx + static_cast<int>(std::ceil(kMarginRatio * (span.most - span.least)));
  const int farthest = left.width() - 1;
  return {std::clamp((span.least - margin) * factor, -farthest, farthest),
          std::clamp((span.most + margin) * factor, -farthest, farthest)};
}

}  // namespace vantage
