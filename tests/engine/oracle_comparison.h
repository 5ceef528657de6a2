#pragma once

#include "engine/execution.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/plain_matching.h"

namespace vantage {
inline namespace test {

enum class PixelKind { kGrey8, kColour8, kGrey16, kGreyFloat };

struct PhotographPair {
  Photograph left;
  Photograph right;
};

/// A random texture on a background in the middle of `range` and a square in front of it, with a
/// little noise in both images. The same on every platform.
PhotographPair textured_pair(int width, int height, DisparityRange range, PixelKind kind,
                             std::uint32_t seed);

/// The pixels [first_column, first_column + width) × [first_row, first_row + height).
Photograph crop(const Photograph& photograph, int first_column, int first_row, int width,
                int height);

/// Raw or refined maps as `options` ask for, by an Execution of its own.
DisparityMaps maps_of(const PhotographPair& pair, const MatchOptions& options,
                      const ExecutionOptions& how = {.threads = 2},
                      const MatchRequest& request = {.confidence = true},
                      MatchReport* report = nullptr);

/// How far matcher and oracle may be apart where nothing but rounding differs.
struct Tolerance {
  /// A winner is distinct if it leads by more than `tie` · max(|E|, |E of the second|, floor).
  double tie = 1e-5;
  /// Magnitude, in units of the energy, below which differences of rounding no longer shrink.
  double floor = 1;
  /// Of the winner's energy, relative to max(|energy|, floor).
  double energy = 1e-5;
  /// Of the confidence, relative to max(|confidence|, confidence_floor).
  double confidence = 5e-5;
  double confidence_floor = 0.01;
  /// Of sub-pixel positions, in pixels, where the winner is distinct and the parabola not flat.
  double subpixel_px = 5e-5;
  /// Share of distinct pixels whose winner must be the oracle's.
  double share = 0.999;
  /// Share of pixels with the same winner at which confidence and sub-pixel position must agree.
  double confidence_share = 1;
  /// Pixels that may stray from each of the two beside: small images have no shares.
  int strays = 0;
};

/// What a comparison found.
struct Agreement {
  int candidates = 0;      ///< pixels that have a candidate
  int equal = 0;           ///< of them: winners equal
  int distinct = 0;        ///< of them: the oracle's winner is distinct
  int distinct_equal = 0;  ///< of those: winners equal
  int confident = 0;       ///< of the equal ones: confidence within the tolerance
  double worst_confidence = 0;
  double worst_subpixel_px = 0;
  std::string first_difference;
};

/// Raw maps of both references and their confidences against the oracle; fails the running test
/// where they differ by more than `tolerance`. `what` names the case in messages. With
/// VANTAGE_TEST_VERBOSE in the environment it prints what it counted.
void expect_equals_oracle(const PhotographPair& pair, MatchOptions options, Execution& execution,
                          const Tolerance& tolerance, const std::string& what);

/// What rounding can do to a method: measured, times three or so.
Tolerance tolerance_of(const MethodParameters& parameters);

/// For names of tests.
std::string case_name(MatchCost cost);
std::string case_name(Aggregation aggregation);

}  // namespace test
}  // namespace vantage
