#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "engine/execution.h"
#include "engine/rectification/rows/row_field.h"
#include "engine/remark.h"
#include "engine/scene_graph/scene_layout.h"
#include "engine/scene_graph/stored_scene.h"

namespace vantage {

/// An image whose rows are corrected.
struct CorrectedImage {
  int vertex = 0;
  RowEstimate rows;  ///< of the image beside a neighbour
  Remark remark;     ///< names both files
};

/// Sets StoredImage::rows of images whose rows differ from those of their neighbours in a row of
/// cameras, where check_rows() says that it pays to correct them. The image that differs least from
/// all of its row stays as it is; to both sides of it each image is compared with the one before,
/// as that is corrected itself. So all images of a row agree, in all their edges and views.
/// `files`: of all images, which are read again. Identical for any execution. Throws Error for an
/// image that cannot be read. Thread rule: pure but for `scene`.
std::vector<CorrectedImage> correct_scene_rows(StoredScene& scene, std::span<const SceneEdge> edges,
                                               std::span<const std::filesystem::path> files,
                                               Execution& execution);

}  // namespace vantage
