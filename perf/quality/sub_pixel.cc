#include "perf/quality/sub_pixel.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vantage::perf {

SubPixelFigures sub_pixel_figures(const DisparityMap& map, const LoadedScene& scene) {
  std::array<std::int64_t, kFractionBins> counts{};
  std::int64_t pixels = 0;
  double absolute = 0;
  double squared = 0;
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      const double error_px = map.at(x, y) - static_cast<double>(scene.truth.at(x, y));
      if (scene.visible.at(x, y) == 0 || !(std::abs(error_px) <= 1)) {
        continue;
      }
      const double from_first_bin = map.at(x, y) + 0.5 / kFractionBins;
      const double fraction = from_first_bin - std::floor(from_first_bin);
      const int bin = std::min(kFractionBins - 1, static_cast<int>(fraction * kFractionBins));
      ++counts[static_cast<std::size_t>(bin)];
      ++pixels;
      absolute += std::abs(error_px);
      squared += error_px * error_px;
    }
  }
  SubPixelFigures figures;
  const auto n = static_cast<double>(pixels);
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    figures.fraction_percent[bin] = 100.0 * static_cast<double>(counts[bin]) / n;
  }
  figures.mean_absolute_error_px = absolute / n;
  figures.rms_error_px = std::sqrt(squared / n);
  return figures;
}

double fullest_over_emptiest(const SubPixelFigures& figures) {
  const auto [emptiest, fullest] = std::ranges::minmax(figures.fraction_percent);
  return fullest / emptiest;
}

}  // namespace vantage::perf
