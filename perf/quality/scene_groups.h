#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "perf/quality/true_scenes.h"

namespace vantage::perf {

/// Scenes that figures are averaged over.
struct SceneGroup {
  std::string name;
  std::vector<std::size_t> scenes;  ///< places in the list of scenes
};

/// The groups that the scenes belong to, in their order, and one of them all.
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
