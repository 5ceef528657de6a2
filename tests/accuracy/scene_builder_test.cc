#include "engine/scene_graph/scene_builder.h"

#include <fmt/format.h>

#include "engine/evaluation/view_evaluation.h"
#include "engine/generation/layered_scene.h"
#include "engine/image/transposed.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "engine/scene_graph/rectified_edge.h"
#include "tests/engine/engine_test.h"

namespace vantage::scene_builder_test {

namespace fs = std::filesystem;

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
  SceneBuilder builder(const std::vector<SceneImage>& images, const std::string& settings = "{}",
                       bool copy_images = false) const {
    SceneBuildOptions options{.match = {}, .settings = settings, .copy_images = copy_images};
    options.match.preset = MatchPreset::kQuality;  // these tests are about views, not maps
    options.match.disparities = {0, 8};
    return {place_, images, options, execution()};
  }
  void build(const std::vector<SceneImage>& images, const std::string& settings = "{}") const {
    SceneBuilder one = builder(images, settings);
    for (const int edge : one.edges_to_match()) {
      one.build(edge);
    }
  }
  /// Name → bytes of everything in the scene's folder but its lock.
  [[nodiscard]] std::map<std::string, std::vector<std::uint8_t>> contents() const {
    std::map<std::string, std::vector<std::uint8_t>> files;
    for (const auto& entry : fs::recursive_directory_iterator(place_)) {
      if (entry.is_regular_file() && entry.path().filename() != ".lock") {
        files[entry.path().lexically_relative(place_).string()] = bytes_of(entry.path());
      }
    }
    return files;
  }

  LayeredScene scene_{small_scene(), execution()};
  TemporaryFolder folder_;
  fs::path place_ = folder_.path() / "scene";
};

TEST_F(SceneBuilderTest, AViewLeftOutIsMadeFromItsNeighbours) {
  build(row({0, 0.5, 1.5, 2}));
  const StoredScene stored = read_scene(place_);
  const SceneLayout layout(stored.positions(), stored.names());
  require_complete(stored, layout.edges(), place_);
  SceneViewer viewer(
      layout, [&](int vertex) { return load_vertex(place_, stored, vertex); }, {}, execution());
  SynthesizedView view;
  viewer.synthesize({1, 0}, view);
  const ViewScores scores =
      evaluate_view(view.image, scene_.render(SceneView{1, 0}, 0).image, execution());
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
      layout, [&](int vertex) { return load_vertex(place_, stored, vertex); }, {}, execution());
  SynthesizedView view;
  viewer.synthesize({0.2, 0.3}, view);
  const ViewScores scores =
      evaluate_view(view.image, scene_.render(SceneView{0.2, 0.3}, 0).image, execution());
  EXPECT_GE(scores.psnr_db, 29);
}

