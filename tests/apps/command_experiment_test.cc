#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/apps/pair_fixture.h"
#include "tests/well_formed_xml.h"

namespace vantage {
namespace command_experiment_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

int lines_of(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

TEST(ExperimentCommand, WritesAllTablesAndCharts) {
  const TemporaryFolder folder;
  const std::string out = folder / "deep/er";
  const ProcessResult result =
      run_vantage({"experiment", "noise", "-o", out, "--size", "32", "--iterations", "2", "--pairs",
                   "rds-square,real-bars", "--report", folder / "r.json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(files_below(out),
              ElementsAre("iterations-maps.png", "iterations.csv", "iterations.svg",
                          "noise-bad.svg", "noise-mean-absolute.svg", "noise-rms.svg", "noise.csv",
                          "support-shape.svg", "support.csv", "support.svg"));
  EXPECT_EQ(lines_of(read_file(out + "/noise.csv")), 1 + 2 * 8 * 4);
  EXPECT_EQ(lines_of(read_file(out + "/iterations.csv")), 1 + 4 * 5);
  for (const std::string name :
       {"noise-bad", "noise-mean-absolute", "noise-rms", "iterations", "support"}) {
    const XmlOutline plot = read_xml(read_file(out + "/" + name + ".svg"));
    EXPECT_EQ(plot.error, "") << name;
    EXPECT_GT(plot.count("circle"), 30) << name;
  }
  EXPECT_EQ(read_xml(read_file(out + "/support-shape.svg")).error, "");
  EXPECT_GT(read_photograph(out + "/iterations-maps.png").width(), 600);
  const auto report = nlohmann::json::parse(read_file(folder / "r.json"));
  EXPECT_EQ(report["results"]["noise"].size(), 64U);
  EXPECT_EQ(report["results"]["noise"][0]["pair"], "rds-square");
  EXPECT_LT(report["results"]["support_largest_difference"], 1e-4);
}

TEST(ExperimentCommand, IsReproducible) {
  const TemporaryFolder folder;
  const std::vector<std::string> arguments = {"experiment", "noise",       "--size",       "24",
                                              "--pairs",    "real-square", "--iterations", "1",
                                              "--quiet",    "-o"};
  const auto run = [&](const std::string& out, const std::vector<std::string>& more) {
    auto all = arguments;
    all.push_back(out);
    all.insert(all.end(), more.begin(), more.end());
    const ProcessResult result = run_vantage(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, IsEmpty());
    return read_file(out + "/noise.csv");
  };
  const std::string once = run(folder / "a", {"--threads", "1"});
  EXPECT_EQ(run(folder / "b", {"--threads", "3"}), once);
  EXPECT_NE(run(folder / "c", {"--seed", "2"}), once);
}

TEST(InputExperimentCommand, BadInputIsOneLineAndExit2) {
  const TemporaryFolder folder;
  const std::string out = folder / "o";
  const std::vector<std::pair<std::vector<std::string>, std::string>> misuses = {
      {{"-o", out}, "NAME is missing"},
      {{"loudness", "-o", out}, "NAME is 'loudness', expected noise"},
      {{"noise"}, "--output is missing"},
      {{"noise", "-o", out, "--size", "4"}, "size is 4"},
      {{"noise", "-o", out, "--pairs", "stripes"}, "pair 'stripes' is unknown"},
      {{"noise", "-o", out, "--iterations", "-1"}, "iterations is -1"}};
  for (const auto& [more, says] : misuses) {
    std::vector<std::string> arguments = {"experiment"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProcessResult result = run_vantage(arguments);
    EXPECT_EQ(result.exit_code, 2) << says;
    EXPECT_TRUE(is_one_line(result, "experiment"));
    EXPECT_THAT(result.err, HasSubstr(says));
  }
  EXPECT_THAT(files_below(folder.path()), IsEmpty());
  write_file(folder / "file", "x");
  EXPECT_EQ(run_vantage({"experiment", "noise", "-o", folder / "file", "--size", "16"}).exit_code,
            1);
}

}  // namespace command_experiment_test
}  // namespace vantage
