#pragma once

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/matching/costs/intensity_change.h"
#include "engine/matching/search/coarse_to_fine/search_report.h"

namespace vantage {

/// Seconds spent per part, in the order they ran.
struct StageTime {
  std::string_view name;  ///< static storage
  double seconds = 0;
};

/// Intensity statistics of a pair.
struct PairExposure {
  /// Maps the right image's intensities to the left's; empty if the pair does not determine it.
  IntensityChanges of_right;
  bool has_intensity_change = false;
  /// σM in grey levels, at least 4: σ of Birchfield and Tomasi's difference at matches after the
  /// intensity change. Empty if there are too few matches.
  std::optional<double> sigma_measurement;
  int matches = 0;  ///< number of matches examined

  friend bool operator==(const PairExposure&, const PairExposure&) = default;
};

/// What a matcher reports about one call.
struct MatchReport : SearchReport {
  std::vector<StageTime> stages;
  /// Exposure and noise estimated from the images, if parameters ask for it; of several views, the
  /// first's.
  std::optional<PairExposure> exposure;
  /// With MatchRequest::previous: the share of tiles that were searched, of the map with more.
  std::optional<double> searched_share;

  /// Counts a map of which this share of tiles was searched.
  void count_searched(double share) {
    searched_share = std::max(searched_share.value_or(0), share);
  }
  /// Adds the work of another map of the same images; keeps the first plan and exposure.
  void add(const MatchReport& other) {
    stages.insert(stages.end(), other.stages.begin(), other.stages.end());
    if (plan.passes.empty()) {
      plan = other.plan;
    }
    cells += other.cells;
    finest_cells += other.finest_cells;
    finest_pixels += other.finest_pixels;
    exposure = exposure ? exposure : other.exposure;
  }
};

}  // namespace vantage
