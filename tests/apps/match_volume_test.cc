// match --volume: what the file and the report say, and what is refused.

#include "tests/apps/pair_fixture.h"
#include "tests/test_paths.h"

namespace vantage::match_volume_test {

using MatchVolume = PairTest;

TEST_F(MatchVolume, StatesShapeAndCandidates) {
  succeeds(
      run_vantage({"match", left_, right_, "-o", folder_ / "m.pfm", "--method", "bayes", "--volume",
                   folder_ / "v.npy", "--report", folder_ / "r.json", "--disparities=-200:9"}));
  const auto report = read_json(folder_ / "r.json")["results"]["volume"];
  // No pixel of an image 71 columns wide has a disparity below −70.
  EXPECT_EQ(report["shape"], nlohmann::json({53, 71, 80}));
  EXPECT_EQ(report["disparities"], "-70:9");
  EXPECT_EQ(report["values"], "probabilities");
  const std::string file = read_file(folder_ / "v.npy");
  const std::size_t header = file.find('\n') + 1;
  EXPECT_THAT(file.substr(0, header),
              HasSubstr("'<f4', 'fortran_order': False, 'shape': (53,71,80,)"));
  EXPECT_EQ(file.size() - header, 53U * 71 * 80 * 4);
}

TEST_F(MatchVolume, RowsLevelsAndTransposedImages) {
  const auto shape = [&](const Words& more) {
    succeeds(match(folder_ / "m.npy",
                   joined({"--volume", folder_ / "v.npy", "--report", folder_ / "r.json"}, more)));
    return read_json(folder_ / "r.json")["results"]["volume"]["shape"];
  };
  EXPECT_EQ(shape({"--preset", "balanced", "--volume-level", "1"}), nlohmann::json({27, 36, 10}));
  EXPECT_EQ(shape({"--disparities-y=-1:1", "--volume-rows", "7:9", "--volume-kind", "costs"}),
            nlohmann::json({3, 71, 3, 10}));
  EXPECT_EQ(shape({"--vertical"}), nlohmann::json({53, 71, 10}));
}

TEST_F(MatchVolume, RefusesInOneLineAndLeavesNothing) {
  const auto expect_refused = [&](const Words& more, const std::string& why) {
    expect_one_line(match(folder_ / "m.pfm", more), 2, "match", why);
    EXPECT_FALSE(fs::exists(folder_ / "v.npy"));
  };
  const std::string file = folder_ / "v.npy";
  expect_refused({"--volume-level", "1"}, "has no effect without --volume");
  expect_refused({"--volume", file, "--method", "ssd", "--volume-level", "1"}, "expected 0 to 0");
  expect_refused({"--volume", file, "--volume-rows", "5:4"}, "volume-rows is 5:4");
  expect_refused({"--volume", file, "--volume-rows", "5:53"}, "expected rows within 0:52");
  expect_refused({"--volume", folder_ / "v.pfm"}, "ends in .npy");
  // Before the search range, which these images have none of.
  write_photograph(left_, Photograph{Image<std::uint8_t>(70, 53, 1)});
  write_photograph(right_, Photograph{Image<std::uint8_t>(70, 53, 1)});
  expect_failure(
      run_vantage({"match", left_, right_, "-o", folder_ / "m.pfm", "--volume", file,
                   "--volume-rows", "5:27", "--preset", "balanced", "--volume-level", "1"}),
      2, "expected rows within 0:26");
  expect_refused({"--volume", file, "--preset", "realtime", "--search-size", "half"},
                 "expected search-size full");
}

TEST_F(MatchVolume, MeanAndVarianceOfProbabilities) {
  const std::string mean = folder_ / "mean.pfm";
  const std::string variance = folder_ / "variance.pfm";
  succeeds(
      match(folder_ / "m.pfm", {"--method", "bayes", "--posterior-mean", mean,
                                "--posterior-variance", variance, "--raw", "--subpixel", "none"}));
  const DisparityMap winners = read_disparity(folder_ / "m.pfm");
  const DisparityMap means = read_disparity(mean);
  const DisparityMap variances = read_disparity(variance);
  int certain = 0;
  for (int y = 0; y < winners.height(); ++y) {
    for (int x = 0; x < winners.width(); ++x) {
      if (variances.at(x, y) < 0.01F) {
        ++certain;
        EXPECT_NEAR(means.at(x, y), winners.at(x, y), 0.1);
      }
    }
  }
  EXPECT_GT(certain, 71 * 53 / 2);
  succeeds(match(folder_ / "n.pfm", {"--method", "bayes", "--vertical", "--posterior-mean", mean}));
  EXPECT_EQ(read_disparity(mean).width(), 71);
  expect_failure(match(folder_ / "m.pfm", {"--method", "ssd", "--posterior-mean", mean}), 2,
                 "only the aggregation bayes has p(d)");
}

TEST_F(MatchVolume, SymmetricSelectionSaysWhatItWouldKeep) {
  if (test_paths::is_sanitized()) {
    GTEST_SKIP() << "sanitizers need memory of their own";
  }
  Image<std::uint8_t> image(600, 300);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      image.at(x, y) = static_cast<std::uint8_t>((x * 37 + y * 91 + x * y) % 251);
    }
  }
  write_photograph(folder_ / "large.png", {std::move(image)});
  expect_one_line(
      run_vantage({"match", folder_ / "large.png", folder_ / "large.png", "-o", folder_ / "m.pfm",
                   "--disparities=0:500", "--selection", "symmetric", "--memory", "80M"}),
      1, "match",
      "symmetric selection, which keeps 175 MiB of energies (600x300 "
      "pixels, 501 candidates)");
}

}  // namespace vantage::match_volume_test
