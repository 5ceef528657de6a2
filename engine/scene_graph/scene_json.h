#pragma once

#include <string>
#include <string_view>

#include "engine/scene_graph/stored_scene.h"

namespace vantage {

// The description of a scene, scene.json. Thread rule: pure.

std::string scene_text(const StoredScene& scene);

/// Throws Error naming the file `name` when the text is damaged or of another format.
StoredScene parse_scene(std::string_view text, const std::string& name);

}  // namespace vantage
