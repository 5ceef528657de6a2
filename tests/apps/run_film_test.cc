// Films: depth videos, and the report on comfort against exact truth.

#include "engine/image/stereo_packing.h"
#include "engine/io/files/temporary_name.h"
#include "engine/io/video/video_io.h"
#include "tests/apps/sampling.h"

namespace vantage::run_film_test {

constexpr int kWidth = 320;
constexpr int kHeight = 180;
constexpr int kShotFrames = 3;

/// A rectangle with a texture of its own; its disparity may grow from row to row.
struct Plane {
  double left_x = 0;  ///< in the left image
  double right_x = 0;
  double top_y = 0;
  double bottom_y = 0;
  double disparity_px = 0;  ///< in row 0
  double per_row_px = 0;

  [[nodiscard]] double disparity(int y) const { return disparity_px + per_row_px * y; }
  [[nodiscard]] bool covers(double x, int y) const {
    return x >= left_x && x < right_x && y >= top_y && y < bottom_y;
  }
};

/// Sums of waves: exact between pixels, too.
double level(int texture, int channel, double x, double y) {
  double sum = 0;
  for (int wave = 1; wave <= 6; ++wave) {
    const double angle = 2.4 * wave + 1.1 * texture;
    const double period = 4.3 + 2.9 * wave + 0.37 * (texture % 7);
    sum += std::sin((std::cos(angle) * x + std::sin(angle) * y) * 6.2832 / period + 0.9 * channel +
                    1.7 * texture + wave);
  }
  return 128 + 55 * std::sin(2.1 * texture + 0.5 * channel) + 11 * sum;
}

/// The nearest plane at column x of the left (direction 0) or right image (1), and the column of
/// the left image that shows the same point.
struct Hit {
  int plane = 0;
  double left_x = 0;
};
Hit hit_at(const std::vector<Plane>& planes, double x, int y, int direction) {
  Hit best;
  double nearest = -1e9;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const double d = planes[i].disparity(y);
    const double left_x = x + direction * d;
    if (planes[i].covers(left_x, y) && d > nearest) {
      nearest = d;
      best = {static_cast<int>(i), left_x};
    }
  }
  return best;
}

Photograph picture_of(const std::vector<Plane>& planes, int direction, double row_offset,
                      int texture, int darker) {
  Image<std::uint8_t> image(kWidth, kHeight, 3);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Hit hit = hit_at(planes, x, y, direction);
      for (int c = 0; c < 3; ++c) {
        const double value = level(texture + hit.plane, c, hit.left_x, y + row_offset) - darker;
        image.at(x, y, c) = static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
      }
    }
  }
  return Photograph{std::move(image)};
}

/// What is special about a shot.
struct PlannedShot {
  std::vector<Plane> planes;
  double vertical_px = 0;
  bool exchanged = false;
  int darker_right = 0;            ///< grey levels
  std::array<double, 2> cut = {};  ///< rows that are cut at the left and right border, per cent
};

/// A slanted background, something in front of the screen, something behind it.
std::vector<Plane> planes_of(double add_px) {
  return {{-99, kWidth + 99, 0, kHeight, -5.3 + add_px, 0.01},
          {60, 150, 40, 140, 1.4 + add_px, 0},
          {200, 260, 30, 120, -2.6 + add_px, 0}};
}

/// Disparities of the pixels that both images show.
void add_truth(const std::vector<Plane>& planes, std::vector<double>& disparities_px) {
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int plane = hit_at(planes, x, y, 0).plane;
      const double d = planes[plane].disparity(y);
      if (x - d >= 0 && x - d <= kWidth - 1 && hit_at(planes, x - d, y, 1).plane == plane) {
        disparities_px.push_back(d);
      }
    }
  }
}

double percentile(std::vector<double> values, double share) {
  const auto place =
      static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  std::ranges::nth_element(values, values.begin() + place);
  return values[place];
}

