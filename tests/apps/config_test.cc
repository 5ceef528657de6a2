#include <cctype>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include "tests/apps/pair_fixture.h"

namespace vantage::config_test {

/// "a.a.a": a key of so many parts.
std::string deep_key(int parts) {
  std::string key = "a";
  for (int part = 1; part < parts; ++part) {
    key += ".a";
  }
  return key;
}

using Config = PairTest;

TEST_F(Config, PrintedSettingsFedBackAreTheSame) {
  const std::vector<Words> commands = {
      {"match", "a 'quoted'.png", "b\"\\.png", "-o", "o.pfm", "--disparities=-16:15", "--raw",
       "--cross-check", "1.25", "--threads", "3", "--reference=right"},
      words("match a.png b.png -o o.pfm --preset quality --cross-check none "
            "--confidence-threshold none --edge-snapping on --surface-fit on --fill linear "
            "--iterations-per-pass 4"),
      words("match a.png b.png -o o.flo --disparities-y=-2:3 --method gradient --cost gradient "
            "--aggregate gaussian --norm octagon --gradient simoncelli5 --prefilter none --alpha "
            "0.5 --aggregation-sigma 1.5 --candidate-step 0.25 --confidence-threshold -0.25 "
            "--confidence c.exr --unmatched-right u.png"),
      words("match a.png b.png -o o.pfm --method bayes --mu 0.3 --sigma-prior 0.1 --epsilon-prior "
            "0.02 --sigma-measurement 8 --epsilon-measurement 0.2 --iterations 7 --colour "
            "channels --edge-weight 0.3 --edge-contrast 12 --level-weight 0.75 --slant-penalty "
            "0.25 --prior-growth 1.25 --final-iterations 2 --levels 3 --candidate-blocks 2 "
            "--pruned-levels 1 --prior-smoothing maximum --census-thresholds 3"),
      words("match a.png b.png -o o.pfm --method ssd --selection scanline --jump-penalty 2.5 "
            "--jump-limit none"),
      words("match a.png b.png -o o.pfm --selection symmetric --occlusion-penalty 7.5"),
      {"match", "a.png", "b.png", "-o", "o.pfm", "--prior", "quadratic", "--sigma-prior", "0.7"},
      {"match", "a.png", "b.png", "-o", "o.pfm", "--prior", "impulse", "--epsilon-prior", "0.001"},
      words("match a.png b.png c.png -o o.pfm --baselines=-1,2.5 --method local-stopping "
            "--certainty entropy --lambda 0.1 --cost truncated --truncation 12 --edge-weight 0.3 "
            "--edge-diffusion 5"),
      words("synth a.png b.png -o v%03d.png --view 0.1 --view=-0.3,0 --gamma alpha "
            "--no-intensity-matching --holes spread"),
      {"synth", "a.png", "b.png", "-o", "v.mp4", "--sweep", "-1:2:7", "--disparity-scale", "4"},
      words("run --left l --right r -o d --save preview,disparity --save views --view 0.5 "
            "--in-flight 3 --format npy"),
      {"run", "--left", "l", "--right", "r", "-o", "d", "--view", "0.5"},
      {"book", "pair", "-o", "d", "--pattern", "real-bars", "--noise", "0.25", "--seed", "7"},
      {"generate", "scene", "-o", "d", "--frames", "9", "--near", "33.5"},
      {"eval", "a.pfm", "b.pfm", "--scale", "4", "--ignore-border", "3"},
      words("reproject a.pfm --cloud c.ply --cloud-min-confidence 0.5 --principal-point 3,4.5 "
            "--calibration-unit cm --cloud-filled"),
      {"match"}};
  for (auto arguments : commands) {
    const bool two_words = arguments.front() == "generate" || arguments.front() == "book";
    arguments.push_back("--print-config");
    const ProcessResult first = succeeds(run_vantage(arguments));
    write_file(folder_ / "config.toml", first.out);
    Words again(arguments.begin(), arguments.begin() + (two_words ? 2 : 1));
    again.insert(again.end(), {"--config", folder_ / "config.toml", "--print-config"});
    const ProcessResult second = succeeds(run_vantage(again));
    EXPECT_EQ(second.out, first.out);
  }
}

/// The words of every command.
std::vector<Words> all_commands() {
  const std::string help = run_vantage({"help"}).out;
  const std::regex command("\n  ([a-z]+)( [a-z]+)? {2,}[A-Z]");
  std::vector<Words> commands;
  for (std::sregex_iterator it(help.begin(), help.end(), command), end; it != end; ++it) {
    commands.push_back({(*it)[1]});
    if ((*it)[2].matched) {
      commands.back().push_back((*it)[2].str().substr(1));
    }
  }
  return commands;
}

std::string output_of(Words words, const std::string& option) {
  words.push_back(option);
  const ProcessResult result = succeeds(run_vantage(words));
  return result.out;
}

/// Long names of the options in a help.
std::set<std::string> options_in(const std::string& help) {
  const std::regex option("(^|\n)  (-.,)?--([a-z-]+)");
  std::set<std::string> names;
  for (std::sregex_iterator it(help.begin(), help.end(), option), end; it != end; ++it) {
    names.insert((*it)[3]);
  }
  for (const char* name : {"help", "help-all", "config", "print-config"}) {
    EXPECT_EQ(names.erase(name), 1U) << name;
  }
  return names;
}

TEST_F(Config, HelpAllHasTheOptionsThatAreReadFromFiles) {
  int options = 0;
  const auto commands = all_commands();
  EXPECT_GT(commands.size(), 15U);
  for (const auto& words : commands) {
    const std::string help = output_of(words, "--help-all");
    const std::string config = output_of(words, "--print-config");
    std::set<std::string> names = options_in(help);
    EXPECT_EQ(names.erase("help-json"), 1U) << words.back();
    const std::regex key("\n(# )?([a-z-]+)( = | is not set\n)");
    for (std::sregex_iterator it(config.begin(), config.end(), key), end; it != end; ++it) {
      const std::string name = (*it)[2];
      std::string positional = name == "more" ? "OTHER" : name == "profiles" ? "PROFILE" : name;
      std::ranges::transform(positional, positional.begin(), ::toupper);
      ++options;
      EXPECT_TRUE(names.contains(name) || help.find("\n  " + positional) != std::string::npos)
          << words.back() << ' ' << name;
    }
    for (const std::string& name : names) {
      EXPECT_TRUE(config.find("\n" + name + " = ") != std::string::npos ||
                  config.find("\n# " + name + " is not set\n") != std::string::npos)
          << words.back() << ' ' << name;
    }
    EXPECT_FALSE(std::regex_search(help, std::regex("(^|\n) {30}[^\n]{71}"))) << words.back();
  }
  EXPECT_GT(options, 300);
}

TEST_F(Config, RowsOfCombinationsNameOptionsThatThereAre) {
  std::set<std::string> known;
  for (const char* const command : {"match", "run"}) {
    const auto help = nlohmann::json::parse(output_of({command}, "--help-json"));
    for (const nlohmann::json& option : help["options"]) {
      known.insert(option["name"]);
    }
  }
  const nlohmann::json rows = nlohmann::json::parse(output_of({}, "--help-json"))["combinations"];
  EXPECT_GT(rows.size(), 100U);
  for (const nlohmann::json& row : rows) {
    std::vector<std::string> texts = row[row.contains("not_with") ? "not_with" : "only_with"];
    texts.push_back(row["option"]);
    for (const std::string& text : texts) {
      std::smatch name;
      if (std::regex_search(text, name, std::regex("^--([a-z-]+)"))) {
        EXPECT_TRUE(known.contains(name[1])) << text;
      } else {
        EXPECT_THAT(text, testing::AnyOf(testing::StartsWith("a list of pairs with the column"),
                                         "a stream as input"));
      }
    }
  }
}

TEST_F(Config, HelpIsOneScreenOfOptionsThatHelpAllHas) {
  constexpr int kMaxLines = 45;
  constexpr std::size_t kMaxColumns = 100;
  for (const auto& words : all_commands()) {
    const std::string help = output_of(words, "--help");
    EXPECT_LE(std::ranges::count(help, '\n'), kMaxLines) << words.back();
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_LE(line.size(), kMaxColumns) << words.back() << ": " << line;
    }
    const std::set<std::string> all = options_in(output_of(words, "--help-all"));
    for (const std::string& name : options_in(help)) {
      EXPECT_TRUE(all.contains(name)) << words.back() << ' ' << name;
    }
  }
}

