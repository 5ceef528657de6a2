#include "engine/scene_graph/scene_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "engine/evaluation/view_evaluation.h"
#include "engine/generation/layered_scene.h"
#include "engine/image/transposed.h"
#include "engine/io/disparity_io.h"
#include "engine/io/photograph_io.h"
#include "tests/engine/identical_maps.h"
#include "tests/engine/io_test_support.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::error_of;
using test::put_text;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Execution& threads() {
  static Execution execution({.threads = 2});
  return execution;
}

LayeredSceneOptions small_scene() {
  LayeredSceneOptions options;
  options.width_px = 107;
  options.height_px = 73;
  options.samples_per_side = 2;
  return options;
}

/// Photographs of a made-up scene as files, and scenes built of them.
class SceneBuilderTest : public ::testing::Test {
 protected:
  SceneImage photograph(const std::string& name, ScenePosition position) const {
    const fs::path file = folder_.path() / (name + ".png");
    write_photograph(file, scene_.render(SceneView{position.x, position.y}, 0).image);
    return {.file = file, .position = position};
  }
  [[nodiscard]] std::vector<SceneImage> row(const std::vector<double>& columns) const {
    std::vector<SceneImage> images;
    for (const double x : columns) {
      images.push_back(photograph("row" + std::to_string(images.size()), {x, 0}));
    }
    return images;
  }
  SceneBuilder builder(const std::vector<SceneImage>& images,
                       const std::string& settings = "{}") const {
    SceneBuildOptions options{.match = {}, .settings = settings};
    options.match.preset = MatchPreset::kBalanced;
    options.match.disparities = {0, 8};
    return {place_, images, options, threads()};
  }
  void build(const std::vector<SceneImage>& images, const std::string& settings = "{}") const {
    SceneBuilder one = builder(images, settings);
    for (const int edge : one.edges_to_match()) {
      one.build(edge);
    }
  }
  /// Name → bytes of everything in the scene's folder.
  [[nodiscard]] std::map<std::string, std::vector<std::uint8_t>> contents() const {
    std::map<std::string, std::vector<std::uint8_t>> files;
    for (const auto& entry : fs::recursive_directory_iterator(place_)) {
      if (entry.is_regular_file()) {
        files[entry.path().lexically_relative(place_).string()] = bytes_of(entry.path());
      }
    }
    return files;
  }

  LayeredScene scene_{small_scene(), threads()};
  TemporaryFolder folder_;
  fs::path place_ = folder_.path() / "scene";
};

TEST_F(SceneBuilderTest, AViewLeftOutIsMadeFromItsNeighbours) {
  build(row({0, 0.5, 1.5, 2}));
  const StoredScene stored = read_scene(place_);
  const SceneLayout layout(stored.positions(), stored.names());
  require_complete(stored, layout, place_);
  SceneViewer viewer(
      layout, [&](int vertex) { return load_vertex(place_, stored, vertex); }, {}, threads());
  SynthesizedView view;
  viewer.synthesize({1, 0}, view);
  const ViewScores scores =
      evaluate_view(view.image, scene_.render(SceneView{1, 0}, 0).image, threads());
  EXPECT_GE(scores.psnr_db, 27);
}

TEST_F(SceneBuilderTest, AGridIsMatchedAlongRowsAndColumns) {
  std::vector<SceneImage> images;
  for (int i = 0; i < 4; ++i) {
    images.push_back(photograph("grid" + std::to_string(i), {(i % 2) * 0.5, (i / 2) * 0.5}));
  }
  build(images);
  const StoredScene stored = read_scene(place_);
  ASSERT_EQ(stored.edges.size(), 4U);
  const SceneLayout layout(stored.positions(), stored.names());
  SceneViewer viewer(
      layout, [&](int vertex) { return load_vertex(place_, stored, vertex); }, {}, threads());
  SynthesizedView view;
  viewer.synthesize({0.2, 0.3}, view);
  const ViewScores scores =
      evaluate_view(view.image, scene_.render(SceneView{0.2, 0.3}, 0).image, threads());
  EXPECT_GE(scores.psnr_db, 29);
}

// A column of cameras is a row turned over.
TEST_F(SceneBuilderTest, AColumnIsARowOfTransposedImages) {
  std::vector<SceneImage> images = row({0, 0.5});
  build(images);
  const DisparityMap of_row = read_disparity(place_ / "maps/000-001-first.pfm");
  fs::remove_all(place_);
  for (SceneImage& image : images) {
    write_photograph(image.file, transposed(read_photograph(image.file)));
    std::swap(image.position.x, image.position.y);
  }
  build(images);
  const DisparityMap of_column = read_disparity(place_ / "maps/000-001-first.pfm");
  EXPECT_TRUE(testing::identical(transposed(of_column.view()), of_row));
  EXPECT_TRUE(read_scene(place_).edges.at(0).edge.is_vertical);
}

TEST_F(SceneBuilderTest, LongerEdgesAreSearchedFarther) {
  build(row({0, 0.25, 1}));
  const StoredScene stored = read_scene(place_);
  EXPECT_EQ(stored.edges.at(0).disparities, (DisparityRange{0, 8}));
  EXPECT_EQ(stored.edges.at(1).disparities, (DisparityRange{0, 24}));
}