/// Writes the frames of a shot as packed pictures and returns their disparities. What is in front
/// of the background moves.
std::vector<double> write_shot(const PlannedShot& shot, int number, const fs::path& folder) {
  std::vector<double> truth_px;
  for (int frame = 0; frame < kShotFrames; ++frame) {
    std::vector<Plane> planes = shot.planes;
    for (std::size_t i = 1; i < planes.size(); ++i) {
      planes[i].top_y += 2 * frame;
      planes[i].bottom_y += 2 * frame;
    }
    Photograph left = picture_of(planes, 0, 0, 10 * number, 0);
    Photograph right = picture_of(planes, 1, shot.vertical_px, 10 * number, shot.darker_right);
    if (shot.exchanged) {
      std::swap(left, right);
    }
    Photograph packed;
    pack_stereo(left, right, {}, packed);
    write_photograph(folder / frame_file(number * kShotFrames + frame), packed);
    add_truth(planes, truth_px);
  }
  return truth_px;
}

std::string verdict_of(const nlohmann::json& shot, const std::string& name) {
  for (const nlohmann::json& finding : shot["findings"]) {
    if (finding["name"] == name) {
      return finding["verdict"];
    }
  }
  return "none";
}

TEST(RunFilm, ComfortAgainstTruth) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "film");
  std::vector<Plane> cut_left = planes_of(0);
  cut_left[1] = {-50, 60, 50, 140, 5.6, 0};
  std::vector<Plane> cut_right = planes_of(0);
  cut_right[2] = {250, 400, 30, 120, 6.3, 0};
  const std::vector<PlannedShot> plan = {
      {.planes = planes_of(0)},
      {.planes = cut_left, .cut = {50, 0}},
      {.planes = cut_right, .cut = {0, 50}},
      {.planes = planes_of(0), .vertical_px = 2},
      {.planes = planes_of(-1), .exchanged = true, .cut = {100, 100}},  // near is far
      {.planes = planes_of(0), .darker_right = 20},
      {.planes = planes_of(-10)}};
  std::vector<std::vector<double>> truth_px;
  for (const PlannedShot& shot : plan) {
    truth_px.push_back(write_shot(shot, static_cast<int>(truth_px.size()), folder / "film"));
  }
  const ProcessResult result =
      succeeds(run_vantage({"run", "--stereo", folder / "film", "--packing", "sbsl", "--save",
                            "comfort,depth-video", "--depth-range", "shot", "-o", folder / "out"}));
  EXPECT_THAT(result.err, HasSubstr("comfort: unsafe"));
  const nlohmann::json report = read_json(folder / "out/comfort.json");
  ASSERT_EQ(report["shots"].size(), plan.size()) << report["shots"].dump(1);
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const nlohmann::json& shot = report["shots"][i];
    SCOPED_TRACE(std::to_string(i) + " " + shot.dump(1));
    EXPECT_EQ(shot["first_frame"], static_cast<int>(i) * kShotFrames);
    EXPECT_EQ(shot["frames_measured"], kShotFrames);
    EXPECT_EQ(shot["exchanged"], plan[i].exchanged);
    EXPECT_EQ(verdict_of(shot, "vertical error"), plan[i].vertical_px != 0 ? "unsafe" : "safe");
    EXPECT_EQ(verdict_of(shot, "colour"), plan[i].darker_right != 0 ? "unsafe" : "safe");
    for (const auto& [name, side] : {std::pair("left_border", 0U), {"right_border", 1U}}) {
      EXPECT_NEAR(shot[name]["worst_rows_percent"].get<double>(), plan[i].cut[side], 2) << name;
    }
    if (plan[i].vertical_px != 0) {
      EXPECT_NEAR(shot["vertical_offset_px"].get<double>(), plan[i].vertical_px, 0.1);
      continue;  // matches are less exact there
    }
    for (const auto& [name, share] :
         {std::pair("1", 0.01), {"5", 0.05}, {"50", 0.5}, {"95", 0.95}, {"99", 0.99}}) {
      EXPECT_NEAR(
          shot["percentiles_px"][name].get<double>(),
          plan[i].exchanged ? -percentile(truth_px[i], 1 - share) : percentile(truth_px[i], share),
          0.25)
          << name;
    }
  }
  // The last shot is too far behind the screen, its near end included: it can come forward.
  EXPECT_NEAR(report["shots"][6]["advised_shift_px"].get<double>(), 15.2 - 0.02 * kWidth, 0.25);
  EXPECT_NEAR(report["shots"][6]["jump_px"].get<double>(), -10, 0.25);
  const std::string page = read_file(folder / "out/comfort.html");
  for (const char* part : {"<svg", "BSkyB", "zone of comfort", "unsafe", "advised"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
  // Each shot has a scale of its own, which no disparity exceeds.
  const nlohmann::json scale = read_json(folder / "out/depth-video.json");
  ASSERT_EQ(scale["shots"].size(), plan.size());
  EXPECT_LT(scale["shots"][6]["min_px"], -15.2);
  EXPECT_LT(scale["shots"][6]["max_px"], 0);
  EXPECT_GT(scale["shots"][0]["max_px"], 1.4);
}

using RunFilms = RunTest;

/// Every level is the disparity of the map, rounded.
TEST_F(RunFilms, DepthVideosHoldTheMaps) {
  succeeds(
      run(folder_ / "out",
          words("--save disparity,depth-video --frames 0-6 --chunk-frames 5 --fps 24000/1001")));
  const nlohmann::json scale = read_json(folder_ / "out/depth-video.json");
  EXPECT_EQ(scale["bits"], 16);
  const float min = scale["shots"][0]["min_px"];
  const float max = scale["shots"][0]["max_px"];
  EXPECT_EQ(min, 0);
  EXPECT_EQ(max, 9);
  VideoReader reader(folder_ / "out/depth-video.mkv");
  EXPECT_EQ(reader.frame_count(), 7);
  EXPECT_EQ(reader.frame_rate(), (FrameRate{24000, 1001}));
  for (int frame = 0; frame < 7; ++frame) {
    Photograph picture;
    ASSERT_TRUE(reader.read(picture));
    EXPECT_EQ(reader.frames_missing(), 0);
    const auto& levels = std::get<Image<std::uint16_t>>(picture.pixels);
    const DisparityMap map =
        read_disparity(folder_ / ("out/disparity/" + frame_file(frame, "pfm")));
    int wrong = 0;
    for (int y = 0; y < RunTest::kHeight; ++y) {
      for (int x = 0; x < RunTest::kWidth; ++x) {
        const double level = 1 + (map.at(x, y) - min) / (max - min) * 65534.0;
        wrong += std::abs(levels.at(x, y, 0) - level) > 0.6 ? 1 : 0;
      }
    }
    EXPECT_EQ(wrong, 0) << frame;
  }
}

TEST_F(RunFilms, OtherCodecs) {
  for (const auto& [codec, file, tolerance_px] : {std::tuple("ffv1-10", "depth-video.mkv", 0.006),
                                                  {"hevc-10", "depth-video.mp4", 0.3},
                                                  {"prores-10", "depth-video.mov", 0.1}}) {
    SCOPED_TRACE(codec);
    const std::string out = folder_ / codec;
    const ProcessResult result =
        run(out, {"--save", "disparity,depth-video", "--frames", "0-5", "--chunk-frames", "4",
                  "--depth-codec", codec, "--depth-range", "-3:12"});
    if (result.exit_code != 0) {
      EXPECT_THAT(result.err, HasSubstr("built without the encoder"));
      continue;
    }
    VideoReader reader(out + "/" + file);
    ASSERT_EQ(reader.frame_count(), 6);
    Photograph picture;
    double sum = 0;
    for (int frame = 0; frame < 6; ++frame) {
      ASSERT_TRUE(reader.read(picture));
      const DisparityMap map = read_disparity(out + "/disparity/" + frame_file(frame, "pfm"));
      std::visit(
          [&](const auto& levels) {
            const double white = sizeof(*levels.row(0)) == 2 ? 65535 : 255;
            for (int y = 0; y < RunTest::kHeight; ++y) {
              for (int x = 0; x < RunTest::kWidth; ++x) {
                const double d = -3 + 15 * static_cast<double>(levels.at(x, y, 0)) / white;
                sum += std::abs(d - static_cast<double>(map.at(x, y))) /
                       (6 * RunTest::kWidth * RunTest::kHeight);
              }
            }
          },
          picture.pixels);
    }
    EXPECT_LT(sum, 2 * tolerance_px);
  }
}

TEST_F(RunFilms, PartsAndInterruptionsGiveTheSameBytes) {
  const Words outputs = {"--save", "depth-video,comfort", "--chunk-frames", "5"};
  const FolderContent expected = undisturbed(outputs);
  ASSERT_TRUE(expected.contains("comfort.json"));
  ASSERT_TRUE(expected.contains("depth-video.json"));
  ASSERT_TRUE(expected.contains("depth-video.mkv"));
  const std::string parts = folder_ / "parts";
  for (const char* shard : {"2/3", "1/3", "3/3"}) {
    succeeds(run(parts, joined(outputs, {"--shard", shard})));
  }
  succeeds(run_vantage({"merge", parts}));
  EXPECT_TRUE(same_files(results_in(parts), expected));
  const std::string resumed = folder_ / "resumed";
  succeeds(run(resumed, joined(outputs, {"--frames", "0-9"})));
  fs::remove(resumed + "/depth-video.mkv");
  fs::remove(resumed + "/comfort.html");
  succeeds(run(resumed, joined(outputs, {"--resume"})));
  EXPECT_TRUE(same_files(results_in(resumed), expected));
  // What a killed process leaves goes when the run is resumed, whatever is left to do.
  for (const char* name : {"comfort.json", "comfort.html", "depth-video.json", "depth-video.mkv"}) {
    write_file(resumed + "/" + temporary_name(name, 7), "");
  }
  succeeds(run_vantage({"run", "-o", resumed, "--resume"}));
  EXPECT_TRUE(same_files(results_in(resumed), expected));
  // The report alone.
  succeeds(run(folder_ / "alone", {"--save", "comfort"}));
  EXPECT_EQ(read_file(folder_ / "alone/comfort.json"), expected.at("comfort.json"));
}

TEST_F(RunFilms, ReportsAreVerifiedAndNameTheInputAsAtTheStart) {
  const std::string out = folder_ / "out";
  succeeds(run_vantage({"run", "--left", fs::relative(left_), "--right", right_, "--frames", "0-2",
                        "--disparities=0:9", "--method", "ssd", "--save", "depth-video,comfort",
                        "-o", out}));
  const FolderContent expected = results_in(out);
  succeeds(run_vantage({"verify", out}));
  write_file(out + "/comfort.json", expected.at("comfort.json") + " ");
  fs::remove(out + "/depth-video.json");
  const ProcessResult damaged = run_vantage({"verify", out});
  EXPECT_EQ(damaged.exit_code, 1);
  EXPECT_THAT(damaged.out, HasSubstr("comfort.json has "));
  EXPECT_THAT(damaged.out, HasSubstr("depth-video.json is missing"));
  succeeds(run_vantage({"run", "-o", out, "--resume"}));
  EXPECT_TRUE(same_files(results_in(out), expected));
  succeeds(run_vantage({"verify", out}));
}

TEST_F(RunFilms, WrongOptions) {
  const std::vector<Refusal> refusals = {
      {{"--depth-range", "shot"}, "--depth-range has no effect"},
      {{"--depth-codec", "ffv1-10"}, "--depth-codec has no effect"},
      {{"--save", "depth-video", "--depth-range", "5:5"}, "depth-range is 5:5, expected MIN:MAX"},
      {{"--save", "depth-video", "--depth-range", "near"}, "--depth-range is 'near'"},
      {{"--save", "comfort", "--search-range", "shot"}, "search-range is shot, expected film"},
      {{"--save", "comfort", "--video", "comfort"}, "video has comfort"}};
  expect_refusals("run", folder_.path(), refusals,
                  [&](const Words& words) { return run(folder_ / "wrong", words); });
}

}  // namespace vantage::run_film_test
