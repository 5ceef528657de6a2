#include "engine/matching/pair_exposure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "engine/image/intensity_rows.h"
#include "engine/matching/estimation/intensity_change_fit.h"
#include "engine/matching/stereo_matcher.h"

namespace vantage {
namespace {

/// Rows of a band, and the rows at its ends whose windows and codes reach outside it.
constexpr int kBandRows = 24;
constexpr int kBandMarginRows = 6;
constexpr int kMinBands = 4;
/// One of this many image rows is matched, except in small images.
constexpr int kRowsPerMatchedRow = 8;
constexpr std::size_t kMaxMatches = 65536;
/// Intensities nearer to black or white than this may be clipped.
constexpr float kUnclippedMargin = 2;
constexpr float kWhite = 255;
/// Lower bound of σ even for noise-free photographs: reflections, edges and slanted surfaces are
/// not represented among the reliable matches.
constexpr double kMinNoiseSigma = 4;

/// The rows to match, as one image.
struct Bands {
  std::vector<int> rows;        ///< image row of each row of `Bands`
  std::vector<bool> is_inside;  ///< per row: whether its windows lie inside the band
};

Bands bands_of(int height) {
  Bands bands;
  const int count = std::max(kMinBands, height / (kRowsPerMatchedRow * kBandRows));
  if (count * kBandRows >= height) {
    for (int y = 0; y < height; ++y) {
      bands.rows.push_back(y);
      bands.is_inside.push_back(true);
    }
    return bands;
  }
  for (int band = 0; band < count; ++band) {
    const int first = (height - kBandRows) * band / (count - 1);
    for (int row = 0; row < kBandRows; ++row) {
      bands.rows.push_back(first + row);
      bands.is_inside.push_back(row >= kBandMarginRows && row < kBandRows - kBandMarginRows);
    }
  }
  return bands;
}

/// Intensities of the bands' rows: luma, then the channels if they are compared.
class BandIntensities {
 public:
  BandIntensities(const Photograph& photograph, const Bands& bands, int planes)
      : width_(photograph.width()) {
    const int height = static_cast<int>(bands.rows.size());
    for (int plane = 0; plane < planes; ++plane) {
      Image<float>& intensities = planes_.emplace_back(width_, height);
      for (int row = 0; row < height; ++row) {
        const int y = bands.rows[static_cast<std::size_t>(row)];
        if (plane == 0) {
          intensity_row(photograph, y, intensities.row(row));
        } else {
          channel_intensity_row(photograph, plane - 1, y, intensities.row(row));
        }
      }
    }
  }

  [[nodiscard]] float at(std::size_t plane, int x, int row) const {
    return planes_[plane].at(std::clamp(x, 0, width_ - 1), row);
  }
  [[nodiscard]] std::size_t planes() const { return planes_.size(); }
  /// The luma as an image for matching.
  [[nodiscard]] Photograph photograph() const {
    Image<float> image(width_, planes_.front().height());
    for (int y = 0; y < image.height(); ++y) {
      std::transform(planes_.front().row(y), planes_.front().row(y) + width_, image.row(y),
                     [](float level) { return level / kWhite; });
    }
    return {std::move(image)};
  }