// Within a triangle, from computed maps, against each of the two edges alone.
TEST_F(SceneBuilderTest, ATriangleIsBetterThanItsEdges) {
  const std::vector<SceneImage> corners = {photograph("a", {0, 0}), photograph("b", {0.5, 0}),
                                           photograph("c", {0, 0.5})};
  const auto mean_psnr_from = [&](const std::vector<SceneImage>& images, int vertices) {
    constexpr ScenePosition kWithin[] = {{0.17, 0.17}, {0.1, 0.3}, {0.3, 0.1}, {0.22, 0.22}};
    fs::remove_all(place_);
    build(images);
    const StoredScene stored = read_scene(place_);
    const SceneLayout layout(stored.positions(), stored.names());
    SceneViewer viewer(
        layout, [&](int vertex) { return load_vertex(place_, stored, vertex); }, {}, execution());
    double sum = 0;
    for (const ScenePosition& position : kWithin) {
      SynthesizedView view;
      EXPECT_EQ(viewer.synthesize(position, view).count, vertices);
      const Photograph truth = scene_.render(SceneView{position.x, position.y}, 0).image;
      sum += evaluate_view(view.image, truth, execution()).psnr_db;
    }
    return sum / std::size(kWithin);
  };
  const double of_triangle = mean_psnr_from(corners, 3);
  EXPECT_GE(of_triangle, 32);
  const double of_row = mean_psnr_from({corners[0], corners[1]}, 2);
  const double of_column = mean_psnr_from({corners[0], corners[2]}, 2);
  EXPECT_GT(of_triangle, std::max(of_row, of_column));
  EXPECT_GE(of_triangle, std::min(of_row, of_column) + 1);
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
  EXPECT_TRUE(identical(transposed(of_column.view()), of_row));
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

  // What a killed process was writing goes.
  put_text(place_ / ".scene.tmp-0123abcd-17-0.json", "{");
  put_text(place_ / "maps/.000-001-first.tmp-0123abcd-17-0.pfm", "Pf");
  EXPECT_THAT(builder(images).edges_to_match(), IsEmpty());
  EXPECT_EQ(contents(), complete);
  // Nothing else does.
  const std::vector<fs::path> mine = {place_ / ".notes.tmp-mine",
                                      place_ / "maps/.other.tmp-0123abcd-17-0.pfm"};
  for (const fs::path& file : mine) {
    put_text(file, "mine");
  }
  builder(images);
  for (const fs::path& file : mine) {
    EXPECT_TRUE(fs::exists(file)) << file;
  }

  // Interrupted after two of three, and continued.
  fs::remove_all(place_);
  {
    SceneBuilder interrupted = builder(images);
    interrupted.build(0);
    EXPECT_THAT(error_of([&] { builder(images); }), HasSubstr("another process builds this scene"));
    interrupted.build(2);
  }
  EXPECT_THAT(error_of([&] {
                const StoredScene stored = read_scene(place_);
                require_complete(stored, SceneLayout(stored.positions(), stored.names()).edges(),
                                 place_);
              }),
              HasSubstr("1 of 3 edges are not matched yet"));
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

TEST_F(SceneBuilderTest, CopiedImagesMakeTheFolderDependOnNothingElse) {
  const std::vector<SceneImage> images = row({0, 0.5, 1});
  builder(images, "{}", true);  // interrupted before the first edge
  EXPECT_THAT(builder(images, "{}", true).edges_to_match(), ElementsAre(0, 1));
  {
    SceneBuilder whole = builder(images, "{}", true);
    whole.build(0);
    whole.build(1);
  }
  const auto complete = contents();
  EXPECT_EQ(complete.size(), 1U + 8U + 3U);
  EXPECT_THAT(builder(images, "{}", true).edges_to_match(), IsEmpty());
  EXPECT_EQ(contents(), complete);

  for (const SceneImage& image : images) {
    fs::remove(image.file);
  }
  fs::rename(place_, folder_.path() / "elsewhere");
  place_ = folder_.path() / "elsewhere";
  const StoredScene stored = read_scene(place_);
  EXPECT_TRUE(same(load_vertex(place_, stored, 2).image, scene_.render(SceneView{1, 0}, 0).image));

  // Built from the copies: they are not copied again.
  std::vector<SceneImage> copies;
  for (const StoredImage& image : stored.images) {
    copies.push_back({.file = place_ / image.file, .position = image.position});
  }
  EXPECT_THAT(builder(copies, "{}", true).edges_to_match(), IsEmpty());
  EXPECT_EQ(contents(), complete);
  // A damaged copy is noticed, and replaced where there is a whole one.
  put_text(place_ / stored.images[1].file, "cut off");
  EXPECT_THAT(error_of([&] { load_vertex(place_, stored, 1); }), HasSubstr("has changed"));
  EXPECT_THAT(builder(row({0, 0.5, 1}), "{}", true).edges_to_match(), IsEmpty());
  EXPECT_EQ(contents(), complete);
  fs::remove(place_ / stored.images[1].file);
  EXPECT_THAT(error_of([&] { load_vertex(place_, stored, 1); }), HasSubstr("is missing"));
}

// An oblique edge against the exact maps.
TEST_F(SceneBuilderTest, ObliqueNeighboursAreMatched) {
  const std::vector<std::array<ScenePosition, 2>> cases = {{{{0, 0}, {0.8, 0.6}}},
                                                           {{{0.3, 0.1}, {-0.1, 0.6}}}};
  for (const auto& places : cases) {
    fs::remove_all(place_);
    std::optional<SceneBuilder> one(
        builder({photograph("oblique0", places[0]), photograph("oblique1", places[1])}));
    ASSERT_EQ(one->edges().size(), 1U);
    const SceneEdge edge = one->edges()[0];
    EXPECT_NE(edge.slope, 0);
    const StoredEdge stored = one->build(0).stored;
    one.reset();  // it has the folder for itself
    const std::array<int, 2> ends = {edge.first, edge.second};
    for (std::size_t side = 0; side < 2; ++side) {
      const ScenePosition at = places[static_cast<std::size_t>(ends[side])];
      const DisparityMap map = read_disparity(place_ / stored.maps[side].name);
      const Photograph mask = read_photograph(place_ / stored.unmatched[side].name);
      const auto& unmatched = std::get<Mask>(mask.pixels);
      const DisparityMap truth = scene_.render(SceneView{at.x, at.y}, 0).disparity;
      int matched = 0;
      int wrong = 0;
      for (const auto [x, y] : positions_of(map)) {
        if (unmatched.at(x, y) == 0) {
          ++matched;
          const double expected = truth.at(x, y) * edge.length;
          wrong += std::abs(map.at(x, y) - expected) > 1 ? 1 : 0;
        }
      }
      const double pixels = map.width() * map.height();
      EXPECT_GE(matched / pixels, 0.8);
      EXPECT_NEAR(matched / pixels, stored.matched_share[side], 1e-9);
      // Two images of a row at this distance have 0.096.
      EXPECT_LE(wrong / pixels, 0.095) << "side " << side;
    }
    const StoredScene scene = read_scene(place_);
    const SceneLayout layout(scene.positions(), scene.names());
    SceneViewer viewer(
        layout, [&](int vertex) { return load_vertex(place_, scene, vertex); }, {}, execution());
    SynthesizedView view;
    const ScenePosition middle{(places[0].x + places[1].x) / 2, (places[0].y + places[1].y) / 2};
    EXPECT_FALSE(viewer.synthesize(middle, view).is_outside);
    EXPECT_GE(evaluate_view(view.image, scene_.render(SceneView{middle.x, middle.y}, 0).image,
                            execution())
                  .psnr_db,
              27);
    EXPECT_THAT(builder({photograph("oblique0", places[0]), photograph("oblique1", places[1])})
                    .edges_to_match(),
                IsEmpty());
    // The same length in another direction is another edge.
    std::vector<SceneImage> mirrored = {photograph("oblique0", places[0]),
                                        photograph("oblique1", places[1])};
    mirrored[1].position.y = 2 * places[0].y - places[1].y;
    EXPECT_THAT(builder(mirrored).edges_to_match(), ElementsAre(0));
  }
}

TEST_F(SceneBuilderTest, TellsWhetherRowsAndColumnsCorrespond) {
  LayeredSceneOptions options = small_scene();
  options.width_px = 320;
  options.height_px = 240;
  const LayeredScene scene(options, execution());
  std::map<std::pair<double, double>, Photograph> rendered;
  const auto seen_from = [&](ScenePosition at) -> const Photograph& {
    Photograph& image = rendered[{at.x, at.y}];
    if (image.width() == 0) {
      image = scene.render(SceneView{at.x, at.y}, 0).image;
    }
    return image;
  };
  // Cameras that stand lower, or further left, than they are said to.
  const auto error_between = [&](ScenePosition second, ScenePosition true_second) {
    std::vector<SceneImage> images;
    for (const ScenePosition at : {ScenePosition{}, true_second}) {
      images.push_back({.file = folder_.path() / fmt::format("check{}.png", images.size()),
                        .position = images.empty() ? ScenePosition{} : second});
      write_photograph(images.back().file, seen_from(at));
    }
    SceneBuildOptions build;
    build.rows = RowMode::kAsIs;
    build.match.preset = MatchPreset::kRealtime;  // maps are not looked at
    build.match.disparities = {-20, 20};
    fs::remove_all(place_);
    SceneBuilder checking(place_, images, build, execution());
    const auto error = checking.build(0).rectification;
    EXPECT_EQ(read_scene(place_).edges.at(0).rectification_error_px.has_value(), error.has_value());
    return error.value_or(VerticalError{.systematic_px = -1});
  };
  for (const ScenePosition straight : {ScenePosition{0.5, 0}, {0, 0.5}, {0.5, 0.35}}) {
    const VerticalError right = error_between(straight, straight);
    EXPECT_GE(right.systematic_px, 0);
    EXPECT_LE(right.systematic_px, 0.1) << straight.x << "," << straight.y;
    EXPECT_FALSE(right.looks_exchanged());
    const ScenePosition off{straight.x + 0.05, straight.y + 0.08};
    EXPECT_GE(error_between(straight, off).systematic_px, 0.3) << straight.x << "," << straight.y;
    const VerticalError exchanged = error_between(straight, {-straight.x, -straight.y});
    EXPECT_TRUE(exchanged.looks_exchanged()) << straight.x << "," << straight.y;
  }
}

TEST(EdgeCheck, SaysWhyLittleMatches) {
  const auto error_with = [](double second_share, double negative_share) {
    const VerticalError rows{.inliers = 325, .negative_share = negative_share};
    return error_of([&] { require_matched({0.5, second_share}, {0, 100}, rows); });
  };
  EXPECT_THAT(error_with(0.25, 1),
              AllOf(HasSubstr("25 % of the pixels match, expected at least 30 %"),
                    HasSubstr("the images look exchanged (100 % of 325 points")));
  EXPECT_THAT(error_with(0.25, 0.5), HasSubstr("`disparities` (0:100 was searched)"));
  EXPECT_NO_THROW(require_matched({0.5, 0.31}, {0, 100}, std::nullopt));
}

TEST_F(SceneBuilderTest, SaysWhatIsWrong) {
  std::vector<SceneImage> images = row({0, 0.5});
  EXPECT_THAT(error_of([&] { read_scene(place_); }), HasSubstr("no scene"));
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
    EXPECT_THAT(error_of([&] { read_scene(place_); }), HasSubstr("scene.json:")) << damage;
    EXPECT_THAT(error_of([&] { builder(images); }), HasSubstr("scene.json:")) << damage;
  }
  fs::remove_all(place_);

  write_photograph(images[1].file, noise<std::uint8_t>(20, 10, 3));
  EXPECT_THAT(error_of([&] { builder(images); }),
              AllOf(HasSubstr("row1.png is 20×10, 3 channels, 8-bit"),
                    HasSubstr("expected 107×73, 3 channels, 8-bit as"), HasSubstr("row0.png")));
  fs::remove(images[1].file);
  EXPECT_THAT(error_of([&] { builder(images); }), HasSubstr("row1.png"));
  SceneBuildOptions options;
  options.match.disparities_y = DisparityRange{-1, 1};
  options.match.method = MatchMethod::kGradient;
  EXPECT_THAT(error_of([&] { options.validate(); }), HasSubstr("disparities-y is set"));
}

}  // namespace vantage::scene_builder_test
