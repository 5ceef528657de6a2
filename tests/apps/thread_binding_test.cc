// --bind, and machines with several NUMA nodes as hwloc simulates them: results are the same.
#include <sched.h>

#include "tests/apps/sampling.h"

namespace vantage::thread_binding_test {

using nlohmann::json;

const std::string kTwoNodes = "HWLOC_SYNTHETIC=node:2 core:4 pu:2";

class MatchOnNodes : public PairTest {
 protected:
  /// `machine`: a variable for hwloc; empty for this one.
  [[nodiscard]] ProcessResult match_on(const std::string& machine, const std::string& out,
                                       const Words& more = {}) const {
    Words environment;
    if (!machine.empty()) {
      environment.push_back(machine);
    }
    return run_vantage(
        joined({"match", left_, right_, "-o", out, "--disparities=0:9", "--method", "bayes"}, more),
        environment);
  }
};

TEST_F(MatchOnNodes, ResultsAreTheSame) {
  const std::string expected_map = folder_ / "expected.pfm";
  succeeds(match_on("", expected_map, {"--executor", "serial"}));
  const std::string expected = read_file(expected_map);
  struct Way {
    std::string machine;
    Words options;
  };
  const std::vector<Way> ways = {
      {"", {"--bind", "core"}},
      {"", {"--bind", "node", "--threads", "3"}},
      {kTwoNodes, {}},
      {kTwoNodes, {"--bind", "none"}},
      {kTwoNodes, {"--bind", "core", "--threads", "5"}},
      {kTwoNodes, {"--executor", "openmp"}},
      {kTwoNodes, {"--executor", "serial"}},
      {"HWLOC_SYNTHETIC=pack:2 node:2 core:3 pu:1", {"--strip-width", "16", "--band-height", "9"}},
      {"HWLOC_SYNTHETIC=node:4 core:1 pu:1", {"--bind", "node", "--threads", "3"}},
      {"HWLOC_SYNTHETIC=node:1 core:5 pu:1", {"--bind", "core"}}};
  SCOPED_TRACE(test::sample_name());
  for (const Way& way : sampled(ways, 4, 9)) {
    const std::string map = folder_ / "map.pfm";
    succeeds(match_on(way.machine, map, way.options));
    EXPECT_EQ(read_file(map), expected) << way.machine << testing::PrintToString(way.options);
  }
}

TEST_F(MatchOnNodes, ReportsTellWhereThreadsRan) {
  const auto binding = [&](const std::string& machine, const Words& options) {
    const std::string report = folder_ / "r.json";
    const ProcessResult result =
        succeeds(match_on(machine, folder_ / "map.pfm", joined({"--report", report}, options)));
    return std::pair(json::parse(read_file(report)).at("binding"), result.err);
  };
  const json nodes = {{{"node", 0}, {"threads", 8}}, {{"node", 1}, {"threads", 8}}};
  const auto [all, says] = binding(kTwoNodes, {});
  EXPECT_EQ(all, (json{{"to", "node"}, {"is_in_effect", false}, {"nodes", nodes}}));
  EXPECT_THAT(says, HasSubstr("16 threads on 2 NUMA nodes (simulated, so not bound)"));
  const json none = {{"to", "none"}, {"is_in_effect", false}, {"nodes", json::array()}};
  EXPECT_EQ(binding(kTwoNodes, {"--threads", "4"}).first, none) << "one node is enough";
  EXPECT_EQ(binding(kTwoNodes, {"--executor", "serial"}).first, none);
  const json here = binding("", {"--bind", "core"}).first;
  EXPECT_EQ(here.at("to"), "core");
  EXPECT_EQ(here.at("is_in_effect"), true);
}

TEST_F(MatchOnNodes, TracesHaveTheThreadsOfAllNodes) {
  const std::string report = folder_ / "r.json";
  succeeds(match_on("HWLOC_SYNTHETIC=node:2 core:1 pu:1", folder_ / "map.pfm",
                    {"--trace", folder_ / "t.json", "--report", report}));
  const json totals = json::parse(read_file(report)).at("trace");
  double all_s = 0;
  int in_pool = 0;
  for (const json& thread : totals.at("threads")) {
    if (thread.at("is_in_pool")) {
      ++in_pool;
      all_s += thread.at("work_seconds").get<double>() + thread.at("wait_seconds").get<double>();
    }
  }
  EXPECT_GE(in_pool, 1);
  EXPECT_LE(in_pool, 2);  // a caller whose node has but one thread sleeps
  EXPECT_NEAR(all_s / in_pool, totals.at("wall_seconds").get<double>(), 1e-3);
}

TEST_F(MatchOnNodes, ManyMoreThreadsThanProcessorsAreToldAndNotMade) {
  const std::string machine = "HWLOC_SYNTHETIC=node:1 core:1 pu:1";
  const std::string report = folder_ / "r.json";
  const std::string note = "--threads 17 for 1 processor: 16 are used, ";
  for (const std::string executor : {"tbb", "openmp"}) {
    const Words words = {"--executor", executor, "--report", report};
    EXPECT_THAT(
        succeeds(match_on(machine, folder_ / "d.pfm", joined(words, {"--threads", "17"}))).err,
        HasSubstr("match: " + note));
    EXPECT_EQ(read_json(report).at("threads"), 16);
    EXPECT_THAT(
        succeeds(match_on(machine, folder_ / "d.pfm", joined(words, {"--threads", "16"}))).err,
        Not(HasSubstr("processor:")));
    EXPECT_EQ(read_json(report).at("threads"), 16);
  }
}

TEST_F(MatchOnNodes, SerialExecutorsAreNotBound) {
  const std::string out = folder_ / "map.pfm";
  expect_one_line(match_on("", out, {"--executor", "serial", "--bind", "core"}), 2, "match",
                  "bind is core, expected auto or none");
  EXPECT_THAT(match_on("", out, {"--bind", "socket"}).err,
              HasSubstr("--bind is 'socket', expected one of none|node|core"));
}

TEST_F(MatchOnNodes, ConfigurationsHaveTheBinding) {
  EXPECT_THAT(run_vantage({"match", "--print-config"}).out, HasSubstr("bind = 'auto'"));
  EXPECT_THAT(run_vantage({"match", "--bind=node", "--print-config"}).out,
              HasSubstr("bind = 'node'"));
}

class RunOnNodes : public RunTest {};

TEST_F(RunOnNodes, ResultsAreTheSame) {
  const FolderContent expected = undisturbed(kImageOutputs);
  using Way = std::pair<std::string, Words>;
  std::vector<Way> ways;
  for (const std::string machine : {"node:2 core:2 pu:1", "node:3 core:1 pu:1", "node:2 core:4"}) {
    for (const Words& options :
         {Words{}, {"--in-flight", "1"}, {"--bind", "core", "--threads", "5"}}) {
      ways.emplace_back(machine, options);
    }
  }
  SCOPED_TRACE(test::sample_name());
  const std::string out = folder_ / "out";
  for (const auto& [machine, options] : sampled(ways, 2, 10)) {
    fs::remove_all(out);
    succeeds(run_vantage(arguments(out, joined(kImageOutputs, options)),
                         {"HWLOC_SYNTHETIC=" + machine}));
    EXPECT_TRUE(same_files(results_in(out), expected))
        << machine << testing::PrintToString(options);
  }
}

TEST(InfoOnNodes, ListsThem) {
  const ProcessResult table = run_vantage({"info"}, {kTwoNodes});
  EXPECT_THAT(table.out, HasSubstr("16 on 8 cores, 2 NUMA nodes (simulated)"));
  EXPECT_THAT(table.out, HasSubstr("NUMA node 1      8 threads on 4 cores, 1024 MiB"));
  const json info = json::parse(run_vantage({"info", "--json"}, {kTwoNodes}).out);
  EXPECT_EQ(info.at("is_simulated"), true);
  ASSERT_EQ(info.at("nodes").size(), 2U);
  EXPECT_EQ(info.at("nodes")[1].at("hardware_threads"), 8);
  EXPECT_EQ(info.at("nodes")[1].at("cores")[0], (json{8, 9}));
}

TEST(InfoOnNodes, CountsWhatTheAffinityMaskLeaves) {
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  cpu_set_t one;
  CPU_ZERO(&one);
  std::size_t number = 0;
  while (!CPU_ISSET(number, &before)) {
    ++number;
  }
  CPU_SET(number, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  const json info = json::parse(run_vantage({"info", "--json"}).out);
  ASSERT_EQ(sched_setaffinity(0, sizeof before, &before), 0);
  if (info.at("is_simulated")) {
    GTEST_SKIP() << "HWLOC_SYNTHETIC or HWLOC_XMLFILE stands for another machine";
  }
  EXPECT_EQ(info.at("hardware_threads"), 1);
}

}  // namespace vantage::thread_binding_test
