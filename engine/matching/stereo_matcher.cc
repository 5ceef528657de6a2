#include "engine/matching/stereo_matcher.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "engine/error.h"
#include "engine/matching/winner_merge.h"
#include "scheduler/strip_pipeline.h"
#include "scheduler/trace.h"

namespace vantage {
namespace {

std::size_t held_bytes_of(const RefinementWork& work) {
  const EdgeSnappingWork& edges = work.edge_snapping;
  std::size_t bytes = held_bytes(edges.grey) + held_bytes(edges.smooth_x) +
                      held_bytes(edges.gradient_x) + held_bytes(edges.gradient_y) +
                      held_bytes(edges.edges) + held_bytes(work.filled_medians.before) +
                      held_bytes(work.filled_medians.pixels) +
                      held_bytes(work.surface_fit.matched_px);
  for (const SpeckleWork& speckles : work.speckles) {
    bytes += held_bytes(speckles.runs) + held_bytes(speckles.row_begin);
  }
  return bytes;
}

/// Times one stage after the other for a report, and shows them in traces.
class StageClock {
 public:
  explicit StageClock(MatchReport& report) : report_(report) {}
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;
  ~StageClock() { end(); }
  /// Ends the stage before. `name` is of static storage.
  void begin(std::string_view name) {
    end();
    name_ = name;
    start_ = Clock::now();
    span_.emplace(name);
  }

 private:
  using Clock = std::chrono::steady_clock;
  void end() {
    if (span_) {
      span_.reset();
      report_.stages.push_back(
          {name_, std::chrono::duration<double>(Clock::now() - start_).count()});
    }
  }

