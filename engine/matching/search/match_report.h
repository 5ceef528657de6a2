#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/matching/noise/noise_estimate.h"
#include "engine/matching/search/coarse_to_fine/search_report.h"
#include "engine/matching/worth/map_shares.h"
#include "engine/remark.h"

namespace vantage {

/// Seconds spent per part, in the order they ran.
struct StageTime {
  std::string_view name;  ///< static storage
  double seconds = 0;
};

/// What a matcher reports about one call.
struct MatchReport : SearchReport {
  std::vector<StageTime> stages;
  /// With MatchRequest::previous: the share of tiles that were searched, of the map with more.
  std::optional<double> searched_share;
  /// What the left map is worth if it was requested, else the right one.
  std::optional<MapShares> shares;
  std::vector<Remark> remarks;
  FoundNoise noise;  ///< in the images of the call

  void warn(std::string_view subject, std::string text) {
    remarks.push_back({Remark::Kind::kWarning, subject, std::move(text)});
  }
  void note(std::string_view subject, std::string text) {
    remarks.push_back({Remark::Kind::kNote, subject, std::move(text)});
  }
  /// Counts a map of which this share of tiles was searched.
  void count_searched(double share) {
    searched_share = std::max(searched_share.value_or(0), share);
  }
  /// Adds the work of another map of the same images; keeps the first plan and shares.
  void add(const MatchReport& other) {
    stages.insert(stages.end(), other.stages.begin(), other.stages.end());
    remarks.insert(remarks.end(), other.remarks.begin(), other.remarks.end());
    if (plan.passes.empty()) {
      plan = other.plan;
    }
    if (!shares) {
      shares = other.shares;
    }
    cells += other.cells;
    finest_cells += other.finest_cells;
    finest_pixels += other.finest_pixels;
  }
};

}  // namespace vantage
