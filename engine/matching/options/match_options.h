#pragma once

#include <optional>
#include <string>

#include "engine/image/disparity_range.h"
#include "engine/image/side.h"
#include "engine/matching/options/method_rules.h"
#include "engine/refinement/refinement_options.h"

namespace vantage {

/// Of a pixel; of a two-dimensional search the pairs of both components count.
inline constexpr int kMaxCandidates = 4096;

/// Whether maps of these parameters have levels whose winners a cross-check can look at.
bool can_check_levels(const MethodParameters& parameters);

/// What is in force after method, preset and defaults have had their say: what matching works by.
struct ResolvedMatchOptions {
  DisparityRange disparities;
  std::optional<DisparityRange> disparities_y;
  MethodParameters parameters;
  std::optional<RefinementOptions> refinement;  ///< none: maps stay as the winners are
};

/// Everything that decides what a pair's disparity maps are. Defaults are the command line's.
struct MatchOptions {
  /// Empty: that of the preset in force. Not both.
  std::optional<MatchMethod> method;
  /// Chooses the method and the defaults of everything that is not set.
  std::optional<MatchPreset> preset;
  /// At most kMaxCandidates.
  DisparityRange disparities;
  /// `disparities` is still to be replaced by what estimate_disparity_range() says: whoever reads
  /// the images does that. Matchers refuse it.
  bool disparities_auto = false;
  /// Vertical component of a two-dimensional search, y_left − y_right (5.5.3); empty: 0 only.
  std::optional<DisparityRange> disparities_y;
  /// The same of `disparities_y`, which is set, and find_vertical_range().
  bool disparities_y_auto = false;
  MethodOverrides parameters;
  Side reference = Side::kLeft;
  /// Winner-take-all only: no refinement (sub-pixel stays as set above).
  bool raw = false;
  RefinementOverrides refinement;

  /// Without method and preset it is `balanced`, whatever the cost. None with an aggregation, which
  /// starts from SSD: most of a preset is about its own. None with `disparities_y`, whose columns
  /// are long.
  [[nodiscard]] std::optional<MatchPreset> preset_in_force() const;
  /// What maps are made by, in words: "preset balanced", "method ssd with aggregation gaussian",
  /// "preset balanced with cost census".
  [[nodiscard]] std::string chosen() const;
  /// What is in force: the fields of `parameters`, else the preset's, else the method's.
  [[nodiscard]] MethodParameters resolved() const;
  /// What is in force unless `raw`: the fields of `refinement`, else the preset's, else: no
  /// snapping, a cross-check of whole maps within max(1, D/15) px, a confidence above 0 for
  /// gradient evidence and any for the others, speckles kept, no surface fit, fill at constant
  /// depth.
  [[nodiscard]] RefinementOptions resolved_refinement() const;
  /// All of it.
  [[nodiscard]] ResolvedMatchOptions in_force() const;
  /// The same options with every field set to what is in force, without the preset. To be shown:
  /// validate() refuses them, as a method reads some of the fields only.
  [[nodiscard]] MatchOptions fully_resolved() const;
  /// Throws UsageError naming the field, its value and its limit, or why options do not go
  /// together, or which field of `parameters` or `refinement` is set although nothing reads it
  /// (method_fields).
  void validate() const;
};

}  // namespace vantage
