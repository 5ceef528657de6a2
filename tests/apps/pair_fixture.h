#pragma once

#include "engine/generation/book_pairs.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "tests/apps/vantage_process.h"

namespace vantage {

/// A picture of one grey level.
inline void write_grey(const fs::path& path, int width, int height, std::uint8_t level) {
  Image<std::uint8_t> grey(width, height);
  grey.fill(level);
  write_photograph(path.string(), {std::move(grey)});
}

/// A random-dot square of known disparity as left.png and right.png in a folder of its own.
class PairTest : public testing::Test {
 protected:
  PairTest() {
    pair_ = make_book_pair({.width_px = 71, .height_px = 53});
    write_photograph(left_, pair_.left);
    write_photograph(right_, pair_.right);
  }

  /// `match LEFT RIGHT -o OUT --disparities=0:9 …`
  [[nodiscard]] ProcessResult match(const std::string& out, const Words& more = {}) const {
    return run_vantage(joined({"match", left_, right_, "-o", out, "--disparities=0:9"}, more));
  }

  /// Share of the pixels that are not occluded and are off by more than half a pixel.
  static double bad_share(const DisparityMap& map, const DisparityMap& truth,
                          const Mask& occluded) {
    int bad = 0;
    int all = 0;
    for (int y = 0; y < truth.height(); ++y) {
      for (int x = 0; x < truth.width(); ++x) {
        if (occluded.at(x, y) == 0) {
          ++all;
          bad += std::abs(map.at(x, y) - truth.at(x, y)) <= 0.5F ? 0 : 1;
        }
      }
    }
    return static_cast<double>(bad) / all;
  }

  TemporaryFolder folder_;
  BookPair pair_;
  std::string left_ = folder_ / "left.png";
  std::string right_ = folder_ / "right.png";
};

/// Six random-dot squares of 47x29 pixels as left/frame0.png … and right/frame0.png … in a folder
/// of its own.
class DotFramesTest : public testing::Test {
 protected:
  static constexpr int kFrames = 6;

  DotFramesTest() {
    fs::create_directories(left_);
    fs::create_directories(right_);
    for (int frame = 0; frame < kFrames; ++frame) {
      BookPairOptions options;
      options.width_px = 47;
      options.height_px = 29;
      options.seed = static_cast<std::uint64_t>(frame + 1);
      const BookPair pair = make_book_pair(options);
      write_photograph(left_ + name(frame), pair.left);
      write_photograph(right_ + name(frame), pair.right);
    }
  }
  static std::string name(int frame) { return "/frame" + std::to_string(frame) + ".png"; }

  TemporaryFolder folder_;
  std::string left_ = folder_ / "left";
  std::string right_ = folder_ / "right";
};

}  // namespace vantage
