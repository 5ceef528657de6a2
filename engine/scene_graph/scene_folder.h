#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "engine/image/disparity_maps.h"
#include "engine/scene_graph/stored_scene.h"

namespace vantage {

// Files of a scene's folder beside scene.json: maps and masks in maps/, copies of images in
// images/. Thread rule: one thread at a time; errors are thrown as Error.

/// The file whose lock belongs to the process that builds the scene; made with its folders.
std::filesystem::path scene_lock_file(const std::filesystem::path& folder);

/// The name of an image in scene.json, relative to the folder, so that folder and images can be
/// moved together; links to images are not resolved. With `copy`, an image from outside is copied
/// into the folder unless it is there. `content` is that of content_of_file().
std::string stored_image_file(const std::filesystem::path& folder,
                              const std::filesystem::path& image, const std::string& content,
                              bool copy);

/// Writes the maps and masks of an edge and names them in `edge`.
void store_maps(const std::filesystem::path& folder, const DisparityMaps& maps, StoredEdge& edge);

/// Whether the maps and masks of an edge are there in their sizes.
bool has_maps(const std::filesystem::path& folder, const StoredEdge& edge);

/// Removes unfinished files of a killed process. No other process may use the folder.
void remove_leftovers(const std::filesystem::path& folder, std::span<const SceneEdge> edges);

/// Removes the maps of `before` that no longer belong to the scene.
void remove_outdated_maps(const std::filesystem::path& folder, const StoredScene& before,
                          const StoredScene& scene);

}  // namespace vantage
