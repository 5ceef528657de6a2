#include "tests/engine/oracle_comparison.h"

#include <iostream>

#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/costs/cost_table.h"
#include "engine/matching/levels/energy_format.h"
#include "tests/engine/engine_test.h"

namespace vantage {
inline namespace test {
namespace {

/// Uniform in [0, 1).
double next(std::mt19937& random) { return static_cast<double>(random()) / 4294967296.0; }

/// Noise of several wavelengths, 0..1, `width` × `height`.
std::vector<double> texture(int width, int height, std::mt19937& random) {
  const auto columns = static_cast<std::size_t>(width);
  std::vector<double> result(columns * static_cast<std::size_t>(height));
  double total = 0;
  for (const int step : {7, 3, 1}) {
    const int lattice_width = width / step + 2;
    const int lattice_height = height / step + 2;
    std::vector<double> lattice(static_cast<std::size_t>(lattice_width) *
                                static_cast<std::size_t>(lattice_height));
    for (double& value : lattice) {
      value = next(random);
    }
    const double weight = 1 + 0.2 * step;
    total += weight;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const double u = static_cast<double>(x) / step;
        const double v = static_cast<double>(y) / step;
        const int i = static_cast<int>(u);
        const int j = static_cast<int>(v);
        const auto at = [&](int p, int q) {
          return lattice[static_cast<std::size_t>(q) * static_cast<std::size_t>(lattice_width) +
                         static_cast<std::size_t>(p)];
        };
        const double a = at(i, j) + (u - i) * (at(i + 1, j) - at(i, j));
        const double b = at(i, j + 1) + (u - i) * (at(i + 1, j + 1) - at(i, j + 1));
        result[static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x)] +=
            weight * (a + (v - j) * (b - a));
      }
    }
  }
  for (double& value : result) {
    value /= total;
  }
  return result;
}

template <typename T>
Photograph photograph_of(const std::vector<std::vector<double>>& channels, int width, int height,
                         double top) {
  Image<T> image(width, height, static_cast<int>(channels.size()));
  for (const auto [x, y] : positions_of(width, height)) {
    for (int c = 0; c < image.channels(); ++c) {
      const double value =
          channels[static_cast<std::size_t>(c)][static_cast<std::size_t>(y * width + x)];
      image.at(x, y, c) = static_cast<T>(top * std::clamp(value, 0.0, 0.999999));
    }
  }
  return {std::move(image)};
}

Photograph photograph_of(const std::vector<std::vector<double>>& channels, int width, int height,
                         PixelKind kind) {
  switch (kind) {
    case PixelKind::kGrey16:
      return photograph_of<std::uint16_t>(channels, width, height, 65536);
    case PixelKind::kGreyFloat:
      return photograph_of<float>(channels, width, height, 1);
    case PixelKind::kGrey8:
    case PixelKind::kColour8:
      break;
  }
  return photograph_of<std::uint8_t>(channels, width, height, 256);
}

/// Whether the matcher's prior has fewer taps than would count in float: it leaves out those below
/// a thousandth of its floor (EQUATIONS §3: three taps for σP = .4).
bool leaves_out_taps(const MethodParameters& parameters) {
  for (int k = 1; k < 100; ++k) {
    const double offset = k * parameters.candidate_step_px / parameters.sigma_prior;
    const double tap = std::exp(-offset * offset / 2);
    if (tap < 1e-3 * parameters.epsilon_prior && tap > 1e-6 * parameters.epsilon_prior) {
      return true;
    }
  }
  return false;
}