TEST_F(Config, ExamplesOfTheHelpAreAccepted) {
  const std::regex example("\n  vantage ([^\n]*)");
  int examples = 0;
  for (const auto& words : all_commands()) {
    const std::string help = output_of(words, "--help");
    for (std::sregex_iterator it(help.begin(), help.end(), example), end; it != end; ++it) {
      ++examples;
      std::istringstream text((*it)[1]);
      const Words arguments(std::istream_iterator<std::string>(text), {});
      output_of(arguments, "--print-config");
    }
  }
  EXPECT_GT(examples, 40);
}

using InputConfig = Config;

TEST_F(InputConfig, CommandLineOverridesFileOverridesDefault) {
  write_file(folder_ / "config.toml",
             "window = 5\ndisparities = \"0:9\"\nraw = true\nthreads = 2\ncross-check = 2\n");
  const ProcessResult result =
      succeeds(run_vantage({"match", "--config", folder_ / "config.toml", "--window", "7",
                            "--raw=false", "--threads", "auto", "--print-config"}));
  EXPECT_THAT(result.out, HasSubstr("\nwindow = 7\n"));
  EXPECT_THAT(result.out, HasSubstr("\ndisparities = '0:9'\n"));
  EXPECT_THAT(result.out, HasSubstr("\nraw = false\n"));
  EXPECT_THAT(result.out, HasSubstr("\nthreads = 'auto'\n"));
  EXPECT_THAT(result.out, HasSubstr("\ncross-check = 2.0\n"));
  EXPECT_THAT(result.out, HasSubstr("\nsubpixel = 'auto'  # 'parabola'\n"));
}

