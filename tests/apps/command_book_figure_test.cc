#include "tests/apps/sampling.h"
#include "tests/well_formed_xml.h"

namespace vantage::command_book_figure_test {

int lines_of(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

TEST(ExperimentCommand, WritesNumbersChartsAndAPage) {
  const TemporaryFolder folder;
  const std::string out = folder / "deep/er";
  succeeds(run_vantage({"book", "figure", "6.17", "6.9", "-o", out, "--size", "32", "--iterations",
                        "2,3", "--noise", "0,4", "--pairs", "rds-square,real-bars", "--report",
                        folder / "r.json"}));
  EXPECT_THAT(files_below(out),
              ElementsAre("figure-6.17-bad.svg", "figure-6.17-book.csv", "figure-6.17.csv",
                          "figure-6.9-book.csv", "figure-6.9-levels.svg", "figure-6.9-sections.svg",
                          "figure-6.9.csv", "figures.html"));
  EXPECT_EQ(lines_of(read_file(out + "/figure-6.17.csv")), 1 + 2 * 2 * (1 + 3 * 2));
  for (const std::string name : {"6.17-bad", "6.9-sections"}) {
    const XmlOutline plot = read_xml(read_file(out + "/figure-" + name + ".svg"));
    EXPECT_EQ(plot.error, "") << name;
    EXPECT_GT(plot.count("circle"), 10) << name;
  }
  const std::string page = read_file(out + "/figures.html");
  EXPECT_THAT(page, AllOf(HasSubstr("id=\"figure-6.9\""), HasSubstr("id=\"figure-6.17\""),
                          HasSubstr("<svg"), Not(HasSubstr("src=\"http")), Not(HasSubstr("{{"))));
  EXPECT_LT(page.find("id=\"figure-6.9\""), page.find("id=\"figure-6.17\""));
  const auto report = read_json(folder / "r.json");
  EXPECT_EQ(report["results"]["6.17"]["files"].size(), 3U);
  EXPECT_THAT(report["results"]["6.17"]["settings"].get<std::string>(),
              HasSubstr("noise 0, 4; methods ssd"));
}

// Every figure, as small as it gets.
TEST(ExperimentCommand, MakesAllFigures) {
  const TemporaryFolder folder;
  const std::string out = folder / "all";
  succeeds(run_vantage({"book", "figure", "all", "-o", out, "--size", "40", "--iterations", "1,2",
                        "--noise", "1", "--quiet"}));
  const auto files = files_below(out);
  const ProcessResult list = succeeds(run_vantage({"book", "figure", "--list"}));
  int figures = 0;
  for (std::size_t begin = 0; begin < list.out.size(); begin = list.out.find('\n', begin) + 1) {
    if (list.out[begin] != ' ') {
      const std::string key = list.out.substr(begin, list.out.find(' ', begin) - begin);
      const auto is_of_figure = [&key](const std::string& file) {
        return file.starts_with("figure-" + key + ".") || file.starts_with("figure-" + key + "-");
      };
      EXPECT_TRUE(std::ranges::any_of(files, is_of_figure)) << key;
      ++figures;
    }
  }
  EXPECT_GE(figures, 30);
}

TEST(ExperimentCommand, IsReproducible) {
  const TemporaryFolder folder;
  const Words arguments =
      words("book figure 6.16 --size 24 --pairs real-square --noise 0,1 --iterations 1 --quiet -o");
  const auto run = [&](const std::string& out, const Words& more) {
    const ProcessResult result = succeeds(run_vantage(joined(joined(arguments, {out}), more)));
    EXPECT_THAT(result.err, IsEmpty());
    return read_file(out + "/figure-6.16.csv");
  };
  const std::string once = run(folder / "a", {"--threads", "1"});
  EXPECT_EQ(run(folder / "b", {"--threads", "3"}), once);
  EXPECT_NE(run(folder / "c", {"--seed", "2"}), once);
  EXPECT_NE(run(folder / "d", {"--window", "9"}), once);
}

TEST(ExperimentCommand, EachRowIsAnotherComputation) {
  const TemporaryFolder folder;
  const auto rows_of = [&folder](const std::string& figure, Words more) {
    const std::string out = folder / ("rows-" + figure);
    more.insert(more.begin(), {"book", "figure", figure, "-o", out, "--quiet", "--size", "24",
                               "--pairs", "rds-square"});
    succeeds(run_vantage(more));
    return read_file(out + "/figure-" + figure + ".csv");
  };
  // Methods that read no iterations or no window have one row.
  const std::string noise =
      rows_of("6.16", {"--methods", "balanced,bayes", "--iterations", "5,20", "--noise", "0"});
  EXPECT_EQ(lines_of(noise), 1 + 1 + 2) << noise;
  EXPECT_THAT(noise, HasSubstr("rds-square,balanced,,0,"));
  const std::string windows = rows_of("6.5", {"--methods", "bayes,ssd", "--iterations", "1"});
  EXPECT_EQ(lines_of(windows), 1 + 1 + 2) << windows;
  EXPECT_THAT(windows, Not(HasSubstr("bayes, w =")));
  const std::string maps = rows_of("6.10", {"--methods", "bayes,ssd", "--iterations", "1,2"});
  EXPECT_EQ(lines_of(maps), 1 + 2 + 1) << maps;
  EXPECT_THAT(read_file(folder / "rows-6.10/figure-6.10-book.csv"), Not(HasSubstr("ssd")));
  const std::string membrane =
      rows_of("6.8", {"--methods", "ssd,membrane", "--iterations", "1,2,4"});
  EXPECT_EQ(lines_of(membrane), 1 + 1 + 3) << membrane;
  EXPECT_THAT(read_file(folder / "rows-6.8/figure-6.8-book.csv"),
              AllOf(HasSubstr("membrane: n = 2 and n = 4"), Not(HasSubstr("ssd"))));
  const std::string sections =
      rows_of("6.7", {"--methods", "ssd,membrane", "--iterations", "0,1", "--noise", "0,8"});
  EXPECT_EQ(lines_of(sections), 1 + 2 * (1 + 2)) << sections;
  EXPECT_THAT(sections, AllOf(HasSubstr("rds-square,ssd,,8,"), HasSubstr("membrane,1,0,")));
}

TEST(ExperimentCommand, SaysOnlyWhatFiguresRead) {
  const ProcessResult list = run_vantage({"book", "figure", "--list"});
  const auto line_after = [&list](const std::string& title) {
    const std::size_t begin = list.out.find('\n', list.out.find(title)) + 1;
    return list.out.substr(begin, list.out.find('\n', begin) - begin);
  };
  EXPECT_THAT(line_after("The pair kids and its disparity maps"),
              AllOf(HasSubstr("methods gradient"), Not(HasSubstr("iterations"))));
  EXPECT_THAT(line_after("The membrane model"), HasSubstr("iterations 5, 10"));
  const TemporaryFolder folder;
  succeeds(run_vantage({"book", "figure", "6.9", "6.11", "-o", folder / "o", "--iterations", "1",
                        "--beta", "0.2", "--report", folder / "r.json", "--quiet"}));
  const auto report = read_json(folder / "r.json");
  EXPECT_EQ(report["results"]["6.9"]["settings"], "iterations 1; beta 0.2");
  EXPECT_EQ(report["results"]["6.11"]["settings"], "");
}

class ExperimentPhotographs : public PairTest {};

TEST_F(ExperimentPhotographs, TakeThePlaceOfGeneratedScenes) {
  const std::string truth = folder_ / "truth.pfm";
  write_disparity(truth, pair_.left_disparity.view());
  const auto run = [&](const std::string& out, const Words& more) {
    succeeds(run_vantage(joined(
        {"book", "figure", "3.9", "5.8", "-o", out, "--quiet", "--disparities", "0:9"}, more)));
    return read_file(out + "/figure-5.8.csv");
  };
  const std::string with_truth =
      run(folder_ / "a", {"--left", left_, "--right", right_, "--truth", truth});
  EXPECT_EQ(lines_of(with_truth), 2);
  EXPECT_NE(run(folder_ / "b", {"--left", left_, "--right", right_}), with_truth);
  // Only a photograph from there says how good a view is.
  EXPECT_THAT(read_file(folder_ / "a/figure-3.9.csv"), HasSubstr(",,,"));
  EXPECT_NE(read_file(folder_ / "a/figures.html").find("in place of the book"), std::string::npos);
}

TEST(InputExperimentCommand, BadInputIsOneLineAndExit2) {
  const TemporaryFolder folder;
  const std::string out = folder / "o";
  const std::vector<Refusal> refusals = {
      {{"-o", out}, "FIGURE is missing"},
      {{"9.1", "-o", out}, "figure '9.1' is unknown, expected all, a chapter or one of"},
      {{"6.16"}, "--output is missing"},
      {{"6.16", "-o", out, "--size", "4"}, "size is 4"},
      {{"6.16", "-o", out, "--pairs", "stripes"}, "pair 'stripes' is unknown"},
      {{"6.16", "-o", out, "--methods", "guess"}, "method 'guess' is unknown"},
      {{"6.16", "-o", out, "--noise", "-1"}, "noise is -1"},
      {{"6.9", "-o", out, "--size", "40"}, "--size has no effect"},
      {{"6.9", "-o", out, "--mu", "0.4"}, "--mu has no effect"},
      {{"6.9", "-o", out, "--lambda", "0.1"}, "--lambda has no effect: the figures do not read it"},
      {{"5.2", "-o", out, "--aggregation-sigma", "1"},
       "--aggregation-sigma has no effect: the figures do not read it"},
      {{"6.11", "-o", out, "--mu", "0.4"}, "--mu has no effect: the figures do not read it"},
      {{"6.5", "-o", out, "--iterations", "2"}, "--iterations has no effect"},
      {{"3.4", "3.6", "5.11", "-o", out, "--iterations", "2"}, "--iterations has no effect"},
      {{"6.10", "-o", out, "--methods", "ssd", "--iterations", "2"}, "--iterations has no effect"},
      {{"6.16", "-o", out, "--left", "a.png", "--right", "b.png"}, "--left has no effect"},
      {{"3.9", "-o", out, "--left", "a.png"}, "--right is missing"},
      {{"3.9", "-o", out, "--left", "a.png", "--right", "b.png", "--seed", "2"},
       "--seed has no effect with photographs"},
      {{"3.9", "-o", out, "--disparities", "0:9"}, "--disparities has no effect without"},
      {{"6.16", "-o", out, "--iterations", "-1"}, "iterations is -1"}};
  expect_refusals("book figure", folder.path(), refusals, [&](const Words& words) {
    return run_vantage(joined({"book", "figure"}, words));
  });
  write_file(folder / "file", "x");
  EXPECT_EQ(
      run_vantage({"book", "figure", "6.9", "-o", folder / "file", "--iterations", "1"}).exit_code,
      1);
}

}  // namespace vantage::command_book_figure_test
