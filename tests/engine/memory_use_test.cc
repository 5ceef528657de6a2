// What memory belongs to, against sums over the pixels and cells that must be there.
#include "engine/image/memory_use.h"

#include "engine/matching/search/coarse_to_fine/level_plan.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/sequence/steps/frame_slot.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage::memory_use_test {

constexpr int kWidth = 611;
constexpr int kHeight = 83;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

std::size_t bytes_of(const MemoryUse& use, const std::string& name) {
  const auto owner = std::ranges::find(use.owners, name, &MemoryUse::Owner::name);
  return owner == use.owners.end() ? 0 : owner->bytes;
}

/// Padding of rows may add up to a cache line and one more to each.
void expect_images_of(std::size_t bytes, std::size_t pixel_bytes, int images) {
  EXPECT_GE(bytes, pixel_bytes);
  EXPECT_LE(bytes, pixel_bytes + std::size_t{128} * kHeight * static_cast<std::size_t>(images));
}

/// What a match of a pair took.
MemoryUse use_of(MatchOptions options, const ExecutionOptions& execution_options,
                 PixelKind pixels = PixelKind::kGrey8) {
  options.raw = true;
  const auto [left, right] = textured_pair(kWidth, kHeight, options.disparities, pixels, 2);
  Execution execution(execution_options);
  const StereoMatcher matcher(options, execution);
  DisparityMaps maps;
  matcher.match(left, right, {.right = false}, maps);
  MemoryUse use;
  matcher.add_memory_use(use);
  add_scratch_use(execution, use);
  return use;
}

TEST(MemoryUse, AddsUpWhatBelongsToOneOwner) {
  MemoryUse use;
  use.add("maps", 100);
  use.add("rings", 0);
  use.add("photographs", 7);
  use.add("maps", 20);
  ASSERT_EQ(use.owners.size(), 2U);
  EXPECT_EQ(bytes_of(use, "maps"), 120U);
  EXPECT_EQ(bytes_of(use, "photographs"), 7U);
}

TEST(MemoryUse, OfIterationsIsTheStateOfWholeImages) {
  MatchOptions options;
  options.method = MatchMethod::kDiffusion;
  options.disparities = {0, 36};  // 48 lanes
  options.parameters.iterations = 6;
  const std::size_t state = kPixels * 48 * sizeof(float);
  ExecutionOptions execution{.threads = 2, .iterations_per_pass = 6};
  EXPECT_EQ(bytes_of(use_of(options, execution), "stored iterations"), 0U) << "one pass";
  execution.iterations_per_pass = 3;
  EXPECT_EQ(bytes_of(use_of(options, execution), "stored iterations"), state);
  execution.iterations_per_pass = 2;
  EXPECT_EQ(bytes_of(use_of(options, execution), "stored iterations"), 2 * state)
      << "input and output of the pass in the middle";
}

TEST(MemoryUse, OfRingsIsThatOfStrips) {
  MatchOptions options;
  options.method = MatchMethod::kSsd;
  options.disparities = {0, 31};
  const auto rings = [&](int strip_width_px) {
    return bytes_of(use_of(options, {.threads = 1, .strip_width_px = strip_width_px}), "rings");
  };
  // One row of sums of 9×9 windows, with four columns of halo on either side.
  constexpr std::size_t kColumnBytes = 32 * sizeof(std::int32_t);
  EXPECT_GE(rings(20), (20 + 2 * 4) * kColumnBytes);
  const std::size_t growth = rings(100) - rings(20);
  EXPECT_GE(growth, 80 * kColumnBytes);
  EXPECT_LE(growth, 80 * kColumnBytes * 11 / 10);
}

TEST(MemoryUse, OfPreparedImagesIsThatOfTheirPlanes) {
  MatchOptions options;
  options.method = MatchMethod::kSsd;
  options.disparities = {0, 15};
  // Margins: the candidates on either side, rounded up to lanes.
  const std::size_t margins = std::size_t{kHeight} * (2 * 64);
  const std::size_t grey_8 = bytes_of(use_of(options, {.threads = 1}), "prepared images");
  EXPECT_GE(grey_8, 2 * kPixels) << "the left one and the right one mirrored";
  EXPECT_LE(grey_8, 3 * (kPixels + margins + 128 * kHeight));
  const std::size_t grey_float =
      bytes_of(use_of(options, {.threads = 1}, PixelKind::kColour8), "prepared images");
  EXPECT_GE(grey_float, 2 * kPixels * sizeof(float));
  EXPECT_LE(grey_float, 3 * (kPixels + margins + 128 * kHeight) * sizeof(float));
  options.method = MatchMethod::kGradient;
  // Levels, smoothed levels and three planes of two images, and three mirrored ones.
  EXPECT_GE(bytes_of(use_of(options, {.threads = 1}), "prepared images"),
            (2 * 5 + 3) * kPixels * sizeof(float));
}

TEST(MemoryUse, OfCoarseLevelsIsThatOfTheirCells) {
  MatchOptions options;
  options.method = MatchMethod::kBayes;
  options.disparities = {0, 36};  // 48 lanes of a byte
  options.parameters.iterations = 1;
  const auto levels = [&](int count) {
    options.parameters.levels = count;
    return bytes_of(use_of(options, {.threads = 2}), "coarse levels");
  };
  EXPECT_EQ(levels(1), 0U);
  const std::size_t first = std::size_t{306} * 42 * 48;
  const std::size_t second = std::size_t{153} * 21 * 48;
  const std::size_t third = std::size_t{77} * 11 * 48;
  // Costs of all, and results of two.
  expect_images_of(levels(2), 2 * first, 2);
  expect_images_of(levels(4), 2 * (first + second) + third, 5);
  EXPECT_EQ(level_plan(options.resolved(), {kWidth, kHeight}, options.disparities.count()).bytes(),
            2 * (first + second) + third);
  options.method = MatchMethod::kMembrane;
  expect_images_of(levels(2), 2 * 2 * first, 2);
}

TEST(MemoryUse, OfFramesIsThatOfTheirImages) {
  FrameSlot slot;
  EXPECT_EQ(held_bytes(slot), 0U);
  slot.pair.left.pixels = Image<std::uint8_t>(kWidth, kHeight, 3);
  slot.pair.right.pixels = Image<std::uint16_t>(kWidth, kHeight, 3);
  expect_images_of(held_bytes(slot), 3 * kPixels * (1 + 2), 2);
  slot.maps.left.disparity_px.resize(kWidth, kHeight);
  slot.maps.right.confidence.resize(kWidth, kHeight);
  slot.maps.left.unmatched.resize(kWidth, kHeight);
  expect_images_of(held_bytes(slot), kPixels * (3 * (1 + 2) + 4 + 4 + 1), 5);
  slot.views.resize(2);
  slot.views[1].image.pixels = Image<std::uint8_t>(kWidth, kHeight, 3);
  slot.views[1].holes.resize(kWidth, kHeight);
  slot.preview.pixels = Image<std::uint8_t>(kWidth, kHeight, 3);
  slot.encoded.reserve(1000);
  expect_images_of(held_bytes(slot), kPixels * (3 * (1 + 2) + 4 + 4 + 1 + 3 + 1 + 3) + 1000, 8);
}

}  // namespace vantage::memory_use_test
