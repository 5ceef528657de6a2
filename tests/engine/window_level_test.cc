#include "engine/matching/windows/window_level.h"

#include "engine/image/tile_mask.h"
#include "engine/matching/aggregation/edge_weights.h"
#include "kernels/candidate_windows.h"
#include "kernels/census/census.h"
#include "kernels/intensity_diffusion/intensity_diffusion.h"
#include "kernels/window_start/window_start.h"
#include "tests/engine/engine_test.h"

namespace vantage::window_level_test {

using Bytes = Image<std::uint8_t>;
constexpr int kAbsent = std::numeric_limits<std::int16_t>::min();

/// Given energies and winners of all candidates.
class GivenBeliefs final : public CoarseBeliefs {
 public:
  GivenBeliefs(scheduler::Extent extent, int disparity_min, int count, std::mt19937& random)
      : extent_(extent), disparity_min_(disparity_min), count_(count) {
    const auto pixels = static_cast<std::size_t>(extent.columns * extent.rows);
    winners_.resize(pixels);
    energies_.resize(pixels * static_cast<std::size_t>(count));
    for (int& winner : winners_) {
      // Mostly one surface, so that some pixels have one window and some two.
      winner = static_cast<int>(random() % (random() % 5 == 0 ? static_cast<unsigned>(count) : 2U));
      winner = std::min(winner, count - 1);
    }
    for (std::uint8_t& energy : energies_) {
      energy = static_cast<std::uint8_t>(random());
    }
  }
  [[nodiscard]] scheduler::Extent extent() const override { return extent_; }
  [[nodiscard]] int disparity_min() const override { return disparity_min_; }
  [[nodiscard]] double nats_per_step() const override { return 0.05; }
  void winners_row(int y, std::int16_t* winners) const override {
    for (int x = 0; x < extent_.columns; ++x) {
      winners[x] = static_cast<std::int16_t>(winner(x, y));
    }
  }
  void energies_row(int y, scheduler::Range columns, const std::int16_t* first, int valid,
                    kernels::WindowCells* energies) const override {
    for (int x = columns.begin; x < columns.end; ++x) {
      energies[x] = 0;
      for (int i = 0; i < valid; ++i) {
        energies[x] |= static_cast<kernels::WindowCells>(energy(x, y, first[x] + i)) << (8 * i);
      }
    }
  }
  [[nodiscard]] int winner(int x, int y) const {
    x = std::clamp(x, 0, extent_.columns - 1);
    y = std::clamp(y, 0, extent_.rows - 1);
    return winners_[static_cast<std::size_t>(y * extent_.columns + x)];
  }
  [[nodiscard]] int energy(int x, int y, int candidate) const {
    return candidate < 0 || candidate >= count_
               ? 255
               : energies_[static_cast<std::size_t>((y * extent_.columns + x) * count_ +
                                                    candidate)];
  }

 private:
  scheduler::Extent extent_;
  int disparity_min_;
  int count_;
  std::vector<int> winners_;
  std::vector<std::uint8_t> energies_;
};

/// contrast: grey levels from one value to the next.
Photograph random_photograph(int width, int height, int contrast, std::mt19937& random) {
  Bytes pixels(width, height);
  for (const auto [x, y] : positions_of(width, height)) {
    pixels.at(x, y) = static_cast<std::uint8_t>(random() % 8 * static_cast<unsigned>(contrast));
  }
  return {std::move(pixels)};
}

Image<float> copy_of(const Image<float>& image) {
  Image<float> copy(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y) {
    std::copy_n(image.row(y), image.width(), copy.row(y));
  }
  return copy;
}

/// What levels differ in.
struct Kind {
  int side;     ///< pixels of a column along one direction
  int spacing;  ///< candidates from one coarse candidate to the next
  int thresholds;
  double prior_weight;
};

/// A level, transcribed from EQUATIONS §3.13 pixel by pixel.
class PlainLevel {
 public:
  PlainLevel(const MethodParameters& parameters, const Kind& kind,
             const kernels::CandidateGeometry& geometry, const Photograph& reference,
             const Photograph& partner, const Image<float>& grey, const Image<float>& prior_px,
             const GivenBeliefs& coarse)
      : parameters_(parameters),
        kind_(kind),
        prior_px_(prior_px),
        geometry_(geometry),
        reference_(std::get<Bytes>(reference.pixels)),
        partner_(std::get<Bytes>(partner.pixels)),
        grey_(copy_of(grey)),
        coarse_(coarse),
        columns_(grey.width()),
        rows_(grey.height()) {
    const double ceiling_nats =
        std::log1p(-parameters.epsilon_prior) - std::log(parameters.epsilon_prior);
    outlier_nats_ = -std::log(parameters.epsilon_measurement);
    steps_ = std::min({16.0, 255 / ceiling_nats, 63 / outlier_nats_});
    ceiling_ = static_cast<int>(std::lround(steps_ * ceiling_nats));
    start();
  }

