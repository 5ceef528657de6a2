// Runs whose results cannot be written, or whose film cannot be read. What the disk could not do is
// told, also where only names or sound depend on it.

#include <sys/mount.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/apps/preloaded.h"
#include "tests/apps/sampling.h"

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

std::string numbers(std::initializer_list<std::uint32_t> all) {
  std::string bytes;
  for (const std::uint32_t number : all) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  return bytes;
}

std::string chunk(const std::string& name, const std::string& content) {
  return name + numbers({static_cast<std::uint32_t>(content.size())}) + content;
}

/// An AVI of two frames a second, nothing compressed, with sound of 8 kHz.
std::string sounding_film(std::uint32_t seconds) {
  constexpr std::uint32_t kSide = 16;
  constexpr std::uint32_t kSamples = 8000;
  const std::uint32_t frames = 2 * seconds;
  const auto list = [](const std::string& content) { return chunk("LIST", content); };
  const std::string main =
      chunk("avih", numbers({500'000, 0, 0, 0, frames, 0, 2, 0, kSide, kSide, 0, 0, 0, 0}));
  const std::string pictures =
      chunk("strh", "vidsDIB " + numbers({0, 0, 0, 1, 2, 0, frames, 0, 0, 0, 0, 0})) +
      chunk("strf", numbers({40, kSide, kSide, 1 | 24U << 16U, 0, 0, 0, 0, 0, 0}));
  const std::string sound =
      chunk("strh",
            "auds" + numbers({0, 0, 0, 0, 2, 2 * kSamples, 0, kSamples * seconds, 0, 0, 2, 0, 0})) +
      chunk("strf", numbers({1 | 1U << 16U, kSamples, 2 * kSamples, 2 | 16U << 16U}));
  std::string content;
  SampledNumbers random(1);
  const auto noise = [&](std::size_t bytes) {
    std::string made(bytes, 0);
    std::ranges::generate(made, [&] { return static_cast<char>(random.below(256)); });
    return made;
  };
  for (std::uint32_t frame = 0; frame < frames; ++frame) {
    content += chunk("00db", noise(kSide * kSide * 3)) + chunk("01wb", noise(kSamples));
  }
  return chunk("RIFF", "AVI " +
                           list("hdrl" + main + list("strl" + pictures) + list("strl" + sound)) +
                           list("movi" + content));
}

class IoErrors : public RunTest {
 protected:
  [[nodiscard]] Words failing(const std::string& call, int number) const {
    return fault_at("FAIL", call + ":" + std::to_string(number), folder_.path().string());
  }
};

TEST_F(IoErrors, NoFlushFailsUnnoticed) {
  const Words match = {"match",  left_ + "/000000.png", right_ + "/000000.png",
                       "-o",     folder_ / "d.pfm",     "--disparities=0:9",
                       "--quiet"};
  // The file, and the folder with its name.
  for (const int flush : {1, 2}) {
    expect_one_line(run_vantage(match, failing("fsync", flush)), 1, "match",
                    "cannot write " + (flush == 1 ? folder_ / "d.pfm" : folder_.path().string()) +
                        ": Input/output error");
  }
  const std::string out = folder_ / "out";
  const Words run = arguments(out, joined(kVideoOutputs, {"--frames", "0-9", "--quiet"}));
  // How often folders are flushed depends on how many frames are delivered together.
  const int fewest = calls_of(run, folder_.path().string()).counts.at("fsync") / 2;
  const FolderContent expected = results_in(out);
  for (const int flush : sampled_range(1, fewest, 3, 31)) {
    fs::remove_all(out);
    expect_one_line(run_vantage(run, failing("fsync", flush)), 1, "run", "nput/output error");
    succeeds(run_vantage(joined(run, {"--resume"})));
    EXPECT_TRUE(same_files(results_in(out), expected)) << flush;
  }
}

/// Demultiplexers take a failing read for the end of the file.
TEST_F(IoErrors, SoundThatCannotBeReadIsTold) {
  constexpr std::uint32_t kSeconds = 8;  // more than one read
  write_file(folder_ / "film.avi", sounding_film(kSeconds));
  fs::create_directory(folder_ / "bad");
  const std::string film = folder_ / "bad/film.mp4";
  const auto run_of = [&](const std::string& input, const std::string& out) {
    return Words{"run",    "--left", input,      "--right",         input,    "--disparities=0:1",
                 "--save", "views",  "--video",  "views",           "--view", "0",
                 "-o",     out,      "--report", folder_ / "r.json"};
  };
  succeeds(run_vantage(run_of(folder_ / "film.avi", folder_ / "first")));
  fs::rename(folder_ / "first/views.mp4", film);
  const Words words = run_of(film, folder_ / "out");
  const int reads = calls_of(words, film).counts.at("read");
  EXPECT_EQ(read_json(folder_ / "r.json")["results"]["sound_problem"], "");
  const ProcessResult result = succeeds(run_vantage(
      joined(words, {"--overwrite"}), fault_at("FAIL", "read:" + std::to_string(reads), film)));
  const std::string problem = film + ": its sound cannot be read (input/output error)";
  EXPECT_THAT(result.err, HasSubstr("run: note: the videos have no sound: " + problem));
  EXPECT_EQ(read_json(folder_ / "r.json")["results"]["sound_problem"], problem);
}

}  // namespace vantage::run_disk_test