TEST_F(InputConfig, AFileCanHoldTheWholeJob) {
  succeeds(match(folder_ / "a.pfm", {"--mu", "0.4"}));
  write_file(folder_ / "job.toml", "left = '" + left_ + "'\nright = '" + right_ + "'\noutput = '" +
                                       folder_ / "b.pfm" + "'\nmu = 0.4\ndisparities = '0:9'\n");
  succeeds(run_vantage({"match", "--config", folder_ / "job.toml"}));
  EXPECT_EQ(read_file(folder_ / "a.pfm"), read_file(folder_ / "b.pfm"));
}

TEST_F(InputConfig, BadFilesAreOneLine) {
  struct Case {
    std::string content;
    std::string says;
  };
  const std::vector<Case> cases = {
      {"windoe = 5\n", "unknown key 'windoe', the nearest known one is 'window'"},
      {"window = \"wide\"\n", "window is 'wide', expected a whole number"},
      {"window = 5.5\n", "window is 5.5, expected a whole number"},
      {"window = [5, 7]\n", "window is [5,7], expected a whole number"},
      {"raw = 1\n", "raw is 1, expected true or false"},
      {"cross-check = inf\n", "cross-check is inf, expected"},
      {"left = 3\n", "left is 3, expected a text"},
      {"window = 99999999999\n", "expected a whole number"},
      {"[match]\nwindow = 5\n", "'match' is a table"},
      {"window = = 5\n", ":1: not TOML"},
      {deep_key(40'000) + " = 5\n", "a key has more than 64 parts"},
      {"[" + deep_key(65) + "]\n", "a key has more than 64 parts"},
      {"# " + deep_key(99) + "\nleft = '" + deep_key(99) + "'\nwindoe = 1\n", "'windoe'"},
      {std::string("\0\xff\xfe", 3), "not TOML"}};
  for (const Case& bad : cases) {
    write_file(folder_ / "bad.toml", bad.content);
    const ProcessResult result = match(folder_ / "out.pfm", {"--config", folder_ / "bad.toml"});
    expect_one_line(result, 2, "match", "bad.toml");
    EXPECT_THAT(result.err, HasSubstr(bad.says));
  }
  for (const std::string& missing : {folder_ / "none.toml", folder_.path().string()}) {
    expect_one_line(match(folder_ / "out.pfm", {"--config", missing}), 1, "match");
  }
  write_file(folder_ / "empty.toml", "");
  succeeds(match(folder_ / "out.pfm", {"--config", folder_ / "empty.toml"}));
}

}  // namespace vantage::config_test