Agreement compare(const DisparityMap& map, const Image<float>& confidence, const PlainMap& oracle,
                  bool refined, const Tolerance& tolerance) {
  Agreement result;
  for (const auto [x, y] : positions_of(oracle.width, oracle.height)) {
    const PlainChoice& expected = oracle.at(x, y);
    const double actual = map.at(x, y);
    const double sureness = confidence.at(x, y);
    if (std::isnan(expected.winner)) {
      EXPECT_TRUE(std::isnan(actual) && std::isnan(sureness))
          << "no candidate, but " << actual << " at " << x << ", " << y;
      continue;
    }
    ++result.candidates;
    EXPECT_TRUE(std::isfinite(actual) && std::isfinite(sureness))
        << actual << " with confidence " << sureness << " at " << x << ", " << y;
    const double magnitude = std::max(
        {std::abs(expected.energy),
         std::isinf(expected.runner_up) ? 0 : std::abs(expected.runner_up), tolerance.floor});
    const bool distinct = expected.runner_up - expected.energy > tolerance.tie * magnitude;
    const double off_px = std::abs(actual - expected.disparity);
    // A refined position is at most half a pixel from its winner.
    const bool equal =
        refined ? std::abs(actual - expected.winner) <= 0.5001 : actual == expected.winner;
    result.distinct += distinct ? 1 : 0;
    result.equal += equal ? 1 : 0;
    result.distinct_equal += distinct && equal ? 1 : 0;
    const double off = std::abs(sureness - expected.confidence) /
                       std::max(std::abs(expected.confidence), tolerance.confidence_floor);
    const bool flat = expected.curvature <= 100 * tolerance.tie * magnitude || !distinct;
    const bool agrees =
        off <= tolerance.confidence && (!refined || flat || off_px <= tolerance.subpixel_px);
    if (equal) {
      result.confident += agrees ? 1 : 0;
      result.worst_confidence = std::max(result.worst_confidence, off);
      result.worst_subpixel_px =
          std::max(result.worst_subpixel_px, refined && !flat ? off_px : 0.0);
    }
    if (((distinct && !equal) || (equal && !agrees)) && result.first_difference.empty()) {
      std::ostringstream text;
      text << "at " << x << ", " << y << ": disparity " << actual << ", expected "
           << expected.disparity << "; confidence " << sureness << ", expected "
           << expected.confidence << "; energy " << expected.energy << ", second "
           << expected.runner_up;
      result.first_difference = text.str();
    }
  }
  return result;
}

/// Names of tests have no hyphens.
std::string test_name(std::string_view name) {
  std::string text(name);
  std::ranges::replace(text, '-', '_');
  return text;
}

}  // namespace

PhotographPair textured_pair(int width, int height, DisparityRange range, PixelKind kind,
                             std::uint32_t seed) {
  std::mt19937 random(seed);
  const int background = (range.min + range.max) / 2;
  const int front = std::min(range.max, background + std::max(1, range.count() / 4));
  // Wide enough for every pixel of either image to see something of its own.
  const int margin = std::max(std::abs(background), std::abs(front));
  const int wide = width + 2 * margin;
  const int channels = kind == PixelKind::kColour8 ? 3 : 1;
  std::vector<std::vector<double>> left;
  std::vector<std::vector<double>> right;
  for (int c = 0; c < channels; ++c) {
    const std::vector<double> world = texture(wide, height, random);
    left.emplace_back();
    right.emplace_back();
    const auto seen = [&](int column, int y) {
      const double noise = (next(random) - 0.5) * 4 / 255;
      return 0.5 + 1.6 * (world[static_cast<std::size_t>(y * wide + column + margin)] - 0.5) +
             noise;
    };
    for (const auto [x, y] : positions_of(width, height)) {
      const bool in_front =
          std::abs(2 * x - width) < width / 2 && std::abs(2 * y - height) < height / 2;
      right.back().push_back(seen(x, y));
      left.back().push_back(seen(x - (in_front ? front : background), y));
    }
  }
  return {photograph_of(left, width, height, kind), photograph_of(right, width, height, kind)};
}

DisparityMaps maps_of(const PhotographPair& pair, const MatchOptions& options,
                      const ExecutionOptions& how, const MatchRequest& request,
                      MatchReport* report) {
  Execution execution(how);
  DisparityMaps maps;
  StereoMatcher(options, execution).match(pair.left, pair.right, request, maps, report);
  return maps;
}

Photograph crop(const Photograph& photograph, int first_column, int first_row, int width,
                int height) {
  return std::visit(
      [&](const auto& image) {
        std::remove_cvref_t<decltype(image)> part(width, height, image.channels());
        for (int y = 0; y < height; ++y) {
          std::copy_n(image.row(first_row + y) + first_column * image.channels(),
                      width * image.channels(), part.row(y));
        }
        return Photograph{std::move(part)};
      },
      photograph.pixels);
}