  DisparityMap map() {
    for (int i = 1; i < parameters_.iterations; ++i) {
      diffuse_intensities(i);
      iterate();
    }
    diffuse_intensities(parameters_.iterations);
    DisparityMap result(columns_, rows_);
    for (const auto [x, y] : positions_of(columns_, rows_)) {
      result.at(x, y) = winner(x, y);
    }
    return result;
  }

 private:
  /// Before iteration n.
  void diffuse_intensities(int n) {
    if (n > parameters_.edge_diffusion) {
      return;
    }
    const Image<float> before = copy_of(grey_);
    std::vector<float> work(
        static_cast<std::size_t>(kernels::intensity_diffusion_work_floats(columns_)));
    for (int y = 0; y < rows_; ++y) {
      kernels::intensity_diffusion_row({.up = y > 0 ? before.row(y - 1) : nullptr,
                                        .centre = before.row(y),
                                        .down = y + 1 < rows_ ? before.row(y + 1) : nullptr,
                                        .width = columns_,
                                        .contrast = static_cast<float>(parameters_.edge_contrast),
                                        .work = work.data(),
                                        .output = grey_.row(y)});
    }
  }

  /// Cells of a window by candidate.
  using Window = std::map<int, int>;
  using Pixel = std::vector<Window>;

  [[nodiscard]] const Pixel& at(int x, int y) const {
    return pixels_[static_cast<std::size_t>(y * columns_ + x)];
  }

  void start() {
    pixels_.resize(static_cast<std::size_t>(columns_ * rows_));
    const int spacing = kind_.spacing;
    const int first = spacing * coarse_.disparity_min() - geometry_.disparity_min;
    const int steps = static_cast<int>(std::ceil(256 * coarse_.nats_per_step() * steps_));
    for (const auto [x, y] : positions_of(columns_, rows_)) {
      Pixel& pixel = pixels_[static_cast<std::size_t>(y * columns_ + x)];
      for (const int winner : guesses(x / 2, y / 2)) {
        const int window_start =
            std::clamp(spacing * winner + first - 3, 0, std::max(0, geometry_.count - 8));
        Window window;
        for (int d = window_start; d < std::min(window_start + 8, geometry_.count); ++d) {
          const int place = d - first;
          const int low = coarse_.energy(x / 2, y / 2, place / spacing);
          const int high =
              place % spacing == 0 ? low : coarse_.energy(x / 2, y / 2, place / spacing + 1);
          window[d] = std::max(0, ceiling_ - (((low + high + 1) / 2 * steps) >> 8));
        }
        pixel.push_back(window);
      }
    }
  }

  [[nodiscard]] std::vector<int> guesses(int x, int y) const {
    const int own = coarse_.winner(x, y);
    int min = own;
    int max = own;
    for (int v = -1; v <= 1; ++v) {
      for (int u = -1; u <= 1; ++u) {
        min = std::min(min, coarse_.winner(x + u, y + v));
        max = std::max(max, coarse_.winner(x + u, y + v));
      }
    }
    if (own - min >= kernels::kOtherSurface) {
      return {own, min};
    }
    return max - own >= kernels::kOtherSurface ? std::vector<int>{own, max} : std::vector<int>{own};
  }

  [[nodiscard]] bool has_partners(int x, int candidate) const {
    const int side = kind_.side;
    for (int column = side * x; column < std::min(side * (x + 1), geometry_.width); ++column) {
      const int partner = geometry_.partner(column, candidate);
      if (partner < 0 || partner >= geometry_.width) {
        return false;
      }
    }
    return true;
  }

