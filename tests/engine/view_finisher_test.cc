#include "engine/synthesis/view_finisher.h"

#include "engine/evaluation/view_evaluation.h"
#include "engine/generation/layered_scene.h"
#include "engine/synthesis/pair_warpers.h"
#include "engine/synthesis/view_synthesizer.h"
#include "engine/synthesis/warped_pair_layout.h"
#include "kernels/hole_fill/hole_fill.h"
#include "kernels/soft_edges/soft_edges.h"
#include "kernels/view_blend/view_blend.h"
#include "tests/engine/engine_test.h"

namespace vantage::view_finisher_test {

using Bytes = Image<std::uint8_t>;

/// A noisy background at disparity 2 and a bright object at 12, whose outline pixels in both images
/// are half background; exact maps.
struct ObjectScene {
  static constexpr int kWidth = 90;
  static constexpr int kHeight = 20;
  Photograph left;
  Photograph right;
  DisparityMap left_disparity{kWidth, kHeight};
  DisparityMap right_disparity{kWidth, kHeight};

  ObjectScene() {
    std::mt19937 random(51);
    Bytes pattern(kWidth + 40, kHeight);
    for (const auto [x, y] : positions_of(kWidth + 40, kHeight)) {
      pattern.at(x, y) = static_cast<std::uint8_t>(40 + random() % 20);
    }
    const auto render = [&](int background_shift, int first, DisparityMap& map) {
      Bytes image(kWidth, kHeight);
      for (const auto [x, y] : positions_of(kWidth, kHeight)) {
        const int background = pattern.at(x + background_shift, y);
        const bool object = x >= first && x < first + 20;
        // The background beside the object is the mixture, as the maps see it.
        const bool mixed = x == first - 1 || x == first + 20;
        map.at(x, y) = object ? 12.0F : 2.0F;
        image.at(x, y) = static_cast<std::uint8_t>(object  ? 220
                                                   : mixed ? (background + 220) / 2
                                                           : background);
      }
      return Photograph{std::move(image)};
    };
    left = render(0, 40, left_disparity);
    right = render(2, 28, right_disparity);
  }

