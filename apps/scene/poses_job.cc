#include "apps/scene/poses_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <set>

#include "apps/commands/commands.h"
#include "apps/process/command_work.h"
#include "apps/process/outputs.h"
#include "apps/process/progress.h"
#include "apps/process/tell.h"
#include "apps/reports/remarks.h"
#include "engine/error.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/video/frame_source.h"
#include "engine/rectification/kitti_cameras.h"
#include "engine/scene_graph/edge_maps.h"
#include "engine/scene_graph/posed_edges.h"
#include "engine/sequence/options/sequence_layout.h"
#include "engine/view_geometry/colmap_model.h"
#include "engine/view_geometry/intrinsics_file.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::array kModelFiles = {"cameras.txt", "images.txt", "points3D.txt"};
constexpr std::size_t kLinesPrinted = 5;

std::vector<fs::path> photographs_of(const std::string& images) {
  if (images.empty()) {
    throw UsageError("no images are given, expected --images");
  }
  const std::unique_ptr<FrameSource> source = open_frame_source(images);
  if (!source->video_file().empty()) {
    throw UsageError(fmt::format("--images is '{}', a video; expected image files", images));
  }
  std::vector<fs::path> files;
  std::set<fs::path> names;
  for (int i = 0; i < source->frame_count(); ++i) {
    files.emplace_back(source->describe(i));
    if (!names.insert(files.back().filename()).second) {
      throw Error(fmt::format("{}: its name is that of another image, expected different names",
                              files.back().string()));
    }
  }
  return files;
}

void check_files(const ScenePosesJob& job, const Settings& settings,
                 const std::vector<fs::path>& files) {
  if (fs::exists(job.output) && !fs::is_directory(job.output)) {
    throw UsageError(fmt::format("--output is '{}', a file; expected a folder", job.output));
  }
  FileChecks checks(settings);
  for (const fs::path& file : files) {
    checks.add_input(file);
  }
  for (const char* const name : kModelFiles) {
    checks.add_made_file(fs::path(job.output) / name, "--output");
  }
  checks.require_nothing_made_unless(job.overwrite);
  check_common_files(job.common, checks);
}

void require_image(int number, std::size_t images) {
  if (number >= static_cast<int>(images)) {
    throw UsageError(
        fmt::format("--known-distance names image {}, expected 0 to {}", number, images - 1));
  }
}

/// Makes the known distance true.
void give_scale(const KnownDistance& distance, const std::vector<fs::path>& files,
                CameraEstimate& estimate) {
  std::array<Eigen::Vector3d, 2> centres;
  for (std::size_t i = 0; i < 2; ++i) {
    const int number = i == 0 ? distance.first : distance.second;
    const EstimatedImage& image = estimate.images[static_cast<std::size_t>(number)];
    if (!image.pose) {
      throw Error(
          fmt::format("{}: has no pose, expected two images with poses for "
                      "--known-distance: {}",
                      files[static_cast<std::size_t>(number)].string(), image.problem));
    }
    centres[i] = image.pose->centre();
  }
  const double scale = distance.metres / (centres[1] - centres[0]).norm();
  for (EstimatedImage& image : estimate.images) {
    if (image.pose) {
      image.pose->translation *= scale;
    }
  }
  for (PointTrack& track : estimate.points) {
    track.point *= scale;
  }
}

void write_model(const ScenePosesJob& job, const std::vector<fs::path>& files, ImageSize size,
                 const CameraEstimate& estimate) {
  std::vector<PosedImageName> images;
  std::vector<int> places;
  for (std::size_t i = 0; i < files.size(); ++i) {
    places.push_back(static_cast<int>(images.size()));
    if (estimate.images[i].pose) {
      images.push_back({.name = files[i].filename().string(), .pose = *estimate.images[i].pose});
    }
  }
  std::vector<PointTrack> points = estimate.points;
  for (PointTrack& point : points) {
    std::erase_if(point.sightings, [&](const PointSighting& sighting) {
      return !estimate.images[static_cast<std::size_t>(sighting.image)].pose;
    });
    for (PointSighting& sighting : point.sightings) {
      sighting.image = places[static_cast<std::size_t>(sighting.image)];
    }
  }
  make_folder(job.output);
  write_colmap_model(job.output, {.camera = estimate.lens, .size = size}, images, points);
}

