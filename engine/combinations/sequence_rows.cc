#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "engine/combinations/combination_rows.h"

// What does not go together in a sequence, whoever runs it.

namespace vantage {
namespace {

constexpr CombinationScope kSequence = CombinationScope::kSequence;
constexpr std::string_view kFractionsOfPixels =
    "candidates differ by fractions from pixel to pixel";

Condition reduced_realtime() {
  return is_not("search-size", "full").said("with a reduced search-size (preset realtime)");
}

void add_frame_before(std::vector<Combination>& rows) {
  rows.push_back({.scope = kSequence,
                  .option = above("temporal-prior", 0),
                  .with = {reduced_realtime()},
                  .expected = "0"});
  std::vector<Condition> obstacles = {
      given("baselines"), given("save posterior-mean").said("with moments of p(d)"),
      given("save posterior-variance").said("with moments of p(d)")};
  const std::vector<Condition> of_method = obstacles_of_reuse();
  obstacles.insert(obstacles.end(), of_method.begin(), of_method.end());
  rows.push_back({.scope = kSequence,
                  .option = is("reuse", "frame"),
                  .with = std::move(obstacles),
                  .expected = "none"});
  rows.push_back({.scope = kSequence,
                  .option = is("search-range", "shot"),
                  .with = {above("temporal-prior", 0), is_not("reuse", "none")},
                  .reason = "they pass disparities on",
                  .message = "search-range is shot, expected film with temporal-prior or reuse, "
                             "which pass disparities on"});
}

void add_sequence_outputs(std::vector<Combination>& rows) {
  for (const std::string_view output : {"save posterior-mean", "save posterior-variance"}) {
    const std::string_view name = output.substr(output.find(' ') + 1);
    rows.push_back({.scope = kSequence,
                    .option = given(output),
                    .with = {is_not("aggregate", "bayes")},
                    .reason = "bayes alone has p(d)",
                    .message = fmt::format("save has {} with {{chosen}}, expected the aggregation "
                                           "bayes, which alone has p(d)",
                                           name)});
    rows.push_back({.scope = kSequence,
                    .option = given(output),
                    .with = {reduced_realtime()},
                    .reason = "a few candidates are searched at full size",
                    .message = fmt::format("save has {} with a reduced search-size (preset "
                                           "realtime), expected search-size full",
                                           name)});
  }
  for (const std::string_view output : {"save cyclopean", "save cyclopean-occlusion"}) {
    rows.push_back({.scope = kSequence,
                    .option = given(output),
                    .with = {is_not("selection", "symmetric")},
                    .reason = "others have no matches of both images",
                    .message = "save has cyclopean or cyclopean-occlusion, expected them with "
                               "selection symmetric only"});
  }
  for (const std::string_view output : {"save right-disparity", "save right-unmatched"}) {
    rows.push_back({.scope = kSequence,
                    .option = given(output),
                    .with = {is("reference", "right")},
                    .reason = "disparity is the right map then",
                    .message = fmt::format("save has {} with reference right, expected disparity, "
                                           "which is the right map then",
                                           output.substr(output.find(' ') + 1))});
  }
}

void add_unrectified_sequences(std::vector<Combination>& rows) {
  const auto add = [&](const Condition& option, std::string_view what, std::string_view why) {
    rows.push_back({.scope = kSequence,
                    .option = option,
                    .with = {given("unrectified")},
                    .reason = why,
                    .message = fmt::format("{} cannot be used with unrectified: {}", what, why)});
  };
  add(given("baselines"), "baselines", "a calibration is of two cameras");
  add(is("selection", "symmetric"), "selection symmetric",
      "pixels of both photographs lie on different epipolar lines");
  constexpr std::string_view kMoments = "save posterior-mean and posterior-variance";
  add(given("save posterior-mean"), kMoments, kFractionsOfPixels);
  add(given("save posterior-variance"), kMoments, kFractionsOfPixels);
  add(above("temporal-prior", 0), "temporal-prior", kFractionsOfPixels);
  add(is_not("reuse", "none"), "reuse", "tiles of rows are kept");
  for (const std::string_view output :
       {"save views", "save holes", "save sources", "save stereo", "save depth",
        "save depth-resolution", "save cloud", "save mesh", "save comfort"}) {
    rows.push_back({.scope = kSequence,
                    .option = given(output),
                    .with = {is("unrectified", "photographs")},
                    .reason = "it belongs to rectified pixels",
                    .message = fmt::format("save has {} with unrectified, which belongs to "
                                           "rectified pixels, expected rectified-pixels too",
                                           output.substr(output.find(' ') + 1))});
  }
}

}  // namespace

std::vector<Combination> sequence_combinations() {
  std::vector<Combination> rows;
  add_frame_before(rows);
  rows.push_back({.scope = kSequence,
                  .option = is("selection", "symmetric"),
                  .with = {given("baselines")},
                  .expected = "winner or scanline",
                  .reason = "a symmetric solution is of two images"});
  add_sequence_outputs(rows);
  add_unrectified_sequences(rows);
  return rows;
}

}  // namespace vantage
