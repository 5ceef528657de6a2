#pragma once

#include <optional>

#include "tests/apps/pair_fixture.h"

namespace vantage {

/// Names of files, relative to a folder, and their bytes.
using FolderContent = std::map<std::string, std::string>;

/// What a run made, of its folder: everything that is not of its journal. Files without a name yet
/// count, so that comparisons find what has been left behind.
FolderContent results_in(const fs::path& folder);
/// Files and folders below `folder`, the journal included, that something left without a name.
Words leftovers_in(const fs::path& folder);
/// Success when the names and the bytes are the same; tells the first few that are not.
testing::AssertionResult same_files(const FolderContent& actual, const FolderContent& expected);
/// Numbers of the frames that the journal tells of as done or, with `skipped`, as skipped.
std::vector<int> journalled_frames(const fs::path& folder, bool skipped = false);
/// "000012.png"
std::string frame_file(int frame, const std::string& extension = "png");

/// Frames of a moving scene as left/000000.png … and right/000000.png … in a folder of its own, and
/// what `vantage run` makes of them.
class RunTest : public testing::Test {
 protected:
  static constexpr int kFrames = 20;
  static constexpr int kWidth = 64;
  static constexpr int kHeight = 48;

  RunTest();

  /// `run --left … --right … -o OUT --disparities=0:9 …`
  [[nodiscard]] Words arguments(const std::string& out, const Words& more = {}) const;
  [[nodiscard]] ProcessResult run(const std::string& out, const Words& more = {}) const;
  /// Results of a run that nothing happens to; made once in a process for the same sources.
  [[nodiscard]] FolderContent undisturbed(const Words& more) const;
  /// The bytes of a source file.
  [[nodiscard]] std::string frame_bytes(const std::string& side, int frame) const;

  TemporaryFolder folder_;
  std::string left_ = folder_ / "left";
  std::string right_ = folder_ / "right";
};

/// Cameras of the size of the frames, turned and distorting, as OpenCV stores them.
inline constexpr const char* kTurnedRig = R"(%YAML:1.0
M1: [60, 0, 31, 0, 60, 24, 0, 0, 1]
D1: [-0.2, 0.05, 0.001, -0.002]
M2: [61, 0, 32, 0, 61, 23, 0, 0, 1]
D2: [0.1, -0.02, 0.001, 0.001]
R: [1, 0, 0, 0, 0.99920011, -0.03998933, 0, 0.03998933, 0.99920011]
T: [-1, 0.02, 0.01]
)";

/// Two videos in segments of five frames, and a map per frame.
inline const Words kVideoOutputs =
    words("--save disparity,preview,views --view 0.5 --video preview,views --chunk-frames 5");
/// A map, its colours and two new views per frame.
inline const Words kImageOutputs =
    words("--save disparity,preview,views --view 0.5 --view 1.25 --chunk-frames 5");

}  // namespace vantage
