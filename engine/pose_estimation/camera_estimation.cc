#include "engine/pose_estimation/camera_estimation.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "engine/error.h"
#include "engine/order_statistics.h"
#include "engine/pose_estimation/bundle_adjustment.h"
#include "engine/pose_estimation/camera_positions.h"
#include "engine/pose_estimation/feature_tracks.h"
#include "engine/pose_estimation/rotation_averaging.h"
#include "engine/rectification/rotations.h"

namespace vantage {
namespace {

constexpr double kMaxOffDegrees = 5;
constexpr double kMaxFinalOffDegrees = 3;
constexpr int kMinSightings = 12;
// Weights end here: pairs with repeated patterns have many inliers that agree with a wrong pose.
constexpr std::size_t kInliersOfSurePair = 100;
constexpr int kMaxPartners = 100;
// Sightings are outliers if their error is above so many times the median error, and above so many
// pixels.
constexpr double kOutlierDeviations = 5;
constexpr double kMinOutlierPx = 1;

struct ImageSet {
  std::vector<ImageFeatures> features;
  int width_px = 0;
  int height_px = 0;
};

ImageSet read_features(const std::vector<std::string>& names,
                       const std::function<Photograph(int)>& load,
                       const CameraEstimationOptions& options, const StepProgress& progress,
                       Execution& execution) {
  std::vector<std::optional<ImageFeatures>> found(names.size());
  std::vector<std::pair<int, int>> sizes(names.size());
  for_each_piece("finding points", names.size(), progress, execution, [&](std::size_t i) {
    const Photograph photograph = load(static_cast<int>(i));
    sizes[i] = {photograph.width(), photograph.height()};
    found[i].emplace(photograph, options.features);
  });
  ImageSet images{.features = {}, .width_px = sizes[0].first, .height_px = sizes[0].second};
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (sizes[i] != sizes[0]) {
      throw Error(fmt::format("{} is {}x{}, expected {}x{} as {}", names[i], sizes[i].first,
                              sizes[i].second, images.width_px, images.height_px, names[0]));
    }
    images.features.push_back(std::move(*found[i]));
  }
  return images;
}

/// Pairs whose matches agree with one pose.
std::vector<PairGeometry> geometries_of(const std::vector<MatchedPair>& pairs, double focal_px,
                                        std::vector<EstimatedPair>& reported,
                                        Execution& execution) {
  std::vector<std::optional<PairGeometry>> found(pairs.size());
  execution.executor().parallel_for(static_cast<int>(pairs.size()), [&](int number) {
    const auto i = static_cast<std::size_t>(number);
    found[i] = pair_geometry(pairs[i].positions, pairs[i].features, focal_px);
  });
  std::vector<PairGeometry> geometries;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const int matches = static_cast<int>(pairs[i].features.size());
    if (matches < kMinPairInliers) {
      continue;
    }
    reported.push_back({.first = pairs[i].first,
                        .second = pairs[i].second,
                        .matches = matches,
                        .inliers = 0,
                        .off_degrees = 0,
                        .refusal = "no pose of two cameras agrees with enough of the matches"});
    if (found[i]) {
      found[i]->first = pairs[i].first;
      found[i]->second = pairs[i].second;
      reported.back().inliers = static_cast<int>(found[i]->inliers.size());
      reported.back().refusal.clear();
      geometries.push_back(std::move(*found[i]));
    }
  }
  return geometries;
}

EstimatedPair& reported_pair(std::vector<EstimatedPair>& reported, const PairGeometry& pair) {
  return *std::ranges::find_if(reported, [&](const EstimatedPair& one) {
    return one.first == pair.first && one.second == pair.second;
  });
}

