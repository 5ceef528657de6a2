#pragma once

#include <filesystem>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>

#include "engine/image/side.h"
#include "engine/rectification/rectifier.h"
#include "engine/reprojection/map_camera.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// Cameras of pairs that a list gives a calibration of their own (PairDetails). Thread rule: of()
/// concurrently.
class PairCameras {
 public:
  /// Lists are often sorted by camera; each takes 16 bytes per pixel.
  static constexpr int kKept = 4;

  struct Cameras {
    Rectifier rectifier;
    std::optional<MapCamera> map_camera;  ///< of the reference's map, in metres, if they are known
  };
  struct Options {
    RectificationOptions rectification;
    Side reference = Side::kLeft;
    std::function<StereoCalibration(const PairDetails&)> read;
    /// Length of a calibration's unit; empty: not known.
    std::function<std::optional<double>(const StereoCalibration&)> metres_per_unit;
  };

  explicit PairCameras(Options options) : options_(std::move(options)) {}

  /// For a pair of images of this size; the last kKept are kept. Throws Error naming the file as
  /// `options.read` and Rectifier do.
  [[nodiscard]] std::shared_ptr<const Cameras> of(const PairDetails& pair, ImageExtent size);

 private:
  struct Kept {
    std::filesystem::path calibration;
    std::optional<KittiCameras> kitti_cameras;
    ImageExtent size;
    std::shared_ptr<const Cameras> cameras;
  };

  Options options_;
  std::mutex mutex_;
  std::list<Kept> latest_;  ///< the last one used first
};

}  // namespace vantage
