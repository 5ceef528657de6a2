#include "engine/scene_graph/scene_viewer.h"

#include "engine/evaluation/view_evaluation.h"
#include "engine/generation/layered_scene.h"
#include "tests/engine/engine_test.h"

namespace vantage::scene_viewer_test {

/// A made-up scene seen from some cameras, with exact maps.
class MadeUpScene {
 public:
  /// `positions` in baselines of the generator.
  explicit MadeUpScene(const std::vector<ScenePosition>& positions,
                       const LayeredSceneOptions& options = small())
      : scene_(options, execution()),
        layout_(positions, std::vector<std::string>(positions.size(), "image")) {}

  static LayeredSceneOptions small() {
    LayeredSceneOptions options;
    options.width_px = 131;
    options.height_px = 67;
    options.samples_per_side = 2;
    return options;
  }

  [[nodiscard]] const SceneLayout& layout() const { return layout_; }
  [[nodiscard]] const SceneRendering& render(ScenePosition position) const {
    const auto key = std::pair(position.x, position.y);
    const auto found = renderings_.find(key);
    return found != renderings_.end()
               ? found->second
               : renderings_.emplace(key, scene_.render(SceneView{position.x, position.y}, 0))
                     .first->second;
  }
  [[nodiscard]] SceneVertex load(int vertex) const {
    const SceneRendering& rendering = render(layout_.positions()[static_cast<std::size_t>(vertex)]);
    SceneVertex result;
    result.image.pixels = std::get<Image<std::uint8_t>>(rendering.image.pixels).copy();
    for (const SceneEdge& edge : layout_.edges()) {
      if (edge.first == vertex || edge.second == vertex) {
        DisparityMap map(rendering.disparity.width(), rendering.disparity.height());
        for (const auto [x, y] : positions_of(map)) {
          map.at(x, y) = rendering.disparity.at(x, y) * static_cast<float>(edge.length);
        }
        Mask unmatched(map.width(), map.height());
        unmatched.fill(0);
        result.maps.push_back({.neighbour = edge.first == vertex ? edge.second : edge.first,
                               .length = edge.length,
                               .disparity_px = std::move(map),
                               .unmatched = std::move(unmatched)});
      }
    }
    return result;
  }
  [[nodiscard]] SceneViewer viewer(const SynthesisOptions& options = {},
                                   Execution& on = execution()) const {
    return {layout_, [this](int vertex) { return load(vertex); }, options, on};
  }

  /// PSNR of a view against the rendering, where the images show anything.
  [[nodiscard]] double psnr(const SynthesizedView& view, ScenePosition position) const {
    Mask seen(view.holes.width(), view.holes.height());
    for (const auto [x, y] : positions_of(seen)) {
      seen.at(x, y) = static_cast<std::uint8_t>(255 - view.holes.at(x, y));
    }
    return evaluate_view(view.image, render(position).image, execution(), seen.view()).psnr_db;
  }

