#include "engine/sequence/journal/run_journal.h"

#include "engine/sequence/journal/delivered_frames.h"
#include "engine/sequence/journal/journal_json.h"
#include "engine/sequence/journal/run_verification.h"
#include "tests/engine/engine_test.h"

namespace vantage::run_journal_test {

class RunJournalTest : public testing::Test {
 protected:
  RunJournalTest() {
    identity_.settings = R"({"format":"pfm","window":7})";
    identity_.inputs = {"left: 3 files"};
    identity_.frame_count = 9;
    options_.save = {SequenceOutput::kDisparity};
  }

  RunJournal open(JournalOpening opening, const std::string& part = "all") const {
    return {journal_, identity_, opening, part};
  }
  [[nodiscard]] std::string refusal(JournalOpening opening, const std::string& part = "all") const {
    return error_of([&] { open(opening, part); });
  }
  static void append(RunJournal& journal, const JournalRecord& record) {
    journal.append({&record, 1});
  }
  [[nodiscard]] static std::string file_of(int frame) {
    return "disparity/00000" + std::to_string(frame) + ".pfm";
  }
  /// A frame with one file, which is made.
  void deliver(RunJournal& journal, int frame) const {
    FrameRecord record{.frame = frame};
    std::filesystem::create_directories(folder_ / "disparity");
    std::ofstream(folder_ / file_of(frame)) << "map";
    record.files = {record_of_file(folder_, file_of(frame))};
    append(journal, record);
  }
  [[nodiscard]] DeliveredFrames delivered() const {
    return DeliveredFrames(SequenceLayout(folder_, options_));
  }
  [[nodiscard]] static std::string text_in(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  static void write(const std::filesystem::path& path, const std::string& text,
                    std::ios::openmode mode = std::ios::trunc) {
    std::ofstream(path, mode | std::ios::binary) << text;
  }

  TemporaryFolder temporary_;
  const std::filesystem::path& folder_ = temporary_.path();
  std::filesystem::path journal_ = folder_ / ".vantage";
  RunIdentity identity_;
  SequenceOptions options_;
};

TEST_F(RunJournalTest, BringsBackWhatWasRecorded) {
  FrameRecord odd{.frame = 4};
  odd.remarks = {"2 frames are missing before it", "non-UTF-8 \xff"};
  odd.files = {{"views/000004.png", {7, 0xfedcba98}}, {"disparity/000004.pfm", {5000000000, 0x1}}};
  FrameRecord skipped{.frame = 5};
  skipped.skipped = true;
  FrameRecord absent{.frame = 6, .absent = true};
  skipped.problem = "right/5.png: is \"truncated\"";
  {
    RunJournal journal = open(JournalOpening::kNew);
    const std::vector<JournalRecord> records = {odd, skipped, absent,
                                                SegmentRecord{{0, 9}, {{"a.mp4", {5, 6}}}}};
    journal.append(records);
    append(journal, JoinRecord{{0, 9}, {5}, {{"b.mp4", {7, 8}}}});
    append(journal, ReportRecord{{0, 9}, {{"comfort.json", {9, 1}}}});
  }
  const auto records = RunJournal::read_records(journal_).records;
  ASSERT_EQ(records.size(), 6U);
  const auto& first = std::get<FrameRecord>(records[0]);
  EXPECT_EQ(first.frame, 4);
  EXPECT_FALSE(first.skipped);
  EXPECT_EQ(first.files, odd.files);
  EXPECT_EQ(first.remarks.front(), odd.remarks.front());
  const auto& second = std::get<FrameRecord>(records[1]);
  EXPECT_TRUE(second.skipped);
  EXPECT_EQ(second.problem, skipped.problem);
  EXPECT_FALSE(first.absent);
  EXPECT_TRUE(std::get<FrameRecord>(records[2]).absent);
  EXPECT_EQ(std::get<SegmentRecord>(records[3]).frames, (FrameRange{0, 9}));
  EXPECT_THAT(std::get<SegmentRecord>(records[3]).files, ElementsAre(FileRecord{"a.mp4", {5, 6}}));
  EXPECT_EQ(std::get<JoinRecord>(records[4]).frames, (FrameRange{0, 9}));
  EXPECT_THAT(std::get<JoinRecord>(records[4]).files, ElementsAre(FileRecord{"b.mp4", {7, 8}}));
  EXPECT_THAT(std::get<JoinRecord>(records[4]).skipped, ElementsAre(5));
  EXPECT_EQ(std::get<ReportRecord>(records[5]).frames, (FrameRange{0, 9}));
  EXPECT_THAT(std::get<ReportRecord>(records[5]).files,
              ElementsAre(FileRecord{"comfort.json", {9, 1}}));
}

TEST_F(RunJournalTest, TheIdentityIsKept) {
  identity_.sound_file = "/films/\xff left.mp4";
  identity_.sources = R"({"left":"/films/left"})";
  identity_.sound_first_frame = 3;
  identity_.sound_rate = {30000, 1001};
  identity_.frame_times = FrameTimes{{0, 33, 200}, 1, 1000, {30000, 1001}};
  open(JournalOpening::kNew);
  const RunIdentity read = RunJournal::read_identity(journal_);
  EXPECT_EQ(read.settings, identity_.settings);
  EXPECT_EQ(read.sources, identity_.sources);
  EXPECT_EQ(read.inputs, identity_.inputs);
  EXPECT_EQ(read.frame_count, 9);
  EXPECT_EQ(read.sound_file, identity_.sound_file);
  EXPECT_EQ(read.sound_first_frame, 3);
  EXPECT_EQ(read.sound_rate, identity_.sound_rate);
  EXPECT_EQ(read.frame_times, identity_.frame_times);
}

TEST_F(RunJournalTest, ARunIsNotBegunTwiceUnasked) {
  open(JournalOpening::kNew);
  EXPECT_THAT(refusal(JournalOpening::kNew), HasSubstr("expected `resume`"));
  EXPECT_EQ(refusal(JournalOpening::kResume), "");
  {
    RunJournal journal = open(JournalOpening::kResume);
    append(journal, FrameRecord{.frame = 0});
  }
  open(JournalOpening::kOverwrite);
  EXPECT_THAT(RunJournal::read_records(journal_).records, IsEmpty());
}

TEST_F(RunJournalTest, RecordsThatNothingDescribesAreNotTakenOver) {
  {
    RunJournal journal = open(JournalOpening::kNew, "1-of-2");
    deliver(journal, 0);
  }
  std::filesystem::remove(journal_ / "run.json");
  for (const JournalOpening opening : {JournalOpening::kNew, JournalOpening::kResume}) {
    EXPECT_THAT(refusal(opening), HasSubstr("has records of a run but no run.json"));
  }
  EXPECT_TRUE(delivered().is_done(0));
  open(JournalOpening::kOverwrite);
  EXPECT_FALSE(delivered().is_done(0));
}

/// As when `overwrite` is cut off while it removes them.
TEST_F(RunJournalTest, RecordsOfAReplacedRunDoNotCount) {
  {
    RunJournal journal = open(JournalOpening::kNew, "1-of-2");
    deliver(journal, 0);
  }
  identity_.settings = R"({"format":"pfm","window":9})";
  RunIdentity unfinished = identity_;
  unfinished.replaces_records = true;
  write(journal_ / "run.json", text_of(unfinished));
  EXPECT_FALSE(delivered().is_done(0));
  EXPECT_EQ(refusal(JournalOpening::kResume), "");
  EXPECT_FALSE(RunJournal::read_identity(journal_).replaces_records);
  EXPECT_FALSE(delivered().is_done(0));
}

TEST_F(RunJournalTest, ARunIsNotBegunAnewWhileAPartIsWorkedOn) {
  RunJournal journal = open(JournalOpening::kNew, "1-of-2");
  deliver(journal, 0);
  EXPECT_THAT(refusal(JournalOpening::kOverwrite),
              HasSubstr("another process is working on this run"));
  EXPECT_TRUE(delivered().is_done(0));
}

TEST_F(RunJournalTest, AJournalThatCannotBeReadIsNotAnEmptyOne) {
  open(JournalOpening::kNew);
  std::filesystem::create_directory(journal_ / "frames-1-of-2.jsonl");
  EXPECT_THROW(RunJournal::read_records(journal_), Error);
}

TEST_F(RunJournalTest, PartsJoinARunTheyAgreeWith) {
  open(JournalOpening::kNew, "1-of-2");
  EXPECT_EQ(refusal(JournalOpening::kNew, "2-of-2"), "");
  EXPECT_THAT(refusal(JournalOpening::kNew, "2-of-2"), HasSubstr("expected `resume`"));
  identity_.settings = R"({"format":"png","window":7})";
  EXPECT_THAT(refusal(JournalOpening::kNew, "3-of-3"), HasSubstr(R"(format was "pfm", now "png")"));
}

TEST_F(RunJournalTest, DifferencesAreNamed) {
  open(JournalOpening::kNew);
  identity_.settings = R"({"format":"pfm","window":9,"crf":18})";
  EXPECT_THAT(refusal(JournalOpening::kResume),
              HasSubstr("window was 7, now 9 (and 1 more); expected the same, `force`"));
  // Sound that makes trouble may be left out later.
  identity_.settings = R"({"format":"pfm","window":7,"no-sound":true})";
  EXPECT_EQ(refusal(JournalOpening::kResume), "");
  identity_.settings = R"({"format":"pfm"})";
  EXPECT_THAT(refusal(JournalOpening::kResume), HasSubstr("window was 7, now not set"));
  identity_.settings = R"({"format":"pfm","window":7})";
  identity_.inputs = {"left: 4 files"};
  EXPECT_THAT(refusal(JournalOpening::kResume),
              HasSubstr("the input was 'left: 3 files', now 'left: 4 files'"));
  identity_.inputs = {"left, seen from elsewhere: 3 files"};
  EXPECT_EQ(refusal(JournalOpening::kResume), "");
  identity_.frame_count = 8;
  EXPECT_THAT(refusal(JournalOpening::kResume), HasSubstr("9 frames, now 8"));
  EXPECT_EQ(refusal(JournalOpening::kForce), "");
  EXPECT_EQ(refusal(JournalOpening::kResume), "");  // the folder is now that run's
}

TEST_F(RunJournalTest, OneProcessPerPart) {
  const RunJournal journal = open(JournalOpening::kNew);
  EXPECT_THAT(refusal(JournalOpening::kResume), HasSubstr("another process is working"));
  EXPECT_EQ(refusal(JournalOpening::kResume, "1-of-2"), "");
}

TEST_F(RunJournalTest, LinesThatACrashCutOffDoNotCount) {
  const auto file = journal_ / "frames-all.jsonl";
  {
    RunJournal journal = open(JournalOpening::kNew);
    append(journal, FrameRecord{.frame = 0});
  }
  write(file, R"({"frame":1,"fi)", std::ios::app);
  EXPECT_EQ(RunJournal::read_records(journal_).records.size(), 1U);
  {
    RunJournal journal = open(JournalOpening::kResume);
    append(journal, FrameRecord{.frame = 2});
  }
  write(file, "garbage\n{\"frame\":\"x\"}\n{}\n[1]\n\n", std::ios::app);
  const auto read = RunJournal::read_records(journal_);
  ASSERT_EQ(read.records.size(), 2U);
  EXPECT_EQ(std::get<FrameRecord>(read.records[1]).frame, 2);
  EXPECT_EQ(read.damaged_lines, 5);
}

TEST_F(RunJournalTest, NoChangedByteOfALineOrOfTheDescriptionIsBelieved) {
  const auto file = journal_ / "frames-all.jsonl";
  {
    RunJournal journal = open(JournalOpening::kNew);
    deliver(journal, 3);
  }
  for (const auto& changed : {file, journal_ / "run.json"}) {
    const std::string whole = text_in(changed);
    for (std::size_t i = 0; i + 2 < whole.size(); ++i) {
      std::string text = whole;
      text[i] = text[i] == '5' ? '6' : '5';
      if (changed == file) {
        write(changed, text);
        EXPECT_FALSE(delivered().is_done(3)) << text;
      } else if (i % 5 == 0) {
        write(changed, text);
        EXPECT_THROW(RunJournal::read_identity(journal_), Error) << text;
      }
    }
    write(changed, whole);
  }
  EXPECT_TRUE(delivered().is_done(3));
}

/// As when a line was changed by something that made its checksum anew.
TEST_F(RunJournalTest, RecordsThatNameOtherFilesThanTheirFrameHasAreNotBelieved) {
  RunJournal journal = open(JournalOpening::kNew);
  deliver(journal, 2);
  const FileRecord of_two = record_of_file(folder_, file_of(2));
  std::filesystem::create_directories(folder_ / "disparity/000003.d");
  std::ofstream(folder_ / "disparity/000003.d/a.pfm") << "map";
  const FileRecord below = record_of_file(folder_, "disparity/000003.d/a.pfm");
  for (const std::vector<FileRecord>& files :
       std::vector<std::vector<FileRecord>>{{}, {of_two}, {of_two, of_two}, {below}}) {
    append(journal, FrameRecord{.frame = 3, .files = files});
  }
  append(journal, FrameRecord{.frame = 4, .skipped = true, .files = {of_two}});
  EXPECT_EQ(to_string(delivered().missing({0, 9})), "0-1, 3-8");
  append(journal, FrameRecord{.frame = 2, .files = {of_two, of_two}});
  EXPECT_TRUE(delivered().is_done(2));
}

TEST_F(RunJournalTest, VerificationFindsWhatIsNotAsItWasWritten) {
  RunJournal journal = open(JournalOpening::kNew);
  for (int frame = 0; frame < 5; ++frame) {
    deliver(journal, frame);
  }
  const auto verify = [&] {
    return verify_run(
        SequenceLayout(folder_, options_), [](int, int) {}, nullptr);
  };
  EXPECT_EQ(verify().files, 5);
  EXPECT_EQ(verify().bytes, 15U);
  EXPECT_THAT(verify().damaged, IsEmpty());
  write(folder_ / file_of(1), "mop");
  write(folder_ / file_of(2), "maps");
  std::filesystem::remove(folder_ / file_of(3));
  std::vector<std::string> problems;
  for (const DamagedFile& file : verify().damaged) {
    problems.push_back(file.name + " " + file.problem);
  }
  EXPECT_THAT(problems,
              ElementsAre(file_of(1) + " is not as it was written",
                          file_of(2) + " has 4 bytes, expected 3", file_of(3) + " is missing"));
  // A frame that is made anew, with other bytes, is recorded anew.
  write(folder_ / file_of(1), "mop");
  append(journal, FrameRecord{.frame = 1, .files = {record_of_file(folder_, file_of(1))}});
  EXPECT_EQ(verify().damaged.size(), 2U);
}

TEST_F(RunJournalTest, ADamagedDescriptionIsAnError) {
  EXPECT_THAT(error_of([&] { RunJournal::read_identity(journal_); }), HasSubstr("holds no run"));
  open(JournalOpening::kNew);
  for (const std::string text : {"", "{", "[]", R"({"format":3})", R"({"format":"3"})"}) {
    write(journal_ / "run.json", text);
    EXPECT_THAT(refusal(JournalOpening::kResume), testing::ContainsRegex("is damaged|is not JSON"))
        << text;
  }
  write(journal_ / "run.json", R"({"format":77,"version":"9.9"})");
  EXPECT_THAT(refusal(JournalOpening::kResume),
              HasSubstr("has format 77 (written by Vantage 9.9), expected 3"));
}

TEST_F(RunJournalTest, DeliveredIsWhatIsThereAndRecorded) {
  {
    RunJournal journal = open(JournalOpening::kNew, "1-of-2");
    deliver(journal, 0);
    deliver(journal, 1);
    FrameRecord skipped{.frame = 2};
    skipped.skipped = true;
    append(journal, skipped);
    RunJournal other = open(JournalOpening::kNew, "2-of-2");
    deliver(other, 5);
    deliver(other, 7);
  }
  EXPECT_TRUE(delivered().is_done(0));
  EXPECT_FALSE(delivered().is_done(2));
  EXPECT_FALSE(delivered().is_done(3));
  EXPECT_EQ(to_string(delivered().missing({0, 9})), "3-4, 6, 8");
  EXPECT_EQ(to_string(delivered().missing({3, 6})), "3-4");
  EXPECT_THAT(delivered().missing({0, 3}), IsEmpty());
  std::filesystem::remove(folder_ / file_of(1));
  write(folder_ / file_of(7), "");
  EXPECT_EQ(to_string(delivered().missing({0, 9})), "1, 3-4, 6-8");
}

TEST_F(RunJournalTest, ARepairedFrameIsDone) {
  RunJournal journal = open(JournalOpening::kNew);
  FrameRecord skipped{.frame = 0};
  skipped.skipped = true;
  append(journal, skipped);
  deliver(journal, 0);
  EXPECT_TRUE(delivered().is_done(0));
}

TEST_F(RunJournalTest, FramesOfVideosAreDoneWithTheirSegment) {
  options_.save = {SequenceOutput::kDisparity, SequenceOutput::kPreview};
  options_.video = {SequenceOutput::kPreview};
  const SequenceLayout layout(folder_, options_);
  layout.make_folders();
  RunJournal journal = open(JournalOpening::kNew);
  for (int frame = 0; frame < 4; ++frame) {
    deliver(journal, frame);
  }
  EXPECT_FALSE(delivered().is_done(0));
  EXPECT_NE(delivered().files_of(0), nullptr);
  const auto record_of = [&](const std::string& name) { return record_of_file(folder_, name); };
  const auto add_segment = [&](FrameRange frames) {
    write(layout.segment(layout.streams()[1], frames), "video");
    append(journal, SegmentRecord{frames, {record_of(layout.segment_names(frames).front())}});
  };
  add_segment({0, 2});
  EXPECT_TRUE(delivered().is_done(1));
  EXPECT_FALSE(delivered().is_done(2));
  add_segment({0, 4});
  EXPECT_THAT(delivered().segments(), ElementsAre(FrameRange{0, 4}));
  std::filesystem::remove(layout.segment(layout.streams()[1], {0, 4}));
  EXPECT_THAT(delivered().segments(), ElementsAre(FrameRange{0, 2}));
  write(layout.video(layout.streams()[1]), "joined");
  append(journal, JoinRecord{{0, 4}, {}, {record_of("preview.mp4")}});
  std::filesystem::remove(folder_ / "preview.mp4");
  EXPECT_TRUE(delivered().joined().empty());
  write(layout.video(layout.streams()[1]), "joined");
  EXPECT_EQ(delivered().joined(), (FrameRange{0, 4}));
  EXPECT_TRUE(delivered().is_done(3));
  RunJournal later = open(JournalOpening::kNew, "frames-0-1");  // read after "all"
  append(later, JoinRecord{{0, 2}, {}, {record_of("preview.mp4")}});
  EXPECT_EQ(delivered().joined(), (FrameRange{0, 4}));
}

}  // namespace vantage::run_journal_test
