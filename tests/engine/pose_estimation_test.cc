// Rotation averaging, positions and the adjustment of bundles, on exact geometry.

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "engine/pose_estimation/bundle_adjustment.h"
#include "engine/pose_estimation/camera_positions.h"
#include "engine/pose_estimation/feature_tracks.h"
#include "engine/pose_estimation/rotation_averaging.h"
#include "engine/rectification/rotations.h"
#include "tests/engine/engine_test.h"

namespace vantage::pose_estimation_test {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kFocal = 500;

class Numbers {
 public:
  explicit Numbers(unsigned seed) : engine_(seed) {}
  /// Of [−1, 1], the same on every machine.
  double operator()() { return static_cast<double>(engine_()) / 2147483647.5 - 1; }
  Eigen::Vector3d vector() {
    const double x = (*this)();
    const double y = (*this)();
    return {x, y, (*this)()};
  }

 private:
  std::mt19937 engine_;
};

/// Cameras on an arc about (0, 0, 10), all of which look at it but for some degrees, and points.
Bundle arc(int cameras, int points, BundleLens lens = {.focal_px = kFocal, .k1 = 0}) {
  Numbers numbers(3);
  Bundle bundle{.cameras = {}, .lens = lens, .tracks = {}};
  for (int i = 0; i < cameras; ++i) {
    const double angle = (-20 + 40.0 * i / (cameras - 1)) * kDegree;
    const Eigen::Vector3d centre(10 * std::sin(angle), numbers(), 10 - 10 * std::cos(angle));
    bundle.cameras.push_back(
        {.rotation = rotation_by(3 * kDegree * numbers.vector()) * rotation_by({0, angle, 0}),
         .centre = centre});
  }
  for (int k = 0; k < points; ++k) {
    PointTrack track{.sightings = {}, .point = Eigen::Vector3d(0, 0, 10) + 3 * numbers.vector()};
    for (int i = 0; i < cameras; ++i) {
      // Each point is seen by three cameras in a row.
      if (std::abs(i - k % cameras) <= 1) {
        track.sightings.push_back({i, Eigen::Vector2d::Zero()});
      }
    }
    for (PointSighting& sighting : track.sightings) {
      const BundleCamera& camera = bundle.cameras[static_cast<std::size_t>(sighting.image)];
      const Eigen::Vector3d at = camera.rotation * (track.point - camera.centre);
      const Eigen::Vector2d ray(at.x() / at.z(), at.y() / at.z());
      sighting.position_px = lens.focal_px * (1 + lens.k1 * ray.squaredNorm()) * ray;
    }
    bundle.tracks.push_back(track);
  }
  return bundle;
}

/// The largest distance of a centre from the true one, after the best similarity.
double worst_position(const Bundle& truth, const std::vector<Eigen::Vector3d>& found) {
  const auto count = static_cast<Eigen::Index>(found.size());
  Eigen::Matrix3Xd from(3, count);
  Eigen::Matrix3Xd to(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    from.col(i) = found[static_cast<std::size_t>(i)];
    to.col(i) = truth.cameras[static_cast<std::size_t>(i)].centre;
  }
  const Eigen::Matrix4d similarity = Eigen::umeyama(from, to);
  return (similarity.topRows<3>() * from.colwise().homogeneous() - to).colwise().norm().maxCoeff();
}

std::vector<Eigen::Vector3d> centres_of(const Bundle& bundle) {
  std::vector<Eigen::Vector3d> centres;
  for (const BundleCamera& camera : bundle.cameras) {
    centres.push_back(camera.centre);
  }
  return centres;
}

/// The largest turn of a camera from the true one, both seen from camera 0, in degrees.
double worst_turn(const Bundle& truth, const Bundle& found) {
  double worst = 0;
  for (std::size_t i = 0; i < truth.cameras.size(); ++i) {
    const auto seen = [&](const Bundle& bundle) -> Eigen::Matrix3d {
      return bundle.cameras[i].rotation * bundle.cameras[0].rotation.transpose();
    };
    worst = std::max(worst, rotation_vector(seen(truth) * seen(found).transpose()).norm());
  }
  return worst / kDegree;
}

std::vector<RelativeRotation> pairs_of(const Bundle& bundle, double noise_degrees) {
  Numbers numbers(11);
  std::vector<RelativeRotation> pairs;
  const int count = static_cast<int>(bundle.cameras.size());
  for (int i = 0; i < count; ++i) {
    for (int k = i + 1; k < count && k <= i + 3; ++k) {
      pairs.push_back({.first = i,
                       .second = k,
                       .rotation = rotation_by(noise_degrees * kDegree * numbers.vector()) *
                                   bundle.cameras[static_cast<std::size_t>(k)].rotation *
                                   bundle.cameras[static_cast<std::size_t>(i)].rotation.transpose(),
                       .weight = 100.0 - 10 * (k - i)});
    }
  }
  return pairs;
}

TEST(RotationAveraging, PairsThatContradictTheOthersAreFound) {
  const Bundle truth = arc(8, 0);
  std::vector<RelativeRotation> pairs = pairs_of(truth, 0.2);
  // The heaviest of all, so that the tree takes it.
  pairs[6].rotation = rotation_by({0, 0.5, 0}) * pairs[6].rotation;
  pairs[6].weight = 120;
  const AveragedRotations averaged = average_rotations(9, pairs, 5);
  EXPECT_FALSE(averaged.is_joined[8]);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_TRUE(averaged.is_joined[i]);
    const Eigen::Matrix3d seen = truth.cameras[i].rotation * truth.cameras[0].rotation.transpose();
    EXPECT_LT(rotation_vector(seen * averaged.rotations[i].transpose()).norm(), 0.4 * kDegree);
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i == 6) {
      EXPECT_NEAR(averaged.off_degrees[i], 0.5 / kDegree, 1);
    } else {
      EXPECT_LT(averaged.off_degrees[i], 1);
    }
  }
}

