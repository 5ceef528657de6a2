#pragma once

#include <Eigen/Core>

#include "engine/rectification/rectifier.h"
#include "engine/reprojection/map_camera.h"
#include "engine/sequence/pairs/frame_poses.h"
#include "engine/sequence/pairs/pair_cameras.h"
#include "engine/sequence/steps/frame_slot.h"

namespace vantage {

/// The cameras of a run; those of a frame are the pair's own if it has a calibration. What it
/// points to must outlive it. Thread rule: may be used concurrently for different slots.
struct FrameCameras {
  const Rectifier* rectifier = nullptr;      ///< null: the pairs are rectified
  PairCameras* of_pairs = nullptr;           ///< null: no pair has a calibration of its own
  const RectifiedPair* rectified = nullptr;  ///< null if no view needs them
  const MapCamera* map_camera = nullptr;     ///< of the reference's map, in metres; null: unknown
  const FramePoses* poses = nullptr;         ///< null: points are in the frame of the left camera

  /// Null: the pair is rectified.
  [[nodiscard]] const Rectifier* rectifier_of(const FrameSlot& slot) const {
    if (slot.cameras == nullptr) {
      return rectifier;
    }
    return slot.cameras->rectifier.needs_rectification() ? &slot.cameras->rectifier : nullptr;
  }
  /// Of the reference's map, in metres; null: not known.
  [[nodiscard]] const MapCamera* map_camera_of(const FrameSlot& slot) const {
    if (slot.cameras == nullptr) {
      return map_camera;
    }
    return slot.cameras->map_camera ? &*slot.cameras->map_camera : nullptr;
  }
  /// Of the points of a frame; needs the camera of its map.
  [[nodiscard]] MapCamera point_camera(const FrameSlot& slot) const {
    if (poses == nullptr) {
      return *map_camera_of(slot);
    }
    const CameraPose& pose = poses->of(slot.pair);
    const RectifiedPair* const pair =
        slot.cameras != nullptr ? &slot.cameras->rectifier.pair() : rectified;
    return in_world(*map_camera_of(slot), pose.rotation.transpose(), pose.centre(),
                    pair != nullptr ? pair->left.rotation : Eigen::Matrix3d::Identity());
  }
};

}  // namespace vantage
