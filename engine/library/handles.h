#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/library/vantage_c.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/pair_matcher.h"
#include "engine/rectification/rows/row_field.h"
#include "engine/remark.h"
#include "engine/synthesis/pair_with_maps.h"
#include "engine/synthesis/synthesis_options.h"

/// What can be set for a matcher, as texts NAME=VALUE.
struct MatcherOptions {
  vantage::MatchOptions match;
  vantage::SynthesisOptions synthesis;
  vantage::ExecutionOptions execution;
  vantage::RowMode rows = vantage::RowMode::kAuto;
  std::optional<double> white_level;

  /// Throws vantage::UsageError for unknown names, wrong values and what cannot be combined.
  explicit MatcherOptions(const std::vector<std::string_view>& texts);
};

struct vantage_matcher {
  MatcherOptions options;
  std::shared_ptr<vantage::Execution> execution;
  std::shared_ptr<const vantage::PairMatcher> matcher;  ///< of pairs whose rows are corrected
};

struct vantage_pair {
  std::shared_ptr<vantage::Execution> execution;
  std::shared_ptr<const vantage::PairMatcher> matcher;
  vantage::SynthesisOptions synthesis;
  vantage::PairWithMaps pair;             ///< the right image on the rows of the left one
  std::optional<vantage::RowField> rows;  ///< by which it was brought there
  std::vector<vantage::Remark> remarks;
  // Probabilities take as long as the maps do, so they are made when they are asked for.
  mutable std::once_flag has_probabilities;
  mutable vantage::DisparityMaps probabilities;  ///< only their `confidence`
};