TEST(RotationAveraging, TheLargestGroupIsJoined) {
  const Bundle truth = arc(8, 0);
  std::vector<RelativeRotation> pairs = pairs_of(truth, 0);
  // 0 and 1 on one side, 2 to 7 on the other.
  std::erase_if(pairs,
                [](const RelativeRotation& pair) { return (pair.first < 2) != (pair.second < 2); });
  const AveragedRotations averaged = average_rotations(8, pairs, 5);
  EXPECT_EQ(averaged.is_joined,
            (std::vector<bool>{false, false, true, true, true, true, true, true}));
  EXPECT_EQ(averaged.off_degrees[0], 180);
  EXPECT_LT(averaged.off_degrees[1], 1e-6);
}

TEST(CameraPositions, FollowFromPointsOfThreeImages) {
  const Bundle truth = arc(7, 210);
  std::vector<Eigen::Matrix3d> rotations;
  for (const BundleCamera& camera : truth.cameras) {
    rotations.push_back(camera.rotation);
  }
  std::vector<PointTrack> tracks = truth.tracks;
  EXPECT_LT(worst_position(truth, camera_positions(rotations, kFocal, tracks)), 1e-6);
  // A tenth of the points has one wrong sighting.
  tracks = truth.tracks;
  for (std::size_t i = 0; i < tracks.size(); i += 10) {
    tracks[i].sightings.front().position_px += Eigen::Vector2d(15, 40);
  }
  EXPECT_LT(worst_position(truth, camera_positions(rotations, kFocal, tracks)), 0.2);
  // Turned about one point, cameras see no parallax.
  for (PointTrack& track : tracks) {
    for (PointSighting& sighting : track.sightings) {
      const Eigen::Vector3d at = rotations[static_cast<std::size_t>(sighting.image)] * track.point;
      sighting.position_px = kFocal * at.head<2>() / at.z();
    }
  }
  EXPECT_THROW((void)camera_positions(rotations, kFocal, tracks), Error);
}

TEST(BundleAdjustment, FindsCamerasPointsAndTheLensAgain) {
  const Bundle truth = arc(6, 300, {.focal_px = kFocal, .k1 = -0.12});
  Numbers numbers(29);
  Bundle bundle = truth;
  for (BundleCamera& camera : bundle.cameras) {
    camera.rotation = rotation_by(kDegree * numbers.vector()) * camera.rotation;
    camera.centre += 0.2 * numbers.vector();
  }
  for (std::size_t i = 0; i < bundle.tracks.size(); ++i) {
    PointTrack& track = bundle.tracks[i];
    track.point += 0.3 * numbers.vector();
    if (i % 20 == 0) {
      track.sightings.back().position_px += Eigen::Vector2d(30, -20);  // an outlier
    }
  }
  bundle.lens = {.focal_px = 560, .k1 = 0};
  const double before = rms_of(bundle.errors_px());
  adjust_bundle(bundle, 20, true);
  adjust_bundle(bundle, 1, true);
  EXPECT_GT(before, 20);
  EXPECT_NEAR(bundle.lens.focal_px, kFocal, 3);
  EXPECT_NEAR(bundle.lens.k1, -0.12, 0.01);
  EXPECT_LT(worst_turn(truth, bundle), 0.1);
  EXPECT_LT(worst_position(truth, centres_of(bundle)), 0.01);
  // The same start with the lens held.
  Bundle held = truth;
  held.cameras[2].centre += Eigen::Vector3d(0.1, 0, 0.1);
  adjust_bundle(held, 1, false);
  EXPECT_EQ(held.lens.focal_px, kFocal);
  EXPECT_LT(rms_of(held.errors_px()), 1e-4);
}

TEST(FeatureTracks, JoinWhatPairsShareUnlessAnImageWouldShowItTwice) {
  const auto pair = [](int first, int second, std::vector<std::array<int, 2>> inliers) {
    PairGeometry made;
    made.first = first;
    made.second = second;
    made.inliers = std::move(inliers);
    return made;
  };
  const std::vector<PairGeometry> pairs = {pair(0, 1, {{5, 7}, {6, 8}, {1, 1}}),
                                           pair(1, 2, {{7, 3}, {8, 4}}),
                                           pair(0, 2, {{5, 3}, {9, 4}})};
  const auto tracks = feature_tracks(pairs);
  ASSERT_EQ(tracks.size(), 2U);  // 6, 8, 4 and 9 are of one point, twice in image 0
  EXPECT_EQ(tracks[0], (std::vector<FeatureOfImage>{{0, 1}, {1, 1}}));
  EXPECT_EQ(tracks[1], (std::vector<FeatureOfImage>{{0, 5}, {1, 7}, {2, 3}}));
}

}  // namespace vantage::pose_estimation_test