 private:
  LayeredScene scene_;
  SceneLayout layout_;
  mutable std::map<std::pair<double, double>, SceneRendering> renderings_;
};

std::vector<ScenePosition> grid(int columns, int rows, double step_x, double step_y) {
  std::vector<ScenePosition> positions;
  for (int i = 0; i < columns * rows; ++i) {
    positions.push_back({(i % columns) * step_x, (i / columns) * step_y});
  }
  return positions;
}

TEST(SceneViewer, AtACameraTheViewIsItsPhotograph) {
  for (const auto& positions : {grid(3, 3, 0.5, 0.4), grid(3, 1, 0.7, 1), grid(1, 2, 1, 0.6)}) {
    const MadeUpScene scene(positions);
    SceneViewer viewer = scene.viewer();
    SynthesizedView view;
    for (const ScenePosition position : positions) {
      viewer.synthesize(position, view);
      EXPECT_TRUE(same(view.image, scene.render(position).image))
          << positions.size() << " cameras, at " << position.x << "," << position.y;
      EXPECT_EQ(view.hole_fraction, 0);
    }
  }
}

TEST(SceneViewer, ViewsOfAGridAreTheRenderedOnes) {
  const MadeUpScene scene(grid(3, 3, 0.5, 0.5));
  SceneViewer viewer = scene.viewer();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> within(0, 1);
  SynthesizedView view;
  for (int i = 0; i < 12; ++i) {
    const ScenePosition position{within(random), within(random)};
    EXPECT_TRUE(viewer.synthesize(position, view).is_triangle());
    EXPECT_GE(scene.psnr(view, position), 31.5) << position.x << "," << position.y;
    EXPECT_LE(view.hole_fraction, 0.01);
  }
}

TEST(SceneViewer, EdgesOfAnyDirectionAndLengthGiveTheRenderedViews) {
  const std::vector<std::vector<ScenePosition>> cases = {{{0, 0}, {0.5, 0}, {1.7, 0}},
                                                         {{0.2, 0}, {0.2, 0.4}, {0.2, 1.1}}};
  for (const auto& positions : cases) {
    const MadeUpScene scene(positions);
    SceneViewer viewer = scene.viewer();
    SynthesizedView view;
    for (const double t : {0.2, 0.5, 0.81}) {
      for (std::size_t k = 0; k + 1 < positions.size(); ++k) {
        const ScenePosition position{(1 - t) * positions[k].x + t * positions[k + 1].x,
                                     (1 - t) * positions[k].y + t * positions[k + 1].y};
        const ScenePlace place = viewer.synthesize(position, view);
        EXPECT_FALSE(place.is_outside);
        EXPECT_EQ(place.count, 2);
        EXPECT_GE(scene.psnr(view, position), 33) << position.x << "," << position.y;
      }
    }
    const ScenePosition outside{positions[0].x - 0.1, positions[0].y - 0.1};
    EXPECT_TRUE(viewer.synthesize(outside, view).is_outside);
    EXPECT_GE(scene.psnr(view, outside), 31);
  }
}

TEST(SceneViewer, OneEdgeIsAPairOfTheSynthesizer) {
  const MadeUpScene scene({{0, 0}, {0.8, 0}});
  SynthesisOptions options;
  options.gamma.reset();
  options.match_intensities = false;
  SynthesizedView view;
  scene.viewer(options).synthesize({0.3, 0}, view);
  const SceneVertex left = scene.load(0);
  const SceneVertex right = scene.load(1);
  SynthesizedView expected;
  ViewSynthesizer(options, execution())
      .synthesize({left.image, right.image, left.maps[0].disparity_px.view(),
                   right.maps[0].disparity_px.view()},
                  0.3 / 0.8, expected);
  EXPECT_TRUE(same(view.image, expected.image));
}

// One edge of the middle image is wrong, three are right.
TEST(SceneViewer, InATriangleAllEdgesOfAnImageVote) {
  const MadeUpScene scene(grid(3, 3, 0.5, 0.5));
  SynthesizedView view;
  for (std::size_t wrong = 0; wrong < 4; ++wrong) {
    SceneViewer viewer(
        scene.layout(),
        [&](int vertex) {
          SceneVertex loaded = scene.load(vertex);
          if (vertex == 4) {
            loaded.maps[wrong].disparity_px.fill(9);
          }
          return loaded;
        },
        {}, execution());
    for (const ScenePosition position :
         {ScenePosition{0.4, 0.4}, {0.6, 0.4}, {0.4, 0.6}, {0.6, 0.6}}) {
      EXPECT_TRUE(viewer.synthesize(position, view).is_triangle());
      EXPECT_GE(scene.psnr(view, position), 31.5) << wrong;
    }
  }
}

TEST(SceneViewer, ATriangleHasFewerHolesThanItsEdges) {
  const MadeUpScene scene(grid(2, 2, 1, 1));
  SynthesizedView view;
  scene.viewer().synthesize({0.4, 0}, view);
  const double of_triangle = view.hole_fraction;
  const MadeUpScene row({{0, 0}, {1, 0}});
  row.viewer().synthesize({0.4, 0}, view);
  EXPECT_LT(of_triangle, view.hole_fraction);
}

TEST(SceneViewer, PreparedViewsAreRenderedConcurrently) {
  const MadeUpScene scene(grid(3, 2, 0.5, 0.6));
  const std::vector<ScenePosition> positions = {{0.3, 0.2}, {0.9, 0.5},  {0.1, 0},
                                                {1.2, 0.7}, {0.3, 0.25}, {0.2, 0.5}};
  SceneViewer viewer = scene.viewer();
  std::vector<PreparedSceneView> prepared;
  for (const ScenePosition position : positions) {
    prepared.push_back(viewer.prepare(position));
  }
  std::vector<SynthesizedView> views(positions.size());
  std::vector<std::thread> workers;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    workers.emplace_back([&, i] { viewer.render(prepared[i], views[i]); });
  }
  for (std::thread& worker : workers) {
    worker.join();
  }
  SynthesizedView alone;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    scene.viewer().synthesize(positions[i], alone);
    EXPECT_TRUE(same(views[i].image, alone.image)) << i;
    EXPECT_EQ(views[i].hole_fraction, alone.hole_fraction) << i;
  }
}

