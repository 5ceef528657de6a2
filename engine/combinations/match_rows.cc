#include <fmt/format.h>

#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "engine/combinations/combination_rows.h"
#include "engine/refinement/refinement_options.h"

// What does not go together in a method, and in the options of a match.

namespace vantage {
namespace {

constexpr CombinationScope kMethod = CombinationScope::kMethod;
constexpr CombinationScope kMatch = CombinationScope::kMatch;
constexpr double kNoPenalty = std::numeric_limits<double>::infinity();

Condition reduced(std::string_view phrase = "with a reduced search-size") {
  return is_not("search-size", "full").said(phrase);
}

/// Candidates of fine levels are pruned.
void add_pruning(std::vector<Combination>& rows) {
  const auto add = [&](const Condition& with, std::string_view reason) {
    rows.push_back({.scope = kMethod,
                    .option = above("candidate-blocks", 0),
                    .with = {with},
                    .expected = "0",
                    .reason = reason,
                    .gives_way_to = 0});
  };
  add(is("levels", 1).said("with a single level"),
      "candidates are chosen by the winners of a coarser level");
  add(is_not("aggregate", "bayes").said("unless aggregation is bayes"),
      "for energies, candidates that were not searched have no value that is neutral to their "
      "neighbours");
  add(is("cost", "gradient").said("with the cost gradient"),
      "its likelihoods compare a candidate with the best of all");
  add(is("prior-smoothing", "sum"), "pruning needs prior-smoothing maximum");
  add(is("prior", "quadratic"), "it is unbounded, so unsearched candidates have no finite cost");
  add(is_not("selection", "winner"), "a path along a row needs the costs of all candidates");
}

/// Fine levels search windows of candidates, or all candidates are searched in reduced images.
void add_windows(std::vector<Combination>& rows) {
  const auto add = [&](const Condition& option, std::vector<Condition> with,
                       std::string_view reason, std::string message) {
    rows.push_back(
        {.scope = kMethod,
         .option = option,
         .with = std::move(with),
         .expected = "0",
         .reason = reason,
         .message = std::move(message),
         .gives_way_to = option.option == "window-levels" ? std::optional(0.0) : std::nullopt});
  };
  add(is("final-iterations", 0), {reduced()}, "the candidates of the full size need them",
      "final-iterations is 0, expected at least 1 with a reduced search-size, whose "
      "full-size candidates need them");
  add(above("window-levels", 0), obstacles_of_windows(), "what windows are searched with",
      "window-levels is {value}, expected 0; a search in windows needs aggregation bayes, levels "
      "above 1, prior-smoothing maximum, a prior other than quadratic, selection winner, "
      "candidate-step 1 and cost census-rays of luma");
  add(above("window-levels", 0), {is("final-iterations", 0)}, "windows need iterations",
      "final-iterations is 0, expected at least 1 with window-levels above 0");
}

/// Components of displacements: whole pixels, each alone.
void add_two_dimensional(std::vector<Combination>& rows) {
  const auto add = [&](const Condition& option, std::string_view expected, std::string_view reason,
                       std::optional<double> gives_way_to = std::nullopt) {
    rows.push_back({.option = option,
                    .with = {given("disparities-y")},
                    .expected = expected,
                    .reason = reason,
                    .gives_way_to = gives_way_to});
  };
  add(below("candidate-step", 1), "1", "displacements are of whole pixels");
  add(above("candidate-blocks", 0), "0", "blocks are of candidates along rows", 0);
  add(is_not("selection", "winner"), "winner", "paths are along rows");
  add(above("window-levels", 0), "0", "windows are of candidates along rows", 0);
  add(below("slant-penalty", kNoPenalty), "none", "surfaces slant along one range only",
      kNoPenalty);
  add(above("edge-snapping", 0), "0", "it moves discontinuities of horizontal disparities only");
  add(above("cross-check-level", 0), "0",
      "winners of coarse levels are kept of searches along rows only", 0);
}

void add_search(std::vector<Combination>& rows) {
  std::vector<Condition> obstacles = obstacles_of_reduced_search();
  obstacles.insert(obstacles.begin(), given("disparities-y"));
  rows.push_back(
      {.option = is_not("search-size", "full"),
       .with = std::move(obstacles),
       .reason = "what reduced images are searched with",
       .message = "search-size is not full, expected full: a reduced search-size needs a search "
                  "along rows, aggregation bayes, levels above 1, prior-smoothing maximum, a prior "
                  "other than quadratic, selection winner, candidate-step 1, and cost census-rays "
                  "with one threshold and colour luma",
       .gives_way_to = 0});
  rows.push_back({.option = above("edge-snapping", 0),
                  .with = {reduced()},
                  .expected = "0",
                  .reason = "maps are enlarged along the image's edges instead"});
  rows.push_back({.option = above("cross-check-level", 0),
                  .with = {reduced()},
                  .expected = "0",
                  .reason = "both maps have half the size"});
  rows.push_back({.option = above("cross-check-level", 0),
                  .with = obstacles_of_checked_levels(),
                  .reason = "others have no maps of coarse levels",
                  .message = "cross-check-level is {value}, expected 0: only aggregation bayes "
                             "with levels above 1 and selection winner has maps of coarse levels",
                  .gives_way_to = 0});
  rows.push_back(
      {.option = above("window-levels", 0),
       .with = {given("candidate-blocks").set_by_user(), given("pruned-levels").set_by_user()},
       .reason = "what the user chose is used",
       .gives_way_to = 0,
       .is_refused = false});
}

void add_symmetric(std::vector<Combination>& rows) {
  const Condition symmetric = is("selection", "symmetric");
  rows.push_back({.option = is("cross-check", "on"),
                  .with = {symmetric},
                  .expected = "none",
                  .reason = "both maps are of one solution",
                  .gives_way_to = 0});
  rows.push_back({.option = below("candidate-step", 1),
                  .with = {symmetric},
                  .expected = "1",
                  .reason = "it matches whole pixels"});
}

/// Refinement that nothing reads.
void add_idle_refinement(std::vector<Combination>& rows) {
  const auto add = [&](const Condition& option, std::vector<Condition> with, std::string message) {
    rows.push_back({.option = option.set_by_user(),
                    .with = std::move(with),
                    .reason = "no effect",
                    .message = std::move(message)});
  };
  const RefinementOptions defaults;
  std::string_view before;
  visit_fields(
      [&](const RefinementField& field, const auto& /*value*/) {
        if (field.option != before) {
          add(set(field.option), {given("raw")},
              fmt::format("{} is set but has no effect with raw, which leaves all refinement out",
                          field.option));
        }
        before = field.option;
      },
      defaults);
  const Condition unchecked = is("cross-check", "none");
  add(given("cross-check PX"), {unchecked},
      "a number of pixels for cross-check is set but has no effect with cross-check none");
  add(above("cross-check-level", 0), {unchecked},
      "cross-check-level is set but has no effect with cross-check none");
  add(is_not("uniform-contrast", defaults.uniform_contrast),
      {is("fill", "constant"), is("fill", "linear"), is("fill", "median"), is("fill", "none")},
      "uniform-contrast is set but has no effect with a fill other than canonical and thin-plate");
  add(above("surface-fit-step", 1), {is("surface-fit", 0)},
      "surface-fit-step is set but has no effect with surface-fit 0");
}

}  // namespace

std::vector<Condition> obstacles_of_windows() {
  return {is_not("aggregate", "bayes"),  is("levels", 1),
          is("prior-smoothing", "sum"),  is("prior", "quadratic"),
          is_not("selection", "winner"), below("candidate-step", 1),
          is_not("cost", "census-rays"), is("colour", "channels")};
}

std::vector<Condition> obstacles_of_reduced_search() {
  std::vector<Condition> obstacles = obstacles_of_windows();
  obstacles.push_back(above("census-thresholds", 1));
  return obstacles;
}

std::vector<Condition> obstacles_of_checked_levels() {
  return {is_not("aggregate", "bayes"), is("levels", 1), is_not("selection", "winner")};
}

std::vector<Condition> obstacles_of_reuse() {
  constexpr std::string_view kLevels = "with a method without coarse levels of Bayesian diffusion";
  return {is("levels", 1).said(kLevels), is_not("aggregate", "bayes").said(kLevels),
          given("disparities-y").said("with disparities-y"),
          is_not("selection", "winner").said("with a selection other than winner"),
          below("candidate-step", 1).said("with candidates between pixels")};
}

std::vector<Combination> method_combinations() {
  std::vector<Combination> rows;
  add_pruning(rows);
  add_windows(rows);
  rows.push_back({.scope = kMethod,
                  .option = is("certainty", "margin"),
                  .with = {is("cost", "gradient")},
                  .reason = "it divides by a sum, which for these costs has both signs",
                  .message =
                      "certainty margin divides by the sum of a pixel's costs, which for the cost "
                      "gradient have both signs; expected certainty entropy"});
  return rows;
}

std::vector<Combination> match_combinations() {
  std::vector<Combination> rows;
  rows.push_back({.option = given("method"),
                  .with = {given("preset")},
                  .reason = "a preset has a method",
                  .message = "method and preset are both set, expected one of them: a preset has a "
                             "method"});
  add_two_dimensional(rows);
  add_symmetric(rows);
  add_search(rows);
  add_idle_refinement(rows);
  return rows;
}

}  // namespace vantage
