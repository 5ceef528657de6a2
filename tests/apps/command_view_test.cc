#include <limits>
#include <regex>
#include <variant>

#include "tests/apps/sampling.h"
#include "tests/decoded_base64.h"

namespace vantage::command_view_test {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// The text between the first `begin` and the `end` that follows; what() of it is the test's.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin);
  if (from == std::string::npos) {
    return {};
  }
  const std::size_t to = text.find(end, from + begin.size());
  return text.substr(from + begin.size(), to - from - begin.size());
}

class ViewCommand : public PairTest {
 protected:
  ViewCommand() {
    outputs_ = folder_ / "out";
    fs::create_directory(outputs_);
    write_maps();
  }

  void write_maps() const {
    write_disparity(left_map_, pair_.left_disparity.view());
    write_disparity(right_map_, pair_.right_disparity.view());
  }

  [[nodiscard]] ProcessResult view(const Words& more) const {
    return run_vantage(joined({"view", left_, right_, "--quiet"}, more));
  }
  [[nodiscard]] ProcessResult view_from_maps(Words more) const {
    more.insert(more.end(), {"--left-disparity", left_map_, "--right-disparity", right_map_});
    return view(more);
  }
  /// The text of the page, which must come to be.
  [[nodiscard]] std::string page(const Words& more = {}) const {
    succeeds(view_from_maps(joined({"-o", outputs_ + "/page.html"}, more)));
    return read_file(outputs_ + "/page.html");
  }

  static nlohmann::json scene_of(const std::string& page) {
    return nlohmann::json::parse(between(page, "id=\"scene\">", "</script>"));
  }
  /// The numbers and pictures of the pair.
  static nlohmann::json frame_of(const std::string& page) {
    return nlohmann::json::parse(between(page, "Film.deliver(0, ", ");\n"));
  }
  [[nodiscard]] Image<std::uint8_t> picture_in(const std::string& page,
                                               const std::string& name) const {
    const auto bytes = test::decoded_base64(frame_of(page)[name].get<std::string>());
    const std::string file = folder_ / (name + ".png");
    write_file(file, {bytes.begin(), bytes.end()});
    return std::move(std::get<Image<std::uint8_t>>(read_photograph(file).pixels));
  }
  [[nodiscard]] DisparityMap map_in(const std::string& page, const std::string& name) const {
    const Image<std::uint8_t> numbers = picture_in(page, name);
    const nlohmann::json frame = frame_of(page);
    const double smallest = frame["disparity"]["smallest"];
    const double step = frame["disparity"]["step"];
    DisparityMap map(numbers.width(), numbers.height());
    for (int y = 0; y < map.height(); ++y) {
      for (int x = 0; x < map.width(); ++x) {
        const int number = 256 * numbers.at(x, y, 0) + numbers.at(x, y, 1);
        map.at(x, y) = number == 0 ? kUnknown : static_cast<float>(smallest + (number - 1) * step);
      }
    }
    return map;
  }

  static double largest_difference(const DisparityMap& a, const DisparityMap& b) {
    double largest = 0;
    for (int y = 0; y < a.height(); ++y) {
      for (int x = 0; x < a.width(); ++x) {
        const bool known = std::isfinite(b.at(x, y));
        EXPECT_EQ(std::isfinite(a.at(x, y)), known) << x << ' ' << y;
        if (known) {
          largest = std::max<double>(largest, std::abs(a.at(x, y) - b.at(x, y)));
        }
      }
    }
    return largest;
  }

  std::string left_map_ = folder_ / "left.pfm";
  std::string right_map_ = folder_ / "right.npy";
  std::string outputs_;
};

TEST_F(ViewCommand, HoldsThePhotographsAndTheMaps) {
  pair_.left_disparity.at(3, 4) = kUnknown;
  pair_.right_disparity.at(70, 52) = kUnknown;
  write_maps();
  const std::string text = page();
  for (const auto& [name, photograph] :
       {std::pair("left", &pair_.left), std::pair("right", &pair_.right)}) {
    const Image<std::uint8_t> picture = picture_in(text, name);
    const auto& expected = std::get<Image<std::uint8_t>>(photograph->pixels);
    ASSERT_EQ(picture.width(), expected.width());
    ASSERT_EQ(picture.height(), expected.height());
    int different = 0;
    for (int y = 0; y < expected.height(); ++y) {
      for (int x = 0; x < expected.width(); ++x) {
        different += picture.at(x, y) == expected.at(x, y) ? 0 : 1;
      }
    }
    EXPECT_EQ(different, 0) << name;
  }
  // Whole disparities are numbers of steps, so nothing is rounded.
  EXPECT_EQ(largest_difference(map_in(text, "leftMap"), pair_.left_disparity), 0);
  EXPECT_EQ(largest_difference(map_in(text, "rightMap"), pair_.right_disparity), 0);
}

