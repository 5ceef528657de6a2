#include "apps/scene/posed_scene_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/files/text_lines.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/video/frame_source.h"
#include "engine/rectification/calibration/posed_images.h"
#include "engine/rectification/kitti_cameras.h"
#include "engine/view_geometry/intrinsics_file.h"
#include "engine/view_geometry/nerf_transforms.h"
#include "engine/view_geometry/trajectory_file.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxTimeDifference_s = 0.02;

/// `name` of a model is the file in the folder `images`, or the one of the name without folders;
/// NeRF tools leave out extensions.
fs::path file_of(const fs::path& images, const fs::path& name) {
  for (const fs::path& path : {images / name, images / name.filename()}) {
    for (const char* extension : {"", ".png", ".jpg"}) {
      const fs::path file = path.string() + extension;
      if (is_file(file)) {
        return file;
      }
    }
  }
  return images / name;
}

void require_folder(const std::string& images, const fs::path& intrinsics) {
  if (!intrinsics.empty()) {
    throw UsageError("--intrinsics is given with a model, which has its own cameras");
  }
  if (!is_folder(images)) {
    throw UsageError(
        fmt::format("--images is '{}', expected the folder of the model's images", images));
  }
}

/// `model`: the file that names them.
std::vector<SceneImage> images_of_model(const std::vector<PosedImage>& posed,
                                        const std::string& images, const fs::path& model) {
  std::vector<SceneImage> result;
  for (const PosedImage& image : posed) {
    const fs::path file = file_of(images, image.name);
    if (!is_there(file)) {
      throw Error(
          fmt::format("{} is missing, expected an image of {}", file.string(), model.string()));
    }
    result.push_back({.file = file,
                      .position = {},
                      .camera = SceneCamera{.lens = image.camera.camera, .pose = image.pose},
                      .camera_size = image.camera.size});
  }
  return result;
}

std::vector<fs::path> files_of(const std::string& images) {
  const std::unique_ptr<FrameSource> source = open_frame_source(images);
  if (!source->video_file().empty()) {
    throw UsageError(fmt::format("--images is '{}', a video; expected image files", images));
  }
  std::vector<fs::path> files;
  for (int i = 0; i < source->frame_count(); ++i) {
    files.emplace_back(source->describe(i));
  }
  return files;
}

/// The times that the names of all files tell; empty if one does not.
std::vector<double> times_of(const std::vector<fs::path>& files) {
  std::vector<double> times;
  for (const fs::path& file : files) {
    const std::optional<double> time = finite_number(file.stem().string());
    if (!time) {
      return {};
    }
    times.push_back(*time);
  }
  return times;
}

/// The number of the pose nearest in time to each image; −1 if none is near.
std::vector<int> nearest_poses(const std::vector<double>& image_times,
                               const std::vector<double>& pose_times) {
  std::vector<int> numbers;
  for (const double time : image_times) {
    const auto nearest = std::ranges::min_element(
        pose_times, {}, [&](double other) { return std::abs(other - time); });
    numbers.push_back(std::abs(*nearest - time) <= kMaxTimeDifference_s
                          ? static_cast<int>(nearest - pose_times.begin())
                          : -1);
  }
  return numbers;
}

SceneImage image_of(const fs::path& file, const SizedCamera& camera, const CameraPose& pose) {
  return {.file = file,
          .position = {},
          .camera = SceneCamera{.lens = camera.camera, .pose = pose},
          .camera_size = camera.size};
}

std::vector<SceneImage> in_order(const std::vector<fs::path>& files, const SizedCamera& camera,
                                 const std::vector<CameraPose>& poses, const fs::path& file) {
  if (files.size() != poses.size()) {
    throw Error(fmt::format("{} has {} poses, expected {} as there are images", file.string(),
                            poses.size(), files.size()));
  }
  std::vector<SceneImage> result;
  for (std::size_t i = 0; i < files.size(); ++i) {
    result.push_back(image_of(files[i], camera, poses[i]));
  }
  return result;
}

std::vector<SceneImage> images_of_trajectory(const Trajectory& trajectory, const fs::path& file,
                                             const std::vector<fs::path>& files,
                                             const SizedCamera& camera,
                                             std::vector<std::string>& remarks) {
  const std::vector<double> times = times_of(files);
  if (trajectory.times_s.empty() || times.empty()) {
    return in_order(files, camera, trajectory.poses, file);
  }
  const std::vector<int> numbers = nearest_poses(times, trajectory.times_s);
  std::vector<SceneImage> result;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (numbers[i] >= 0) {
      result.push_back(
          image_of(files[i], camera, trajectory.poses[static_cast<std::size_t>(numbers[i])]));
    }
  }
  if (result.empty() && files.size() == trajectory.poses.size()) {
    return in_order(files, camera, trajectory.poses, file);  // names are numbers, not times
  }
  if (result.empty()) {
    throw Error(
        fmt::format("{}: no pose is within {} s of an image, expected images named after "
                    "their times, or as many as there are poses",
                    file.string(), kMaxTimeDifference_s));
  }
  if (result.size() < files.size()) {
    remarks.push_back(fmt::format(
        "{} of {} images are left out: {} has no pose within {} s of them",
        files.size() - result.size(), files.size(), file.string(), kMaxTimeDifference_s));
  }
  return result;
}

}  // namespace

std::vector<SceneImage> posed_scene_images(const fs::path& poses, const std::string& images,
                                           const fs::path& intrinsics, std::optional<LensKind> lens,
                                           std::vector<std::string>& remarks) {
  if (images.empty()) {
    throw UsageError("--poses is given without --images, expected both");
  }
  if (is_folder(poses)) {
    require_folder(images, intrinsics);
    return images_of_model(read_colmap_model(poses), images, poses / "images.txt");
  }
  const std::string text = read_file_text(poses);
  if (is_nerf_transforms(text)) {
    require_folder(images, intrinsics);
    const auto size_of = [&](const std::string& name) {
      const Photograph photograph = read_photograph(file_of(images, name));
      return ImageSize{photograph.width(), photograph.height()};
    };
    return images_of_model(parse_nerf_transforms(text, poses.string(), size_of), images, poses);
  }
  const std::vector<fs::path> files = files_of(images);
  const bool is_opencv = has_opencv_poses(text, poses.string());
  if (!is_opencv && intrinsics.empty()) {
    throw UsageError(
        fmt::format("--poses is '{}', a trajectory without a camera; expected "
                    "--intrinsics too",
                    poses.string()));
  }
  const fs::path& camera_file = intrinsics.empty() ? poses : intrinsics;
  const SizedCamera camera = read_intrinsics(
      camera_file, {.kitti_camera = kitti_camera_of(files).value_or(0), .lens = lens});
  for (const Remark& remark : camera.remarks) {
    remarks.push_back(remark.text);
  }
  if (is_opencv) {
    return in_order(files, camera, parse_opencv_poses(text, poses.string()), poses);
  }
  const Trajectory trajectory = parse_trajectory(text, poses.string());
  if (trajectory.is_of_body) {
    remarks.push_back(fmt::format(
        "{}: the poses are those of the body (IMU), taken as those of the camera", poses.string()));
  }
  return images_of_trajectory(trajectory, poses, files, camera, remarks);
}

}  // namespace vantage::apps