  /// The number of thresholds that a neighbour is less than: the pixel, and with three of them 1.25
  /// grey levels below and above it.
  [[nodiscard]] int number(const Bytes& image, int x, int y,
                           const kernels::PixelOffset& offset) const {
    const auto pixel = [&](int column, int row) {
      return image.at(std::clamp(column, 0, image.width() - 1),
                      std::clamp(row, 0, image.height() - 1));
    };
    const double difference = pixel(x + offset.columns, y + offset.rows) - pixel(x, y);
    if (kind_.thresholds == 1) {
      return difference < 0 ? 1 : 0;
    }
    return (difference < -1.25 ? 1 : 0) + (difference < 0 ? 1 : 0) + (difference < 1.25 ? 1 : 0);
  }

  /// Of the prior at a pixel, above the least.
  [[nodiscard]] int prior_steps(int column, int row, int candidate) const {
    if (kind_.prior_weight == 0) {
      return 0;
    }
    const float offset = prior_px_.at(column, row) - static_cast<float>(geometry_.disparity_min);
    if (!(offset >= 0 && offset <= static_cast<float>(geometry_.count - 1))) {
      return 0;
    }
    const double k = (static_cast<float>(candidate) - offset) / 2;
    return static_cast<int>(std::lround(steps_ * kind_.prior_weight * (1 - std::min(1.0, k * k))));
  }

  [[nodiscard]] int evidence(int x, int y, int candidate) const {
    if (!has_partners(x, candidate)) {
      return 0;
    }
    int sum = 0;
    int of_prior = 0;
    const int side = kind_.side;
    for (const auto [column, row] :
         positions_of({side * x, side * (x + 1)}, {side * y, side * (y + 1)})) {
      const int v = std::min(row, geometry_height() - 1);
      // Columns outside have the code of the last one.
      const int own = std::min(column, geometry_.width - 1);
      const int other = std::clamp(geometry_.partner(column, candidate), 0, geometry_.width - 1);
      int distance = 0;
      for (const kernels::PixelOffset& offset : kernels::kRayCensusOffsets) {
        distance +=
            std::abs(number(reference_, own, v, offset) - number(partner_, other, v, offset));
      }
      const double deviations = distance / (parameters_.sigma_measurement * kind_.thresholds);
      const double epsilon = parameters_.epsilon_measurement;
      const double nats =
          outlier_nats_ +
          std::log((1 - epsilon) * std::exp(-deviations * deviations / 2) + epsilon);
      sum += static_cast<int>(std::lround(steps_ * std::max(0.0, nats)));
      of_prior += prior_steps(own, v, candidate);
    }
    return std::min(255, sum + of_prior);
  }

  [[nodiscard]] int geometry_height() const { return reference_.height(); }

  /// μ · weight towards a neighbour, in units of 2⁻¹⁵.
  [[nodiscard]] int weight(int x, int y, int u, int v) const {
    const auto grey = [&](int column, int row) { return grey_.at(column, row); };
    float weight = 1;
    if (parameters_.edge_weight < 1 && (u != x || v != y)) {
      const auto min = static_cast<float>(parameters_.edge_weight);
      const auto contrast = static_cast<float>(parameters_.edge_contrast);
      weight = min + (1 - min) * std::exp(-std::fabs(grey(u, v) - grey(x, y)) / contrast);
    }
    return static_cast<int>(
        std::nearbyint(std::min(static_cast<float>(parameters_.mu) * weight * 32768, 32767.0F)));
  }

  [[nodiscard]] int support(int x, int y, int candidate) const {
    int max = 0;
    for (const Window& window : at(x, y)) {
      const auto cell = window.find(candidate);
      max = std::max(max, cell == window.end() ? 0 : cell->second);
    }
    return max;
  }

  /// T of a pixel, in quarters of a step.
  [[nodiscard]] Pixel totals(int x, int y) const {
    Pixel totals;
    for (const Window& window : at(x, y)) {
      Window of_window;
      for (const auto& [candidate, cell] : window) {
        int total = 4 * evidence(x, y, candidate);
        for (const auto& [u, v] : std::array<std::pair<int, int>, 5>{
                 {{x, y}, {x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}}}) {
          if (u >= 0 && u < columns_ && v >= 0 && v < rows_) {
            total += (8 * support(u, v, candidate) * weight(x, y, u, v)) >> 16;
          }
        }
        of_window[candidate] = total;
      }
      totals.push_back(of_window);
    }
    return totals;
  }

  static int max_of(const Pixel& totals) {
    int max = 0;
    for (const Window& window : totals) {
      for (const auto& [candidate, total] : window) {
        max = std::max(max, total);
      }
    }
    return max;
  }

