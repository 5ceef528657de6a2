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
constexpr double kMinDepthRatio = 1.3;
constexpr double kLargeResidual_px = 1;

}  // namespace

double BoardCalibration::covered_share(std::size_t camera) const {
  const auto empty = std::ranges::count(corners[camera], 0);
  return 1 - static_cast<double>(empty) / static_cast<double>(corners[camera].size());
}

std::vector<std::string> BoardCalibration::advice() const {
  std::vector<std::string> next;
  if (rms_px > kLargeResidual_px) {
    next.push_back(fmt::format(
        "corners are off by {:.1f} px: is the board flat and its squares square, were both "
        "cameras released at one moment?",
        rms_px));
  }
  // Ninths of a picture, in the order of need: corners of it, sides, middle.
  constexpr std::array<std::string_view, 9> kNames = {"upper left",  "upper right", "lower left",
                                                      "lower right", "left",        "right",
                                                      "top",         "bottom",      "middle"};
  constexpr std::array<std::array<int, 2>, 9> kPlaces = {
      {{0, 0}, {2, 0}, {0, 2}, {2, 2}, {0, 1}, {2, 1}, {1, 0}, {1, 2}, {1, 1}}};
  for (std::size_t side = 0; side < 2; ++side) {
    std::vector<std::string_view> places;
    for (std::size_t k = 0; k < kNames.size(); ++k) {
      const auto [x, y] = kPlaces[k];
      int count = 0;
      for (int row = y * kRows / 3; row < (y + 1) * kRows / 3; ++row) {
        for (int column = x * kColumns / 3; column < (x + 1) * kColumns / 3; ++column) {
          count += corners[side][static_cast<std::size_t>(row * kColumns + column)];
        }
      }
      if (count == 0) {
        places.push_back(kNames[k]);
      }
    }
    if (!places.empty()) {
      next.push_back(fmt::format("no board in the {} of the {} picture", word_list(places, "and"),
                                 side == 0 ? "left" : "right"));
    }
  }
  int tilted = 0;
  double nearest_m = 0;
  double farthest_m = 0;
  for (const BoardPicture& picture : pictures) {
    if (picture.left_out.empty()) {
      tilted += picture.tilt_degrees > kTilted_degrees ? 1 : 0;
      nearest_m = nearest_m == 0 ? picture.distance_m : std::min(nearest_m, picture.distance_m);
      farthest_m = std::max(farthest_m, picture.distance_m);
    }
  }
  if (tilted < kMinTilted) {
    next.push_back(fmt::format("{} tilted more than {:.0f} degrees: focal lengths are uncertain",
                               tilted == 0 ? "none" : "only one", kTilted_degrees));
  }
  if (farthest_m < kMinDepthRatio * nearest_m) {
    next.push_back(fmt::format("all at about {:.2g} m: some should be nearer or farther",
                               (nearest_m + farthest_m) / 2));
  }
  if (pairs < kManyPairs) {
    next.push_back(fmt::format("only {} pairs show the board to both cameras: {} or more are usual",
                               pairs, kManyPairs));
  }
  return next;
}

}  // namespace vantage
