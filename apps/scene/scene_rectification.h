#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/matching/options/match_options.h"
#include "engine/options/setting_value.h"
#include "engine/scene_graph/scene_builder.h"

namespace vantage::apps {

/// Collects what the edges of a scene show about the given image positions.
class SceneRectification {
 public:
  /// `builder` must outlive it. Warns of negative disparities unless `options` expect them.
  SceneRectification(const SceneBuilder& builder, const MatchOptions& options);

  /// The report entry of an edge; null if nothing is known.
  SettingValue add(const BuiltEdge& edge);

  /// Prints one warning for each of the worst few edges whose row or column error is too large or
  /// whose images look exchanged, and the number of the others.
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
