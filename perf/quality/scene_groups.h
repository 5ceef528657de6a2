#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "perf/quality/true_scenes.h"

namespace vantage::perf {

/// Scenes over which results are averaged.
struct SceneGroup {
  std::string name;
  std::vector<std::size_t> scenes;  ///< indices into the list of scenes
};

/// The groups of the scenes, in their order, followed by a group of all scenes.
inline std::vector<SceneGroup> scene_groups(const std::vector<const TrueScene*>& scenes) {
  std::vector<SceneGroup> groups;
  SceneGroup all{"all scenes", {}};
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    auto group = std::ranges::find(groups, scenes[i]->group, &SceneGroup::name);
    if (group == groups.end()) {
      group = groups.insert(groups.end(), {scenes[i]->group, {}});
    }
    group->scenes.push_back(i);
    all.scenes.push_back(i);
  }
  groups.push_back(all);
  return groups;
}

}  // namespace vantage::perf
