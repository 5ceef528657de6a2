#pragma once

#include <memory>
#include <vector>

#include "engine/generation/layered_scene.h"
#include "engine/generation/scene_surface.h"
#include "engine/generation/scene_texture.h"

namespace vantage {

struct SceneObject {
  std::unique_ptr<const Surface> surface;
  Palette palette;
};

/// The surfaces of the layered scene at `frame`, always the same ones in the same order. `options`
/// are valid. Thread rule: pure.
std::vector<SceneObject> compose_scene(const LayeredSceneOptions& options, CentreView centre,
                                       int frame);

}  // namespace vantage
