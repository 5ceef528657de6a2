#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tests/apps/pair_fixture.h"
#include "tests/apps/vantage_process.h"
#include "tests/temporary_folder.h"

namespace vantage {

/// Names of files, relative to a folder, and their bytes.
using FolderContent = std::map<std::string, std::string>;

/// What a run made, of its folder: everything that is not of its journal. Files without a name yet
/// count, so that comparisons find what has been left behind.
FolderContent results_in(const std::filesystem::path& folder);
/// Files and folders below `folder`, the journal included, that something left without a name.
std::vector<std::string> leftovers_in(const std::filesystem::path& folder);
/// Success when the names and the bytes are the same; tells the first few that are not.
testing::AssertionResult same_files(const FolderContent& actual, const FolderContent& expected);
/// Numbers of the frames that the journal tells of as done or, with `skipped`, as skipped.
std::vector<int> journalled_frames(const std::filesystem::path& folder, bool skipped = false);
/// "000012.png"
std::string frame_file(int frame, const std::string& extension = "png");
/// The report that --report wrote.
nlohmann::json read_report(const std::filesystem::path& path);
/// `some` and then `more`.
std::vector<std::string> joined(std::vector<std::string> some,
                                const std::vector<std::string>& more);

/// Frames of a moving scene as left/000000.png … and right/000000.png … in a folder of its own, and
/// what `vantage run` makes of them.
class RunTest : public testing::Test {
 protected:
  static constexpr int kFrames = 20;
  static constexpr int kWidth = 64;
  static constexpr int kHeight = 48;

  RunTest();

  /// `run --left … --right … -o OUT --disparities=0:9 …`
  [[nodiscard]] std::vector<std::string> arguments(const std::string& out,
                                                   const std::vector<std::string>& more = {}) const;
  [[nodiscard]] ProcessResult run(const std::string& out,
                                  const std::vector<std::string>& more = {}) const;
  /// Results of a run that nothing happens to; made once in a process for the same sources.
  [[nodiscard]] FolderContent undisturbed(const std::vector<std::string>& more) const;
  /// The bytes of a source file.
  [[nodiscard]] std::string frame_bytes(const std::string& side, int frame) const;

  TemporaryFolder folder_;
  std::string left_ = folder_ / "left";
  std::string right_ = folder_ / "right";
};

/// Two videos in segments of five frames, and a map per frame.
inline const std::vector<std::string> kVideoOutputs = {
    "--save",  "disparity,preview,views", "--view",         "0.5",
    "--video", "preview,views",           "--chunk-frames", "5"};
/// A map, its colours and two new views per frame.
inline const std::vector<std::string> kImageOutputs = {
    "--save", "disparity,preview,views", "--view", "0.5", "--view", "1.25", "--chunk-frames", "5"};

}  // namespace vantage
