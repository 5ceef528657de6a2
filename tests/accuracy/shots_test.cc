#include "engine/sequence/shots/shots.h"

#include "engine/generation/layered_scene.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/synthesis/view_synthesizer.h"
#include "tests/engine/engine_test.h"

namespace vantage::shots_test {

constexpr int kCut = 7;
constexpr int kFrames = 16;

/// Two shots: different textures, movements and differences between the cameras.
class TwoShots : public PairSource {
 public:
  std::set<int> bad;
  std::vector<int> fetched;
  std::vector<int> with_right;           // those of them whose right image was wanted too
  int max_held = 0;                      // fetched and not decoded yet
  mutable std::atomic<int> decoded = 0;  // or found to be bad

  bool fetch(FramePair& pair) override {
    if (next_ >= kFrames) {
      return false;
    }
    pair.index = next_++;
    fetched.push_back(pair.index);
    if (pair.wants_right) {
      with_right.push_back(pair.index);
    }
    max_held = std::max(max_held, static_cast<int>(fetched.size()) - decoded);
    if (bad.contains(pair.index) && pair.index % 2 == 0) {
      throw Error("damaged");
    }
    return true;
  }
  void make_images(FramePair& pair) const override {
    const int index = pair.index;
    ++decoded;
    if (bad.contains(index)) {
      throw Error("damaged");
    }
    LayeredSceneOptions options;
    options.width_px = 96;
    options.height_px = 64;
    options.samples_per_side = 1;
    options.far_disparity_px = 2;
    options.near_disparity_px = index < kCut ? 8 : 14;
    options.seed = index < kCut ? 1 : 5;
    options.right_gain = index < kCut ? 0.8 : 1.1;
    options.right_offset = index < kCut ? 15 : -10;
    const LayeredScene scene(options, execution());
    const int time = index < kCut ? index : index + 40;
    pair.left = scene.render({0, 0}, time).image;
    pair.right = pair.wants_right ? scene.render({1, 0}, time).image : Photograph();
  }
  void skip_to(int index) override { next_ = index; }
  [[nodiscard]] int pair_count() const override { return kFrames; }
  [[nodiscard]] std::string describe(int index) const override { return std::to_string(index); }
  [[nodiscard]] std::vector<std::string> remarks() const override { return {}; }
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override { return {}; }
  [[nodiscard]] Sound sound() const override { return {}; }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override { return {}; }
  [[nodiscard]] std::vector<std::string> identities() const override { return {}; }

 private:
  int next_ = 0;
};

class Shots : public ::testing::Test {
 protected:
  Shots() {
    options_.match.disparities = {0, 19};
    options_.match.preset = MatchPreset::kRealtime;  // whatever the brightness
    options_.intensity_fit = FitScope::kShot;        // shots are matched
  }

  std::optional<ShotTable> survey(int first = 0, int end = kFrames, int threads = 3) {
    Execution execution({.threads = threads});
    return survey_shots(pairs_, first, end, options_, hooks_, execution);
  }

  /// What such samples give, from all their disparities in order.
  Shot shot_of_samples(const std::vector<int>& frames) {
    const StereoMatcher matcher(options_.match, execution());
    const ViewSynthesizer synthesizer(options_.synthesis, execution());
    kernels::IntensitySums sums;
    std::vector<float> disparities;
    for (const int frame : frames) {
      FramePair pair;
      pair.index = frame;
      pairs_.decode(pair);
      DisparityMaps maps;
      matcher.match(pair.left, pair.right, {}, maps);
      sums.add(synthesizer.intensity_sums(
          {pair.left, pair.right, maps.left.disparity_px.view(), maps.right.disparity_px.view()},
          0.5));
      for (int y = 0; y < maps.left.disparity_px.height(); ++y) {
        disparities.insert(disparities.end(), maps.left.disparity_px.row(y),
                           maps.left.disparity_px.row(y) + maps.left.disparity_px.width());
      }
    }
    std::sort(disparities.begin(), disparities.end());
    const auto last = static_cast<double>(disparities.size() - 1);
    const float min = disparities[static_cast<std::size_t>(std::lround(0.01 * last))];
    const float max = disparities[static_cast<std::size_t>(std::lround(0.99 * last))];
    const float margin = std::max(0.5F, 0.05F * (max - min));
    Shot shot;
    shot.intensity = fit_channels(sums, 3, 1);
    shot.preview_range = {min - margin, max + margin};
    return shot;
  }

