#include "engine/rectification/board/calibration_board.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <string_view>

#include "engine/error.h"
#include "engine/image/intensity_rows.h"
#include "engine/io/images/opencv_setup.h"
#include "engine/late_library.h"
#include "engine/quoted_text.h"

namespace vantage {
namespace {

constexpr int kMaxSide_px = 2000;
constexpr int kMinAlongSide = 3;
constexpr int kMaxAlongSide = 100;
/// Fewer corners of a part of a board hardly tell how it lies.
constexpr std::size_t kMinCorners = 6;

/// By OpenCV's numbers (cv::aruco::PREDEFINED_DICTIONARY_NAME).
constexpr std::array<std::string_view, 21> kDictionaries = {
    "4X4_50",        "4X4_100",        "4X4_250",       "4X4_1000",      "5X5_50",
    "5X5_100",       "5X5_250",        "5X5_1000",      "6X6_50",        "6X6_100",
    "6X6_250",       "6X6_1000",       "7X7_50",        "7X7_100",       "7X7_250",
    "7X7_1000",      "ARUCO_ORIGINAL", "APRILTAG_16H5", "APRILTAG_25H9", "APRILTAG_36H10",
    "APRILTAG_36H11"};

[[noreturn]] void reject(const std::string& text, std::string_view reason) {
  throw UsageError(
      fmt::format("board is '{}': {}, expected {}", quotable(text), reason, kBoardHelp));
}

/// "25mm" in metres; 0: none.
double length_m(std::string_view text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string_view unit = text.substr(static_cast<std::size_t>(end - text.data()));
  const double metres = unit == "mm"   ? 1e-3
                        : unit == "cm" ? 1e-2
                        : unit == "m"  ? 1
                        : unit == "in" ? 0.0254
                                       : 0;
  return error == std::errc{} && number * metres >= 1e-5 && number * metres <= 100 ? number * metres
                                                                                   : 0;
}

int dictionary_of(std::string name) {
  std::ranges::transform(name, name.begin(),
                         [](unsigned char letter) { return std::toupper(letter); });
  const std::string_view known = std::string_view(name).substr(name.starts_with("DICT_") ? 5 : 0);
  return static_cast<int>(std::ranges::find(kDictionaries, known) - kDictionaries.begin());
}

/// Of the release of OpenCV that this is built with: "libopencv_aruco.so.406".
std::string marker_library() {
  std::string name = VANTAGE_TRACKING_LIBRARY;
  return name.replace(name.find("video"), 5, "aruco");
}

/// OpenCV's functions for markers. Their library is opened by the first call: chessboards, and
/// everything else, do without it. The names are the Itanium C++ ABI names of these declarations.
struct MarkerFunctions {
  const LateLibrary library{marker_library(),
                            "cannot read the markers of a board (Debian: libopencv-contrib406)"};
  decltype(&cv::aruco::CharucoBoard::create) board =
      library.function<decltype(&cv::aruco::CharucoBoard::create)>(
          "_ZN2cv5aruco12CharucoBoard6createEiiffRKNS_3PtrINS0_10DictionaryEEE");
  cv::Ptr<cv::aruco::Dictionary> (*dictionary)(int) =
      library.function<cv::Ptr<cv::aruco::Dictionary> (*)(int)>(
          "_ZN2cv5aruco23getPredefinedDictionaryEi");
  decltype(&cv::aruco::DetectorParameters::create) parameters =
      library.function<decltype(&cv::aruco::DetectorParameters::create)>(
          "_ZN2cv5aruco18DetectorParameters6createEv");
  decltype(&cv::aruco::detectMarkers) detect =
      library.function<decltype(&cv::aruco::detectMarkers)>(
          "_ZN2cv5aruco13detectMarkersERKNS_11_InputArrayERKNS_3PtrINS0_10DictionaryEEERKNS_12_"
          "OutputArrayESB_RKNS4_INS0_18DetectorParametersEEESB_");
  decltype(&cv::aruco::interpolateCornersCharuco) corners =
      library.function<decltype(&cv::aruco::interpolateCornersCharuco)>(
          "_ZN2cv5aruco25interpolateCornersCharucoERKNS_11_InputArrayES3_S3_RKNS_"
          "3PtrINS0_12CharucoBoardEEERKNS_12_OutputArrayESB_S3_S3_i");
};

struct FoundCorners {
  std::vector<int> numbers;
  std::vector<cv::Point2f> positions;
};

FoundCorners find_charuco(const cv::Mat& grey, const CalibrationBoard& board) {
  static const MarkerFunctions markers;
  const cv::Ptr<cv::aruco::Dictionary> dictionary = markers.dictionary(board.dictionary);
  const int squares = (board.columns + 1) * (board.rows + 1);
  if (dictionary->bytesList.rows < squares / 2) {
    throw UsageError(
        fmt::format("board is '{}', whose dictionary has {} markers, expected {} or "
                    "more: one for every second square",
                    board.text, dictionary->bytesList.rows, squares / 2));
  }
  const cv::Ptr<cv::aruco::CharucoBoard> charuco =
      markers.board(board.columns + 1, board.rows + 1, static_cast<float>(board.square_m),
                    static_cast<float>(board.marker_m), dictionary);
  std::vector<std::vector<cv::Point2f>> outlines;
  std::vector<int> read;
  markers.detect(grey, dictionary, outlines, read, markers.parameters(), cv::noArray());
  FoundCorners found;
  if (!read.empty()) {
    markers.corners(outlines, read, grey, charuco, found.positions, found.numbers, cv::noArray(),
                    cv::noArray(), 2);
  }
  return found;
}

FoundCorners find_chessboard(const cv::Mat& grey, const CalibrationBoard& board) {
  FoundCorners found;
  if (cv::findChessboardCornersSB(
          grey, {board.columns, board.rows}, found.positions,
          cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_ACCURACY)) {
    for (int number = 0; number < board.corners(); ++number) {
      found.numbers.push_back(number);
    }
  }
  return found;
}

/// 8-bit grey.
cv::Mat grey_levels(const Photograph& photograph) {
  cv::Mat levels(photograph.height(), photograph.width(), CV_8U);
  std::vector<float> grey(static_cast<std::size_t>(photograph.width()));
  for (int y = 0; y < levels.rows; ++y) {
    intensity_row(photograph, y, grey.data());
    std::ranges::transform(grey, levels.ptr<std::uint8_t>(y),
                           [](float level) { return cv::saturate_cast<std::uint8_t>(level); });
  }
  return levels;
}

}  // namespace

CalibrationBoard parse_board(const std::string& text) {
  std::vector<std::string> fields = {""};
  for (const char c : text) {
    if (c == ':') {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  if (fields.size() != 2 && fields.size() != 4) {
    reject(text, "it has not two or four fields");
  }
  CalibrationBoard board;
  board.text = text;
  const std::string& counts = fields[0];
  const char* end = counts.data() + counts.size();
  const auto columns = std::from_chars(counts.data(), end, board.columns);
  const bool has_rows = columns.ec == std::errc{} && columns.ptr != end && *columns.ptr == 'x';
  const auto rows = std::from_chars(columns.ptr + (has_rows ? 1 : 0), end, board.rows);
  if (!has_rows || rows.ec != std::errc{} || rows.ptr != end) {
    reject(text, fmt::format("'{}' is not COLUMNSxROWS", quotable(counts)));
  }
  board.square_m = length_m(fields[1]);
  if (fields.size() == 4) {
    --board.columns;  // corners lie between the squares
    --board.rows;
    board.marker_m = length_m(fields[2]);
    board.dictionary = dictionary_of(fields[3]);
    if (board.dictionary == static_cast<int>(kDictionaries.size())) {
      reject(text, fmt::format("'{}' is no dictionary of OpenCV", quotable(fields[3])));
    }
    if (!(board.marker_m > 0 && board.marker_m < board.square_m)) {
      reject(text, "the side of a marker is not a length below that of a square, with its unit");
    }
  }
  if (!(board.square_m > 0)) {
    reject(text, fmt::format("'{}' is not a length with its unit (mm, cm, m or in)",
                             quotable(fields[1])));
  }
  if (std::min(board.columns, board.rows) < kMinAlongSide ||
      std::max(board.columns, board.rows) > kMaxAlongSide) {
    reject(text, fmt::format("it has {}x{} inner corners, not {} to {} along each side",
                             board.columns, board.rows, kMinAlongSide, kMaxAlongSide));
  }
  return board;
}

BoardCorners find_board(const Photograph& photograph, const CalibrationBoard& board) {
  prepare_opencv();
  cv::Mat grey = grey_levels(photograph);
  const double scale =
      std::max(1.0, static_cast<double>(std::max(grey.cols, grey.rows)) / kMaxSide_px);
  if (scale > 1) {
    cv::Mat reduced;
    cv::resize(grey, reduced,
               {static_cast<int>(std::lround(grey.cols / scale)),
                static_cast<int>(std::lround(grey.rows / scale))},
               0, 0, cv::INTER_AREA);
    grey = reduced;
  }
  const FoundCorners found =
      board.has_markers() ? find_charuco(grey, board) : find_chessboard(grey, board);
  if (found.numbers.size() < kMinCorners) {
    return {};
  }
  const Eigen::Vector2d pixel(static_cast<double>(photograph.width()) / grey.cols,
                              static_cast<double>(photograph.height()) / grey.rows);
  BoardCorners corners{.numbers = found.numbers, .positions_px = {}};
  for (const cv::Point2f& at : found.positions) {
    corners.positions_px.emplace_back((at.x + 0.5) * pixel.x() - 0.5,
                                      (at.y + 0.5) * pixel.y() - 0.5);
  }
  return corners;
}

}  // namespace vantage