  MatchReport& report_;
  std::string_view name_;
  Clock::time_point start_;
  std::optional<scheduler::Span> span_;
};

void require_equal_sizes(const Photograph& first, std::string_view first_name,
                         const Photograph& second, std::string_view second_name) {
  if (first.width() != second.width() || first.height() != second.height()) {
    throw Error(fmt::format("{} is {}x{} but {} is {}x{}, expected equal sizes", first_name,
                            first.width(), first.height(), second_name, second.width(),
                            second.height()));
  }
}

void require_different_baselines(std::span<const OtherView> others) {
  if (others.empty()) {
    throw UsageError("there is no image beside the reference, expected at least one");
  }
  for (std::size_t i = 0; i < others.size(); ++i) {
    const double baseline = others[i].baseline;
    if (!(std::isfinite(baseline) && baseline != 0)) {
      throw UsageError(
          fmt::format("baseline {} is {}, expected a finite number other than 0", i + 1, baseline));
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (baseline == others[j].baseline) {
        throw UsageError(fmt::format("baselines {} and {} are both {}, expected different ones",
                                     j + 1, i + 1, baseline));
      }
    }
  }
}

void require_usable(const DisparityPrior& prior, const Photograph& image) {
  constexpr double kMostWeight = 100;
  if (!(prior.weight >= 0 && prior.weight <= kMostWeight)) {
    throw UsageError(fmt::format("the weight of the prior is {}, expected a number from 0 to {}",
                                 prior.weight, kMostWeight));
  }
  for (const ImageView<const float>& map : {prior.left_px, prior.right_px}) {
    if (!map.empty() && (map.width() != image.width() || map.height() != image.height())) {
      throw Error(fmt::format("the prior is {}x{}, expected {}x{} as the images", map.width(),
                              map.height(), image.width(), image.height()));
    }
  }
}

}  // namespace

std::size_t held_bytes(const DisparityMaps& maps) {
  std::size_t bytes = held_bytes(maps.left_unmatched) + held_bytes(maps.right_unmatched);
  for (const Image<float>* map :
       {&maps.left, &maps.right, &maps.left_confidence, &maps.right_confidence,
        &maps.left_disparity_y, &maps.right_disparity_y}) {
    bytes += held_bytes(*map);
  }
  return bytes;
}

StereoMatcher::StereoMatcher(const MatchOptions& options, Execution& execution)
    : options_(options), execution_(execution) {
  options_.validate();
  if (options_.disparities_auto) {
    throw UsageError("disparities is auto, expected the range that the images suggest");
  }
  parameters_ = options_.resolved();
  if (uses_pair_levels(parameters_)) {
    levels_ = std::make_unique<PairLevelsEstimator>(options_.disparities, execution_);
  }
}

int StereoMatcher::check_level(const RefinementOptions& refinement, scheduler::Extent image) const {
  const auto coarsest = static_cast<int>(level_extents(image, parameters_.levels).size()) - 1;
  return std::min(refinement.cross_check_level, coarsest);
}

bool StereoMatcher::wants_confidence(const MatchRequest& request) const {
  return request.confidence || (!options_.raw && uses_confidence(options_.resolved_refinement()));
}

/// What is estimated from a pair's grey levels.
void StereoMatcher::settle_levels(const Photograph& left, const Photograph& right,
                                  Prepared& prepared, MatchReport& report) const {
  // Throws for the whole images, where bands of them would be named otherwise.
  candidate_geometry(options_, Reference::kLeft, left.width(), left.height());
  const PairLevels levels =
      levels_->estimate(left, right, parameters_.colour, parameters_.match_exposure);
  prepared.of_right = levels.of_right;
  if (parameters_.estimate_sigma_measurement && levels.sigma_measurement) {
    prepared.parameters.sigma_measurement = *levels.sigma_measurement;
  }
  report.levels = levels;
}

/// The same of each other image beside the reference; σ is that of the noisiest.
std::vector<LevelChanges> StereoMatcher::settle_levels(const Photograph& reference,
                                                       std::span<const OtherView> others,
                                                       Prepared& prepared,
                                                       MatchReport& report) const {
  std::vector<LevelChanges> changes;
  std::optional<double> sigma;
  for (const OtherView& other : others) {
    // In units of x_reference − x_other.
    const double ratio = other.baseline / std::abs(others.front().baseline);
    const auto [least, most] =
        std::minmax({options_.disparities.min * ratio, options_.disparities.max * ratio});
    const DisparityRange range{static_cast<int>(std::floor(least)),
                               static_cast<int>(std::ceil(most))};
    const PairLevels levels =
        PairLevelsEstimator(range, execution_)
            .estimate(reference, *other.photograph, parameters_.colour, parameters_.match_exposure);
    changes.push_back(levels.of_right);
    if (levels.sigma_measurement) {
      sigma = std::max(sigma.value_or(0), *levels.sigma_measurement);
    }
    if (!report.levels) {
      report.levels = levels;
    }
  }
  if (parameters_.estimate_sigma_measurement && sigma) {
    prepared.parameters.sigma_measurement = *sigma;
  }
  return changes;
}

/// What the chains of both maps read.
std::pair<ChainInput, ChainInput> StereoMatcher::prepare_inputs(const Photograph& left,
                                                                const Photograph& right,
                                                                bool needs_left, bool needs_right,
                                                                bool uses_prior,
                                                                Prepared& prepared) const {
  const auto geometry = candidate_geometry(options_, Reference::kLeft, left.width(), left.height());
  ChainInput left_input;
  ChainInput right_input;
  if (uses_column_ssd(parameters_) && !options_.disparities_y && !uses_prior) {
    prepare_pair(left, right, geometry, parameters_.window_px * parameters_.window_px,
                 {needs_left, needs_right}, execution_, prepared.pair);
    left_input.pair = right_input.pair = &prepared.pair;
  } else {
    prepared.images.resize(2);
    CostImage& left_image = prepared.images[0];
    CostImage& right_image = prepared.images[1];
    left_image.prepare(left, prepared.parameters, geometry, {needs_left, false, needs_right},
                       execution_);
    right_image.prepare(right, prepared.parameters, geometry,
                        {needs_right, needs_left, false, prepared.of_right}, execution_);
    left_input = {nullptr, &left_image, {CostPartner{&right_image}}};
    right_input = {nullptr, &right_image, {CostPartner{&left_image}}};
  }
  return {left_input, right_input};
}

scheduler::ChainPlan StereoMatcher::plan(const Photograph& left, const Photograph& right) const {
  return plans(left, right, {&execution_.options(), 1}).front();
}

std::vector<scheduler::ChainPlan> StereoMatcher::plans(
    const Photograph& left, const Photograph& right,
    std::span<const ExecutionOptions> executions) const {
  require_equal_sizes(left, "left image", right, "right image");
  const auto prepared = prepared_.borrow();
  prepared->parameters = parameters_;
  prepared->of_right = {};
  const ChainInput input = prepare_inputs(left, right, true, false, false, *prepared).first;
  const auto geometry = candidate_geometry(options_, Reference::kLeft, left.width(), left.height());
  DisparityMap map(left.width(), left.height());
  const LevelVolume coarser;  // nobody looks into it
  const auto extents = level_extents({left.width(), left.height()}, parameters_.levels);
  const bool is_pruned = parameters_.candidate_blocks > 0 && extents.size() > 1;
  CandidateBlocks blocks;
  if (is_pruned) {
    blocks.resize(extents.front(), geometry.count, parameters_.candidate_blocks);
  }
  const MatchChain chain(parameters_, geometry, input, {.disparity_px = map.view()},
                         {.coarser = extents.size() > 1 ? &coarser : nullptr,
                          .blocks = is_pruned ? &blocks : nullptr});
  std::vector<scheduler::ChainPlan> plans;
  for (const ExecutionOptions& execution : executions) {
    plans.push_back(plan_of(chain, execution, thread_count(execution, execution_.machine())));
  }
  return plans;
}

void StereoMatcher::match(const Photograph& left, const Photograph& right,
                          const MatchRequest& request, DisparityMaps& maps,
                          MatchReport* report) const {
  require_equal_sizes(left, "left image", right, "right image");
  require_usable(request.prior, left);
  if (!request.prior.empty() && options_.disparities_y) {
    throw UsageError("there is a prior beside disparities-y, expected a search along rows only");
  }
  const bool uses_prior = !request.prior.empty() && request.prior.weight > 0;
  MatchReport own_report;
  MatchReport& times = report != nullptr ? *report : own_report;
  times = {};
  StageClock clock(times);
  clock.begin("prepare");
  const RefinementOptions refinement = options_.resolved_refinement();
  const int check_level = this->check_level(refinement, {left.width(), left.height()});
  const auto need = [&](bool is_wanted, bool is_other_wanted) -> MapNeed {
    const bool is_checked = !options_.raw && refinement.cross_check;
    return {.whole = is_wanted || (is_checked && check_level == 0),
            .coarse = is_checked && check_level > 0 && is_other_wanted};
  };
  const MapNeed needs_left = need(request.left, request.right);
  const MapNeed needs_right = need(request.right, request.left);
  const auto prepared = prepared_.borrow();
  prepared->parameters = parameters_;
  prepared->of_right = {};
  if (levels_) {
    clock.begin("grey levels");
    settle_levels(left, right, *prepared, times);
    clock.begin("prepare");
  }
  auto [left_input, right_input] =
      prepare_inputs(left, right, needs_left.any(), needs_right.any(), uses_prior, *prepared);
  if (uses_prior) {
    left_input.prior_px = request.prior.left_px;
    right_input.prior_px = request.prior.right_px;
    left_input.prior_weight = right_input.prior_weight = request.prior.weight;
  }

  const bool confidence = wants_confidence(request);
  const auto compute = [&](MapNeed needed, Reference reference, const Photograph& photograph,
                           ChainInput& input, DisparityMap& map, Image<float>& map_confidence,
                           DisparityMap& map_y, DisparityMap& coarse, std::string_view name) {
    const bool two_dimensional = options_.disparities_y.has_value();
    const auto resize = [&](Image<float>& image, bool is_wanted) {
      image.resize(is_wanted ? left.width() : 0, is_wanted ? left.height() : 0);
    };
    resize(map, needed.whole);
    resize(map_confidence, needed.whole && confidence);
    resize(map_y, needed.whole && two_dimensional);
    resize(coarse, needed.coarse);
    if (needed.any()) {
      clock.begin(name);
      input.edges = prepared->edges.prepare(photograph, parameters_, execution_);
      Result result{needed.whole ? map : coarse, nullptr, nullptr};
      if (needed.whole) {
        result.confidence = confidence ? &map_confidence : nullptr;
        result.disparity_y_px = two_dimensional ? &map_y : nullptr;
      }
      if (needed.coarse) {
        result.coarse = {
            .level = check_level, .disparity_px = coarse.view(), .is_all = !needed.whole};
      }
      compute_map(reference, input, *prepared, result, times);
    }
  };
  compute(needs_left, Reference::kLeft, left, left_input, maps.left, maps.left_confidence,
          maps.left_disparity_y, prepared->coarse_px[0], "match left");
  compute(needs_right, Reference::kRight, right, right_input, maps.right, maps.right_confidence,
          maps.right_disparity_y, prepared->coarse_px[1], "match right");

  if (options_.raw) {
    if (request.unmatched) {
      mark_unknown(maps.left.view(), execution_, maps.left_unmatched);
      mark_unknown(maps.right.view(), execution_, maps.right_unmatched);
    }
    return;
  }
  const auto work = refinement_works_.borrow();
  const MapToRefine left_map{
      .side = MapSide::kLeft,
      .image = &left,
      .disparity_px = needs_left.whole ? &maps.left : nullptr,
      .disparity_y_px = options_.disparities_y ? &maps.left_disparity_y : nullptr,
      .confidence = &maps.left_confidence,
      .unmatched = &maps.left_unmatched,
      .check_px = std::as_const(prepared->coarse_px[0]).view(),
      .is_result = request.left};
  const MapToRefine right_map{
      .side = MapSide::kRight,
      .image = &right,
      .disparity_px = needs_right.whole ? &maps.right : nullptr,
      .disparity_y_px = options_.disparities_y ? &maps.right_disparity_y : nullptr,
      .confidence = &maps.right_confidence,
      .unmatched = &maps.right_unmatched,
      .check_px = std::as_const(prepared->coarse_px[1]).view(),
      .is_result = request.right};
  refine_maps(refinement, left_map, &right_map, execution_, *work,
              [&](std::string_view step) { clock.begin(step); });
}

void StereoMatcher::match_several(const Photograph& reference, std::span<const OtherView> others,
                                  const MatchRequest& request, DisparityMaps& maps,
                                  MatchReport* report) const {
  require_different_baselines(others);
  for (std::size_t k = 0; k < others.size(); ++k) {
    require_equal_sizes(reference, "reference image", *others[k].photograph,
                        fmt::format("image {}", k + 1));
  }
  MatchReport own_report;
  MatchReport& times = report != nullptr ? *report : own_report;
  times = {};
  StageClock clock(times);
  clock.begin("prepare");
  const bool is_left = others.front().baseline > 0;
  const Reference side = is_left ? Reference::kLeft : Reference::kRight;
  const int width = reference.width();
  const int height = reference.height();
  const auto geometry = candidate_geometry(options_, Reference::kLeft, width, height);
  const auto prepared = prepared_.borrow();
  prepared->parameters = parameters_;
  std::vector<LevelChanges> changes(others.size());
  if (levels_) {
    clock.begin("grey levels");
    changes = settle_levels(reference, others, *prepared, times);
    clock.begin("prepare");
  }
  prepared->images.resize(others.size() + 1);
  prepared->images[0].prepare(reference, prepared->parameters, geometry, {true, false, false},
                              execution_);
  ChainInput input{nullptr, prepared->images.data(), {}};
  for (std::size_t k = 0; k < others.size(); ++k) {
    CostImage& image = prepared->images[k + 1];
    const double ratio = others[k].baseline / others.front().baseline;
    image.prepare(*others[k].photograph, prepared->parameters, geometry,
                  {false, true, true, changes[k]}, execution_);
    input.partners.push_back({&image, ratio});
  }

  const bool confidence = wants_confidence(request);
  const bool two_dimensional = options_.disparities_y.has_value();
  maps = {};
  DisparityMap& map = is_left ? maps.left : maps.right;
  Image<float>& map_confidence = is_left ? maps.left_confidence : maps.right_confidence;
  DisparityMap& map_y = is_left ? maps.left_disparity_y : maps.right_disparity_y;
  Mask& unmatched = is_left ? maps.left_unmatched : maps.right_unmatched;
  map.resize(width, height);
  map_confidence.resize(confidence ? width : 0, confidence ? height : 0);
  map_y.resize(two_dimensional ? width : 0, two_dimensional ? height : 0);
  clock.begin("match");
  input.edges = prepared->edges.prepare(reference, parameters_, execution_);
  compute_map(side, input, *prepared,
              {map, confidence ? &map_confidence : nullptr, two_dimensional ? &map_y : nullptr},
              times);

  if (options_.raw) {
    if (request.unmatched) {
      mark_unknown(map.view(), execution_, unmatched);
    }
    return;
  }
  const auto work = refinement_works_.borrow();
  const MapToRefine to_refine{.side = is_left ? MapSide::kLeft : MapSide::kRight,
                              .image = &reference,
                              .disparity_px = &map,
                              .disparity_y_px = two_dimensional ? &map_y : nullptr,
                              .confidence = &map_confidence,
                              .unmatched = &unmatched};
  refine_maps(options_.resolved_refinement(), to_refine, nullptr, execution_, *work,
              [&](std::string_view step) { clock.begin(step); });
}

void StereoMatcher::add_memory_use(MemoryUse& use) const {
  if (levels_) {
    levels_->add_memory_use(use);
  }
  prepared_.for_each_idle([&use](const Prepared& prepared) {
    std::size_t bytes = prepared.pair.grey_8.held_bytes() + prepared.pair.grey_float.held_bytes() +
                        prepared.edges.held_bytes();
    for (const CostImage& image : prepared.images) {
      bytes += image.held_bytes();
    }
    for (const Image<float>* image :
         {&prepared.candidate_disparity_px, &prepared.energy, &prepared.candidate_confidence,
          &prepared.candidate_energy, &prepared.coarse_px[0], &prepared.coarse_px[1]}) {
      bytes += held_bytes(*image);
    }
    use.add("prepared images", bytes);
    use.add("coarse levels", prepared.levels.held_bytes());
  });
  refinement_works_.for_each_idle(
      [&use](const RefinementWork& work) { use.add("refinement", held_bytes_of(work)); });
}

void StereoMatcher::compute_map(Reference reference, const ChainInput& input, Prepared& prepared,
                                const Result& result, MatchReport& report) const {
  const auto geometry = candidate_geometry(options_, reference, result.disparity_px.width(),
                                           result.disparity_px.height());
  if (options_.disparities_y) {
    search_rows(geometry, input, prepared, result, report);
    return;
  }
  MapOutputs outputs{.disparity_px = result.disparity_px.view()};
  if (result.confidence != nullptr) {
    outputs.confidence = result.confidence->view();
  }
  run_levels(geometry, input, outputs, result.coarse, prepared, report);
}

/// Vertical disparities one after the other, each like a search along rows between shifted images;
/// of the winners the best is kept (5.5.3).
void StereoMatcher::search_rows(const kernels::CandidateGeometry& geometry, const ChainInput& input,
                                Prepared& prepared, const Result& result,
                                MatchReport& report) const {
  const int width = result.disparity_px.width();
  const int height = result.disparity_px.height();
  constexpr float nothing = std::numeric_limits<float>::quiet_NaN();
  result.disparity_px.fill(nothing);
  result.disparity_y_px->fill(nothing);
  prepared.energy.resize(width, height);
  prepared.energy.fill(std::numeric_limits<float>::infinity());
  prepared.candidate_energy.resize(width, height);
  prepared.candidate_disparity_px.resize(width, height);
  MapOutputs outputs{.disparity_px = prepared.candidate_disparity_px.view(),
                     .energy = prepared.candidate_energy.view()};
  WinnerMerge merge{.candidate_disparity_px = prepared.candidate_disparity_px.view(),
                    .candidate_energy = prepared.candidate_energy.view(),
                    .disparity_px = result.disparity_px.view(),
                    .disparity_y = result.disparity_y_px->view(),
                    .energy = prepared.energy.view()};
  if (result.confidence != nullptr) {
    result.confidence->fill(nothing);
    prepared.candidate_confidence.resize(width, height);
    outputs.confidence = prepared.candidate_confidence.view();
    merge.candidate_confidence = prepared.candidate_confidence.view();
    merge.confidence = result.confidence->view();
  }
  ChainInput shifted = input;
  for (int d = options_.disparities_y->min; d <= options_.disparities_y->max; ++d) {
    for (CostPartner& partner : shifted.partners) {
      partner.disparity_y_px = d;
    }
    run_levels(geometry, shifted, outputs, {}, prepared, report);
    merge.disparity_y_px = d;
    execution_.for_each_band(height, [&](int first_row, int end_row) {
      for (int y = first_row; y < end_row; ++y) {
        const int partner_row = y + geometry.direction * d;
        if (partner_row >= 0 && partner_row < height) {
          merge.merge_row(y);
        }
      }
    });
  }
}

scheduler::ChainPlan StereoMatcher::plan_of(const MatchChain& chain,
                                            const ExecutionOptions& execution, int threads) const {
  scheduler::PlanRequest request;
  request.threads = threads;
  request.strip_columns = execution.strip_width_px;
  request.band_rows = execution.band_height_px;
  request.memory_bytes = execution.chain_memory_bytes;
  if (execution.iterations_per_pass) {
    request.pass_ends = chain.pass_ends(*execution.iterations_per_pass);
  }
  return scheduler::plan_chain(chain.stages(), execution_.machine(), request);
}

/// One map along rows: flat or coarse to fine.
void StereoMatcher::run_levels(const kernels::CandidateGeometry& geometry, const ChainInput& input,
                               const MapOutputs& outputs, const CoarseMap& coarse_map,
                               Prepared& prepared, MatchReport& report) const {
  const MethodParameters& parameters = prepared.parameters;
  const double pixels = static_cast<double>(geometry.width) * outputs.disparity_px.height();
  if (parameters.levels == 1) {
    run_chain(MatchChain(parameters, geometry, input, outputs), report);
    report.finest_pixels += pixels;
    report.cells += pixels * options_.disparities.count();
    report.finest_cells += pixels * options_.disparities.count();
    return;
  }
  scheduler::ChainPlan plan_before = report.plan;
  const LevelCells cells = match_coarse_to_fine(
      parameters, geometry, input, outputs, prepared.levels, execution_,
      [&](const MatchChain& chain) { run_chain(chain, report); }, coarse_map);
  report.cells += cells.all_levels;
  if (coarse_map.is_all) {
    report.plan = std::move(plan_before);
    return;
  }
  report.finest_cells += cells.finest_level;
  report.finest_pixels += pixels;
}

void StereoMatcher::run_chain(const MatchChain& chain, MatchReport& report) const {
  report.plan = plan_of(chain, execution_.options(), execution_.executor().thread_count());
  scheduler::run_strips(chain.stages(), report.plan, execution_.executor(), execution_.scratch());
}

}  // namespace vantage