  /// Even rows, then odd ones, which read them.
  void iterate() {
    for (const int parity : {0, 1}) {
      std::vector<Pixel> next = pixels_;
      for (int y = parity; y < rows_; y += 2) {
        for (int x = 0; x < columns_; ++x) {
          next[static_cast<std::size_t>(y * columns_ + x)] = smoothed(totals(x, y));
        }
      }
      pixels_ = std::move(next);
    }
  }

  [[nodiscard]] Pixel smoothed(const Pixel& totals) const {
    const int max = max_of(totals);
    Pixel pixel;
    for (const Window& window : totals) {
      Window smoothed;
      for (const auto& [candidate, total] : window) {
        int best = total;
        for (const auto& [other, of_other] : window) {
          const double k = (candidate - other) / parameters_.sigma_prior;
          const int rise = static_cast<int>(std::nearbyint(4 * steps_ * k * k / 2));
          if (rise < 4 * ceiling_) {
            best = std::max(best, of_other - rise);
          }
        }
        smoothed[candidate] = (std::max(0, best - max + 4 * ceiling_) + 2) / 4;
      }
      pixel.push_back(smoothed);
    }
    return pixel;
  }

  [[nodiscard]] float winner(int x, int y) const {
    int best = -1;
    float disparity_px = std::numeric_limits<float>::quiet_NaN();
    for (const Window& window : totals(x, y)) {
      for (const auto& [candidate, total] : window) {
        if (!has_partners(x, candidate) || total <= best) {
          continue;
        }
        best = total;
        disparity_px = static_cast<float>(geometry_.disparity_min + candidate);
        const auto before = window.find(candidate - 1);
        const auto after = window.find(candidate + 1);
        if (before == window.end() || after == window.end() || !has_partners(x, candidate - 1) ||
            !has_partners(x, candidate + 1)) {
          continue;
        }
        const int curvature = 2 * total - before->second - after->second;
        if (curvature > 0) {
          disparity_px += static_cast<float>(after->second - before->second) /
                          static_cast<float>(2 * curvature);
        }
      }
    }
    return disparity_px;
  }

