#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/rectification/board/calibration_board.h"
#include "engine/rectification/feature_matches.h"
#include "engine/rectification/rectified_pair.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {

/// Pictures of a board, taken by both cameras at one moment. Arrays are of left and right.
struct BoardPicture {
  std::string name = {};                  ///< for messages
  std::array<BoardCorners, 2> seen = {};  ///< may be empty
  /// Distance of the corners from where the cameras see them, RMS in pixels; 0: none are seen.
  std::array<double, 2> rms_px = {};
  double tilt_degrees = 0;    ///< of the board's normal from the viewing direction
  std::string left_out = {};  ///< why no camera is fitted to it; empty: one is
};

/// Cameras that pictures of a board show.
struct BoardCalibration {
  /// The cells of a picture, row by row.
  static constexpr int kColumns = 8;
  static constexpr int kRows = 6;
  using Cells = std::array<int, static_cast<std::size_t>(kColumns* kRows)>;

  StereoCalibration calibration = {};       ///< in metres
  std::vector<BoardPicture> pictures = {};  ///< all, in the order given
  int pairs = 0;                            ///< that the pose of the cameras is fitted to
  double rms_px = 0;                        ///< of the corners of these, in both images
  std::vector<PointMatch> matches = {};     ///< corners that both cameras see
  std::array<Cells, 2> corners = {};        ///< in every cell, of all pictures

  /// Share of the cells of the left (0) or right picture with corners.
  [[nodiscard]] double covered_share(std::size_t camera) const;
  /// What to photograph next, a sentence each, the most useful first: parts of the pictures that no
  /// board was in, tilts and numbers that are missing. Empty: nothing.
  [[nodiscard]] std::vector<std::string> advice() const;
};

/// Fits each camera to all of its pictures (Zhang's method by OpenCV: K, k1 k2 p1 p2, and k3 where
/// it pays), then their pose to the pictures that both see. A picture whose residual is above a
/// pixel and three times the median is left out: the board moved, or was mistaken. Throws Error
/// where fewer than three pictures show the board to both cameras. Deterministic. Thread rule: may
/// be called concurrently.
BoardCalibration calibrate_with_board(const CalibrationBoard& board,
                                      std::vector<BoardPicture> pictures, ImageSize size);

/// `matches` of the photographs at their places in the rectified images.
std::vector<PointMatch> rectified_matches(const std::vector<PointMatch>& matches,
                                          const StereoCalibration& calibration,
                                          const RectifiedPair& pair);

}  // namespace vantage
