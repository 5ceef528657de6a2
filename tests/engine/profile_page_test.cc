#include "engine/profile_page/profile_page.h"

#include <gtest/gtest.h>

#include <cctype>
#include <limits>
#include <string>

#include "tests/engine/made_up_profiles.h"
#include "tests/well_formed_xml.h"

namespace vantage {
namespace profile_page_test {

constexpr std::string_view kFirstLine = "<!DOCTYPE html>\n";

XmlOutline outline_of(const std::string& page) {
  if (!page.starts_with(kFirstLine)) {
    return {"not HTML", {}};
  }
  return XmlReader(std::string_view(page).substr(kFirstLine.size()), 255).read();
}

/// Text and attributes of what follows the style sheet.
std::string body_of(const std::string& page) { return page.substr(page.find("<body>")); }

/// For texts that are too long to be printed.
bool has(const std::string& page, std::string_view text) {
  return page.find(text) != std::string::npos;
}

/// Whether `word` stands in `text` with no letter beside it.
bool has_word(const std::string& text, const std::string& word) {
  const auto is_letter = [](char letter) {
    return std::isalpha(static_cast<unsigned char>(letter)) != 0;
  };
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    if (!is_letter(text[at - 1]) && !is_letter(text[at + word.size()])) {
      return true;
    }
  }
  return false;
}

void expect_sound(const std::string& page) {
  const XmlOutline outline = outline_of(page);
  EXPECT_EQ(outline.error, "");
  EXPECT_EQ(outline.count("script"), 0);
  EXPECT_EQ(outline.count("link"), 0);
  EXPECT_EQ(outline.count("img"), 0);
  for (const char* loads : {"http:", "https:", "url(", "@import", "src="}) {
    EXPECT_FALSE(has(page, loads)) << loads;
  }
  EXPECT_FALSE(has_word(body_of(page), "nan"));
  EXPECT_FALSE(has_word(body_of(page), "inf"));
}

TEST(ProfilePage, ShowsAMatch) {
  const std::string page = profile_page(made_up_match());
  expect_sound(page);
  EXPECT_TRUE(has(page,
                  "<h1><code>vantage match left.png right.png -o disparity.pfm "
                  "--method bayes</code></h1>"));
  for (const char* text : {"Example Processor 9000",
                           "AVX3",
                           "2026-03-09T11:45:10Z",
                           "0.1.0",  // head
                           "320\u00A0ms",
                           "54.9\u00A0M",
                           "88\u00A0%",
                           "1.81×",
                           "9.0\u00A0%",
                           "81.7\u00A0MB",            // figures
                           "takes 72 % of the work",  // findings
                           "Bayes iteration",
                           "402\u00A0(390–414)\u00A0ms",
                           "2.45",
                           "6.7\u00A0%",
                           "4.90",
                           "4.49",
                           "arithmetic 118 GFLOP/s",
                           "L2 136 GB/s",
                           "memory 9.75 GB/s",  // roofline
                           "match left: 141\u00A0ms from",
                           "worker 1",  // timeline
                           "idle (waiting)",
                           "results being encoded or written",
                           "Amdahl",
                           "rows between stages",
                           "perf_event says not supported"}) {
    EXPECT_TRUE(has(page, text)) << text;
  }
  EXPECT_FALSE(has(page, "frame 0"));
}

TEST(ProfilePage, ShowsARunOfManyFramesOnManyThreads) {
  const std::string page = profile_page(made_up_run());
  expect_sound(page);
  for (const char* text :
       {"22.2", "13.6×", "1.41\u00A0GB", "deliver, frame 20: 200\u00A0ms from 1.50\u00A0s",
        "worker 15", "deliveries", "(outside of the pool)", "instructions per cycle", "2.09",
        "1 more, each below 0.10\u00A0% (waiting)", "1888"}) {
    EXPECT_TRUE(has(page, text)) << text;
  }
  // 16 threads and one more; 3 charts.
  EXPECT_EQ(outline_of(page).count("svg"), 3);
  EXPECT_LT(page.size(), 1'000'000U);
}

TEST(ProfilePage, SaysWhatIsMissing) {
  const std::string page = profile_page({});
  expect_sound(page);
  for (const char* text : {"No run was measured.", "do not suffice", "No stage of matching",
                           "no timeline", "memory was used is not known", "None were read."}) {
    EXPECT_TRUE(has(page, text)) << text;
  }
  Profile profile;
  profile.thread_counts.resize(1);
  const std::string untraced = profile_page(profile);
  expect_sound(untraced);
  for (const char* text : {"time went is not known", "thread worked is not known",
                           "No waiting was recorded", "there is no speed-up"}) {
    EXPECT_TRUE(has(untraced, text)) << text;
  }
}

TEST(ProfilePage, SaysWhyThereIsNoRoofline) {
  Profile profile = made_up_match();
  profile.ceilings.clear();
  EXPECT_TRUE(has(profile_page(profile), "ceilings were not measured"));
  profile = made_up_match();
  for (StageProfile& stage : profile.thread_counts.back().stages) {
    stage.operations = 0;
  }
  EXPECT_TRUE(has(profile_page(profile), "no stage counts its operations and bytes"));
  profile = made_up_match();
  profile.thread_counts.back().stages[1].operations = 0;
  EXPECT_TRUE(has(profile_page(profile), "Not drawn, as they do not count their work: cost."));
}

TEST(ProfilePage, OneNumberOfThreadsHasNoSpeedUp) {
  Profile profile = made_up_match();
  profile.thread_counts.pop_back();
  profile.speed_ups.pop_back();
  profile.serial_fraction.reset();
  const std::string page = profile_page(profile);
  expect_sound(page);
  EXPECT_TRUE(has(page, "One number of threads was measured"));
  EXPECT_EQ(outline_of(page).count("svg"), 2);
}

TEST(ProfilePage, NamesAreTextNotMarkup) {
  const std::string hostile = "<script>&\"'x";
  Profile profile = made_up_match();
  profile.version = profile.command = profile.date = profile.processor = profile.isa = hostile;
  profile.hardware.absence = hostile;
  profile.hardware.counts = {{hostile, {1, 1, 1}}};
  profile.memory[0].name = hostile;
  for (ThreadCountProfile& count : profile.thread_counts) {
    count.stages[0].name = count.parts[0].name = count.waits[0].name = count.workers[0].name =
        hostile;
    count.stages[1] = {.name = hostile, .seconds = {1, 1, 1}};
  }
  profile.timeline[0].thread = hostile;
  for (TimelineSpan& span : profile.timeline[1].spans) {
    span.name = hostile;
  }
  const std::string page = profile_page(profile);
  expect_sound(page);
  EXPECT_FALSE(has(page, "<script"));
  EXPECT_TRUE(has(page, "&lt;script&gt;&amp;&quot;"));
}

TEST(ProfilePage, FiguresThatCannotBeAreLeftOut) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const double value : {0.0, kInfinity, -kInfinity, kNaN, 1e300, 1e-300}) {
    SCOPED_TRACE(value);
    const ProfileSample sample = {value, value, value};
    Profile profile = made_up_match();
    for (ThreadCountProfile& count : profile.thread_counts) {
      count.wall_s = count.compute_s = count.cells_per_s = count.frames_per_s = count.work_share =
          count.imbalance = sample;
      count.stages[0] = {"zero", sample, value, value, value, value, value};
      count.stages[1].operations = value;
      count.stages[2].bytes = value;
      count.parts[0].seconds = count.waits[0].seconds = count.waiting_for.reading_s = sample;
      count.parts[0].count = value;
      count.workers.front().work_s = count.workers.back().wait_s = value;
    }
    for (SpeedUp& speed_up : profile.speed_ups) {
      speed_up = {speed_up.threads, sample, value, value};
    }
    profile.serial_fraction = value;
    profile.ceilings[1].all_gflops = value;
    profile.timeline_s = value;
    profile.timeline[0].spans[1].end_s = value;
    profile.hardware.counts = {{"instructions", sample}, {"cycles", sample}};
    expect_sound(profile_page(profile));
  }
}

}  // namespace profile_page_test
}  // namespace vantage