/// Rotations of the cameras that are joined; leaves the pairs between them that agree.
AveragedRotations joined_rotations(int images, std::vector<PairGeometry>& pairs,
                                   std::vector<EstimatedPair>& reported) {
  std::vector<RelativeRotation> relative;
  for (const PairGeometry& pair : pairs) {
    relative.push_back(
        {.first = pair.first,
         .second = pair.second,
         .rotation = pair.rotation,
         .weight = static_cast<double>(std::min(pair.inliers.size(), kInliersOfSurePair))});
  }
  AveragedRotations averaged = average_rotations(images, relative, kMaxOffDegrees);
  std::vector<PairGeometry> kept;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    EstimatedPair& report = reported_pair(reported, pairs[i]);
    report.off_degrees = averaged.off_degrees[i];
    if (!averaged.is_joined[static_cast<std::size_t>(pairs[i].first)] ||
        !averaged.is_joined[static_cast<std::size_t>(pairs[i].second)]) {
      report.off_degrees = 0;
      report.refusal = "nothing joins it to the others";
    } else if (report.off_degrees > kMaxOffDegrees) {
      report.refusal = fmt::format("its turn is {:.1f} degrees off that of all pairs together",
                                   report.off_degrees);
    } else {
      kept.push_back(std::move(pairs[i]));
    }
  }
  pairs = std::move(kept);
  return averaged;
}

/// The tracks with sub-pixel positions: those that agree best with the first image of each.
/// `places`: of the images in the bundle.
std::vector<PointTrack> refined_tracks(const std::vector<PairGeometry>& pairs,
                                       const ImageSet& images, const LensPositions& positions,
                                       const std::vector<int>& places, Execution& execution) {
  const std::vector<std::vector<FeatureOfImage>> features = feature_tracks(pairs);
  struct Wanted {
    std::vector<std::array<int, 2>> features;
    std::vector<std::pair<std::size_t, std::size_t>> targets;  // track, sighting
  };
  const std::size_t count = images.features.size();
  std::vector<Wanted> wanted(count * count);
  std::vector<std::vector<Eigen::Vector2d>> pixels;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const FeatureOfImage first = features[i].front();
    std::vector<Eigen::Vector2d> own;
    for (std::size_t k = 0; k < features[i].size(); ++k) {
      const auto& [image, feature] = features[i][k];
      own.push_back(images.features[static_cast<std::size_t>(image)].position_px(feature));
      if (k > 0) {
        Wanted& here =
            wanted[static_cast<std::size_t>(first.image) * count + static_cast<std::size_t>(image)];
        here.features.push_back({first.feature, feature});
        here.targets.emplace_back(i, k);
      }
    }
    pixels.push_back(std::move(own));
  }
  execution.executor().parallel_for(static_cast<int>(wanted.size()), [&](int number) {
    const auto i = static_cast<std::size_t>(number);
    const auto refined = refined_partners(images.features[i / count], images.features[i % count],
                                          wanted[i].features);
    for (std::size_t k = 0; k < refined.size(); ++k) {
      const auto [track, sighting] = wanted[i].targets[k];
      if (refined[k]) {
        pixels[track][sighting] = *refined[k];
      }
    }
  });
  std::vector<PointTrack> tracks;
  for (std::size_t i = 0; i < features.size(); ++i) {
    PointTrack track;
    for (std::size_t k = 0; k < features[i].size(); ++k) {
      if (const auto position = positions.of(pixels[i][k])) {
        track.sightings.push_back({.image = places[static_cast<std::size_t>(features[i][k].image)],
                                   .position_px = *position});
      }
    }
    if (track.sightings.size() >= 2) {
      tracks.push_back(std::move(track));
    }
  }
  return tracks;
}

/// The error from which on a sighting is an outlier.
double outlier_limit(const Bundle& bundle) {
  std::vector<double> errors = bundle.errors_px();
  return std::max(kMinOutlierPx, kOutlierDeviations * upper_median(std::move(errors)));
}

