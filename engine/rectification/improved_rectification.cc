#include "engine/rectification/improved_rectification.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "engine/error.h"
#include "engine/rectification/rectifier.h"

namespace vantage {
namespace {

// Tiles on each side. Held-out points are far enough from the others that a wrong lens or rotation
// shows, and near enough that half of the points still cover the whole photograph.
constexpr int kHeldOutTiles = 4;
constexpr int kCoverageTiles = 8;

class Tiles {
 public:
  Tiles(int count, int width_px, int height_px)
      : count_(count), width_px_(width_px), height_px_(height_px) {}

  [[nodiscard]] int column_of(const PointMatch& match) const {
    return tile(match.left.x(), width_px_);
  }
  [[nodiscard]] int row_of(const PointMatch& match) const {
    return tile(match.left.y(), height_px_);
  }

 private:
  [[nodiscard]] int tile(double position_px, int size_px) const {
    return std::clamp(static_cast<int>((position_px + 0.5) / size_px * count_), 0, count_ - 1);
  }

  int count_;
  int width_px_;
  int height_px_;
};

/// Adds the rectified positions of matches in photographs, where both have one.
void add_rectified(const std::vector<PointMatch>& matches, const Rectifier& rectifier,
                   std::vector<PointMatch>& rectified) {
  for (const PointMatch& match : matches) {
    const auto left = rectifier.rectified_position(Side::kLeft, match.left);
    const auto right = rectifier.rectified_position(Side::kRight, match.right);
    if (left && right) {
      rectified.push_back({*left, *right});
    }
  }
}

std::optional<VerticalError> held_out_error(const std::vector<PointMatch>& matches, int width_px,
                                            int height_px, const RectificationOptions& options) {
  const Tiles tiles(kHeldOutTiles, width_px, height_px);
  std::array<std::vector<PointMatch>, 2> parts;
  for (const PointMatch& match : matches) {
    parts[static_cast<std::size_t>((tiles.column_of(match) + tiles.row_of(match)) % 2)].push_back(
        match);
  }
  std::vector<PointMatch> rectified;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    try {
      const Rectifier rectifier(estimate_rig(parts[1 - part], width_px, height_px).calibration,
                                width_px, height_px, options);
      add_rectified(parts[part], rectifier, rectified);
    } catch (const Error&) {
      return std::nullopt;
    }
  }
  return vertical_error(rectified);
}

double covered_share(const UncalibratedRig& rig, const std::vector<PointMatch>& matches,
                     int width_px, int height_px) {
  const Tiles tiles(kCoverageTiles, width_px, height_px);
  std::array<bool, kCoverageTiles * kCoverageTiles> is_covered{};
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (rig.is_inlier[i]) {
      is_covered[static_cast<std::size_t>(tiles.row_of(matches[i]) * kCoverageTiles +
                                          tiles.column_of(matches[i]))] = true;
    }
  }
  return static_cast<double>(std::count(is_covered.begin(), is_covered.end(), true)) /
         static_cast<double>(is_covered.size());
}

/// With a larger row error an estimate is rejected.
constexpr double kMaxRemaining_px = 2;

}  // namespace

RigValidation validate_rig(const UncalibratedRig& rig, const std::vector<PointMatch>& matches,
                           int width_px, int height_px, const RectificationOptions& options) {
  return {.held_out = held_out_error(matches, width_px, height_px, options),
          .covered_share = covered_share(rig, matches, width_px, height_px)};
}

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
    add_rectified(in_photographs, better, rectified);
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
