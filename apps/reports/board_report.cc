#include "apps/reports/board_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/process/tell.h"

namespace vantage::apps {
namespace {

void print_picture(const BoardPicture& picture) {
  const auto [left_px, right_px] = picture.rms_px;
  if (!picture.left_out.empty()) {
    tell("rectify: left out: {}: {}\n", picture.name, picture.left_out);
  } else if (left_px > 0 && right_px > 0) {
    tell("rectify: {}: corners off by {:.2f} and {:.2f} px; tilted {:.0f} degrees\n", picture.name,
         left_px, right_px, picture.tilt_degrees);
  } else {
    tell("rectify: {}: only the {} picture shows the board, corners off by {:.2f} px\n",
         picture.name, left_px > 0 ? "left" : "right", left_px + right_px);
  }
}

}  // namespace

void print_board(const BoardCalibration& board) {
  for (const BoardPicture& picture : board.pictures) {
    print_picture(picture);
  }
  tell("rectify: corners lie in {:.0f} % of the left picture and {:.0f} % of the right one:\n",
       100 * board.covered_share(0), 100 * board.covered_share(1));
  for (int row = 0; row < BoardCalibration::kRows; ++row) {
    std::string line;
    for (const BoardCalibration::Cells& cells : board.corners) {
      line += "  ";
      for (int column = 0; column < BoardCalibration::kColumns; ++column) {
        const auto cell = static_cast<std::size_t>(row * BoardCalibration::kColumns + column);
        line += cells[cell] > 0 ? '#' : '.';
      }
    }
    tell("rectify:{}\n", line);
  }
  if (const auto next = board.advice(); !next.empty()) {
    tell("rectify: photograph next: {}\n", fmt::join(next, "; "));
  }
}

SettingValue board_values(const BoardCalibration& board) {
  SettingValue pictures = SettingValue::array();
  for (const BoardPicture& picture : board.pictures) {
    pictures.push_back({{"name", picture.name},
                        {"left_corners", picture.seen[0].numbers.size()},
                        {"right_corners", picture.seen[1].numbers.size()},
                        {"left_rms_px", picture.rms_px[0]},
                        {"right_rms_px", picture.rms_px[1]},
                        {"tilt_degrees", picture.tilt_degrees},
                        {"left_out", picture.left_out}});
  }
  return {{"pairs", board.pairs},
          {"rms_px", board.rms_px},
          {"pictures", pictures},
          {"columns", BoardCalibration::kColumns},
          {"left_corners_of_cells", board.corners[0]},
          {"right_corners_of_cells", board.corners[1]},
          {"left_covered_share", board.covered_share(0)},
          {"right_covered_share", board.covered_share(1)},
          {"next", board.advice()}};
}

}  // namespace vantage::apps