SettingValue results_of(const ScenePosesJob& job, const std::vector<fs::path>& files,
                        const CameraEstimate& estimate) {
  SettingValue images = SettingValue::array();
  for (std::size_t i = 0; i < files.size(); ++i) {
    const EstimatedImage& image = estimate.images[i];
    SettingValue values = {{"file", files[i].string()}};
    if (image.pose) {
      const Eigen::Vector3d centre = image.pose->centre();
      values["centre"] = {centre.x(), centre.y(), centre.z()};
      values["points"] = image.points;
      values["rms_px"] = image.rms_px;
    } else {
      values["left_out"] = image.problem;
    }
    images.push_back(std::move(values));
  }
  SettingValue pairs = SettingValue::array();
  for (const EstimatedPair& pair : estimate.pairs) {
    SettingValue values = {{"first", pair.first},
                           {"second", pair.second},
                           {"matches", pair.matches},
                           {"inliers", pair.inliers},
                           {"off_degrees", pair.off_degrees}};
    if (!pair.refusal.empty()) {
      values["refused"] = pair.refusal;
    }
    pairs.push_back(std::move(values));
  }
  const Camera& lens = estimate.lens;
  return {{"images", std::move(images)},
          {"pairs", std::move(pairs)},
          {"unit", job.distance ? "metre" : "median distance of a camera from the nearest one"},
          {"lens",
           {{"is_estimated", job.intrinsics.empty()},
            {"focal_length_px", lens.matrix(0, 0)},
            {"distortion", lens.distortion}}},
          {"points", estimate.points.size()},
          {"sightings", estimate.sightings},
          {"outliers", estimate.outliers},
          {"median_px_before_adjustment", estimate.start_median_px},
          {"median_px", estimate.median_px},
          {"rms_px", estimate.rms_px}};
}

void print_results(const ScenePosesJob& job, const std::vector<fs::path>& files,
                   const CameraEstimate& estimate) {
  const auto print_some = [](const std::vector<std::string>& all) {
    for (std::size_t i = 0; i < std::min(all.size(), kLinesPrinted); ++i) {
      tell("scene poses: {}\n", all[i]);
    }
    if (all.size() > kLinesPrinted) {
      tell("scene poses: … and {} more, see --report\n", all.size() - kLinesPrinted);
    }
  };
  std::vector<std::string> left_out;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!estimate.images[i].pose) {
      left_out.push_back(
          fmt::format("{} is left out: {}", files[i].string(), estimate.images[i].problem));
    }
  }
  std::vector<std::string> refused;
  for (const EstimatedPair& pair : estimate.pairs) {
    if (!pair.refusal.empty()) {
      refused.push_back(fmt::format(
          "{} and {} do not count: {}", files[static_cast<std::size_t>(pair.first)].string(),
          files[static_cast<std::size_t>(pair.second)].string(), pair.refusal));
    }
  }
  print_some(left_out);
  print_some(refused);
  tell(
      "scene poses: {} of {} images, {} of {} pairs, {} points; median error {:.2f} px, before "
      "the adjustment {:.2f} px -> {}\n",
      files.size() - left_out.size(), files.size(), estimate.pairs.size() - refused.size(),
      estimate.pairs.size(), estimate.points.size(), estimate.median_px, estimate.start_median_px,
      job.output);
  if (job.intrinsics.empty()) {
    tell("scene poses: focal length {:.1f} px, k1 {:.4f}, estimated from the images\n",
         estimate.lens.matrix(0, 0), estimate.lens.distortion.at(0));
  }
  if (!job.distance) {
    tell(
        "scene poses: lengths have no scale: the median distance of a camera from the nearest one "
        "is 1; --known-distance makes them metres\n");
  }
}

