#include "tests/apps/run_fixture.h"

#include <cstdio>
#include <sstream>

#include "engine/execution.h"
#include "engine/generation/layered_scene.h"

namespace vantage {

namespace {

constexpr std::size_t kDifferencesTold = 5;

bool is_unnamed(const std::string& name) { return name.find(".tmp-") != std::string::npos; }

std::string png_of(const Photograph& photograph) {
  std::vector<std::uint8_t> bytes;
  encode_photograph("frame.png", photograph, bytes);
  return {bytes.begin(), bytes.end()};
}

/// left/000000.png, right/000000.png, …
FolderContent rendered_sources(int frames, int width, int height) {
  Execution execution(ExecutionOptions{});
  const LayeredScene scene(
      {.width_px = width, .height_px = height, .far_disparity_px = 1, .samples_per_side = 1},
      execution);
  FolderContent sources;
  for (int frame = 0; frame < frames; ++frame) {
    sources["left/" + frame_file(frame)] = png_of(scene.render({0, 0}, frame).image);
    sources["right/" + frame_file(frame)] = png_of(scene.render({1, 0}, frame).image);
  }
  return sources;
}

}  // namespace

FolderContent results_in(const fs::path& folder) {
  FolderContent content;
  for (const std::string& name : files_below(folder)) {
    if (!name.starts_with(".vantage/")) {
      content[name] = read_file(folder / name);
    }
  }
  return content;
}

Words leftovers_in(const fs::path& folder) {
  Words left;
  for (const std::string& name : files_below(folder)) {
    if (is_unnamed(name)) {
      left.push_back(name);
    }
  }
  return left;
}

testing::AssertionResult same_files(const FolderContent& actual, const FolderContent& expected) {
  Words differences;
  for (const auto& [name, bytes] : expected) {
    const auto found = actual.find(name);
    if (found == actual.end()) {
      differences.push_back(name + " is missing");
    } else if (found->second != bytes) {
      differences.push_back(name + " has other bytes");
    }
  }
  for (const auto& [name, bytes] : actual) {
    if (!expected.contains(name)) {
      differences.push_back(name + " should not be there");
    }
  }
  if (differences.empty()) {
    return testing::AssertionSuccess();
  }
  auto failure = testing::AssertionFailure() << differences.size() << " differences:";
  for (std::size_t i = 0; i < std::min(differences.size(), kDifferencesTold); ++i) {
    failure << " " << differences[i] << ";";
  }
  return failure;
}

std::vector<int> journalled_frames(const fs::path& folder, bool skipped) {
  std::map<int, bool> frames;
  for (const std::string& name : files_below(folder / ".vantage")) {
    if (!name.starts_with("frames-")) {
      continue;
    }
    std::istringstream lines(read_file(folder / ".vantage" / name));
    for (std::string line; std::getline(lines, line);) {
      const auto record = nlohmann::json::parse(line, nullptr, false);
      if (record.is_object() && record.contains("frame") && record["frame"].is_number()) {
        frames[record["frame"]] = record.contains("skipped");
      }
    }
  }
  std::vector<int> found;
  for (const auto& [frame, is_skipped] : frames) {
    if (is_skipped == skipped) {
      found.push_back(frame);
    }
  }
  return found;
}

std::string frame_file(int frame, const std::string& extension) {
  char name[32];
  std::snprintf(name, sizeof name, "%06d.", frame);
  return name + extension;
}

RunTest::RunTest() {
  static const FolderContent sources = rendered_sources(kFrames, kWidth, kHeight);
  fs::create_directory(left_);
  fs::create_directory(right_);
  for (const auto& [name, bytes] : sources) {
    write_file(folder_ / name, bytes);
  }
}

Words RunTest::arguments(const std::string& out, const Words& more) const {
  Words all = {"run", "--left", left_, "--right", right_, "-o", out, "--disparities=0:9"};
  if (std::ranges::find(more, "--method") == more.end()) {
    all = joined(all, {"--method", "ssd"});  // the quickest: most tests are not about maps
  }
  return joined(all, more);
}

ProcessResult RunTest::run(const std::string& out, const Words& more) const {
  return run_vantage(arguments(out, more));
}

FolderContent RunTest::undisturbed(const Words& more) const {
  // Tests of one process ask for the same again and again. What they did to the sources counts.
  static std::map<std::pair<Words, FolderContent>, FolderContent> known;
  FolderContent sources = results_in(left_);
  for (auto& [name, bytes] : results_in(right_)) {
    sources["right/" + name] = std::move(bytes);
  }
  FolderContent& results = known[{more, std::move(sources)}];
  if (!results.empty()) {
    return results;
  }
  const TemporaryFolder out;
  succeeds(run(out / "out", more));
  results = results_in(out / "out");
  return results;
}

std::string RunTest::frame_bytes(const std::string& side, int frame) const {
  return read_file(folder_ / (side + "/" + frame_file(frame)));
}

}  // namespace vantage