TEST_F(ViewCommand, StoresAnyDisparitiesAsFinelyAsTheirRangeAllows) {
  const auto fill = [&](DisparityMap& map, float smallest, float largest) {
    for (int y = 0; y < map.height(); ++y) {
      for (int x = 0; x < map.width(); ++x) {
        map.at(x, y) =
            smallest + (largest - smallest) * static_cast<float>(x) / static_cast<float>(70);
      }
    }
  };
  const auto step_and_error = [&](float smallest, float largest) {
    fill(pair_.left_disparity, smallest, largest);
    fill(pair_.right_disparity, smallest, largest);
    write_maps();
    const std::string text = page();
    return std::pair(frame_of(text)["disparity"]["step"].get<double>(),
                     largest_difference(map_in(text, "leftMap"), pair_.left_disparity));
  };
  for (const auto& [smallest, largest, expected_step] :
       {std::tuple(-3.3F, 12.6F, 1.0 / 4096), std::tuple(7.7F, 7.7F, 1.0 / 4096),
        std::tuple(-0.1F, 99.9F, 1.0 / 512), std::tuple(100.0F, 4195.0F, 1.0 / 16)}) {
    const auto [step, error] = step_and_error(smallest, largest);
    EXPECT_EQ(step, expected_step);
    EXPECT_LE(error, 0.5 * step + 1e-6 * largest);
  }
}

TEST_F(ViewCommand, IsOneFileThatNamesNoOther) {
  const std::string text = page();
  EXPECT_THAT(text, HasSubstr("default-src 'none'"));
  EXPECT_THAT(text, HasSubstr("<title>left.png and right.png – Vantage</title>"));
  EXPECT_THAT(text, Not(HasSubstr("{{")));
  EXPECT_THAT(text, Not(HasSubstr("http:")));
  EXPECT_THAT(text, Not(HasSubstr("https:")));
  EXPECT_THAT(text, Not(HasSubstr("//fonts")));
  EXPECT_THAT(text, Not(HasSubstr("<link")));
  EXPECT_THAT(text, Not(HasSubstr("import ")));
  // Sliders say what they do, not XS and YS.
  EXPECT_THAT(text, AllOf(HasSubstr(">sideways <input"), HasSubstr(">up and down <input")));
  const std::regex source("(src|href)=\"([^\"]{0,10})");
  int sources = 0;
  for (auto found = std::sregex_iterator(text.begin(), text.end(), source);
       found != std::sregex_iterator(); ++found, ++sources) {
    EXPECT_EQ((*found)[2], "data:image");
  }
  EXPECT_EQ(sources, 1);  // the palette
}

TEST_F(ViewCommand, OptionsReachThePage) {
  const nlohmann::json usual = scene_of(page());
  EXPECT_EQ(usual["width"], 71);
  EXPECT_EQ(usual["height"], 53);
  EXPECT_THAT(usual["rangeX"], ElementsAre(-0.5, 1.5));
  EXPECT_THAT(usual["rangeY"], ElementsAre(-0.2, 0.2));
  EXPECT_TRUE(usual["gamma"].is_null());
  EXPECT_EQ(usual["holes"], "interpolate");
  EXPECT_EQ(usual["softEdges"], true);
  EXPECT_EQ(usual["gradientLimit"], 1.0);
  EXPECT_NEAR(frame_of(page())["intensity"]["gain"][0], 1.0, 0.1);

  const std::string text =
      page(words("--range=0:1 --vertical-range=0:0 --holes spread --gradient-limit 2.5 "
                 "--no-intensity-matching"));
  const nlohmann::json other = scene_of(text);
  EXPECT_THAT(other["rangeX"], ElementsAre(0.0, 1.0));
  EXPECT_THAT(other["rangeY"], ElementsAre(0.0, 0.0));
  EXPECT_EQ(scene_of(page({"--gamma", "0.25"}))["gamma"], 0.25);
  EXPECT_EQ(other["holes"], "spread");
  EXPECT_EQ(other["gradientLimit"], 2.5);
  const nlohmann::json intensity = frame_of(text)["intensity"];
  EXPECT_THAT(intensity["gain"], ElementsAre(1.0, 1.0, 1.0));
  EXPECT_THAT(intensity["offset"], ElementsAre(0.0, 0.0, 0.0));

  const nlohmann::json jpeg = frame_of(page({"--images", "jpeg"}));
  EXPECT_EQ(jpeg["type"], "image/jpeg");
  EXPECT_EQ(jpeg["left"].get<std::string>().substr(0, 4), "/9j/");
}

TEST_F(ViewCommand, NamesOfFilesCannotChangeThePage) {
  const std::string name = folder_ / "a\"<script>&{{scene}}.png";
  fs::rename(left_, name);
  left_ = name;
  const std::string text = page();
  EXPECT_THAT(text, HasSubstr("<title>a&quot;&lt;script&gt;&amp;{{scene}}.png and right.png"));
  EXPECT_EQ(scene_of(text)["width"], 71);
}

