#pragma once

#include <string>

#include "engine/reprojection/point_cloud.h"

namespace vantage::python {

/// Points, and what their file says of the coordinates.
struct FramedCloud {
  PointCloud cloud;
  std::string frame;
};

/// Triangles, likewise.
struct FramedMesh {
  TriangleMesh mesh;
  std::string frame;
};

FramedCloud make_cloud(const CloudSource& source, const CloudOptions& options, Execution& execution,
                       const std::string& frame);
FramedMesh make_mesh(const CloudSource& source, const CloudOptions& options, Execution& execution,
                     const std::string& frame);

}  // namespace vantage::python