void expect_equals_oracle(const PhotographPair& pair, MatchOptions options, Execution& execution,
                          const Tolerance& tolerance, const std::string& what) {
  options.raw = true;
  const MethodParameters parameters = options.resolved();
  MatchRequest request;
  request.confidence = true;
  DisparityMaps maps;
  StereoMatcher(options, execution).match(pair.left, pair.right, request, maps);
  for (const Side reference : {Side::kLeft, Side::kRight}) {
    const bool is_left = reference == Side::kLeft;
    SCOPED_TRACE(what + (is_left ? ", left map" : ", right map"));
    const PlainMap oracle =
        plain_match(pair.left, pair.right, reference, options.disparities, parameters);
    const DisparityMap& map = is_left ? maps.left.disparity_px : maps.right.disparity_px;
    const Image<float>& confidence = is_left ? maps.left.confidence : maps.right.confidence;
    ASSERT_EQ(map.width(), oracle.width);
    ASSERT_EQ(map.height(), oracle.height);
    ASSERT_EQ(confidence.width(), oracle.width);
    ASSERT_EQ(confidence.height(), oracle.height);
    const Agreement agreement =
        compare(map, confidence, oracle, parameters.subpixel == Subpixel::kParabola, tolerance);
    EXPECT_GE(agreement.distinct_equal, tolerance.share * agreement.distinct - tolerance.strays)
        << agreement.first_difference;
    EXPECT_GE(agreement.confident, tolerance.confidence_share * agreement.equal - tolerance.strays)
        << "worst confidence " << agreement.worst_confidence << ", worst sub-pixel "
        << agreement.worst_subpixel_px << "; first " << agreement.first_difference;
    if (std::getenv("VANTAGE_TEST_VERBOSE") != nullptr) {
      std::cout << what << (is_left ? " left" : " right") << ": " << agreement.candidates
                << " pixels, equal " << agreement.equal << ", distinct " << agreement.distinct
                << ", of them equal " << agreement.distinct_equal << ", confident "
                << agreement.confident << ", worst confidence " << agreement.worst_confidence
                << ", worst sub-pixel " << agreement.worst_subpixel_px << "\n";
    }
  }
}

Tolerance tolerance_of(const MethodParameters& parameters) {
  Tolerance tolerance;
  if (is_evidence(parameters)) {
    tolerance.floor = 100;  // evidence is a difference of gradients of that size
    tolerance.confidence_floor = 10;
  }
  switch (parameters.aggregation) {
    case Aggregation::kNone:
      // The margin between two costs that are almost 0.
      tolerance.confidence = 3e-3;
      tolerance.energy = 5e-5;
      break;
    case Aggregation::kBox:
      // Costs are rounded to fixed point, unless they are squares of 8-bit grey levels.
      tolerance.energy = 5e-3;
      tolerance.confidence = 5e-3;
      tolerance.subpixel_px = 1e-3;
      break;
    case Aggregation::kLocalStopping:
      // A column whose certainty hardly changes may be restored by one and not by the other; from
      // then on it differs, and a little later its neighbours.
      tolerance.confidence_share = 0.99;
      tolerance.strays = 2;
      break;
    case Aggregation::kBayes:
      // Each iteration lets likely candidates grow, and so the differences between them.
      tolerance.energy = 1e-4;
      tolerance.confidence = 1e-3;
      tolerance.subpixel_px = 1e-3;
      if (parameters.prior == Prior::kContaminatedGaussian && leaves_out_taps(parameters)) {
        tolerance.tie = 3e-3;
        tolerance.energy = 3e-3;
        tolerance.confidence = 3e-2;
        tolerance.subpixel_px = 3e-2;
      }
      if (parameters.prior == Prior::kQuadratic) {
        tolerance.confidence = 5e-3;  // from logarithms of some thousand bits, in floats
      }
      if (uses_fixed_energies(parameters)) {
        // Sums of numbers in steps of 1/256 nat, each rounded, in each iteration.
        tolerance.tie = 5e-2;
        tolerance.energy = 5e-2;
        tolerance.confidence = 0.1;
        tolerance.subpixel_px = 5e-2;
      }
      break;
    case Aggregation::kGaussian:
    case Aggregation::kBoxCascade:
    case Aggregation::kDiffusion:
    case Aggregation::kMembrane:
      break;
  }
  return tolerance;
}

std::string case_name(MatchCost cost) { return test_name(cost_of(cost).name); }
std::string case_name(Aggregation aggregation) {
  return test_name(aggregation_of(aggregation).name);
}

}  // namespace test
}  // namespace vantage
