#include "engine/view_geometry/colmap_model.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <iterator>

#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/quoted_text.h"

namespace vantage {
namespace {

/// COLMAP's pixel centres are at halves.
constexpr double kHalf = 0.5;

std::string camera_line(const SizedCamera& sized) {
  const Camera& camera = sized.camera;
  const bool is_fisheye = camera.lens == LensKind::kFisheye;
  const std::size_t coefficients = camera.is_without_distortion()  ? 0
                                   : camera.distortion.size() <= 4 ? 4
                                                                   : 8;
  if (!camera.is_without_distortion() && camera.distortion.size() > 8) {
    throw Error(fmt::format("the lens has {} coefficients, expected at most 8 in a COLMAP model",
                            camera.distortion.size()));
  }
  std::string line = fmt::format("1 {} {} {}",
                                 coefficients == 0   ? "PINHOLE"
                                 : is_fisheye        ? "OPENCV_FISHEYE"
                                 : coefficients == 4 ? "OPENCV"
                                                     : "FULL_OPENCV",
                                 sized.size.width_px, sized.size.height_px);
  const Eigen::Matrix3d& k = camera.matrix;
  for (const double value : {k(0, 0), k(1, 1), k(0, 2) + kHalf, k(1, 2) + kHalf}) {
    line += fmt::format(" {}", value);
  }
  for (std::size_t i = 0; i < coefficients; ++i) {
    line += fmt::format(" {}", i < camera.distortion.size() ? camera.distortion[i] : 0.0);
  }
  return line + "\n";
}

}  // namespace

void write_colmap_model(const std::filesystem::path& folder, const SizedCamera& camera,
                        std::span<const PosedImageName> images,
                        std::span<const PointTrack> points) {
  const LensModel lens(camera.camera);
  std::vector<std::string> seen(images.size());
  std::vector<int> counts(images.size());
  std::string point_lines = "# POINT3D_ID X Y Z R G B ERROR TRACK[] (IMAGE_ID POINT2D_IDX)\n";
  auto point_out = std::back_inserter(point_lines);
  long long number = 0;
  for (const PointTrack& point : points) {
    std::string track;
    for (const PointSighting& sighting : point.sightings) {
      const auto image = static_cast<std::size_t>(sighting.image);
      const auto pixel = lens.position_of(sighting.position_px / camera.camera.matrix(0, 0));
      if (!pixel) {
        continue;
      }
      seen[image] +=
          fmt::format("{:.3f} {:.3f} {} ", pixel->x() + kHalf, pixel->y() + kHalf, number + 1);
      track += fmt::format(" {} {}", image + 1, counts[image]++);
    }
    if (!track.empty()) {
      fmt::format_to(point_out, "{} {:.9g} {:.9g} {:.9g} 128 128 128 0{}\n", ++number,
                     point.point.x(), point.point.y(), point.point.z(), track);
    }
  }
  std::string image_lines =
      "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then X Y POINT3D_ID of its points\n";
  for (std::size_t i = 0; i < images.size(); ++i) {
    const auto& [name, pose] = images[i];
    if (name.find_first_of("\r\n") != std::string::npos) {
      throw Error(fmt::format("the name '{}' has a line break, expected none in a COLMAP model",
                              quotable(name)));
    }
    const Eigen::Quaterniond q(pose.rotation);
    const Eigen::Vector3d& t = pose.translation;
    image_lines += fmt::format("{} {} {} {} {} {} {} {} 1 {}\n{}\n", i + 1, q.w(), q.x(), q.y(),
                               q.z(), t.x(), t.y(), t.z(), name, seen[i]);
  }
  write_text_file(folder / "cameras.txt",
                  "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS\n" + camera_line(camera));
  write_text_file(folder / "images.txt", image_lines);
  write_text_file(folder / "points3D.txt", point_lines);
}

}  // namespace vantage
