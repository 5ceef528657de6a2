// The same bytes whatever a run is done with and in however many parts.

#include <array>
#include <memory>

#include "tests/apps/sampling.h"

namespace vantage::run_identity_test {

/// Of threads, executor and frames in flight; with two threads images are cut into small parts.
struct Way {
  std::string executor;
  int threads;
  int in_flight;

  [[nodiscard]] Words arguments() const {
    const Words of_cuts = {"--strip-width", "9", "--band-height", "4"};
    return joined({"--executor", executor, "--threads", std::to_string(threads), "--in-flight",
                   std::to_string(in_flight)},
                  threads == 2 ? of_cuts : Words{});
  }
};

/// All executors with all numbers of threads, each with one number of frames in flight; with the
/// rotations 0, 1 and 2 each with each.
std::vector<Way> ways_of(int rotation) {
  constexpr std::array<int, 3> kInFlight = {1, 2, 5};
  std::vector<Way> ways = {{"serial", 1, 0}};
  for (const std::string executor : {"tbb", "openmp"}) {
    for (const int threads : {1, 2, 3}) {
      ways.push_back({executor, threads, 0});
    }
  }
  for (std::size_t i = 0; i < ways.size(); ++i) {
    ways[i].in_flight = kInFlight[(i + static_cast<std::size_t>(rotation)) % kInFlight.size()];
  }
  return ways;
}

struct Outputs {
  std::string name;
  int rotation;  ///< see ways_of()
  Words arguments;
};

class RunIdentity : public RunTest, public testing::WithParamInterface<Outputs> {
 protected:
  [[nodiscard]] Words with(const Words& more) const { return joined(GetParam().arguments, more); }

  /// What all others must be like.
  void SetUp() override {
    const std::string out = folder_ / "expected";
    succeeds(run(out, with({"--executor", "serial", "--in-flight", "1"})));
    expected_ = results_in(out);
  }

  FolderContent expected_;
};

TEST_P(RunIdentity, ForAnyExecutionAndFramesInFlight) {
  SCOPED_TRACE(test::sample_name());
  for (const Way& way : sampled(ways_of(GetParam().rotation), 2,
                                static_cast<std::uint32_t>(GetParam().name.size()))) {
    const std::string out = folder_ / "out";
    succeeds(run(out, with(way.arguments())));
    EXPECT_TRUE(same_files(results_in(out), expected_))
        << way.executor << " " << way.threads << " " << way.in_flight;
    fs::remove_all(out);
  }
}

TEST_P(RunIdentity, ForAnyNumberOfParts) {
  const std::vector<Way> ways = ways_of(GetParam().rotation);
  std::size_t next_way = 1;
  // With seven, some parts have no frames.
  for (const int shards : test::runs_everything() ? std::vector{1, 2, 7} : std::vector{2, 7}) {
    const std::string out = folder_ / "out";
    // Two at a time, each in its own way.
    for (int shard = 1; shard <= shards; shard += 2) {
      std::vector<std::unique_ptr<TemporaryFolder>> streams;
      std::vector<std::unique_ptr<VantageProcess>> processes;
      for (int index = shard; index < shard + 2 && index <= shards; ++index) {
        const Way& way = ways[next_way];
        next_way = (next_way + 4) % ways.size();
        streams.push_back(std::make_unique<TemporaryFolder>());
        processes.push_back(std::make_unique<VantageProcess>(
            arguments(out, with(joined(way.arguments(), {"--shard", std::to_string(index) + "/" +
                                                                        std::to_string(shards)}))),
            streams.back()->path()));
      }
      for (const auto& process : processes) {
        succeeds(process->wait());
      }
    }
    succeeds(run_vantage({"merge", out}));
    EXPECT_TRUE(same_files(results_in(out), expected_)) << shards;
    fs::remove_all(out);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Outputs, RunIdentity,
    testing::Values(
        Outputs{"Images", 0, kImageOutputs}, Outputs{"Videos", 1, kVideoOutputs},
        Outputs{"Shots", 1,
                joined(kVideoOutputs, {"--intensity-fit", "shot", "--preview-range", "shot"})},
        Outputs{
            "TemporalPrior", 2,
            joined(kVideoOutputs, words("--temporal-prior 1 --method diffusion --iterations 4"))},
        Outputs{"Reuse", 1,
                joined(kVideoOutputs, words("--method bayes --cost census-rays --prior-smoothing "
                                            "maximum --levels 3 --search-size "
                                            "half --reuse frame"))},
        Outputs{
            "ReuseAtFullSize", 1,
            joined(kVideoOutputs,
                   words("--method bayes --cost census-rays --prior-smoothing maximum --levels 3 "
                         "--window-levels 1 --reuse frame"))}),
    [](const auto& instance) { return instance.param.name; });

}  // namespace vantage::run_identity_test
