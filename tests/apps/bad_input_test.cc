#include "tests/apps/pair_fixture.h"
#include "tests/test_paths.h"

namespace vantage::bad_input_test {

using InputBadFiles = PairTest;

/// Bytes of a 2×1 float image whose first pixel is `value`.
std::string pfm_of(const std::string& header, float value) {
  std::string bytes = header;
  const float pixels[2] = {value, 0.5F};
  bytes.append(reinterpret_cast<const char*>(pixels), sizeof pixels);
  return bytes;
}

TEST_F(InputBadFiles, ImagesThatCannotBeMatched) {
  const std::string png = read_file(left_);
  const float nan = std::nanf("");
  const float infinity = HUGE_VALF;
  std::string zero_size = png;
  zero_size.replace(16, 8, std::string(8, '\0'));
  std::string huge = png;
  huge.replace(16, 8, std::string("\x7f\xff\xff\xff\x7f\xff\xff\xff", 8));
  const std::vector<std::pair<std::string, std::string>> files = {
      {"empty.png", ""},
      {"half.png", png.substr(0, png.size() / 2)},
      {"header.png", png.substr(0, 33)},
      {"zero.png", zero_size},
      {"huge.png", huge},
      {"text.png", "This is no picture.\n"},
      {"nan.pfm", pfm_of("Pf\n1 1\n-1.0\n", nan)},
      {"inf.pfm", pfm_of("Pf\n2 1\n-1.0\n", infinity)},
      {"short.pfm", pfm_of("Pf\n200 100\n-1.0\n", 0)},
      {"zero.pfm", pfm_of("Pf\n0 0\n-1.0\n", 0)},
      {"huge.pfm", pfm_of("Pf\n2000000000 2000000000\n-1.0\n", 0)},
      {"negative.pfm", pfm_of("Pf\n-2 -1\n-1.0\n", 0)}};
  for (const auto& [name, content] : files) {
    const std::string file = folder_ / name;
    write_file(file, content);
    const auto before = files_below(folder_.path());
    expect_one_line(run_vantage({"match", file, file, "-o", folder_ / "out.pfm", "--preview",
                                 folder_ / "preview.png", "--report", folder_ / "report.json"}),
                    1, "match", name);
    EXPECT_EQ(files_below(folder_.path()), before);
  }
}

TEST_F(InputBadFiles, JsonNestedToAnyDepth) {
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  write_file(folder_ / "poses.json", "{\"view\":" + deep + "}");
  fs::create_directories(folder_ / "run/.vantage");
  write_file(folder_ / "run/.vantage/run.json", "{\"format\":" + deep + "}");
  write_file(folder_ / "run/scene.json", "{\"format\":" + deep + "}");
  const std::vector<std::pair<Words, int>> cases = {
      {{"synth", left_, right_, "--disparities=0:9", "--pose", folder_ / "poses.json", "-o",
        folder_ / "view.png"},
       2},
      {{"merge", folder_ / "run"}, 1},
      {{"scene info", folder_ / "run"}, 1}};
  for (const auto& [arguments, exit_code] : cases) {
    Words words = arguments;
    if (words.front() == "scene info") {
      words.front() = "scene";
      words.insert(words.begin() + 1, "info");
    }
    const ProcessResult result = run_vantage(words);
    EXPECT_EQ(result.exit_code, exit_code) << arguments.front();
    EXPECT_TRUE(is_one_line(result, arguments.front())) << result.err;
    EXPECT_THAT(result.err, HasSubstr("nested too deep"));
  }
  write_file(folder_ / "tuning.json", "{\"kind\":" + deep + "}");
  const ProcessResult result =
      succeeds(match(folder_ / "map.pfm", {"--tuning", folder_ / "tuning.json", "--method=ssd"}));
  EXPECT_THAT(result.err, HasSubstr("nested too deep"));
}

/// libpng and libjpeg would print lines of their own.
TEST_F(InputBadFiles, DamagedPixelsAndOddNamesAreOneLine) {
  write_photograph(folder_ / "whole.jpg", pair_.left);
  std::string jpeg = read_file(folder_ / "whole.jpg");
  jpeg.erase(jpeg.size() / 2, jpeg.size() / 4);
  const std::string odd = "odd\n\x1B[31m.jpg";
  write_file(folder_ / odd, jpeg);
  expect_one_line(
      run_vantage({"match", folder_ / odd, right_, "--disparities=0:9", "-o", folder_ / "map.pfm"}),
      1, "match", "odd\\n\\x1B[31m.jpg: is damaged");
  const ProcessResult option =
      match(folder_ / "map.pfm", {"--method=" + std::string(3000, 'x') + "\x1B"});
  EXPECT_EQ(option.exit_code, 2);
  EXPECT_LT(option.err.size(), 500U);
  EXPECT_EQ(option.err.find('\x1B'), std::string::npos);
}

TEST_F(InputBadFiles, LimitsOfPixelsAndMemory) {
  expect_failure(match(folder_ / "map.pfm", {"--max-pixels=3000"}), 1,
                 "71x53 pixels, expected at most 65500 a side and 3000 in all");
  succeeds(match(folder_ / "map.pfm", {"--max-pixels=3763", "--memory=1G"}));
  EXPECT_EQ(match(folder_ / "map.pfm", {"--max-pixels=0"}).exit_code, 2);
  EXPECT_EQ(match(folder_ / "map.pfm", {"--memory=0"}).exit_code, 2);
  if (test_paths::is_sanitized()) {
    return;  // the sanitizer needs more memory than such limits leave
  }
  // Libraries that are opened late do not count for the limit, and print nothing.
  const std::string tile = folder_ / "tile.tif";
  write_photograph(tile, {Image<float>(71, 53)});
  for (const char* memory : {"1K", "500K"}) {
    const ProcessResult tight = run_vantage({"asp", tile, tile, folder_ / "asp.tif", "--quiet",
                                             "--disp-min=0", "--disp-max=8", "--memory", memory});
    EXPECT_LE(tight.exit_code, 1);
    EXPECT_TRUE(tight.exit_code == 0 ? tight.err.empty() : bool{is_one_line(tight, "asp")})
        << tight.err;
  }
}

TEST_F(InputBadFiles, PairsThatDoNotGoTogether) {
  write_photograph(folder_ / "small.png", {Image<std::uint8_t>(3, 3)});
  const std::vector<Words> cases = {
      {"match", left_, folder_ / "none.png"},
      {"match", left_, folder_.path().string()},
      {"match", left_, folder_ / "small.png"},
      {"match", left_, right_, "--disparities=71:90"},  // no pixel has a candidate
      {"match", left_, right_, "--disparities=-90:-71"},
      {"synth", left_, folder_ / "small.png", "--view", "0.5"}};
  const auto before = files_below(folder_.path());
  for (Words arguments : cases) {
    const std::string command = arguments.front();
    arguments.insert(arguments.end(),
                     {"-o", folder_ / (command == "match" ? "out.pfm" : "out.png")});
    expect_one_line(run_vantage(arguments), 1, command);
  }
  EXPECT_EQ(files_below(folder_.path()), before);
}

TEST_F(InputBadFiles, OutputsThatCannotBeWritten) {
  fs::create_directory(folder_ / "folder.pfm");
  const auto before = files_below(folder_.path());
  const std::vector<Words> cases = {
      {"-o", folder_ / "none/out.pfm"},
      {"-o", folder_ / "folder.pfm"},
      {"-o", left_ + "/out.pfm"},
      {"-o", "/proc/out.pfm"},
      {"-o", folder_ / "out.pfm", "--report", folder_ / "none/report.json"},
      {"-o", folder_ / "out.pfm", "--preview", folder_ / "none/preview.png"}};
  for (const auto& outputs : cases) {
    expect_one_line(run_vantage(joined({"match", left_, right_, "--disparities=0:9"}, outputs)), 1,
                    "match", outputs.back());
    EXPECT_EQ(files_below(folder_.path()), before);
  }
}

TEST_F(InputBadFiles, OnePixelPairsWork) {
  Image<std::uint8_t> pixel(1, 1);
  pixel.fill(77);
  write_photograph(folder_ / "pixel.png", {std::move(pixel)});
  succeeds(run_vantage({"match", folder_ / "pixel.png", folder_ / "pixel.png", "--disparities",
                        "0:63", "-o", folder_ / "o.pfm"}));
  EXPECT_EQ(read_disparity(folder_ / "o.pfm").at(0, 0), 0);
}

}  // namespace vantage::bad_input_test
