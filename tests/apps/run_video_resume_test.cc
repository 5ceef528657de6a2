// Runs with videos that go on where they stopped, runs that are resumed by their folder alone, and
// results that are verified.

#include <sys/stat.h>

#include "tests/apps/sampling.h"

namespace vantage::run_video_resume_test {

class ResumedByFolder : public RunTest {
 protected:
  [[nodiscard]] ProcessResult resume(const Words& more = {}) const {
    return run_vantage(joined({"run", "-o", out_, "--resume"}, more));
  }
  [[nodiscard]] ProcessResult verify(const Words& more = {}) const {
    return run_vantage(joined({"verify", out_}, more));
  }
  /// Another byte in the middle of a file.
  void damage(const std::string& name) const {
    std::string bytes = read_file(out_ + "/" + name);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
    write_file(out_ + "/" + name, bytes);
  }

  std::string out_ = folder_ / "out";
  std::string report_ = folder_ / "report.json";
};

class VideosResumed : public ResumedByFolder {
 protected:
  static constexpr int kKept = 12;

  /// As when the run has stopped before any video was finished: the files of the first frames are
  /// there.
  void stop_early() const {
    for (const auto& [name, bytes] : results_in(out_)) {
      const std::string stem = fs::path(name).stem().string();
      if (name.ends_with(".mp4") || (stem.size() == 6 && std::stoi(stem) >= kKept)) {
        fs::remove(out_ + "/" + name);
      }
    }
  }
};

TEST_F(VideosResumed, FilesAreKeptAndReadBackWhereTheyHoldWhatVideosShow) {
  struct Case {
    Words outputs;
    bool reads_maps;
  };
  const std::vector<Case> cases = {
      {{"--save", "disparity,preview", "--video", "preview"}, true},
      {{"--save", "disparity,views", "--view", "0.5", "--video", "views"}, false},
      {{"--save", "disparity,unmatched", "--video", "unmatched"}, false},
      {{"--save", "disparity,preview", "--video", "preview", "--temporal-prior", "1"}, false},
      {words("--save disparity,preview --video preview --reference right --format exr --fill none"),
       true},
      {words("--save disparity,right-disparity,preview,views --view 0.5 --video preview "
             "--chunk-frames 7 --format tiff"),
       true},
      {words("--save disparity,right-disparity,views,stereo --view 0.5 --video views,stereo "
             "--stereo-views 0.25,1 --format npy"),
       true}};
  SCOPED_TRACE(test::sample_name());
  for (const auto& [outputs, reads_maps] : sampled(cases, test_paths::is_sanitized() ? 0 : 1, 40)) {
    SCOPED_TRACE(testing::PrintToString(outputs));
    succeeds(run(out_, joined(outputs, {"--report", report_})));
    const FolderContent expected = results_in(out_);
    stop_early();
    const ProcessResult resumed = succeeds(resume({"--report", report_}));
    EXPECT_THAT(resumed.err,
                HasSubstr("12 were already done (12 of them added to the videos now)"));
    EXPECT_TRUE(same_files(results_in(out_), expected));
    const nlohmann::json report = read_json(report_);
    EXPECT_EQ(report["results"]["frames"], kFrames - kKept);
    EXPECT_EQ(report["results"]["pictures_again"], kKept);
    EXPECT_EQ(report["seconds"]["stages"].contains("read maps"), reads_maps);
    fs::remove_all(out_);
  }
}

TEST_F(VideosResumed, WhereAllMapsAreThereNothingIsMatched) {
  succeeds(run(out_, {"--save", "disparity,preview", "--video", "preview"}));
  const FolderContent expected = results_in(out_);
  fs::remove(out_ + "/preview.mp4");
  succeeds(resume({"--report", report_}));
  EXPECT_TRUE(same_files(results_in(out_), expected));
  const nlohmann::json report = read_json(report_);
  EXPECT_EQ(report["results"]["frames"], 0);
  EXPECT_FALSE(report["seconds"]["stages"].contains("match left"));
}

TEST_F(VideosResumed, AFileThatWasDamagedIsMadeAnew) {
  succeeds(run(out_, {"--save", "disparity,preview", "--video", "preview"}));
  const FolderContent expected = results_in(out_);
  stop_early();
  damage("disparity/000003.pfm");
  succeeds(resume());
  EXPECT_TRUE(same_files(results_in(out_), expected));
  succeeds(verify());
}

TEST_F(ResumedByFolder, SettingsAndInputsAreThoseOfTheRun) {
  const std::string poses = folder_ / "poses.toml";
  write_file(poses, "[[view]]\nat = [0.25, 0]\n[[view]]\nat = [0.5, 0.1]\n");
  const Words settings = {"--save", "disparity,views", "--pose", poses,         "--window",
                          "7",      "--offset",        "1",      "--keep-going"};
  const FolderContent expected = undisturbed(settings);
  const std::string good = frame_bytes("left", 4);
  succeeds(run(out_, settings));
  fs::remove(poses);
  fs::remove(out_ + "/disparity/000004.pfm");
  const ProcessResult resumed = succeeds(resume());
  EXPECT_THAT(resumed.err, HasSubstr("run: 1 frame of"));
  EXPECT_TRUE(same_files(results_in(out_), expected));
  // Options go before what is stored; what changes results is refused as ever.
  expect_failure(resume({"--window", "9", "--quiet"}), 1,
                 "holds a different run: window was 7, now 9");
  succeeds(resume({"--threads", "2", "--quiet"}));
  expect_failure(run_vantage({"run", "-o", folder_ / "none", "--resume"}), 1, "holds no run");
}

TEST_F(ResumedByFolder, ThePartThatWasBegunIsThatOfTheOnlyJournal) {
  succeeds(run(out_, {"--frames", "3-9", "--shard", "1/1"}));
  fs::remove(out_ + "/disparity/000005.pfm");
  EXPECT_THAT(resume().err, HasSubstr("run: 1 frame of"));
  EXPECT_EQ(results_in(out_).size(), 7U);
  EXPECT_THAT(resume({"--frames", "0-4"}).err, HasSubstr("run: 3 frames of"));
  // Several parts: the whole.
  succeeds(resume());
  EXPECT_TRUE(same_files(results_in(out_), undisturbed({})));
}

TEST_F(ResumedByFolder, BadFramesAreSkippedAgain) {
  write_file(right_ + "/" + frame_file(4), "bad");
  ASSERT_EQ(run(out_, {"--keep-going"}).exit_code, 3);
  EXPECT_EQ(resume().exit_code, 3);
}

TEST_F(ResumedByFolder, VerificationFindsDamageAndResumingRepairsIt) {
  const Words outputs = words("--save disparity,preview --video preview --chunk-frames 8");
  const FolderContent expected = undisturbed(outputs);
  succeeds(run(out_, outputs));
  const ProcessResult whole = succeeds(verify());
  EXPECT_THAT(whole.err, ContainsRegex("verify: 21 files with .* MB are unchanged\n$"));
  for (const std::string name : {"disparity/000002.pfm", "disparity/000017.pfm", "preview.mp4"}) {
    damage(name);
  }
  fs::resize_file(out_ + "/disparity/000009.pfm", 12);
  const ProcessResult damaged = verify({"--report", report_, "--quiet"});
  expect_one_line(damaged, 1, "verify");
  EXPECT_THAT(damaged.err, HasSubstr("disparity/000002.pfm is not as it was written (and 3 more"));
  EXPECT_EQ(damaged.out,
            "disparity/000002.pfm is not as it was written\n"
            "disparity/000009.pfm has 12 bytes, expected 12302\n"
            "disparity/000017.pfm is not as it was written\n"
            "preview.mp4 is not as it was written\n");
  EXPECT_EQ(read_json(report_)["results"]["damaged"].size(), 4U);
  expect_failure(run_vantage({"merge", out_, "--verify"}), 1, "disparity/000002.pfm");
  EXPECT_EQ(verify({"--remove"}).exit_code, 1);
  succeeds(resume());
  EXPECT_TRUE(same_files(results_in(out_), expected));
  succeeds(verify());
  succeeds(run_vantage({"merge", out_, "--verify"}));
}

TEST_F(ResumedByFolder, DamagedSegmentsAreMadeAgainInsteadOfJoined) {
  const Words outputs = words("--save disparity,preview --video preview --chunk-frames 8");
  const FolderContent expected = undisturbed(outputs);
  for (const std::string shard : {"1/2", "2/2"}) {
    succeeds(run(out_, joined(outputs, {"--shard", shard})));
  }
  damage(".vantage/segments/preview/000000-000007.mp4");
  expect_failure(run_vantage({"merge", out_}), 1, "8 of 20 frames are missing (0-7)");
  EXPECT_FALSE(fs::exists(out_ + "/preview.mp4"));
  succeeds(run_vantage({"run", "-o", out_, "--resume", "--shard", "1/2"}));
  damage("disparity/000013.pfm");
  expect_one_line(run_vantage({"merge", out_}), 1, "merge",
                  "disparity/000013.pfm is not as it was written");
  EXPECT_FALSE(fs::exists(out_ + "/preview.mp4"));
  EXPECT_EQ(verify({"--remove"}).exit_code, 1);
  succeeds(run_vantage({"run", "-o", out_, "--resume", "--frames", "all"}));
  succeeds(run_vantage({"merge", out_}));
  EXPECT_TRUE(same_files(results_in(out_), expected));
}

TEST_F(ResumedByFolder, VerificationReadsNeitherPipesNorDevices) {
  succeeds(run(out_));
  for (const std::string name : {"disparity/000002.pfm", "disparity/000017.pfm"}) {
    fs::remove(out_ + "/" + name);
  }
  ASSERT_EQ(::mkfifo((out_ + "/disparity/000002.pfm").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", out_ + "/disparity/000017.pfm");
  const ProcessResult damaged = verify({"--quiet"});
  EXPECT_EQ(damaged.exit_code, 1);
  EXPECT_EQ(damaged.out,
            "disparity/000002.pfm is not a regular file\n"
            "disparity/000017.pfm is not a regular file\n");
  for (const std::string name : {"frames-x.jsonl", "run.json"}) {
    fs::remove(out_ + "/.vantage/" + name);
    ASSERT_EQ(::mkfifo((out_ + "/.vantage/" + name).c_str(), 0600), 0);
    expect_one_line(verify({"--quiet"}), 1, "verify", name + ": it is not a regular file");
  }
}

TEST_F(ResumedByFolder, LinesOfTheJournalThatWereChangedAreNotBelieved) {
  succeeds(run(out_));
  const std::string journal = out_ + "/.vantage/frames-all.jsonl";
  const std::string whole = read_file(journal);
  const std::size_t line = whole.find("{\"frame\":3,");
  const std::string record = whole.substr(line, whole.find('\n', line) - line);
  const std::string other = "disparity/000002.pfm";
  for (const std::string& change :
       {std::string("{\"frame\":3}"),
        std::string(record).replace(record.find("disparity"), other.size(), other)}) {
    write_file(journal, std::string(whole).replace(line, record.size(), change));
    fs::remove(out_ + "/disparity/000003.pfm");
    expect_failure(run_vantage({"merge", out_}), 1, "1 of 20 frames are missing (3)");
    expect_failure(verify(), 1, "1 line of the journal is damaged");
    succeeds(resume());
    EXPECT_TRUE(same_files(results_in(out_), undisturbed({})));
    succeeds(verify());
  }
}

/// Bytes of names that are no UTF-8 come back from everything that is stored.
TEST_F(ResumedByFolder, NamesNeedNotBeUtf8) {
  const std::string place = folder_ / "x\xff";
  fs::create_directory(place);
  fs::rename(left_, place + "/left");
  fs::rename(right_, place + "/right");
  const Words input = {"--left",       place + "/left", "--right", place + "/right",    "-o",
                       place + "/out", "--frames",      "0-2",     "--disparities=0:9", "--method",
                       "ssd"};
  succeeds(run_vantage(joined({"run"}, input)));
  fs::remove(place + "/out/disparity/000001.pfm");
  succeeds(run_vantage({"run", "-o", place + "/out", "--resume"}));
  EXPECT_TRUE(fs::exists(place + "/out/disparity/000001.pfm"));

  const std::string config = folder_ / "config.toml";
  write_file(config, run_vantage(joined({"run", "--print-config"}, input)).out);
  EXPECT_THAT(read_file(config), HasSubstr("x\\xff/left"));
  succeeds(run_vantage({"run", "--config", config, "--resume"}));

  succeeds(run_vantage(joined({"submit", "--shards", "1"}, input)));
  succeeds(run_vantage({"run", "--config", place + "/out/.vantage/slurm/job.toml", "--resume"}));

  const std::string scene = folder_ / "scene";
  succeeds(run_vantage({"scene", "build", "--images", place + "/left/00000[0-1].png", "-o", scene,
                        "--disparities=0:9", "--method", "ssd"}));
  succeeds(run_vantage({"scene", "view", scene, "--at", "0.5,0", "-o", folder_ / "view.png"}));
}

}  // namespace vantage::run_video_resume_test
