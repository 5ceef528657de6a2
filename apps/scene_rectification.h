#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "apps/setting_value.h"
#include "engine/matching/options/match_options.h"
#include "engine/scene_graph/scene_builder.h"

namespace vantage::apps {

/// Gathers what the edges of a scene say about where its images are said to stand.
class SceneRectification {
 public:
  /// `builder` outlives it. Warns of negative disparities unless `options` expect them.
  SceneRectification(const SceneBuilder& builder, const MatchOptions& options);

  /// What the report says about an edge; null where nothing is known.
  SettingValue add(const SceneBuilder::BuiltEdge& edge);

  /// One line on stderr for each of the worst few edges whose rows or columns are farther off than
  /// those of pairs may be, or whose images look exchanged, and how many more there are.
  void print_warnings() const;

 private:
  struct Warning {
    double severity = 0;
    std::string text;
  };

  const SceneBuilder& builder_;
  bool expects_negative_disparities_;
  std::vector<Warning> warnings_;
};

}  // namespace vantage::apps
