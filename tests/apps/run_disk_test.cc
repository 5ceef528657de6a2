// Runs whose results cannot be written.

#include <sys/mount.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/apps/run_fixture.h"

namespace vantage::run_disk_test {

/// A file system of its own in a folder.
class SmallDisk {
 public:
  explicit SmallDisk(const std::string& path) : path_(path) {
    fs::create_directory(path);
    is_mounted_ = ::mount("none", path_.c_str(), "tmpfs", 0, "size=1m") == 0;
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  ~SmallDisk() {
    if (is_mounted_) {
      ::umount2(path_.c_str(), MNT_DETACH);
    }
  }
  [[nodiscard]] bool is_mounted() const { return is_mounted_; }
  void resize(std::uintmax_t bytes) const { remount(0, "size=" + std::to_string(bytes)); }
  void make_read_only() const { remount(MS_RDONLY, ""); }
  void make_writable() const { remount(0, ""); }

 private:
  void remount(unsigned long flags, const std::string& options) const {
    ASSERT_EQ(::mount("none", path_.c_str(), "tmpfs", MS_REMOUNT | flags, options.c_str()), 0);
  }

  std::string path_;
  bool is_mounted_ = false;
};

class RunDisk : public RunTest {
 protected:
  /// Fails, tells why in one line, and has kept what was finished.
  void expect_full(const ProcessResult& result, const std::string& out,
                   const FolderContent& expected) const {
    expect_one_line(result, 1, "run", "o space left on device");
    EXPECT_THAT(result.err, HasSubstr(out));
    EXPECT_THAT(leftovers_in(out), IsEmpty());
    for (const auto& [name, bytes] : results_in(out)) {
      const auto whole = expected.find(name);
      EXPECT_TRUE(whole != expected.end() && bytes == whole->second) << name;
    }
    for (const int frame : journalled_frames(out)) {
      EXPECT_TRUE(fs::exists(out + "/disparity/" + frame_file(frame, "pfm"))) << frame;
    }
  }
};

TEST_F(RunDisk, FullInTheMiddle) {
  const SmallDisk disk(folder_ / "disk");
  if (!disk.is_mounted()) {
    GTEST_SKIP() << "a small file system can be mounted by root only";
  }
  const FolderContent expected = undisturbed({});
  const std::string out = folder_ / "disk/out";
  constexpr int kPage = 4096;
  constexpr int kMapPages = (kWidth * kHeight * 4 + 20) / kPage + 1;
  // The journal sets 16 pages aside.
  disk.resize((17 + 11 * kMapPages) * kPage);
  const ProcessResult result = run(out, {"--quiet"});
  expect_full(result, out, expected);
  const std::size_t done = journalled_frames(out).size();
  EXPECT_GT(done, 5U);
  EXPECT_LT(done, 12U);
  const std::string next = frame_file(static_cast<int>(done), "pfm");
  EXPECT_THAT(result.err, HasSubstr("frame " + std::to_string(done) + ": cannot write"));
  EXPECT_THAT(result.err, HasSubstr("disparity/" + next));
  // Still full: nothing is lost, nothing is won.
  expect_full(run(out, {"--quiet", "--resume"}), out, expected);
  // It is no fault of the frame.
  expect_full(run(out, {"--quiet", "--resume", "--keep-going"}), out, expected);
  EXPECT_THAT(journalled_frames(out, true), IsEmpty());
  disk.resize(1 << 20);
  succeeds(run(out, {"--quiet", "--resume"}));
  EXPECT_TRUE(same_files(results_in(out), expected));
}

TEST_F(RunDisk, AReadOnlyFolderIsOneLine) {
  const SmallDisk disk(folder_ / "disk");
  const std::string out = folder_ / "disk/out";
  const bool by_rights = !disk.is_mounted();
  if (by_rights) {
    fs::permissions(folder_ / "disk", fs::perms::owner_read | fs::perms::owner_exec);
  } else {
    disk.make_read_only();
  }
  const ProcessResult result = run(out, {"--quiet"});
  expect_one_line(result, 1, "run", out);
  EXPECT_THAT(result.err,
              AnyOf(HasSubstr("Read-only file system"), HasSubstr("Permission denied")));
  if (by_rights) {
    fs::permissions(folder_ / "disk", fs::perms::owner_all);
    return;
  }
  // A run that has begun keeps what it has.
  disk.make_writable();
  succeeds(run(out, {"--frames", "0-4"}));
  disk.make_read_only();
  expect_one_line(run(out, {"--quiet", "--resume"}), 1, "run", "Read-only file system");
  disk.make_writable();
  succeeds(run(out, {"--resume"}));
  EXPECT_TRUE(same_files(results_in(out), undisturbed({})));
}

TEST_F(RunDisk, FilesWhereFoldersHaveToBe) {
  write_file(folder_ / "file", "mine");
  fs::create_directories(folder_ / "out/.vantage");
  write_file(folder_ / "out/disparity", "mine");
  fs::create_directories(folder_ / "other");
  write_file(folder_ / "other/.vantage", "mine");
  for (const std::string& out :
       {folder_ / "file", folder_ / "file/below", folder_ / "out", folder_ / "other"}) {
    expect_one_line(run(out, {"--quiet"}), 1, "run", out);
  }
  EXPECT_EQ(read_file(folder_ / "file"), "mine");
  EXPECT_EQ(read_file(folder_ / "out/disparity"), "mine");
}

TEST_F(RunDisk, AFolderThatGoesAwayAndComesBack) {
  constexpr int kMany = 600;
  for (int frame = kFrames; frame < kMany; ++frame) {
    for (const std::string& side : {left_, right_}) {
      fs::create_hard_link(side + "/" + frame_file(frame % kFrames),
                           side + "/" + frame_file(frame));
    }
  }
  const std::string out = folder_ / "out";
  const TemporaryFolder streams;
  const VantageProcess process(arguments(out, {"--quiet"}), streams.path());
  while (!fs::exists(out + "/disparity/000000.pfm") && !process.has_ended()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  fs::rename(out, folder_ / "elsewhere");
  const ProcessResult result = process.wait();
  expect_one_line(result, 1, "run");
  EXPECT_THAT(result.err, StartsWith("vantage run: frame "));
  EXPECT_THAT(result.err, HasSubstr("No such file or directory"));
  EXPECT_FALSE(fs::exists(out));
  fs::rename(folder_ / "elsewhere", out);
  const std::size_t before = journalled_frames(out).size();
  EXPECT_GT(before, 0U);
  EXPECT_LT(before, static_cast<std::size_t>(kMany));
  succeeds(run(out, {"--resume", "--report", folder_ / "r.json"}));
  EXPECT_EQ(read_json(folder_ / "r.json")["results"]["frames_before"], before);
  const FolderContent results = results_in(out);
  EXPECT_EQ(results.size(), static_cast<std::size_t>(kMany));
  const FolderContent expected = undisturbed({"--frames", "0-" + std::to_string(kFrames - 1)});
  for (int frame = 0; frame < kMany; ++frame) {
    EXPECT_EQ(results.at("disparity/" + frame_file(frame, "pfm")),
              expected.at("disparity/" + frame_file(frame % kFrames, "pfm")))
        << frame;
  }
}

}  // namespace vantage::run_disk_test
