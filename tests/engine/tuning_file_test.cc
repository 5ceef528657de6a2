#include "engine/tuning/tuning_file.h"

#include "tests/engine/engine_test.h"

namespace vantage::tuning_file_test {

namespace fs = std::filesystem;

TuningEntry entry(const std::string& size, int strip_width_px = 160) {
  TuningEntry one;
  one.key = {"a machine", "all threads", "a method", size, "1.2.3"};
  one.match = TunedPlan{.settings = {.threads = 2, .strip_width_px = strip_width_px},
                        .frame_seconds = 0.25,
                        .default_frame_seconds = 0.5,
                        .ratio_to_default = 0.5,
                        .measurements = 77,
                        .measured_rows = 480,
                        .date = "2026-11-22T00:00:00Z"};
  return one;
}

class TuningFileTest : public testing::Test {
 protected:
  void write(const std::string& text) const {
    fs::create_directories(path_.parent_path());
    std::ofstream(path_) << text;
  }
  [[nodiscard]] std::string text() const {
    std::ifstream stream(path_);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  /// The text of a file with the entry of entry("a"), `from` replaced by `to`.
  [[nodiscard]] std::string changed(const std::string& from, const std::string& to) const {
    store_entry(path_, entry("a"));
    std::string all = text();
    const std::size_t at = all.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return all.replace(at, from.size(), to);
  }

  TemporaryFolder folder_;
  fs::path path_ = folder_.path() / "config" / "vantage" / "tuning.json";
};

TEST_F(TuningFileTest, AMissingFileHasNoEntries) {
  const TuningFileContent content = read_tuning_file(path_);
  EXPECT_THAT(content.entries, IsEmpty());
  EXPECT_THAT(content.warnings, IsEmpty());
  EXPECT_FALSE(fs::exists(path_.parent_path()));
}

TEST_F(TuningFileTest, GivesBackWhatWasStored) {
  TuningEntry stored = entry("a");
  stored.run = TunedPlan{.settings = {.threads = 1,
                                      .strip_width_px = 2,
                                      .band_height_px = 3,
                                      .iterations_per_pass = 4,
                                      .frames_in_flight = 5}};
  store_entry(path_, entry("b"));
  store_entry(path_, stored);
  const TuningFileContent content = read_tuning_file(path_);
  EXPECT_THAT(content.warnings, IsEmpty());
  ASSERT_EQ(content.entries.size(), 2U);
  const TuningEntry* found = find_entry(content, stored.key);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->key, stored.key);
  EXPECT_EQ(found->match->settings, stored.match->settings);
  EXPECT_EQ(found->match->frame_seconds, 0.25);
  EXPECT_EQ(found->match->default_frame_seconds, 0.5);
  EXPECT_EQ(found->match->ratio_to_default, 0.5);
  EXPECT_EQ(found->match->measurements, 77);
  EXPECT_EQ(found->match->measured_rows, 480);
  EXPECT_EQ(found->match->date, "2026-11-22T00:00:00Z");
  EXPECT_EQ(found->run->settings, stored.run->settings);
  EXPECT_EQ(find_entry(content, TuningKey{}), nullptr);
}

TEST_F(TuningFileTest, ReplacesTheEntryOfAKey) {
  TuningEntry old = entry("a");
  old.run = TunedPlan{.settings = {.frames_in_flight = 3}};
  store_entry(path_, old);
  store_entry(path_, entry("a", 99));
  const TuningFileContent content = read_tuning_file(path_);
  ASSERT_EQ(content.entries.size(), 1U);
  EXPECT_EQ(content.entries[0].match->settings.strip_width_px, 99);
  ASSERT_TRUE(content.entries[0].run) << "what was found for run stays";
  EXPECT_EQ(content.entries[0].run->settings.frames_in_flight, 3);
}

TEST_F(TuningFileTest, WarnsOfFilesThatAreNone) {
  for (const auto& [content, warning] : std::vector<std::pair<std::string, std::string>>{
           {"", "not JSON"},
           {"{\"kind\"", "not JSON"},
           {"[1, 2]", "no tuning file"},
           {"{\"kind\": \"something else\"}", "no tuning file"},
           {"{\"kind\": \"vantage tuning\", \"format\": 2, \"entries\": []}",
            "its format is 2, expected 1"},
           {"{\"kind\": \"vantage tuning\", \"format\": \"1\", \"entries\": []}", "its format is"},
           {"{\"kind\": \"vantage tuning\", \"format\": 1, \"entries\": 7}", "no list of entries"},
           {std::string(100000, '['), "too deep"}}) {
    write(content);
    const TuningFileContent read = read_tuning_file(path_);
    EXPECT_THAT(read.entries, IsEmpty());
    ASSERT_EQ(read.warnings.size(), 1U) << content.substr(0, 60);
    EXPECT_THAT(read.warnings[0], HasSubstr(warning));
    EXPECT_THAT(read.warnings[0], HasSubstr(path_.string()));
    // It may be a newer program's: nothing of it must be lost.
    EXPECT_THROW(store_entry(path_, entry("a")), Error);
    EXPECT_EQ(text(), content);
  }
}

TEST_F(TuningFileTest, WarnsOfDamagedEntriesAndKeepsTheOthers) {
  store_entry(path_, entry("whole"));
  for (const auto& [from, to, warning] : std::vector<std::array<std::string, 3>>{
           {"\"threads\": 2", "\"threads\": 0", "threads is 0, expected a whole number from 1"},
           {"\"threads\": 2", "\"threads\": 1025", "threads is 1025"},
           {"\"threads\": 2", "\"threads\": -1", "threads is -1"},
           {"\"threads\": 2", "\"threads\": 2.5", "threads is 2.5"},
           {"\"threads\": 2", "\"threads\": true", "threads is true"},
           {"\"threads\": 2", "\"threads\": \"2\"", "threads is '2'"},
           {"\"threads\": 2", "\"threads\": 1e300", "threads is 1e+300"},
           {"\"threads\": 2", "\"thraeds\": 2", "'thraeds' is not a setting"},
           {"\"frame_seconds\": 0.25", "\"frame_seconds\": -1", "frame_seconds is -1"},
           {"\"ratio_to_default\": 0.5", "\"ratio_to_default\": null", "ratio_to_default is null"},
           {"\"method\": \"a method\"", "\"method\": 3", "damaged"},
           {"\"size\": \"a\"", "\"sice\": \"a\"", "damaged"},
           {"\"settings\": {", "\"settinks\": {", "damaged"}}) {
    fs::remove(path_);
    std::string all = changed(from, to);
    write(all);
    TuningFileContent content = read_tuning_file(path_);
    EXPECT_THAT(content.entries, IsEmpty()) << to;
    ASSERT_EQ(content.warnings.size(), 1U) << to;
    EXPECT_THAT(content.warnings[0], HasSubstr(warning));
    EXPECT_THAT(content.warnings[0], HasSubstr("entry 1"));
    EXPECT_EQ(content.warnings[0].find('\n'), std::string::npos);
    store_entry(path_, entry("b"));
    content = read_tuning_file(path_);
    EXPECT_EQ(content.entries.size(), 1U);
    EXPECT_THAT(content.warnings, IsEmpty());
  }
}

TEST_F(TuningFileTest, SeveralWritersLoseNothing) {
  constexpr int kWriters = 4;
  constexpr int kEntries = 8;
  std::vector<std::thread> writers;
  for (int writer = 0; writer < kWriters; ++writer) {
    writers.emplace_back([&, writer] {
      for (int i = 0; i < kEntries; ++i) {
        store_entry(path_, entry(std::to_string(writer) + "-" + std::to_string(i)));
      }
    });
  }
  for (std::thread& writer : writers) {
    writer.join();
  }
  EXPECT_EQ(read_tuning_file(path_).entries.size(), static_cast<std::size_t>(kWriters * kEntries));
}

TEST_F(TuningFileTest, ReportsWhatCannotBeWritten) {
  write("");
  EXPECT_THROW(store_entry(path_ / "tuning.json", entry("a")), Error);  // below a file
  fs::remove(path_);
  fs::create_directory(path_);
  EXPECT_THROW(store_entry(path_, entry("a")), Error);
  EXPECT_THAT(read_tuning_file(path_).warnings,
              ElementsAre(HasSubstr("it is a folder, expected a file")));
}

TEST(DefaultTuningPath, FollowsTheBaseDirectories) {
  const auto path_with = [](const char* config, const char* home) {
    const char* const old_config = std::getenv("XDG_CONFIG_HOME");
    const char* const old_home = std::getenv("HOME");
    const auto set = [](const char* name, const char* value) {
      value == nullptr ? ::unsetenv(name) : ::setenv(name, value, 1);
    };
    const std::string kept_config = old_config == nullptr ? "" : old_config;
    const std::string kept_home = old_home == nullptr ? "" : old_home;
    set("XDG_CONFIG_HOME", config);
    set("HOME", home);
    const auto path = default_tuning_path();
    set("XDG_CONFIG_HOME", old_config == nullptr ? nullptr : kept_config.c_str());
    set("HOME", old_home == nullptr ? nullptr : kept_home.c_str());
    return path ? path->string() : "";
  };
  EXPECT_EQ(path_with("/c", "/h"), "/c/vantage/tuning.json");
  EXPECT_EQ(path_with(nullptr, "/h"), "/h/.config/vantage/tuning.json");
  EXPECT_EQ(path_with("", "/h"), "/h/.config/vantage/tuning.json");
  EXPECT_EQ(path_with("relative", "/h"), "/h/.config/vantage/tuning.json");
  EXPECT_EQ(path_with(nullptr, nullptr), "");
  EXPECT_EQ(path_with(nullptr, "relative"), "");
}

}  // namespace vantage::tuning_file_test
