#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/scene_graph/scene_camera.h"
#include "engine/scene_graph/scene_layout.h"

namespace vantage {

inline constexpr int kMaxNeighbours = 32;

/// The edges of a scene of posed cameras: every camera is joined to its `neighbours` (1 to 32)
/// nearest ones in different directions; fewer if only those are left. Cameras are neighbours if
/// the pair can be rectified: viewing directions at most 45° apart, each at least 30° off the
/// baseline, and enough common view. Turned cameras count as farther, twice as far at 20°. Nearer
/// ones in the same direction (45°) come first; more in one direction only where others lack.
/// Sorted by first < second; `is_vertical` and `slope` are not used.
///
/// `names`: of the images, for messages. Throws Error naming images for fewer than 2 or more than
/// SceneLayout::kMaxVertices cameras, two at one position, and one without neighbours.
std::vector<SceneEdge> posed_edges(std::span<const SceneCamera> cameras,
                                   std::span<const std::string> names, int width_px, int height_px,
                                   int neighbours);

/// The median length of the edges, at least one: the unit of disparities of a posed scene.
double median_length(std::span<const SceneEdge> edges);

}  // namespace vantage
