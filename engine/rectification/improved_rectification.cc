#include "engine/rectification/improved_rectification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/error.h"

namespace vantage {
namespace {

/// With a larger row error an estimate is rejected.
constexpr double kMaxRemaining_px = 2;

}  // namespace

void improve_rectification(Rectification& rectification, Rectifier& rectifier,
                           const std::vector<PointMatch>& found,
                           const RectificationOptions& options) {
  constexpr double kNearRowsPerSide = 10.0 / 640;
  const RectifiedPair& pair = rectifier.pair();
  const double near_px = kNearRowsPerSide * std::max(pair.width_px, pair.height_px);
  std::vector<PointMatch> in_photographs;
  std::vector<PointMatch> near;
  for (const PointMatch& match : found) {
    const auto left = rectifier.source_position(Side::kLeft, match.left);
    const auto right = rectifier.source_position(Side::kRight, match.right);
    if (left && right) {
      in_photographs.push_back({*left, *right});
      if (std::abs(match.left.y() - match.right.y()) <= near_px) {
        near.push_back(in_photographs.back());
      }
    }
  }
  try {
    UncalibratedRig rig = estimate_rig(near, pair.width_px, pair.height_px);
    if (rectification.calibration.has_scale) {
      rig.calibration.set_baseline_m(rectification.calibration.baseline());
    }
    Rectifier better(rig.calibration, pair.width_px, pair.height_px, options);
    std::vector<PointMatch> rectified;
    for (const PointMatch& match : in_photographs) {
      const auto left = better.rectified_position(Side::kLeft, match.left);
      const auto right = better.rectified_position(Side::kRight, match.right);
      if (left && right) {
        rectified.push_back({*left, *right});
      }
    }
    const auto remaining = vertical_error(rectified);
    if (remaining &&
        (!rectification.remaining || remaining->rms_px < rectification.remaining->rms_px)) {
      rectification.matches = std::move(near);
      rectification.calibration = rig.calibration;
      rectification.estimate = std::move(rig);
      rectification.remaining = remaining;
      rectifier = std::move(better);
    }
  } catch (const Error&) {
    // The first estimate stays; the caller checks whether it is good enough.
  }
}

void require_success(const Rectification& rectification, std::size_t matches,
                     const std::string& inputs) {
  if (!rectification.remaining) {
    throw Error(
        fmt::format("{}: the rectified images have {} points in common, expected at least {}",
                    inputs, matches, kMinMatches));
  }
  if (rectification.remaining->rms_px > kMaxRemaining_px) {
    throw Error(
        fmt::format("{}: the remaining row error is {:.1f} px RMS, expected at most {}: the images "
                    "show too little to estimate the cameras, use `calibration`",
                    inputs, rectification.remaining->rms_px, kMaxRemaining_px));
  }
}

}  // namespace vantage
