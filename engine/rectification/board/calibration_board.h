#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "engine/image/photograph.h"

namespace vantage {

/// A flat board of squares, of OpenCV's kinds: a chessboard, or with markers in the white squares
/// (ChArUco), which is also read where a part of it is seen.
struct CalibrationBoard {
  int columns = 0;        ///< of inner corners, between four squares; 3..100
  int rows = 0;           ///< likewise
  double square_m = 0;    ///< side of a square, metres
  double marker_m = 0;    ///< ChArUco: side of a marker, metres; 0: a chessboard
  int dictionary = 0;     ///< ChArUco: OpenCV's number of the markers' dictionary
  std::string text = {};  ///< as it was given, for messages and reports

  [[nodiscard]] bool has_markers() const { return marker_m > 0; }
  [[nodiscard]] int corners() const { return columns * rows; }
  /// Corner 0..corners() − 1, row by row, in metres on the board.
  [[nodiscard]] Eigen::Vector2d corner_m(int number) const {
    return {square_m * (number % columns), square_m * (number / columns)};
  }
};

/// What `board` takes, for help and messages.
inline constexpr const char* kBoardHelp =
    "COLUMNSxROWS:SQUARE: inner corners of a chessboard and the side of a square, as 9x6:25mm. "
    "ChArUco, COLUMNSxROWS:SQUARE:MARKER:DICTIONARY: squares, and the side and dictionary of the "
    "markers, as 8x5:40mm:30mm:4x4_50";

/// Reads kBoardHelp; lengths in mm, cm, m or in, dictionaries by OpenCV's names with or without
/// DICT_. Throws UsageError.
CalibrationBoard parse_board(const std::string& text);

/// Corners of a board in a photograph, by growing number.
struct BoardCorners {
  std::vector<int> numbers;
  std::vector<Eigen::Vector2d> positions_px;  ///< pixel centres at integers
};

/// The corners of `board` that `photograph` shows, to some hundredths of a pixel: all of a
/// chessboard, by OpenCV's sector-based detector, or none; those of a ChArUco board between markers
/// that are read, six or more, or none. Photographs with a side above 2000 pixels are reduced to
/// it. Deterministic. Throws Error when OpenCV's library of markers cannot be opened. Thread rule:
/// may be called concurrently.
BoardCorners find_board(const Photograph& photograph, const CalibrationBoard& board);

}  // namespace vantage
