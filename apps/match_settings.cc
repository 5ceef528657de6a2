#include "apps/match_settings.h"

#include <fmt/format.h>

#include <limits>

#include "engine/error.h"
#include "engine/matching/options/match_presets.h"
#include "engine/matching/options/method_names.h"

namespace vantage::apps {
namespace {

/// "auto: squared; gradient for gradient, …": a default that depends on the method. The rule is
/// what most methods have.
template <typename Enum>
std::string by_method(Enum MethodParameters::*field, Enum rule) {
  std::string text = fmt::format("auto: {}", name_of(rule));
  std::string separator = "; ";
  for (const auto& [method_name, method] : method_names()) {
    if (const Enum value = book_parameters(method).*field; value != rule) {
      text += fmt::format("{}{} for {}", separator, name_of(value), method_name);
      separator = ", ";
    }
  }
  return text;
}

/// "auto: 9": a default that all methods share.
std::string shared(double value) { return fmt::format("auto: {}", value); }

bool is_word(const SettingValue& value, std::string_view word) {
  return value.is_string() && value.get_ref<const std::string&>() == word;
}

void add_exposure_setting(Settings& settings, MethodOverrides& parameters) {
  settings.choice<bool>(
      "match-exposure", parameters.match_exposure, {{"estimated", true}, {"none", false}},
      "What makes the right image's grey levels the left's before they are "
      "compared: gain and offset estimated from each pair, or nothing; auto: none");
}

void add_sigma_measurement_setting(Settings& settings, MethodOverrides& parameters) {
  Setting& setting =
      settings.add("sigma-measurement", "S|estimated",
                   "Cost contaminated or combined, aggregation bayes, certainty entropy: the noise "
                   "in grey levels, above 0; estimated: from each pair; " +
                       shared(book_parameters(MatchMethod::kSsd).sigma_measurement) +
                       "; estimated for cost combined");
  setting.set = [&parameters](const SettingValue& value) {
    const bool is_estimated = is_word(value, "estimated");
    const bool is_number = !is_estimated && !is_word(value, "auto");
    parameters.sigma_measurement = is_number ? std::optional(to_number(value)) : std::nullopt;
    parameters.estimate_sigma_measurement =
        is_number || is_estimated ? std::optional(is_estimated) : std::nullopt;
  };
  setting.get = [&parameters]() -> SettingValue {
    if (parameters.estimate_sigma_measurement == true) {
      return "estimated";
    }
    return parameters.sigma_measurement ? SettingValue(*parameters.sigma_measurement)
                                        : SettingValue("auto");
  };
}

void add_cost_settings(Settings& settings, MethodOverrides& parameters) {
  const MethodParameters book = book_parameters(MatchMethod::kSsd);
  settings.begin_group("Matching: cost");
  settings.choice("cost", parameters.cost, cost_names(),
                  "How unlike a pixel and its partner are; " +
                      by_method(&MethodParameters::cost, MatchCost::kSquared));
  settings.choice<ColourUse>("colour", parameters.colour,
                             {{"luma", ColourUse::kLuma}, {"channels", ColourUse::kChannels}},
                             "What is compared of colour images: their luma, or each channel, of "
                             "which the costs are averaged; auto: luma");
  settings.number("truncation", parameters.truncation, "T",
                  "Cost truncated: its most, in grey levels, above 0; " + shared(book.truncation));
  add_exposure_setting(settings, parameters);
  add_sigma_measurement_setting(settings, parameters);
  settings.number(
      "epsilon-measurement", parameters.epsilon_measurement, "E",
      "Cost contaminated or combined, aggregation bayes: the share of outliers, between "
      "0 and 1; " +
          shared(book.epsilon_measurement));
  settings.integer("census-thresholds", parameters.census_thresholds, "N",
                   "Cost census-rays: how many grey levels each neighbour is compared with, 1 (the "
                   "pixel's) or 3 (1.25 less and more, too: better where noise is as large as "
                   "texture, in more time); " +
                       shared(book.census_thresholds));
  settings.number("sigma-census", parameters.sigma_census, "S",
                  "Cost combined: how many census bits differ by noise, as a share of all, at most "
                  "1; 0 leaves them out; " +
                      shared(book.sigma_census));
  settings.number("sigma-gradient", parameters.sigma_gradient, "S",
                  "Cost combined: the noise of gradients in grey levels per pixel; 0 leaves them "
                  "out; " +
                      shared(book.sigma_gradient));
  add_gradient_settings(settings, parameters);
}

void add_aggregation_settings(Settings& settings, MethodOverrides& parameters) {
  const MethodParameters book = book_parameters(MatchMethod::kSsd);
  settings.begin_group("Matching: aggregation");
  settings.choice("aggregate", parameters.aggregation, aggregation_names(),
                  "How costs gather support from their neighbours; " +
                      by_method(&MethodParameters::aggregation, Aggregation::kBox));
  settings.integer("window", parameters.window_px, "PX",
                   "box: side of the square window, odd, 1 to 181; " + shared(book.window_px));
  settings.choice<Border>("border", parameters.border,
                          {{"clip", Border::kClip}, {"valid", Border::kValid}},
                          "box: clip uses the part of a window inside both images, valid takes "
                          "whole windows only; auto: clip");
  settings.number(
      "aggregation-sigma", parameters.aggregation_sigma_px, "PX",
      "gaussian, box-cascade: standard deviation, 0.5 to 16; " + shared(book.aggregation_sigma_px));
  settings.integer("iterations", parameters.iterations, "N",
                   "diffusion, membrane, local-stopping, bayes: how many, 0 to 10000; " +
                       shared(book.iterations));
  settings.integer("levels", parameters.levels, "N",
                   "Coarse to fine, iterations at each level: how many levels, each half as wide "
                   "and high as the one before, 1 (the image alone) to 10; " +
                       shared(book.levels));
  settings.integer(
      "candidate-blocks", parameters.candidate_blocks, "K",
      "bayes with levels: on the finest levels only the K blocks of 16 disparities, up "
      "to 8, that hold the coarser level's winners around; 0: all; " +
          shared(book.candidate_blocks));
  settings.integer("pruned-levels", parameters.pruned_levels, "N",
                   "How many of the finest levels that is, 1 to 10; " + shared(book.pruned_levels));
  settings.integer("final-iterations", parameters.final_iterations, "N",
                   "Several levels: iterations of the finest one, the image itself, 0 to 10000; "
                   "auto: as --iterations");
  settings.number("lambda", parameters.lambda, "L",
                  "diffusion, local-stopping: step, above 0 and below 0.25; membrane: at most "
                  "1/(4 + beta); " +
                      shared(book.lambda));
  settings.number("beta", parameters.beta, "B",
                  "membrane: pull towards the first costs, at least 0; " + shared(book.beta));
  settings.choice<Certainty>(
      "certainty", parameters.certainty,
      {{"margin", Certainty::kMargin}, {"entropy", Certainty::kEntropy}},
      "local-stopping: what must not fall, the winner's margin or the negative entropy; auto: "
      "margin");
  settings.number("mu", parameters.mu, "M",
                  "bayes: weight of the neighbours, above 0 and at most 1; " + shared(book.mu));
  settings.number("sigma-prior", parameters.sigma_prior, "S",
                  "bayes: how much neighbours differ, in pixels of disparity, above 0; " +
                      shared(book.sigma_prior));
  settings.number("epsilon-prior", parameters.epsilon_prior, "E",
                  "bayes: the share of neighbours of any disparity, between 0 and 1; " +
                      shared(book.epsilon_prior));
  settings.number("prior-growth", parameters.prior_growth, "G",
                  "bayes with several levels: --sigma-prior of a level over that of the next finer "
                  "one, 1 to 4; " +
                      shared(book.prior_growth));
  settings.choice<PriorSmoothing>(
      "prior-smoothing", parameters.prior_smoothing,
      {{"sum", PriorSmoothing::kSum}, {"maximum", PriorSmoothing::kMaximum}},
      "bayes: of the disparities near one that a neighbour may have, sum adds up the "
      "probabilities, maximum takes the largest, which is several times faster; auto: sum");
  settings.number("level-weight", parameters.level_weight, "W",
                  "bayes with several levels: how much of the evidence of four pixels is that of "
                  "one of the next coarser level, above 0 and at most 1; " +
                      shared(book.level_weight));
  settings.number("edge-weight", parameters.edge_weight, "W",
                  "bayes: how much neighbours count across intensity edges, 0 to 1, where edges do "
                  "not matter; " +
                      shared(book.edge_weight));
  settings.number("edge-contrast", parameters.edge_contrast, "C",
                  "bayes: difference in grey levels that is an edge for --edge-weight, above 0; " +
                      shared(book.edge_contrast));
}

void add_selection_settings(Settings& settings, MatchOptions& options) {
  settings.begin_group("Matching: selection");
  settings.choice<Subpixel>("subpixel", options.parameters.subpixel,
                            {{"parabola", Subpixel::kParabola}, {"none", Subpixel::kNone}},
                            "Refinement of the winner between candidates; auto: parabola");
}

/// A number of pixels, or `on` for the usual one.
void add_usual_pixels(Settings& settings, const std::string& name, std::optional<int>& field,
                      int usual_px, const std::string& help) {
  Setting& setting = settings.add(name, "PX|on", help);
  setting.set = [&field, usual_px](const SettingValue& value) {
    if (is_word(value, "auto")) {
      field.reset();
    } else {
      field = is_word(value, "on") ? usual_px : to_integer(value);
    }
  };
  setting.get = [&field] { return field ? SettingValue(*field) : SettingValue("auto"); };
}

void add_edge_snapping_setting(Settings& settings, RefinementOverrides& refinement) {
  constexpr int kUsualPx = 4;
  add_usual_pixels(
      settings, "edge-snapping", refinement.edge_snapping_px, kUsualPx,
      fmt::format("Move discontinuities to intensity edges at most PX columns away, 0 to 16; on: "
                  "{}; auto: 0, which leaves them",
                  kUsualPx));
}

void add_surface_fit_setting(Settings& settings, RefinementOverrides& refinement) {
  constexpr int kUsualPx = 10;
  add_usual_pixels(
      settings, "surface-fit", refinement.surface_fit_px, kUsualPx,
      fmt::format("Matched pixels take the values of planes fitted to the matched ones at most PX "
                  "around, 0 to 16; on: {}; auto: 0, which leaves them",
                  kUsualPx));
}

void add_cross_check_setting(Settings& settings, RefinementOverrides& refinement) {
  Setting& setting = settings.add("cross-check", "PX|none",
                                  "Left and right disparities agree if they differ by less, at "
                                  "least 1; none: no check; auto: the number of candidates / 15");
  setting.set = [&refinement](const SettingValue& value) {
    const bool is_number = !is_word(value, "auto") && !is_word(value, "none");
    refinement.cross_check_px = is_number ? std::optional(to_number(value)) : std::nullopt;
    refinement.cross_check = is_word(value, "auto") ? std::nullopt : std::optional(is_number);
  };
  setting.get = [&refinement]() -> SettingValue {
    if (refinement.cross_check == false) {
      return "none";
    }
    return refinement.cross_check_px ? SettingValue(*refinement.cross_check_px)
                                     : SettingValue("auto");
  };
}

void add_confidence_setting(Settings& settings, RefinementOverrides& refinement) {
  Setting& setting =
      settings.add("confidence-threshold", "X|none",
                   "Pixels of no more confidence (see --confidence of match) count as unmatched; "
                   "none: all may match; auto: 0 for cost gradient, none for others");
  std::optional<double>& field = refinement.confidence_threshold;
  setting.set = [&field](const SettingValue& value) {
    if (is_word(value, "auto")) {
      field.reset();
    } else {
      field = is_word(value, "none") ? kNoConfidenceThreshold : to_number(value);
    }
  };
  setting.get = [&field]() -> SettingValue {
    if (field == kNoConfidenceThreshold) {
      return "none";
    }
    return field ? SettingValue(*field) : SettingValue("auto");
  };
}

void add_refinement_settings(Settings& settings, MatchOptions& options) {
  settings.begin_group("Refinement");
  settings.flag("raw", options.raw, "Winner-take-all only: nothing of this group");
  add_edge_snapping_setting(settings, options.refinement);
  add_cross_check_setting(settings, options.refinement);
  settings.integer("cross-check-level", options.refinement.cross_check_level, "N",
                   "bayes with levels: the level of the other image's map that pixels are checked "
                   "against, 1 to 9; a map that is not asked for is not made any finer; 0: the "
                   "map itself; auto: 0");
  add_confidence_setting(settings, options.refinement);
  settings.integer("speckle-size", options.refinement.speckle_size_px, "PX",
                   "Matched regions of fewer pixels count as unmatched; auto: 0, which keeps them");
  add_surface_fit_setting(settings, options.refinement);
  settings.choice<Fill>(
      "fill", options.refinement.fill,
      {{"constant", Fill::kConstant},
       {"linear", Fill::kLinear},
       {"median", Fill::kMedian},
       {"none", Fill::kNone}},
      "What unmatched pixels become: the depth of the background beside them, a line where both "
      "sides are one surface, the median of what looks alike around them, unknown; auto: constant");
}

void add_parameter_settings(Settings& settings, MatchOptions& options) {
  add_cost_settings(settings, options.parameters);
  add_aggregation_settings(settings, options.parameters);
  add_selection_settings(settings, options);
  add_refinement_settings(settings, options);
}

/// The command line that `preset` stands for.
std::string describe(MatchPreset preset) {
  const PresetSettings preset_values = preset_settings(preset);
  MatchOptions options;
  Settings settings("", "");
  add_parameter_settings(settings, options);
  const SettingValue unset = settings.values();
  options.parameters = preset_values.parameters;
  options.refinement = preset_values.refinement;
  std::string text(name_of(preset_values.method));
  const SettingValue values = settings.values();
  for (const auto& [name, value] : values.items()) {
    if (value != unset[name]) {
      text += fmt::format(" --{} {}", name,
                          value.is_string() ? value.get<std::string>() : value.dump());
    }
  }
  return text;
}

void add_method_settings(Settings& settings, MatchOptions& options) {
  settings.choice("method", options.method, method_names(),
                  "Combination of cost, aggregation and their parameters; auto: the preset's, "
                  "without one ssd");
  std::string help =
      "For real photographs, instead of --method; what it sets goes before auto; auto: balanced, "
      "none with --method, --aggregate, --disparities-y or several images, which begin with ssd";
  for (const auto& [name, preset] : preset_names()) {
    help += fmt::format("; {}: {}", name, describe(preset));
  }
  settings.choice("preset", options.preset, preset_names(), help);
}

}  // namespace

DisparityRange to_disparity_range(const SettingValue& value, std::string_view expected) {
  const auto parts = split(value.is_string() ? value.get<std::string>() : "", ':');
  try {
    if (parts.size() == 2) {
      return {to_integer(parts[0]), to_integer(parts[1])};
    }
  } catch (const UsageError&) {  // the message below says more
  }
  reject_value(value, expected);
}

std::string to_text(DisparityRange range) { return fmt::format("{}:{}", range.min, range.max); }

MatchOptions options_with_found_range() {
  MatchOptions options;
  options.disparities_auto = true;
  return options;
}

void add_gradient_settings(Settings& settings, MethodOverrides& parameters) {
  settings.number("alpha", parameters.alpha, "A",
                  "Cost gradient: weight of the difference of the gradients, at least 0; " +
                      shared(book_parameters(MatchMethod::kGradient).alpha));
  settings.choice<GradientNorm>("norm", parameters.norm,
                                {{"l2", GradientNorm::kL2}, {"octagon", GradientNorm::kOctagon}},
                                "Cost gradient: length of gradients; auto: l2");
  settings.choice<GradientFilter>("gradient", parameters.gradient,
                                  {{"central", GradientFilter::kCentral},
                                   {"sobel", GradientFilter::kSobel},
                                   {"simoncelli3", GradientFilter::kSimoncelli3},
                                   {"simoncelli5", GradientFilter::kSimoncelli5}},
                                  "Cost gradient: filter; --confidence-threshold depends on its "
                                  "gain; auto: central");
  settings.choice<bool>("prefilter", parameters.prefilter, {{"gaussian", true}, {"none", false}},
                        "Cost gradient: what smooths the images first, a Gaussian of 0.5 px; "
                        "auto: gaussian");
}

void add_match_settings(Settings& settings, MatchOptions& options) {
  settings.begin_group("Matching");
  Setting& disparities = settings.add(
      "disparities", "MIN:MAX|auto",
      "Candidate disparities x_left - x_right in pixels, both inclusive; auto: what the pair "
      "suggests, of a sequence up to 16 pairs of it");
  disparities.set = [&options](const SettingValue& value) {
    options.disparities_auto = is_word(value, "auto");
    if (!options.disparities_auto) {
      options.disparities =
          to_disparity_range(value, "MIN:MAX in whole pixels, such as 0:63 or -16:15, or auto");
    }
  };
  disparities.get = [&options] {
    return options.disparities_auto ? "auto" : to_text(options.disparities);
  };
  Setting& disparities_y = settings.add(
      "disparities-y", "MIN:MAX|auto",
      "Candidates y_left - y_right of a search in two dimensions; auto: what the pair suggests; "
      "none: 0 only, as of rectified pairs");
  disparities_y.set = [&options](const SettingValue& value) {
    options.disparities_y_auto = is_word(value, "auto");
    if (is_word(value, "none")) {
      options.disparities_y.reset();
    } else if (options.disparities_y_auto) {
      options.disparities_y = DisparityRange{0, 0};
    } else {
      options.disparities_y =
          to_disparity_range(value, "MIN:MAX in whole pixels, such as -2:2, or auto");
    }
  };
  disparities_y.get = [&options] {
    return options.disparities_y_auto ? "auto"
           : options.disparities_y    ? to_text(*options.disparities_y)
                                      : "none";
  };
  add_method_settings(settings, options);
  add_parameter_settings(settings, options);
}

void add_reference_setting(Settings& settings, MatchOptions& options) {
  settings.begin_group("Matching");
  settings.choice<Side>("reference", options.reference,
                        {{"left", Side::kLeft}, {"right", Side::kRight}},
                        "The image whose grid the disparity map is on");
}

SettingValue reported_settings(const Settings& settings, const MatchOptions& options) {
  MatchOptions in_force = options.fully_resolved();
  Settings resolved("", "");
  add_match_settings(resolved, in_force);
  SettingValue values = settings.values();
  values["resolved"] = resolved.values();
  const std::optional<MatchPreset> preset = options.preset_in_force();
  values["resolved"]["preset"] = preset ? std::string(name_of(*preset)) : "none";
  return values;
}

}  // namespace vantage::apps
