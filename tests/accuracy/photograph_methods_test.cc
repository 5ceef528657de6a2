// The methods against the plain transcription on a rendered scene, and on a photographed one where
// there is one: textures, slanted surfaces and occlusions that random pairs lack.

#include "engine/generation/layered_scene.h"
#include "engine/io/images/photograph_io.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/method_cases.h"
#include "tests/engine/oracle_comparison.h"
#include "tests/test_paths.h"

namespace vantage::photograph_methods_test {

class PhotographMethods : public ::testing::TestWithParam<MethodCase> {
 protected:
  static void expect_equal(const PhotographPair& pair, DisparityRange range, const char* what) {
    MatchOptions options = GetParam().options;
    options.disparities = range;
    expect_equals_oracle(pair, options, execution(), tolerance_of(options.resolved()), what);
  }
};

TEST_P(PhotographMethods, EqualTheOracleOnARenderedScene) {
  if (is_stepped(GetParam())) {
    GTEST_SKIP() << "cells are rounded to steps: see stage_cost_test, coarse_to_fine_test";
  }
  static const PhotographPair pair = [] {
    LayeredSceneOptions options;
    options.width_px = 160;
    options.height_px = 120;
    options.far_disparity_px = 3;
    options.near_disparity_px = 18;
    options.noise_sigma = 1;
    const LayeredScene scene(options, execution());
    return PhotographPair{crop(scene.render({0, 0}, 0).image, 50, 38, 60, 44),
                          crop(scene.render({1, 0}, 0).image, 50, 38, 60, 44)};
  }();
  expect_equal(pair, {0, 23}, "rendered");
}

TEST_P(PhotographMethods, EqualTheOracleOnAPhotographedScene) {
  if (is_stepped(GetParam())) {
    GTEST_SKIP() << "cells are rounded to steps: see stage_cost_test, coarse_to_fine_test";
  }
  const std::filesystem::path folder = test_paths::shared_data() / "cones_half";
  if (!std::filesystem::is_directory(folder)) {
    GTEST_SKIP() << "no photographs at " << folder;
  }
  static const PhotographPair pair{crop(read_photograph(folder / "im2.png"), 60, 66, 60, 44),
                                   crop(read_photograph(folder / "im6.png"), 60, 66, 60, 44)};
  expect_equal(pair, {4, 33}, "photographed");
}

INSTANTIATE_TEST_SUITE_P(Methods, PhotographMethods, ::testing::ValuesIn(method_cases({})),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace vantage::photograph_methods_test