TEST_F(ViewCommand, DeepAndTransparentPhotographsBecomeEightBitColours) {
  Image<std::uint16_t> deep(71, 53, 4);
  for (int y = 0; y < 53; ++y) {
    for (int x = 0; x < 71; ++x) {
      deep.at(x, y, 0) = static_cast<std::uint16_t>(257 * x);
      deep.at(x, y, 1) = static_cast<std::uint16_t>(257 * y + 128);
      deep.at(x, y, 2) = 65535;
      deep.at(x, y, 3) = 0;
    }
  }
  const Photograph photograph{std::move(deep)};
  write_photograph(left_, photograph);
  write_photograph(right_, photograph);
  const Image<std::uint8_t> picture = picture_in(page(), "left");
  EXPECT_EQ(picture.channels(), 3);
  EXPECT_EQ(picture.at(70, 0, 0), 70);
  EXPECT_EQ(picture.at(0, 52, 1), 52);
  EXPECT_EQ(picture.at(5, 5, 2), 255);
}

TEST_F(ViewCommand, MatchesThePairWithoutMaps) {
  succeeds(view({"-o", outputs_ + "/p.html", "--disparities", "0:9", "--method", "ssd", "--report",
                 folder_ / "r.json"}));
  const auto report = read_json(folder_ / "r.json");
  EXPECT_EQ(report["cells"], 71.0 * 53 * 10 * 2);
  EXPECT_EQ(report["results"]["page_bytes"], fs::file_size(outputs_ + "/p.html"));
  const DisparityMap map = map_in(read_file(outputs_ + "/p.html"), "leftMap");
  EXPECT_LT(bad_share(map, pair_.left_disparity, pair_.left_occluded), 0.05);
}

using InputViewCommand = ViewCommand;

TEST_F(InputViewCommand, WrongUsageIsOneLineAndExit2) {
  const std::string out = outputs_ + "/p.html";
  const std::vector<Refusal> refusals = {
      {{}, "--output is"},
      {{"-o", outputs_ + "/p.png"}, "ends in .html"},
      {{"-o", out, "--range", "1"}, "--range is '1'"},
      {{"-o", out, "--range", "a:b"}, "--range is 'a:b'"},
      {{"-o", out, "--range", "1:0"}, "the smaller one first"},
      {{"-o", out, "--range", "0:17"}, "within ±16"},
      {{"-o", out, "--vertical-range", "0.1:-0.1"}, "--vertical-range is 0.1:-0.1"},
      {{"-o", out, "--images", "gif"}, "--images is 'gif'"},
      {{"-o", out, "--gamma", "2"}, "gamma"},
      {{"-o", out, "--warp", "forward"}, "unknown option '--warp'"},
      {{"-o", out, "--left-disparity", left_map_}, "--right-disparity is missing"},
      {{"-o", out, "--left-disparity", left_map_, "--right-disparity", right_map_, "--window", "5"},
       "--window has no effect"}};
  expect_refusals("view", folder_.path(), refusals,
                  [&](const Words& words) { return view(words); });
}

TEST_F(InputViewCommand, FoldersAreThoseOfRunsWithBothMaps) {
  const std::string pairs = folder_ / "pairs";
  for (const auto& [side, image] : {std::pair("/left", left_), std::pair("/right", right_)}) {
    fs::create_directories(pairs + side);
    fs::copy(image, pairs + side + "/0.png");
  }
  const auto run = [&](const std::string& save, const std::string& name) {
    succeeds(run_vantage({"run", "--left", pairs + "/left", "--right", pairs + "/right", "--save",
                          save, "--disparities", "0:9", "-o", folder_ / name, "--quiet"}));
    return folder_ / name;
  };
  const auto refuse = [&](const Words& words, int code, const std::string& says) {
    const Words page = {"view", "-o", outputs_ + "/p.html"};
    expect_one_line(run_vantage(joined(page, words)), code, "view", says);
    EXPECT_THAT(files_below(outputs_), IsEmpty());
  };
  const std::string whole = run("disparity,right-disparity", "whole");
  refuse({pairs}, 1, "holds no run");
  refuse({run("disparity", "half")}, 1, "--save disparity,right-disparity");
  refuse({whole, "--preset", "quality"}, 2, "--preset has no effect with the folder of a run");
  write_photograph(pairs + "/left/0.png", read_photograph(right_));
  refuse({whole}, 1, "is of another input");
}

TEST_F(InputViewCommand, InputsThatDoNotFitAreAnErrorAndLeaveNothing) {
  const auto expect_error = [&](const std::string& says) {
    expect_one_line(view_from_maps({"-o", outputs_ + "/p.html"}), 1, "view", says);
    EXPECT_THAT(files_below(outputs_), IsEmpty());
  };
  pair_.left_disparity.at(0, 0) = 5000;
  write_maps();
  expect_error("expected at most 4095");
  DisparityMap small(3, 3);
  small.fill(1);
  write_disparity(left_map_, small.view());
  expect_error("left disparity map is 3×3, expected 71×53");
}

}  // namespace vantage::command_view_test