  const MethodParameters& parameters_;
  const Kind& kind_;
  const Image<float>& prior_px_;
  kernels::CandidateGeometry geometry_;
  const Bytes& reference_;
  const Bytes& partner_;
  Image<float> grey_;  ///< as the current iteration sees it
  const GivenBeliefs& coarse_;
  int columns_;
  int rows_;
  double outlier_nats_ = 0;
  double steps_ = 0;
  int ceiling_ = 0;
  std::vector<Pixel> pixels_;
};

MethodParameters parameters_of(int number) {
  MethodParameters parameters;
  parameters.cost = MatchCost::kRayCensus;
  parameters.aggregation = Aggregation::kBayes;
  parameters.prior_smoothing = PriorSmoothing::kMaximum;
  parameters.levels = 2;
  parameters.sigma_measurement = number % 2 == 0 ? 3 : 8;
  parameters.epsilon_measurement = number % 3 == 0 ? 0.1 : 0.02;
  parameters.epsilon_prior = number % 2 == 0 ? 5e-6 : 0.01;
  parameters.sigma_prior = number % 4 < 2 ? 0.48 : 2;
  parameters.mu = 0.3;
  parameters.edge_weight = number % 3 == 1 ? 1 : 0.2;
  parameters.edge_diffusion = number % 2 == 0 ? 2 : 0;
  parameters.iterations = 1 + number % 4;
  return parameters;
}

/// Searches some squares of the level, on a chessboard, and expects those of `whole` and nothing
/// else.
void expect_regions_equal(const WindowLevelInput& input, const DisparityMap& whole,
                          Execution& execution) {
  constexpr float kUntouched = -99;
  TileMask tiles(whole.width(), whole.height(), false, 5);
  for (int row = 0; row < tiles.rows(); ++row) {
    for (int column = row % 2; column < tiles.columns(); column += 2) {
      tiles.set(column, row);
    }
  }
  const std::vector<scheduler::Region> regions = tiles.regions();
  DisparityMap map(whole.width(), whole.height());
  map.fill(kUntouched);
  search_windows(input, Subpixel::kParabola, {.disparity_px = map.view(), .regions = &regions},
                 execution);
  DisparityMap expected = whole.copy();
  for (int row = 0; row < tiles.rows(); ++row) {
    tiles.for_each_run(row, false, [&](scheduler::Range columns) {
      const scheduler::Range rows = tiles.row_pixels(row);
      for (int y = rows.begin; y < rows.end; ++y) {
        std::fill_n(expected.row(y) + columns.begin, columns.size(), kUntouched);
      }
    });
  }
  EXPECT_TRUE(identical(map, expected));
}

TEST(WindowLevel, EqualsPlainTranscriptionForAnyExecution) {
  std::mt19937 random(1);
  Execution one({.threads = 1, .executor = scheduler::ExecutorKind::kSerial});
  Execution three({.threads = 3});
  int number = 0;
  struct Size {
    int width, height, disparity_min, count;
  };
  for (const Size& size : {Size{37, 21, 0, 24},
                           {40, 7, -9, 20},
                           {23, 70, -3, 5},
                           {66, 67, 3, 40},
                           {17, 2, 0, 1},
                           {150, 5, 20, 100}}) {
    for (const Kind& kind :
         {Kind{2, 2, 1, 0}, Kind{1, 1, 3, 0}, Kind{1, 1, 1, 0.7}, Kind{2, 1, 3, 0.4}}) {
      const int direction = number % 2 == 0 ? -1 : 1;
      MethodParameters parameters = parameters_of(number++);
      parameters.census_thresholds = kind.thresholds;
      const kernels::CandidateGeometry geometry{size.width, size.disparity_min, size.count,
                                                direction};
      const int contrast = kind.thresholds == 1 ? 30 : 1;
      const Photograph reference = random_photograph(size.width, size.height, contrast, random);
      const Photograph partner = random_photograph(size.width, size.height, contrast, random);
      const scheduler::Extent extent{(size.width + kind.side - 1) / kind.side,
                                     (size.height + kind.side - 1) / kind.side};
      const int spacing = kind.spacing;
      const int coarse_min =
          static_cast<int>(std::floor(size.disparity_min / static_cast<double>(spacing)));
      const GivenBeliefs coarse({(extent.columns + 1) / 2, (extent.rows + 1) / 2}, coarse_min,
                                spacing == 1 ? size.count : size.count / 2 + 2, random);
      Image<float> prior_px(size.width, size.height);
      for (const auto [x, y] : positions_of(size.width, size.height)) {
        // Some unknown, some outside the range.
        prior_px.at(x, y) = random() % 4 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                              : static_cast<float>(size.disparity_min) - 2 +
                                                    static_cast<float>(random() % 16) * 0.75F;
      }
      Image<float> grey(extent.columns, extent.rows);
      for (const auto [x, y] : positions_of(grey)) {
        grey.at(x, y) = static_cast<float>(random() % 4 * 8);
      }
      const auto margins = window_margins(geometry);
      CostImage of_reference;
      CostImage of_partner;
      of_reference.prepare(reference, parameters, margins, {true, false, true}, one);
      of_partner.prepare(partner, parameters, margins, {true, false, true}, one);
      EdgeWeights edges;
      edges.prepare(grey.view(), parameters, one);
      const WindowLevelInput input{.parameters = parameters,
                                   .side = kind.side,
                                   .spacing = spacing,
                                   .geometry = geometry,
                                   .reference = of_reference,
                                   .partner = of_partner,
                                   .edges = parameters.edge_weight < 1 ? &edges : nullptr,
                                   .coarse = coarse,
                                   .prior_px = kind.prior_weight > 0
                                                   ? std::as_const(prior_px).view()
                                                   : ImageView<const float>(),
                                   .prior_weight = kind.prior_weight};
      const DisparityMap expected =
          PlainLevel(parameters, kind, geometry, reference, partner, grey, prior_px, coarse).map();
      for (Execution* const execution : {&one, &three}) {
        DisparityMap map(extent.columns, extent.rows);
        search_windows(input, Subpixel::kParabola, {.disparity_px = map.view()}, *execution);
        for (const auto [x, y] : positions_of(map)) {
          const float value = map.at(x, y);
          ASSERT_TRUE(std::isnan(value) ? std::isnan(expected.at(x, y))
                                        : value == expected.at(x, y))
              << size.width << "x" << size.height << ", side " << kind.side << ", direction "
              << direction << ", pixel " << x << ", " << y << ": " << value << ", expected "
              << expected.at(x, y);
        }
        expect_regions_equal(input, map, *execution);
      }
    }
  }
}

}  // namespace vantage::window_level_test