 private:
  int width_;
  std::vector<Image<float>> planes_;
};

/// A pixel of the left bands and its match.
struct Match {
  int row = 0;
  int left_x = 0;
  int right_x = 0;
};

std::vector<Match> matches_of(const DisparityMap& left_map, const Bands& bands) {
  std::vector<Match> matches;
  for (int row = 0; row < left_map.height(); ++row) {
    if (!bands.is_inside[static_cast<std::size_t>(row)]) {
      continue;
    }
    for (int x = 0; x < left_map.width(); ++x) {
      if (const float disparity = left_map.at(x, row); std::isfinite(disparity)) {
        matches.push_back({row, x, x - static_cast<int>(std::lround(disparity))});
      }
    }
  }
  const std::size_t step = matches.size() / kMaxMatches + 1;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < matches.size(); k += step) {
    matches[kept++] = matches[k];
  }
  matches.resize(kept);
  return matches;
}

bool is_unclipped(float level) {
  return level > kUnclippedMargin && level < kWhite - kUnclippedMargin;
}

std::optional<IntensityChange> change_of(const BandIntensities& left, const BandIntensities& right,
                                         std::span<const Match> matches, std::size_t plane) {
  std::vector<IntensityPair> pairs;
  for (const Match& match : matches) {
    const IntensityPair pair{left.at(plane, match.left_x, match.row),
                             right.at(plane, match.right_x, match.row)};
    if (is_unclipped(pair.reference) && is_unclipped(pair.other)) {
      pairs.push_back(pair);
    }
  }
  return fit_intensity_change(pairs);
}

/// Distance of `value` from the range of the (changed) intensities within half a pixel of x.
template <typename Level>
float outside(float value, const Level& intensity_at, int x) {
  const float here = intensity_at(x);
  const float before = (intensity_at(x - 1) + here) / 2;
  const float after = (intensity_at(x + 1) + here) / 2;
  return std::max(
      {0.0F, value - std::max({before, here, after}), std::min({before, here, after}) - value});
}

/// Birchfield and Tomasi's difference, averaged over the planes from `first_plane` on.
float residual(const BandIntensities& left, const BandIntensities& right, const Match& match,
               std::size_t first_plane, std::span<const IntensityChange> changes) {
  float sum = 0;
  for (std::size_t plane = first_plane; plane < left.planes(); ++plane) {
    const auto gain = static_cast<float>(changes[plane].gain);
    const auto offset = static_cast<float>(changes[plane].offset);
    const auto of_left = [&](int x) { return left.at(plane, x, match.row); };
    const auto of_right = [&](int x) { return gain * right.at(plane, x, match.row) + offset; };
    sum += std::min(outside(of_left(match.left_x), of_right, match.right_x),
                    outside(of_right(match.right_x), of_left, match.left_x));
  }
  return sum / static_cast<float>(left.planes() - first_plane);
}

/// Fast; sparse but reliable.
MatchOptions band_options(DisparityRange range) {
  MatchOptions options;
  options.method = MatchMethod::kSsd;
  options.disparities = range;
  options.parameters.cost = MatchCost::kCensus;
  options.parameters.window_px = 7;
  options.parameters.subpixel = Subpixel::kNone;
  options.refinement.cross_check_px = 1;
  options.refinement.fill = Fill::kNone;
  return options;
}

}  // namespace

PairExposureEstimator::PairExposureEstimator(DisparityRange range, Execution& execution)
    : execution_(execution),
      matcher_(std::make_unique<StereoMatcher>(band_options(range), execution)) {}

PairExposureEstimator::~PairExposureEstimator() = default;

void PairExposureEstimator::add_memory_use(MemoryUse& use) const { matcher_->add_memory_use(use); }

PairExposure PairExposureEstimator::estimate(const Photograph& left, const Photograph& right,
                                             ColourUse colour, bool changes_intensities) const {
  const Bands bands = bands_of(left.height());
  const bool has_channels =
      colour == ColourUse::kChannels && left.channels() >= 3 && right.channels() >= 3;
  const int planes = has_channels ? 4 : 1;
  const BandIntensities of_left(left, bands, planes);
  const BandIntensities of_right(right, bands, planes);
  DisparityMaps maps;
  matcher_->match(of_left.photograph(), of_right.photograph(),
                  {.left = true, .right = false, .unmatched = false}, maps);
  const std::vector<Match> matches = matches_of(maps.left.disparity_px, bands);

  PairExposure result;
  result.matches = static_cast<int>(matches.size());
  std::array<IntensityChange, 4> changes;
  if (changes_intensities) {
    std::vector<std::optional<IntensityChange>> found;
    for (std::size_t plane = 0; plane < of_left.planes(); ++plane) {
      found.push_back(change_of(of_left, of_right, matches, plane));
    }
    result.has_intensity_change =
        std::ranges::all_of(found, [](const auto& change) { return change.has_value(); });
    for (std::size_t plane = 0; result.has_intensity_change && plane < found.size(); ++plane) {
      changes[plane] = *found[plane];
    }
    result.of_right = {changes[0], {changes[1], changes[2], changes[3]}};
  }
  if (matches.size() >= kMinIntensityPairs) {
    std::vector<float> residuals;
    for (const Match& match : matches) {
      residuals.push_back(residual(of_left, of_right, match, has_channels ? 1 : 0, changes));
    }
    result.sigma_measurement = std::max(kMinNoiseSigma, noise_sigma(residuals));
  }
  return result;
}

}  // namespace vantage