  [[nodiscard]] SynthesizedView view(const SynthesisOptions& options, double view_x) const {
    SynthesizedView result;
    ViewSynthesizer(options, execution())
        .synthesize({left, right, left_disparity.view(), right_disparity.view()}, view_x, result);
    return result;
  }
};

const Bytes& pixels_of(const SynthesizedView& view) { return std::get<Bytes>(view.image.pixels); }

// What the view should be, from the kernels one after the other.
TEST(ViewFinisher, IsBlendThenFillThenMix) {
  const ObjectScene scene;
  for (const double view_x : {0.3, 0.5, 1.4, -0.35}) {
    for (const HoleFilling holes : {HoleFilling::kMirror, HoleFilling::kSpread}) {
      const SynthesisOptions options{.holes = holes, .match_intensities = false};
      const SynthesizedView view = scene.view(options, view_x);
      const StereoSource<std::uint8_t> source{.left = std::get<Bytes>(scene.left.pixels).view(),
                                              .right = std::get<Bytes>(scene.right.pixels).view(),
                                              .left_disparity = scene.left_disparity.view(),
                                              .right_disparity = scene.right_disparity.view()};
      const RowPairWarper<std::uint8_t> warper(source, options, view_x);
      constexpr int kWidth = ObjectScene::kWidth;
      const WarpedPairLayout layout(kWidth, 1);
      std::vector<float> memory(layout.floats);
      std::vector<float> scratch(warper.scratch_floats());
      int outlines = 0;
      for (int y = 0; y < ObjectScene::kHeight; ++y) {
        warper.warp(y, scratch, memory.data());
        const kernels::WarpedPairRow pair = layout.row_in(memory.data(), 1);
        std::vector<std::uint8_t> pixels(kWidth);
        std::vector<std::uint8_t> empty(kWidth);
        std::vector<std::uint8_t> sources(kWidth);
        std::vector<float> d(kWidth);
        std::vector<float> filled_d(kWidth);
        std::vector<std::uint8_t> filled(kWidth);
        std::vector<std::uint8_t> shares(2 * kWidth);
        kernels::BlendWeights weights;
        weights.alpha = static_cast<float>(warper.alpha());
        weights.trust_at_ends = 0.1F;
        kernels::blend_row(pair, weights, 1,
                           kernels::BlendedRow<std::uint8_t>{pixels.data(), d.data(), empty.data(),
                                                             sources.data()});
        kernels::fill_holes_row({.pixels = pixels.data(),
                                 .disparity_px = d.data(),
                                 .width = kWidth,
                                 .channels = 1,
                                 .mixed_px = 1,
                                 .filled_disparity_px = filled_d.data(),
                                 .filled = filled.data()},
                                holes == HoleFilling::kMirror);
        outlines += kernels::outline_shares_row({.disparity_px = filled_d.data(),
                                                 .left_disparity_px = pair.left_disparity_px,
                                                 .right_disparity_px = pair.right_disparity_px,
                                                 .width = kWidth,
                                                 .alpha = weights.alpha,
                                                 .left_offset = view_x,
                                                 .right_offset = view_x - 1},
                                                shares.data());
        kernels::mix_outlines_row(shares.data(), kWidth, 1, pixels.data());
        for (int x = 0; x < kWidth; ++x) {
          const auto i = static_cast<std::size_t>(x);
          ASSERT_EQ(pixels_of(view).at(x, y), pixels[i]) << view_x << ": " << x << ", " << y;
          ASSERT_EQ(view.holes.at(x, y), empty[i]);
          ASSERT_EQ(view.sources.at(x, y), filled[i] != 0 ? 0 : sources[i]);
        }
      }
      EXPECT_GT(outlines, 0);
    }
  }
}

// The view between the cameras sees the mixed pixels of one image where the other is clean, and
// those beside a view's holes are filled with it.
TEST(ViewFinisher, LeavesNoGhostOfAnOutline) {
  const ObjectScene scene;
  for (const HoleFilling holes :
       {HoleFilling::kInterpolate, HoleFilling::kMirror, HoleFilling::kSpread,
        HoleFilling::kInpaint, HoleFilling::kTexture}) {
    for (const double view_x : {0.5, 1.5, -0.5}) {
      const SynthesizedView soft = scene.view({.holes = holes}, view_x);
      const SynthesizedView hard = scene.view({.holes = holes, .soft_edges = false}, view_x);
      const auto first = static_cast<int>(40 - 12 * view_x);
      int ghosts = 0;
      for (const auto [x, y] : positions_of(ObjectScene::kWidth, ObjectScene::kHeight)) {
        // All but the outline itself, which is mixed.
        if (x < first - 1 || x > first + 20) {
          ASSERT_LT(pixels_of(soft).at(x, y), 75)
              << view_x << ": " << x << ", " << y << ", way " << static_cast<int>(holes);
          ghosts += pixels_of(hard).at(x, y) > 75 ? 1 : 0;
        }
      }
      EXPECT_GT(ghosts, 0);
    }
  }
}

TEST(ViewFinisher, CamerasHaveTheirOwnOutlines) {
  const ObjectScene scene;
  for (const double camera : {0.0, 1.0}) {
    for (const HoleFilling holes : {HoleFilling::kInterpolate, HoleFilling::kMirror,
                                    HoleFilling::kInpaint, HoleFilling::kTexture}) {
      const SynthesizedView soft = scene.view({.holes = holes}, camera);
      const SynthesizedView hard = scene.view({.holes = holes, .soft_edges = false}, camera);
      for (int y = 0; y < ObjectScene::kHeight; ++y) {
        ASSERT_EQ(std::memcmp(pixels_of(soft).row(y), pixels_of(hard).row(y), ObjectScene::kWidth),
                  0);
      }
    }
  }
}

TEST(ViewFinisher, SourcesOfHardEdgesAreNoneInHolesOnly) {
  const ObjectScene scene;
  for (const HoleFilling holes :
       {HoleFilling::kInterpolate, HoleFilling::kMirror, HoleFilling::kNone, HoleFilling::kInpaint,
        HoleFilling::kTexture}) {
    std::array<int, 256> counts{};
    for (const double view_x : {0.5, 1.5, -0.5}) {
      const SynthesizedView view = scene.view({.holes = holes, .soft_edges = false}, view_x);
      for (const auto [x, y] : positions_of(ObjectScene::kWidth, ObjectScene::kHeight)) {
        ++counts[view.sources.at(x, y)];
        ASSERT_EQ(view.sources.at(x, y) == 0, view.holes.at(x, y) == 255);
      }
    }
    for (const std::size_t value : {0, 85, 170, 255}) {
      EXPECT_GT(counts[value], 0);
      counts[value] = 0;
    }
    EXPECT_EQ(std::count(counts.begin(), counts.end(), 0), 256);
  }
}

// Rows that no image reaches are painted from those above and below.
TEST(ViewFinisher, InpaintsEmptyRows) {
  ObjectScene scene;
  for (const int y : {0, 7, 8, 19}) {
    std::fill_n(scene.left_disparity.row(y), ObjectScene::kWidth,
                std::numeric_limits<float>::quiet_NaN());
    std::fill_n(scene.right_disparity.row(y), ObjectScene::kWidth,
                std::numeric_limits<float>::quiet_NaN());
  }
  const SynthesizedView view = scene.view({.holes = HoleFilling::kInpaint}, 0.5);
  for (int x = 4; x < 20; ++x) {
    for (const int y : {0, 7, 8, 19}) {
      EXPECT_EQ(view.holes.at(x, y), 255);
      EXPECT_NEAR(pixels_of(view).at(x, y), 50, 25);
    }
  }
}

}  // namespace vantage::view_finisher_test