TEST_F(SceneBuilderTest, FinishedEdgesAreKept) {
  const std::vector<SceneImage> images = row({0, 0.5, 1, 1.5});
  build(images);
  const auto complete = contents();
  EXPECT_EQ(complete.size(), 13U);
  EXPECT_THAT(builder(images).edges_to_match(), IsEmpty());
  EXPECT_EQ(contents(), complete);

  // Interrupted after two of three, and continued.
  fs::remove_all(place_);
  SceneBuilder interrupted = builder(images);
  interrupted.build(0);
  interrupted.build(2);
  EXPECT_THAT(error_of([&] {
                const StoredScene stored = read_scene(place_);
                require_complete(stored, SceneLayout(stored.positions(), stored.names()), place_);
              }),
              HasSubstr("1 of 3 edges have not been matched yet"));
  EXPECT_THAT(builder(images).edges_to_match(), ElementsAre(1));
  build(images);
  EXPECT_EQ(contents(), complete);
}

TEST_F(SceneBuilderTest, WhatHasChangedIsMatchedAgain) {
  std::vector<SceneImage> images = row({0, 0.5, 1, 1.5});
  build(images);
  const auto complete = contents();
  EXPECT_THAT(builder(images, R"({"window":7})").edges_to_match(), ElementsAre(0, 1, 2));
  EXPECT_EQ(contents().size(), 1U) << "maps of other settings are still there";
  build(images);
  EXPECT_EQ(contents(), complete);

  fs::remove(place_ / "maps/001-002-second.pfm");
  EXPECT_THAT(builder(images).edges_to_match(), ElementsAre(1));
  build(images);
  put_text(place_ / "maps/000-001-first-unmatched.png", "cut off");
  EXPECT_THAT(builder(images).edges_to_match(), ElementsAre(0));
  build(images);
  EXPECT_EQ(contents(), complete);

  photograph("row3", {1.6, 0});  // another picture under the same name
  EXPECT_THAT(error_of([&] { load_vertex(place_, read_scene(place_), 3); }),
              AllOf(HasSubstr("row3.png has changed")));
  EXPECT_THAT(builder(images).edges_to_match(), ElementsAre(2));
  build(images);
  images[3].position.x = 1.6;
  EXPECT_THAT(builder(images).edges_to_match(), ElementsAre(2));
  images.pop_back();
  EXPECT_THAT(builder(images).edges_to_match(), IsEmpty());
  EXPECT_EQ(contents().size(), 9U);
}

TEST_F(SceneBuilderTest, FolderAndImagesCanBeMovedTogether) {
  build(row({0, 0.5}));
  const fs::path elsewhere = folder_.path() / "a" / "b";
  fs::create_directories(elsewhere);
  for (const char* name : {"row0.png", "row1.png", "scene"}) {
    fs::rename(folder_.path() / name, elsewhere / name);
  }
  const StoredScene stored = read_scene(elsewhere / "scene");
  EXPECT_EQ(load_vertex(elsewhere / "scene", stored, 1).maps.size(), 1U);
}

TEST_F(SceneBuilderTest, SaysWhatIsWrong) {
  std::vector<SceneImage> images = row({0, 0.5});
  EXPECT_THAT(error_of([&] { read_scene(place_); }), HasSubstr("there is no scene"));
  build(images);
  const StoredScene stored = read_scene(place_);

  write_disparity(place_ / "maps/000-001-first.pfm", DisparityMap(9, 9).view());
  EXPECT_THAT(error_of([&] { load_vertex(place_, stored, 0); }),
              AllOf(HasSubstr("000-001-first.pfm"), HasSubstr("9×9, expected 107×73")));
  fs::remove(place_ / "maps/000-001-first.pfm");
  EXPECT_THAT(error_of([&] { load_vertex(place_, stored, 0); }), HasSubstr("000-001-first.pfm"));

  for (const char* damage :
       {"", "{", "[]", R"({"format":1})", R"({"format":2})",
        R"({"format":1,"settings":{},"unit_length":0,"images":[],"edges":[]})",
        R"({"format":1,"settings":{},"unit_length":1,"images":[],"edges":[{"first":0,"second":1,)"
        R"("direction":"x","length":1}]})"}) {
    put_text(place_ / "scene.json", damage);
    EXPECT_THAT(error_of([&] { read_scene(place_); }), HasSubstr("scene.json: ")) << damage;
    EXPECT_THAT(error_of([&] { builder(images); }), HasSubstr("scene.json: ")) << damage;
  }
  fs::remove_all(place_);

  write_photograph(images[1].file, test::noise<std::uint8_t>(20, 10, 3));
  EXPECT_THAT(error_of([&] { builder(images); }),
              AllOf(HasSubstr("row1.png is 20×10, 3 channels, 8-bit"),
                    HasSubstr("expected 107×73, 3 channels, 8-bit as"), HasSubstr("row0.png")));
  fs::remove(images[1].file);
  EXPECT_THAT(error_of([&] { builder(images); }), HasSubstr("row1.png"));
  SceneBuildOptions options;
  options.match.disparities_y = DisparityRange{-1, 1};
  options.match.method = MatchMethod::kGradient;
  EXPECT_THAT(error_of([&] { options.validate(); }), HasSubstr("--disparities-y"));
}

}  // namespace
}  // namespace vantage
