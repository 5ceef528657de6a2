#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "engine/rectification/board/board_calibration.h"
#include "engine/word_list.h"

namespace vantage {
namespace {

constexpr int kManyPairs = 10;
/// Boards that face the camera leave its focal length open.
constexpr double kTilted_degrees = 15;
constexpr int kMinTilted = 2;
constexpr std::array<std::string_view, 9> kNinths = {"upper left", "top",    "upper right",
                                                     "left",       "middle", "right",
                                                     "lower left", "bottom", "lower right"};

}  // namespace

double BoardCalibration::covered_share(std::size_t camera) const {
  const auto empty = std::ranges::count(corners[camera], 0);
  return 1 - static_cast<double>(empty) / static_cast<double>(corners[camera].size());
}

std::vector<std::string> BoardCalibration::advice() const {
  std::vector<std::string> next;
  for (std::size_t side = 0; side < 2; ++side) {
    std::array<int, 9> ninths{};
    for (std::size_t cell = 0; cell < corners[side].size(); ++cell) {
      const std::size_t row = cell / kColumns * 3 / kRows;
      ninths[3 * row + cell % kColumns * 3 / kColumns] += corners[side][cell];
    }
    std::vector<std::string_view> places;
    for (std::size_t ninth = 0; ninth < ninths.size(); ++ninth) {
      if (ninths[ninth] == 0) {
        places.push_back(kNinths[ninth]);
      }
    }
    if (!places.empty()) {
      next.push_back(fmt::format("no board in the {} of the {} picture", word_list(places, "and"),
                                 side == 0 ? "left" : "right"));
    }
  }
  const auto tilted = std::ranges::count_if(pictures, [](const BoardPicture& picture) {
    return picture.left_out.empty() && picture.tilt_degrees > kTilted_degrees;
  });
  if (tilted < kMinTilted) {
    next.push_back(fmt::format("{} tilted more than {:.0f} degrees: focal lengths are uncertain",
                               tilted == 0 ? "none" : "only one", kTilted_degrees));
  }
  if (pairs < kManyPairs) {
    next.push_back(fmt::format("only {} pairs show the board to both cameras: {} or more are usual",
                               pairs, kManyPairs));
  }
  return next;
}

}  // namespace vantage