// One camera darker than the others: what it shows comes with the brightness that the place has.
TEST(SceneViewer, BrightnessMovesWithTheView) {
  const MadeUpScene scene(grid(2, 2, 0.5, 0.5));
  const auto mean = [](const SynthesizedView& view) {
    const auto& image = std::get<Image<std::uint8_t>>(view.image.pixels);
    double sum = 0;
    for (const auto [i, y] : positions_of(image.width() * 3, image.height())) {
      sum += image.row(y)[i];
    }
    return sum / (3.0 * image.width() * image.height());
  };
  for (int dark = 0; dark < 4; ++dark) {
    SceneViewer viewer(
        scene.layout(),
        [&](int vertex) {
          SceneVertex loaded = scene.load(vertex);
          auto& image = std::get<Image<std::uint8_t>>(loaded.image.pixels);
          for (const auto [i, y] :
               positions_of(image.width() * 3, vertex == dark ? image.height() : 0)) {
            image.row(y)[i] = static_cast<std::uint8_t>(0.7 * image.row(y)[i]);
          }
          return loaded;
        },
        {}, execution());
    const std::vector<ScenePosition>& places = scene.layout().positions();
    const ScenePosition at_dark = places[static_cast<std::size_t>(dark)];
    SceneViewer bright_viewer = scene.viewer();
    SynthesizedView view;
    SynthesizedView bright;
    for (const double t : {0.0, 0.3, 1.0}) {
      // From the dark camera along the diagonal or edge to a neighbour in x.
      const ScenePosition position{at_dark.x + t * (0.5 - 2 * at_dark.x), at_dark.y};
      viewer.synthesize(position, view);
      bright_viewer.synthesize(position, bright);
      EXPECT_NEAR(mean(view) / mean(bright), 0.7 + 0.3 * t, 0.02) << dark << " " << t;
    }
  }
}

TEST(SceneViewer, EqualForAnyThreadsAndHistory) {
  const MadeUpScene scene(grid(3, 2, 0.5, 0.6));
  const std::vector<ScenePosition> positions = {{0.3, 0.2}, {0.9, 0.5}, {0.1, 0}, {1.2, 0.7}};
  Execution one({.threads = 1, .executor = scheduler::ExecutorKind::kSerial});
  Execution many({.threads = 3, .band_height_px = 5});
  SceneViewer serial = scene.viewer({}, one);
  SceneViewer parallel = scene.viewer({}, many);
  std::vector<Photograph> expected;
  SynthesizedView view;
  for (const ScenePosition position : positions) {
    serial.synthesize(position, view);
    expected.push_back(std::move(view.image));
  }
  for (std::size_t i = positions.size(); i-- > 0;) {
    parallel.synthesize(positions[i], view);
    EXPECT_TRUE(same(view.image, expected[i]));
  }
}

TEST(SceneViewer, LoadsNoMoreThanItNeeds) {
  const MadeUpScene scene(grid(12, 1, 0.1, 1));
  std::vector<int> loaded;
  SceneViewer viewer(
      scene.layout(),
      [&](int vertex) {
        loaded.push_back(vertex);
        return scene.load(vertex);
      },
      {}, execution());
  SynthesizedView view;
  for (int step = 0; step <= 22; ++step) {
    viewer.synthesize({step * 0.05, 0}, view);
  }
  EXPECT_EQ(loaded.size(), 12U);
  viewer.synthesize({0, 0}, view);  // long ago
  EXPECT_EQ(loaded.size(), 14U);
}

TEST(SceneViewer, RefusesWhatItCannotRender) {
  const MadeUpScene scene({{0, 0}, {0.5, 0}});
  SceneViewer viewer = scene.viewer();
  SynthesizedView view;
  EXPECT_THAT(error_of([&] { viewer.synthesize({9, 0}, view); }), HasSubstr("at most 16"));
  EXPECT_THAT(error_of([&] { viewer.synthesize({NAN, 0}, view); }), HasSubstr("not finite"));
  SynthesisOptions forward;
  forward.warp = WarpColour::kForward;
  EXPECT_THAT(error_of([&] { (void)scene.viewer(forward); }), HasSubstr("one-pass"));
}

}  // namespace vantage::scene_viewer_test