/// Removes sightings with larger errors, then tracks with fewer than two sightings. Returns how
/// many sightings are removed.
int leave_out(Bundle& bundle, double limit_px) {
  int before = 0;
  int after = 0;
  for (PointTrack& track : bundle.tracks) {
    before += static_cast<int>(track.sightings.size());
    std::erase_if(track.sightings, [&](const PointSighting& sighting) {
      return !((bundle.projection_px(sighting.image, track.point) - sighting.position_px).norm() <=
               limit_px);
    });
  }
  std::erase_if(bundle.tracks, [](const PointTrack& track) { return track.sightings.size() < 2; });
  for (const PointTrack& track : bundle.tracks) {
    after += static_cast<int>(track.sightings.size());
  }
  return before - after;
}

void adjust(Bundle& bundle, bool fits_lens, CameraEstimate& estimate) {
  constexpr int kRounds = 4;
  estimate.start_median_px = upper_median(bundle.errors_px());
  for (int round = 0; round < kRounds && !bundle.tracks.empty(); ++round) {
    adjust_bundle(bundle, outlier_limit(bundle), fits_lens && round > 0);
    estimate.outliers += leave_out(bundle, 2 * outlier_limit(bundle));
  }
  adjust_bundle(bundle, outlier_limit(bundle), fits_lens);
}

/// The median distance of a camera from the nearest one; 1 for a single one.
double median_spacing(const std::vector<CameraPose>& poses) {
  std::vector<double> nearest;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    double distance = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < poses.size(); ++k) {
      if (k != i) {
        distance = std::min(distance, (poses[i].centre() - poses[k].centre()).norm());
      }
    }
    nearest.push_back(distance);
  }
  const double median = upper_median(std::move(nearest));
  return median > 0 && std::isfinite(median) ? median : 1;
}

/// Counts the sightings of the images, and moves poses and points to the frame of the first.
void take_poses(const Bundle& bundle, const std::vector<int>& numbers,
                const std::vector<std::string>& names, CameraEstimate& estimate) {
  std::vector<std::vector<double>> errors(bundle.cameras.size());
  for (const PointTrack& track : bundle.tracks) {
    for (const PointSighting& sighting : track.sightings) {
      errors[static_cast<std::size_t>(sighting.image)].push_back(
          (bundle.projection_px(sighting.image, track.point) - sighting.position_px).norm());
    }
  }
  std::vector<std::size_t> placed;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    EstimatedImage& image = estimate.images[static_cast<std::size_t>(numbers[i])];
    image.points = static_cast<int>(errors[i].size());
    image.rms_px = rms_of(errors[i]);
    if (image.points < kMinSightings) {
      image.problem = fmt::format("{} points agree with the other images, expected at least {}",
                                  image.points, kMinSightings);
    } else {
      placed.push_back(i);
    }
  }
  if (placed.size() < 2) {
    throw Error(
        fmt::format("{}: has no partner that agrees with it, expected images of one scene "
                    "that overlap",
                    names.front()));
  }
  const BundleCamera first = bundle.cameras[placed.front()];
  std::vector<CameraPose> poses;
  for (const std::size_t i : placed) {
    const BundleCamera& camera = bundle.cameras[i];
    poses.push_back(
        CameraPose::from_camera_to_world(first.rotation * camera.rotation.transpose(),
                                         first.rotation * (camera.centre - first.centre)));
  }
  const double spacing = median_spacing(poses);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    poses[i].translation /= spacing;
    estimate.images[static_cast<std::size_t>(numbers[placed[i]])].pose = poses[i];
  }
  estimate.points = bundle.tracks;
  for (PointTrack& track : estimate.points) {
    track.point = first.rotation * (track.point - first.centre) / spacing;
    for (PointSighting& sighting : track.sightings) {
      sighting.image = numbers[static_cast<std::size_t>(sighting.image)];
    }
  }
  std::vector<double> all = bundle.errors_px();
  estimate.rms_px = rms_of(all);
  estimate.sightings = static_cast<int>(all.size());
  estimate.median_px = upper_median(all);
}