  TwoShots pairs_;
  SequenceOptions options_;
  SurveyHooks hooks_;
};

TEST_F(Shots, AreFoundAndFitted) {
  const std::optional<ShotTable> table = survey();
  ASSERT_TRUE(table.has_value());
  ASSERT_EQ(table->shots.size(), 2U);
  EXPECT_EQ(table->shots[0].first_frame, 0);
  EXPECT_EQ(table->shots[0].end_frame, kCut);
  EXPECT_EQ(table->shots[1].first_frame, kCut);
  EXPECT_EQ(table->shots[1].end_frame, kFrames);
  EXPECT_NEAR(table->shots[0].intensity[0].gain, 0.8, 0.1);
  EXPECT_NEAR(table->shots[1].intensity[0].gain, 1.1, 0.2);
  const std::vector<int> samples[] = {{0, 3, 6}, {7, 11, 15}};
  for (std::size_t k = 0; k < 2; ++k) {
    Shot expected = shot_of_samples(samples[k]);
    expected.first_frame = table->shots[k].first_frame;
    expected.end_frame = table->shots[k].end_frame;
    EXPECT_EQ(table->shots[k], expected) << k;
    EXPECT_EQ(expected.intensity[3], IntensityFit{});
  }
  EXPECT_EQ(&table->shot_of(0), &table->shots[0]);
  EXPECT_EQ(&table->shot_of(kCut - 1), &table->shots[0]);
  EXPECT_EQ(&table->shot_of(kCut), &table->shots[1]);
  EXPECT_EQ(&table->shot_of(1000), &table->shots[1]);
  EXPECT_EQ(&table->shot_of(-1), &table->shots[0]);
}

TEST_F(Shots, LookAtAllFramesOnceAndAtThreeOfEachShotAgain) {
  std::vector<SurveyProgress> progress;
  hooks_.progress = [&](const SurveyProgress& now) { progress.push_back(now); };
  survey();
  std::vector<int> expected;
  for (int frame = 0; frame < kFrames; ++frame) {
    expected.push_back(frame);
  }
  for (const int frame : {0, 3, 6, 7, 11, 15}) {
    expected.push_back(frame);
  }
  EXPECT_EQ(pairs_.fetched, expected);
  EXPECT_EQ(pairs_.with_right, (std::vector<int>{0, 3, 6, 7, 11, 15}));
  EXPECT_EQ(progress.back().frames_done, kFrames + 6);
  EXPECT_EQ(progress.back().frames_total, kFrames + 6);
}

TEST_F(Shots, DoNotDependOnTheExecution) {
  const auto table = survey();
  EXPECT_EQ(survey(0, kFrames, 1), table);
}

TEST_F(Shots, HoldNoMorePairsThanTheyMay) {
  const auto table = survey();
  EXPECT_EQ(pairs_.max_held, 3);
  pairs_.max_held = 0;
  pairs_.fetched.clear();
  pairs_.decoded = 0;
  hooks_.in_flight = 1;
  EXPECT_EQ(survey(), table);
  EXPECT_EQ(pairs_.max_held, 1);
}

TEST_F(Shots, OfAPartOfTheFrames) {
  const auto table = survey(3, 10);
  ASSERT_EQ(table->shots.size(), 2U);
  EXPECT_EQ(table->shots[0].first_frame, 3);
  EXPECT_EQ(table->shots[0].end_frame, kCut);
  EXPECT_EQ(table->shots[1].end_frame, 10);
  EXPECT_EQ(survey(2, 3)->shots.size(), 1U);
}

TEST_F(Shots, UnreadableFramesAreLeftOut) {
  pairs_.bad = {0, 3, 4, 11};
  const auto table = survey();
  ASSERT_EQ(table->shots.size(), 2U);
  EXPECT_EQ(table->shots[1].first_frame, kCut);
  EXPECT_NEAR(table->shots[0].intensity[0].gain, 0.8, 0.1);
  for (int frame = 0; frame < kFrames; ++frame) {
    pairs_.bad.insert(frame);
  }
  const auto nothing = survey();
  ASSERT_EQ(nothing->shots.size(), 1U);
  EXPECT_EQ(nothing->shots[0].intensity[0], IntensityFit{});
  EXPECT_EQ(nothing->shots[0].preview_range, (PreviewRange{-0.5F, 19.5F}));
}

TEST_F(Shots, PreparePairsBeforeMatching) {
  std::atomic<int> prepared = 0;
  hooks_.prepare = [&](FramePair& pair) {
    ++prepared;
    auto& right = std::get<Image<std::uint8_t>>(pair.right.pixels);
    for (const auto [k, y] : positions_of(right.width() * right.channels(), right.height())) {
      right.row(y)[k] = static_cast<std::uint8_t>(right.row(y)[k] / 2);
    }
  };
  const auto table = survey();
  EXPECT_EQ(prepared, 6);
  ASSERT_EQ(table->shots.size(), 2U);
  EXPECT_NEAR(table->shots[0].intensity[0].gain, 0.4, 0.05);
}

TEST_F(Shots, StopWhenTold) {
  std::atomic<bool> stop = false;
  hooks_.stop = &stop;
  hooks_.progress = [&](const SurveyProgress& now) { stop = now.frames_done >= kFrames + 2; };
  EXPECT_FALSE(survey().has_value());
  stop = true;
  pairs_.fetched.clear();
  EXPECT_FALSE(survey().has_value());
  EXPECT_TRUE(pairs_.fetched.empty());
}

TEST(ShotTableJson, ComesBackTheSame) {
  ShotTable table;
  table.shots.push_back({.first_frame = 3, .end_frame = 10, .preview_range = {-0.1F, 1 / 3.0F}});
  table.shots.push_back({.first_frame = 10, .end_frame = 11, .preview_range = {1e-7F, 60}});
  table.shots[0].intensity[1] = {.offset = 0.1 + 0.2, .gain = 1 / 3.};
  table.shots[1].intensity[3] = {.offset = -1e-300, .gain = 16};
  EXPECT_EQ(shot_table_from_json(to_json(table)), table);
}

TEST(ShotTableFile, IsThatOfTheFirstWhoKeepsOne) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "shots.json";
  EXPECT_EQ(read_shot_table(file), std::nullopt);
  ShotTable first;
  first.shots.push_back({.first_frame = 0, .end_frame = 5, .preview_range = {1, 2}});
  ShotTable second = first;
  second.shots[0].preview_range = {1, 3};
  EXPECT_EQ(keep_shot_table(file, first), first);
  EXPECT_EQ(keep_shot_table(file, second), first);
  EXPECT_EQ(read_shot_table(file), first);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  put_text(file, to_json(first));
  EXPECT_THAT(test::error_of([&] { read_shot_table(file); }), HasSubstr("wrong checksum"));
  put_text(file, to_json(first).substr(0, 40));
  EXPECT_THAT(test::error_of([&] { read_shot_table(file); }),
              HasSubstr(file.string() + ": is damaged (shots:"));
  put_text(file, "");
  EXPECT_THAT(test::error_of([&] { read_shot_table(file); }), HasSubstr(file.string()));
  EXPECT_THAT(test::error_of([&] { keep_shot_table(folder / "none/shots.json", first); }),
              HasSubstr("there is no folder"));
}

