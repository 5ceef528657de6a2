#include "apps/scene/scene_rectification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <limits>

#include "apps/inputs/rectification_check.h"
#include "apps/process/tell.h"
#include "apps/reports/vertical_error_report.h"
#include "engine/matching/pair_matcher.h"
#include "engine/rectification/rows/row_remarks.h"
#include "engine/rectification/vertical_error.h"
#include "engine/scene_graph/rectified_edge.h"

namespace vantage::apps {
namespace {

constexpr std::size_t kMaxWarnings = 5;

}  // namespace

SceneRectification::SceneRectification(const SceneBuilder& builder, const MatchOptions& options)
    : builder_(builder), expects_negative_disparities_(expects_negative_disparities(options)) {}

SettingValue SceneRectification::add(const BuiltEdge& edge) {
  if (!edge.refusal.empty()) {
    warnings_.push_back({std::numeric_limits<double>::infinity(),
                         fmt::format("edge {}-{} is left out: {}", edge.stored.edge.first,
                                     edge.stored.edge.second, edge.refusal)});
    return {};
  }
  if (!edge.rectification) {
    return {};
  }
  const VerticalError& error = *edge.rectification;
  const SceneEdge& ends = edge.stored.edge;
  const std::string name = fmt::format("edge {}-{} ({}, {})", ends.first, ends.second,
                                       builder_.image_file(ends.first).filename().string(),
                                       builder_.image_file(ends.second).filename().string());
  const bool looks_exchanged = !expects_negative_disparities_ && error.looks_exchanged();
  if (!is_rectified(error)) {
    warnings_.push_back(
        {error.systematic_px, fmt::format("{}: {}; {}", name, cost_text(error, lines_of(ends)),
                                          vertical_error_text(error))});
  }
  if (looks_exchanged) {
    warnings_.push_back(
        {std::numeric_limits<double>::infinity(),
         fmt::format("{}: the images look exchanged: {:.0f} % of {} points have negative "
                     "disparities; x must increase to the right, y downwards",
                     name, 100 * error.negative_share, error.inliers)});
  }
  SettingValue values = vertical_error_values(error);
  values["is_rectified"] = is_rectified(error);
  values["looks_exchanged"] = looks_exchanged;
  return values;
}

void SceneRectification::print_warnings() const {
  std::vector<Warning> worst = warnings_;
  std::stable_sort(worst.begin(), worst.end(),
                   [](const Warning& a, const Warning& b) { return a.severity > b.severity; });
  const std::size_t printed = std::min(worst.size(), kMaxWarnings);
  for (std::size_t i = 0; i < printed; ++i) {
    tell("scene build: warning: {}\n", with_dashes(worst[i].text));
  }
  if (worst.size() > printed) {
    tell("scene build: warning: {} more of these; --report lists all\n", worst.size() - printed);
  }
}

}  // namespace vantage::apps
