#include "engine/sequence/sequence_runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>

#include "engine/error.h"
#include "engine/generation/book_pairs.h"
#include "engine/io/disparity_io.h"
#include "engine/io/photograph_io.h"
#include "engine/sequence/busy_clock.h"
#include "tests/temporary_folder.h"

namespace vantage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Frames made up on the spot; the left or right half of a random-dot pair per frame.
class MadeUpSource : public FrameSource {
 public:
  MadeUpSource(Reference side, int frames, bool knows_count = true)
      : side_(side), frames_(frames), knows_count_(knows_count) {}

  bool next(Photograph& frame) override {
    if (next_ == frames_) {
      return false;
    }
    const int index = next_++;
    if (index == bad_frame) {
      throw Error(describe(index) + ": damaged");
    }
    BookPairOptions options;
    options.width_px = index == narrow_frame ? 7 : 37;
    options.height_px = 23;
    options.seed = static_cast<std::uint64_t>(index);
    BookPair pair = make_book_pair(options);
    frame = std::move(side_ == Reference::kLeft ? pair.left : pair.right);
    return true;
  }
  [[nodiscard]] std::optional<int> frame_count() const override {
    return knows_count_ ? std::optional(frames_) : std::nullopt;
  }
  [[nodiscard]] std::string describe(int index) const override {
    return (side_ == Reference::kLeft ? "left " : "right ") + std::to_string(index);
  }
  [[nodiscard]] std::optional<double> frames_per_second() const override { return {}; }

  int bad_frame = -1;
  int narrow_frame = -1;

 private:
  Reference side_;
  int frames_;
  bool knows_count_;
  int next_ = 0;
};