TEST(ShotTableJson, MalformedTextIsRefused) {
  ShotTable table;
  table.shots.push_back({.first_frame = 0, .end_frame = 5, .preview_range = {}});
  table.shots.push_back({.first_frame = 5, .end_frame = 9, .preview_range = {}});
  const auto error_of = [](const std::string& text) -> std::string {
    try {
      shot_table_from_json(text);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const std::string text = to_json(table);
  for (std::size_t size = 0; size + 2 < text.size(); size += 7) {
    EXPECT_THAT(error_of(text.substr(0, size)), HasSubstr("shots:")) << size;
  }
  EXPECT_THAT(error_of("[]"), HasSubstr("shots:"));
  EXPECT_THAT(error_of(R"({"shots": []})"), HasSubstr("expected at least one"));
  EXPECT_THAT(error_of(R"({"shots": [1]})"), HasSubstr("shots:"));
  const auto with = [&](void (*change)(ShotTable & changed)) {
    ShotTable changed = table;
    change(changed);
    return error_of(to_json(changed));
  };
  EXPECT_EQ(with([](ShotTable&) {}), "");
  EXPECT_THAT(with([](ShotTable& t) { t.shots[1].first_frame = 6; }),
              HasSubstr("shot 1 starts at frame 6, expected 5"));
  EXPECT_THAT(with([](ShotTable& t) { t.shots[0].end_frame = 0; }), HasSubstr("shot 0"));
  EXPECT_THAT(with([](ShotTable& t) { t.shots[0].preview_range = {4, 4}; }), HasSubstr("range"));
  EXPECT_THAT(with([](ShotTable& t) { t.shots[1].intensity[2].gain = 0; }), HasSubstr("gain"));
}

}  // namespace vantage::shots_test