/// With its progress on stderr.
CameraEstimate estimate_of(const ScenePosesJob& job, const std::vector<fs::path>& files,
                           Execution& execution) {
  std::vector<std::string> names;
  for (const fs::path& file : files) {
    names.push_back(file.string());
  }
  std::optional<Progress> progress;
  std::string step_shown;
  return estimate_cameras(
      names,
      [&](int image) {
        return read_photograph(files[static_cast<std::size_t>(image)], job.reading);
      },
      job.estimation,
      [&](std::string_view step, int done, int total) {
        if (step != step_shown) {
          step_shown = step;
          progress.emplace("scene poses: " + step_shown, "pieces",
                           job.common.quiet ? ProgressStyle::kNone : ProgressStyle::kAuto);
        }
        progress->update(done, total, 0);
      },
      execution);
}

/// Says at once what 'scene build' would refuse.
void warn_of_edges(const std::vector<fs::path>& files, ImageSize size,
                   const CameraEstimate& estimate) {
  std::vector<SceneCamera> cameras;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (const auto& pose = estimate.images[i].pose) {
      cameras.push_back({.lens = estimate.lens, .pose = *pose});
      names.push_back(files[i].string());
    }
  }
  try {
    posed_edges(cameras, names, size.width_px, size.height_px, SceneBuildOptions{}.neighbours);
  } catch (const Error& error) {
    tell("scene poses: warning: 'vantage scene build' will refuse this: {}\n", error.what());
  }
}

}  // namespace

int estimate_poses(ScenePosesJob& job, const Settings& settings) {
  job.estimation.validate();
  job.common.execution.validate();
  const std::vector<fs::path> files = photographs_of(job.images);
  check_files(job, settings, files);
  if (job.distance) {
    require_image(std::max(job.distance->first, job.distance->second), files.size());
  }
  SizedCamera camera;
  if (!job.intrinsics.empty()) {
    camera = read_intrinsics(
        job.intrinsics, {.kitti_camera = kitti_camera_of(files).value_or(0), .lens = job.lens});
    job.estimation.lens = camera.camera;
  } else {
    settings.refuse_idle({"lens"}, "without --intrinsics");
  }
  CommandWork work(settings, job.common);
  RunReport& report = work.report;
  tell_remarks(camera.remarks, job.common, report);

  const Photograph first =
      report.timed_file_access("read", [&] { return read_photograph(files[0], job.reading); });
  tell_remarks(first.origin.remarks, job.common, report);
  const ImageSize size{first.width(), first.height()};
  if (camera.size.width_px != 0 &&
      (camera.size.width_px != size.width_px || camera.size.height_px != size.height_px)) {
    job.estimation.lens = camera.scaled_to(size);
    if (!job.estimation.lens) {
      throw Error(fmt::format("{} is {}x{}, expected {}x{} as its camera", files[0].string(),
                              size.width_px, size.height_px, camera.size.width_px,
                              camera.size.height_px));
    }
    tell("scene poses: {} is for images of {}x{} and is scaled to {}x{}\n", job.intrinsics,
         camera.size.width_px, camera.size.height_px, size.width_px, size.height_px);
  }
  CameraEstimate estimate =
      report.timed_compute("poses", [&] { return estimate_of(job, files, work.execution); });
  if (job.distance) {
    give_scale(*job.distance, files, estimate);
  }
  report.timed_file_access("write", [&] { write_model(job, files, size, estimate); });
  report.set_results(results_of(job, files, estimate));
  report.write(job.common.report);
  if (!job.common.quiet) {
    print_results(job, files, estimate);
    warn_of_edges(files, size, estimate);
    report.print_summary();
  }
  const bool is_complete = std::ranges::all_of(
      estimate.images, [](const EstimatedImage& image) { return image.pose.has_value(); });
  return is_complete ? kExitDone : kExitSkipped;
}

}  // namespace vantage::apps