class SequenceTest : public testing::Test {
 protected:
  SequenceTest() {
    options_.match.disparities = {0, 9};
    options_.match.parameters.window_px = 5;
  }
  [[nodiscard]] std::vector<std::string> written() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
      if (entry.is_regular_file()) {
        names.push_back(entry.path().lexically_relative(folder_).string());
      }
    }
    std::ranges::sort(names);
    return names;
  }

  /// What run() throws as Error; empty if it does not.
  std::string error_of(FrameSource& left, FrameSource& right) {
    Execution execution({.threads = 3});
    try {
      SequenceRunner(options_, execution).run(left, right, folder_);
    } catch (const UsageError&) {
      throw;
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder temporary_;
  const std::filesystem::path& folder_ = temporary_.path();
  SequenceOptions options_;
};

TEST_F(SequenceTest, WritesWhatTheMatcherComputes) {
  options_.save = {SequenceOutput::kDisparity, SequenceOutput::kUnmatched};
  options_.match.reference = Reference::kRight;
  options_.in_flight = 3;
  Execution execution({.threads = 3});
  MadeUpSource left(Reference::kLeft, 4);
  MadeUpSource right(Reference::kRight, 4);
  std::vector<int> done;
  const SequenceReport report = SequenceRunner(options_, execution)
                                    .run(left, right, folder_, [&](const SequenceProgress& now) {
                                      done.push_back(now.frames_done);
                                      EXPECT_EQ(now.frames_total, 4);
                                    });
  EXPECT_THAT(done, ElementsAre(1, 2, 3, 4));
  EXPECT_EQ(report.frames, 4);
  EXPECT_FALSE(report.interrupted);
  EXPECT_EQ(report.cells, 4.0 * 37 * 23 * 10 * 2);
  EXPECT_GT(report.compute_seconds, 0);
  EXPECT_EQ(report.stages.front().name, "read");
  EXPECT_EQ(report.stages.back().name, "write");

  MadeUpSource left_again(Reference::kLeft, 4);
  MadeUpSource right_again(Reference::kRight, 4);
  Execution serial({.executor = scheduler::ExecutorKind::kSerial});
  const StereoMatcher matcher(options_.match, serial);
  Photograph left_frame;
  Photograph right_frame;
  DisparityMaps maps;
  for (int frame = 0; frame < 4; ++frame) {
    ASSERT_TRUE(left_again.next(left_frame) && right_again.next(right_frame));
    matcher.match(left_frame, right_frame, {}, maps);
    const std::string name = "00000" + std::to_string(frame);
    const DisparityMap map = read_disparity(folder_ / "disparity" / (name + ".pfm"));
    const Photograph mask = read_photograph(folder_ / "unmatched" / (name + ".png"));
    for (int y = 0; y < map.height(); ++y) {
      for (int x = 0; x < map.width(); ++x) {
        ASSERT_EQ(map.at(x, y), maps.right.at(x, y));
        ASSERT_EQ(std::get<Image<std::uint8_t>>(mask.pixels).at(x, y),
                  maps.right_unmatched.at(x, y));
      }
    }
  }
}

TEST_F(SequenceTest, ViewsGoToOneFolderEach) {
  options_.save = {SequenceOutput::kViews};
  options_.views_x = {0.25, -1};
  const SequenceLayout several(folder_, options_);
  EXPECT_EQ(several.file(SequenceOutput::kViews, 12, "png", 1), folder_ / "views/-1/000012.png");
  EXPECT_EQ(several.folders().size(), 2U);
  Execution execution({});
  MadeUpSource left(Reference::kLeft, 1);
  MadeUpSource right(Reference::kRight, 1);
  SequenceRunner(options_, execution).run(left, right, folder_);
  EXPECT_THAT(written(), ElementsAre("views/-1/000000.png", "views/0.25/000000.png"));
  options_.views_x = {0.25};
  EXPECT_EQ(SequenceLayout(folder_, options_).file(SequenceOutput::kViews, 0, "png"),
            folder_ / "views/000000.png");
}

TEST_F(SequenceTest, TheFirstBadFrameEndsTheRun) {
  MadeUpSource left(Reference::kLeft, 6);
  MadeUpSource right(Reference::kRight, 6);
  right.bad_frame = 4;
  left.narrow_frame = 2;
  const std::string error = error_of(left, right);
  EXPECT_THAT(error, HasSubstr("frame 2 (left 2, right 2): "));
  EXPECT_THAT(error, HasSubstr("7x23"));
  EXPECT_THAT(written(), ElementsAre("disparity/000000.pfm", "disparity/000001.pfm"));
}

TEST_F(SequenceTest, UnreadableFramesAreNamed) {
  MadeUpSource left(Reference::kLeft, 6);
  MadeUpSource right(Reference::kRight, 6);
  right.bad_frame = 1;
  EXPECT_EQ(error_of(left, right), "frame 1: right 1: damaged");
  EXPECT_THAT(written(), ElementsAre("disparity/000000.pfm"));
}

TEST_F(SequenceTest, UnequalLengths) {
  MadeUpSource left(Reference::kLeft, 2);
  MadeUpSource right(Reference::kRight, 5);
  EXPECT_EQ(error_of(left, right),
            "frame 2: the left sequence has ended after 2 frames but the right one has 5, expected "
            "equal lengths");
  EXPECT_EQ(written().size(), 2U);
  MadeUpSource left_video(Reference::kLeft, 3, false);
  MadeUpSource right_video(Reference::kRight, 1, false);
  EXPECT_THAT(error_of(left_video, right_video), HasSubstr("the left one has at least 2"));
  MadeUpSource nothing(Reference::kLeft, 0);
  MadeUpSource nothing_either(Reference::kRight, 0);
  EXPECT_THAT(error_of(nothing, nothing_either), HasSubstr("no frames"));
}

TEST_F(SequenceTest, StopFinishesWhatIsUnderWay) {
  Execution execution({.threads = 2});
  MadeUpSource left(Reference::kLeft, 1000);
  MadeUpSource right(Reference::kRight, 1000);
  std::atomic<bool> stop{false};
  const SequenceReport report =
      SequenceRunner(options_, execution)
          .run(
              left, right, folder_, [&](const SequenceProgress&) { stop.store(true); }, &stop);
  EXPECT_TRUE(report.interrupted);
  EXPECT_GE(report.frames, 1);
  EXPECT_LE(report.frames, 1 + 2 * report.in_flight);
  EXPECT_EQ(written().size(), static_cast<std::size_t>(report.frames));
}

TEST_F(SequenceTest, OptionsAreChecked) {
  Execution execution({});
  const auto is_refused = [&](const SequenceOptions& options) {
    try {
      SequenceRunner(options, execution);
    } catch (const UsageError&) {
      return true;
    }
    return false;
  };
  EXPECT_FALSE(is_refused(options_));
  auto wrong = options_;
  wrong.save = {};
  EXPECT_TRUE(is_refused(wrong));
  wrong = options_;
  wrong.views_x = {0.5};
  EXPECT_TRUE(is_refused(wrong));
  wrong = options_;
  wrong.in_flight = 65;
  EXPECT_TRUE(is_refused(wrong));
  wrong = options_;
  wrong.disparity_format = "bmp";
  EXPECT_TRUE(is_refused(wrong));
  wrong = options_;
  wrong.match.parameters.window_px = 4;
  EXPECT_TRUE(is_refused(wrong));
}

TEST(BusyClock, CountsOverlappingActivitiesOnce) {
  BusyClock clock;
  const auto start = std::chrono::steady_clock::now();
  {
    const BusyClock::Activity outer(clock);
    const BusyClock::Activity inner(clock);
  }
  const double elapsed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_GT(clock.seconds(), 0);
  EXPECT_LE(clock.seconds(), elapsed);
}

}  // namespace
}  // namespace vantage