/// Pairs whose own turn the adjusted poses contradict do not count.
void check_pairs(const std::vector<PairGeometry>& pairs, CameraEstimate& estimate) {
  for (const PairGeometry& pair : pairs) {
    const auto& first = estimate.images[static_cast<std::size_t>(pair.first)].pose;
    const auto& second = estimate.images[static_cast<std::size_t>(pair.second)].pose;
    EstimatedPair& report = reported_pair(estimate.pairs, pair);
    if (!first || !second) {
      report.refusal = "one of its images is left out";
      continue;
    }
    report.off_degrees =
        degrees(rotation_vector(pair.rotation * relative_pose(*first, *second).rotation.transpose())
                    .norm());
    if (report.off_degrees > kMaxFinalOffDegrees) {
      report.refusal = fmt::format(
          "its turn is {:.1f} degrees off that of all images together, expected at most {}",
          report.off_degrees, kMaxFinalOffDegrees);
    }
  }
}

}  // namespace

void CameraEstimationOptions::validate() const {
  if (partners < 1 || partners > kMaxPartners) {
    throw UsageError(
        fmt::format("partners is {}, expected a number from 1 to {}", partners, kMaxPartners));
  }
  features.validate();
}

CameraEstimate estimate_cameras(const std::vector<std::string>& names,
                                const std::function<Photograph(int image)>& load,
                                const CameraEstimationOptions& options,
                                const StepProgress& progress, Execution& execution) {
  options.validate();
  const int count = static_cast<int>(names.size());
  if (count < 2 || count > kMaxEstimatedCameras) {
    throw Error(fmt::format("there are {} images, expected 2 to {}", count, kMaxEstimatedCameras));
  }
  const ImageSet images = read_features(names, load, options, progress, execution);
  const LensPositions positions(options.lens, images.width_px, images.height_px);
  const std::vector<MatchedPair> matched =
      match_image_pairs(images.features, positions, options.partners, progress, execution);
  const double focal_px = positions.focal_px().value_or(
      focal_length_of(matched, std::max(images.width_px, images.height_px), execution));
  CameraEstimate estimate;
  estimate.images.resize(names.size());
  std::vector<PairGeometry> pairs = geometries_of(matched, focal_px, estimate.pairs, execution);
  const AveragedRotations averaged = joined_rotations(count, pairs, estimate.pairs);
  if (pairs.empty()) {
    throw Error(
        fmt::format("{}: shares too few points with any other image, expected at least {} "
                    "that agree with one pose of two cameras",
                    names.front(), kMinPairInliers));
  }
  std::vector<int> numbers;  // of the images in the bundle
  std::vector<int> places(names.size(), -1);
  Bundle bundle;
  std::vector<Eigen::Matrix3d> rotations;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (averaged.is_joined[i]) {
      places[i] = static_cast<int>(numbers.size());
      numbers.push_back(static_cast<int>(i));
      rotations.push_back(averaged.rotations[i]);
    } else {
      estimate.images[i].problem = fmt::format(
          "no pair joins it to the other images, expected {} points in common that agree with "
          "one pose",
          kMinPairInliers);
    }
  }
  bundle.lens.focal_px = focal_px;
  bundle.tracks = refined_tracks(pairs, images, positions, places, execution);
  const std::vector<Eigen::Vector3d> centres = camera_positions(rotations, focal_px, bundle.tracks);
  for (std::size_t i = 0; i < centres.size(); ++i) {
    bundle.cameras.push_back({.rotation = rotations[i], .centre = centres[i]});
  }
  adjust(bundle, !options.lens, estimate);
  take_poses(bundle, numbers, names, estimate);
  check_pairs(pairs, estimate);
  if (options.lens) {
    estimate.lens = *options.lens;
  } else {
    estimate.lens.matrix << bundle.lens.focal_px, 0, (images.width_px - 1) / 2.0, 0,
        bundle.lens.focal_px, (images.height_px - 1) / 2.0, 0, 0, 1;
    estimate.lens.distortion = {bundle.lens.k1, 0, 0, 0};
  }
  return estimate;
}

}  // namespace vantage
