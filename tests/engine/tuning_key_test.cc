#include "engine/tuning/tuning_key.h"

#include "engine/build_info.h"
#include "engine/matching/options/method_fields.h"
#include "tests/engine/engine_test.h"

namespace vantage::tuning_key_test {

class TuningKeyTest : public testing::Test {
 protected:
  TuningKeyTest() {
    machine_.processor = "Some CPU";
    machine_.hardware_threads = 8;
    machine_.cores = 4;
    machine_.l3_bytes = std::size_t{32} << 20;
    match_.method = MatchMethod::kSsd;
    match_.disparities = {0, 255};
  }

  [[nodiscard]] TuningKey key(const TunedImages& images = {1282, 1110, false}) const {
    return make_tuning_key(machine_, match_, execution_, images);
  }

  scheduler::Machine machine_;
  MatchOptions match_;
  ExecutionOptions execution_;
};

TEST_F(TuningKeyTest, CanBeRead) {
  const TuningKey one = key();
  EXPECT_EQ(one.machine, "Some CPU, L1 32 KiB, L2 512 KiB, L3 32768 KiB, 8 threads on 4 cores");
  EXPECT_EQ(one.threads.substr(0, 17), "all threads, tbb,");
  EXPECT_EQ(one.method, "squared box about 8 px, any images");
  EXPECT_EQ(one.size, "about 1448x1024 pixels, 256 disparities");
  EXPECT_EQ(one.version, build_info().version);
  EXPECT_EQ(one.text().find('\n'), std::string::npos);
}

TEST_F(TuningKeyTest, NearlyEqualWorkSharesAKey) {
  const TuningKey one = key();
  EXPECT_EQ(key({1280, 1100, false}), one);
  match_.disparities = {-10, 250};
  EXPECT_EQ(key(), one);
  match_.parameters.window_px = 11;
  EXPECT_EQ(key(), one);
  // What does not change the work of a cell.
  match_.parameters.subpixel = Subpixel::kNone;
  match_.raw = true;
  match_.reference = Side::kRight;
  EXPECT_EQ(key(), one);
}

TEST_F(TuningKeyTest, CountsDisplacementsInTwoDimensions) {
  match_.disparities = {0, 63};
  match_.disparities_y = {-2, 1};
  EXPECT_EQ(key().size, "about 1448x1024 pixels, 256 displacements");
}

TEST_F(TuningKeyTest, DifferentWorkHasDifferentKeys) {
  std::set<std::string> texts;
  std::size_t count = 0;
  const auto add = [&](const TuningKey& one) {
    texts.insert(one.text());
    ++count;
    EXPECT_EQ(texts.size(), count) << one.text();
  };
  add(key());
  add(key({640, 1110, false}));
  add(key({1282, 480, false}));
  add(key({1282, 1110, true}));
  match_.disparities = {0, 63};
  add(key());
  match_.parameters.window_px = 31;
  add(key());
  match_.method = MatchMethod::kBayes;
  add(key());
  match_.parameters.iterations = 50;
  add(key());
  match_.parameters.prior_smoothing = PriorSmoothing::kMaximum;
  add(key());
  match_.parameters.levels = 4;
  add(key());
  match_.parameters.candidate_blocks = 2;
  add(key());
  match_.parameters.pruned_levels = 1;
  add(key());
  match_.parameters.cost = MatchCost::kRayCensus;
  add(key());
  match_.parameters.census_thresholds = 3;
  add(key());
  match_.parameters.window_levels = 1;
  add(key());
  match_.parameters.colour = ColourUse::kChannels;
  add(key());
  match_.method = MatchMethod::kMembrane;
  add(key());
  execution_.threads = 8;
  add(key());
  execution_.threads = 4;
  add(key());
  execution_.executor = scheduler::ExecutorKind::kOpenMp;
  add(key());
  machine_.l2_bytes *= 2;
  add(key());
  machine_.processor = "Another CPU";
  add(key());
  machine_.hardware_threads = 16;
  add(key());
  machine_.numa_nodes = 2;
  add(key());
  execution_.binding = scheduler::ThreadBinding::kNone;
  add(key());
  execution_.binding = scheduler::ThreadBinding::kCores;
  add(key());
}

/// A value of another class of work, if any.
template <typename T>
T other_value(T value) {
  if constexpr (std::is_same_v<T, bool>) {
    return !value;
  } else if constexpr (std::is_enum_v<T>) {
    return static_cast<T>(static_cast<int>(value) == 0 ? 1 : 0);
  } else {
    return static_cast<T>(value * 4 + 1);
  }
}

// A field that is added is part of the key, or stands here as one that leaves the work of a cell as
// it is.
TEST_F(TuningKeyTest, HasEveryFieldThatChangesTheWork) {
  const std::set<std::string_view> same_work = {"truncation",
                                                "sigma-measurement",
                                                "epsilon-measurement",
                                                "alpha",
                                                "gradient-components",
                                                "norm",
                                                "gradient",
                                                "prefilter",
                                                "border",
                                                "lambda",
                                                "beta",
                                                "certainty",
                                                "mu",
                                                "sigma-prior",
                                                "epsilon-prior",
                                                "prior-growth",
                                                "level-weight",
                                                "slant-penalty",
                                                "edge-weight",
                                                "edge-contrast",
                                                "edge-diffusion",
                                                "jump-penalty",
                                                "jump-limit",
                                                "occlusion-penalty",
                                                "subpixel"};
  std::set<std::string_view> options;
  std::set<std::string_view> in_key;
  for (const bool has_levels : {false, true}) {
    for (const MatchMethod method :
         {MatchMethod::kSsd, MatchMethod::kGradient, MatchMethod::kBayes}) {
      match_.method = method;
      match_.parameters = {};
      if (has_levels) {
        match_.parameters.cost = MatchCost::kRayCensus;
        match_.parameters.levels = 3;
        match_.parameters.candidate_blocks = 2;
        match_.parameters.prior_smoothing = PriorSmoothing::kMaximum;
      }
      const MethodParameters before = match_.resolved();
      const TuningKey key_before = key();
      visit_fields(
          [&](const MethodField& field, const auto& value, auto& override_value) {
            const auto unchanged = override_value;
            override_value = other_value(value);
            options.insert(field.option);
            if (key() != key_before) {
              in_key.insert(field.option);
            }
            override_value = unchanged;
          },
          before, match_.parameters);
    }
  }
  for (const std::string_view option : options) {
    EXPECT_NE(in_key.contains(option), same_work.contains(option)) << option;
  }
}

TEST_F(TuningKeyTest, HasTextForEveryMethodAndSize) {
  for (const MatchMethod method :
       {MatchMethod::kSsd, MatchMethod::kGradient, MatchMethod::kDiffusion, MatchMethod::kMembrane,
        MatchMethod::kLocalStopping, MatchMethod::kBayes}) {
    match_.method = method;
    EXPECT_FALSE(key().method.empty());
  }
  match_.parameters.iterations = 0;
  match_.disparities = {0, 0};
  EXPECT_THAT(key().method, HasSubstr("about 0 iterations"));
  EXPECT_EQ(key({1, 1, false}).size, "about 1x1 pixels, 1 disparities");
}

}  // namespace vantage::tuning_key_test
