#pragma once

#include <array>
#include <optional>
#include <string>

#include "engine/image/disparity_range.h"
#include "engine/image/image_region.h"
#include "engine/image/side.h"
#include "engine/matching/noise/noise_kind.h"
#include "engine/matching/options/method_rules.h"
#include "engine/refinement/refinement_options.h"

namespace vantage {

/// Maximum number of candidates per pixel; a two-dimensional search counts pairs of components.
inline constexpr int kMaxCandidates = 4096;

/// Number of candidates of `disparities`, which include those between pixels.
int candidate_count(DisparityRange disparities, const MethodParameters& parameters);

/// The options that matching uses, after method, preset and defaults are applied.
struct ResolvedMatchOptions {
  DisparityRange disparities;
  std::optional<DisparityRange> disparities_y;
  MethodParameters parameters;
  std::optional<RefinementOptions> refinement;  ///< empty: maps keep the winners
  std::optional<double> noise = 0;              ///< MatchOptions::noise_in_force()
  /// Instead of `parameters`, where set, for images with noise: by NoiseKind.
  std::array<std::optional<MethodParameters>, kNoiseKinds> parameters_of = {};
  std::optional<ImageRegion> roi = std::nullopt;
  double scale = 1;

  /// Whether less than the images is matched, or smaller ones are.
  [[nodiscard]] bool is_of_part() const { return roi.has_value() || scale < 1; }
};

/// Everything that determines a pair's disparity maps. Defaults are those of the command line,
/// where only `disparities` differs: it is automatic there.
struct MatchOptions {
  /// Empty: that of the preset in force. Cannot be combined with `preset`.
  std::optional<MatchMethod> method;
  /// Sets the method and the defaults of everything not set.
  std::optional<MatchPreset> preset;
  /// At most kMaxCandidates values.
  DisparityRange disparities;
  /// `disparities` must still be replaced by the result of estimate_disparity_range(). PairMatcher
  /// does so for each pair, StereoMatcher refuses it.
  bool disparities_auto = false;
  /// Vertical component of a two-dimensional search, y_left − y_right (5.5.3); empty: 0 only.
  std::optional<DisparityRange> disparities_y;
  /// As disparities_auto, for `disparities_y` (set) and find_vertical_range().
  bool disparities_y_auto = false;
  /// Pixels of the left image, or of the reference of several images, that get disparities; all
  /// others are unknown, as are pixels of the right image without a partner there. Empty: all.
  std::optional<ImageRegion> roi;
  /// Above 0, at most 1: images are matched at this size, and maps brought back to theirs.
  double scale = 1;
  MethodOverrides parameters;
  /// Standard deviation of the noise that costs are made insensitive to, grey levels; 0: images are
  /// matched as they are; empty: what is found in the images of a preset, nothing without one.
  std::optional<double> noise;
  Side reference = Side::kLeft;  ///< whose map results, where no MatchRequest names others
  /// Winner-take-all only: no refinement (sub-pixel stays as set above).
  bool raw = false;
  RefinementOverrides refinement;

  /// `balanced` if neither method nor preset is set, for any cost. None if an aggregation is set:
  /// it starts from SSD, since a preset mostly tunes its own aggregation. None with
  /// `disparities_y`, whose columns are long.
  [[nodiscard]] std::optional<MatchPreset> preset_in_force() const;
  /// The choice in words: "preset balanced", "method ssd with aggregation gaussian", "preset
  /// balanced with cost census".
  [[nodiscard]] std::string chosen() const;
  /// The parameters in force for images with such noise: fields of `parameters`, else the preset's,
  /// else the method's.
  [[nodiscard]] MethodParameters resolved(NoiseKind kind = NoiseKind::kNone) const;
  /// `noise`, or 0 where nothing is to be found.
  [[nodiscard]] std::optional<double> noise_in_force() const;
  /// The refinement in force unless `raw`: fields of `refinement`, else the preset's, else: no
  /// snapping, a cross-check of whole maps within max(1, D/15) px, a confidence above 0 for
  /// gradient evidence and any confidence for other costs, speckles kept, no surface fit, fill at
  /// constant depth.
  [[nodiscard]] RefinementOptions resolved_refinement() const;
  /// All options in force.
  [[nodiscard]] ResolvedMatchOptions in_force() const;
  /// These options with every field set to the value in force, without the preset. For display
  /// only: validate() refuses them, because a method reads only some of the fields.
  [[nodiscard]] MatchOptions fully_resolved() const;
  /// Throws UsageError naming the field, its value and its limit, or why options cannot be
  /// combined, or which field of `parameters` or `refinement` is set but not read (method_fields).
  void validate() const;
};

}  // namespace vantage
