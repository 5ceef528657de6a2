#include "apps/match_settings.h"

#include <fmt/format.h>

#include <limits>

#include "engine/error.h"
#include "engine/matching/options/match_presets.h"
#include "engine/matching/options/method_fields.h"
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
  settings.choice<bool>("match-exposure", parameters.match_exposure,
                        {{"estimated", true}, {"none", false}},
                        "Match the brightness of the right image to that of the left one before "
                        "comparing, by a gain and an offset estimated from each pair; auto: none");
}

void add_sigma_measurement_setting(Settings& settings, MethodOverrides& parameters) {
  Setting& setting =
      settings.add("sigma-measurement", "S|estimated",
                   "With cost contaminated or combined, aggregation bayes or certainty entropy: "
                   "standard deviation of the noise, above 0, in the unit of the cost (grey "
                   "levels; with census costs, differing neighbours); estimated: from each pair; " +
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
                  "Measure of how different two pixels are; " +
                      by_method(&MethodParameters::cost, MatchCost::kSquared));
  settings.choice<ColourUse>(
      "colour", parameters.colour, {{"luma", ColourUse::kLuma}, {"channels", ColourUse::kChannels}},
      "Compare colour images by luma, or by the mean of the costs of their channels; auto: luma");
  settings.number("truncation", parameters.truncation, "T",
                  "With cost truncated: maximum difference in grey levels, above 0; " +
                      shared(book.truncation));
  add_exposure_setting(settings, parameters);
  add_sigma_measurement_setting(settings, parameters);
  settings.number("epsilon-measurement", parameters.epsilon_measurement, "E",
                  "With cost contaminated or combined or aggregation bayes: share of outliers, "
                  "above 0 and below 1; " +
                      shared(book.epsilon_measurement));
  settings.integer("census-thresholds", parameters.census_thresholds, "N",
                   "With cost census-rays: number of thresholds that each neighbour is compared "
                   "with: 1 (the centre pixel) or 3 (also 1.25 grey levels below and above: "
                   "slower, better where texture is as weak as noise); " +
                       shared(book.census_thresholds));
  settings.number("sigma-census", parameters.sigma_census, "S",
                  "With cost combined: standard deviation of the share of differing census bits, "
                  "up to 1; 0: no census term; " +
                      shared(book.sigma_census));
  settings.number("sigma-gradient", parameters.sigma_gradient, "S",
                  "With cost combined: standard deviation of the gradients' noise in grey levels "
                  "per pixel; 0: no gradient term; " +
                      shared(book.sigma_gradient));
  add_gradient_settings(settings, parameters);
}

void add_aggregation_settings(Settings& settings, MethodOverrides& parameters) {
  const MethodParameters book = book_parameters(MatchMethod::kSsd);
  settings.begin_group("Matching: aggregation");
  settings.choice("aggregate", parameters.aggregation, aggregation_names(),
                  "How costs are aggregated over neighbouring pixels; " +
                      by_method(&MethodParameters::aggregation, Aggregation::kBox));
  settings.integer("window", parameters.window_px, "PX",
                   "With box: side of the square window, odd, 1 to 181; " + shared(book.window_px));
  settings.choice<Border>(
      "border", parameters.border, {{"clip", Border::kClip}, {"valid", Border::kValid}},
      "With box: clip windows at the image border, or use whole windows only; auto: clip");
  settings.number("aggregation-sigma", parameters.aggregation_sigma_px, "PX",
                  "With gaussian or box-cascade: standard deviation, 0.5 to 16; " +
                      shared(book.aggregation_sigma_px));
  settings.integer(
      "iterations", parameters.iterations, "N",
      "With diffusion, membrane, local-stopping or bayes: number of iterations, 0 to 10000; " +
          shared(book.iterations));
  settings.integer("levels", parameters.levels, "N",
                   "Number of pyramid levels of the coarse-to-fine search, 1 (full size only) to "
                   "10; each level halves width and height and has its own iterations; " +
                       shared(book.levels));
  settings.integer(
      "candidate-blocks", parameters.candidate_blocks, "K",
      "With bayes, several levels and prior-smoothing maximum: search only K blocks of "
      "16 disparities, 1 to 8, around what the coarser level found; 0: search all; " +
          shared(book.candidate_blocks));
  settings.integer(
      "pruned-levels", parameters.pruned_levels, "N",
      "Number of finest levels on which --candidate-blocks limits the search, 1 to 10; " +
          shared(book.pruned_levels));
  settings.integer("final-iterations", parameters.final_iterations, "N",
                   "With several levels: number of iterations on the finest one, 0 to 10000; auto: "
                   "as --iterations");
  settings.number("lambda", parameters.lambda, "L",
                  "With diffusion, membrane or local-stopping: step size, above 0 and below 0.25; "
                  "membrane: at most 1/(4 + beta); " +
                      shared(book.lambda));
  settings.number(
      "beta", parameters.beta, "B",
      "With membrane: pull towards the initial costs, at least 0; " + shared(book.beta));
  settings.choice<Certainty>("certainty", parameters.certainty,
                             {{"margin", Certainty::kMargin}, {"entropy", Certainty::kEntropy}},
                             "With local-stopping: measure of certainty that must not decrease: "
                             "the winner's margin or the negative entropy; auto: margin");
  settings.number("mu", parameters.mu, "M",
                  "With bayes: weight of the neighbours, above 0, at most 1; " + shared(book.mu));
  settings.number("sigma-prior", parameters.sigma_prior, "S",
                  "With bayes: standard deviation of the disparity difference of neighbours in "
                  "pixels, above 0; " +
                      shared(book.sigma_prior));
  settings.number("epsilon-prior", parameters.epsilon_prior, "E",
                  "With bayes: probability that a neighbour is on another surface, above 0 and "
                  "below 1; larger: disparity jumps cost less; " +
                      shared(book.epsilon_prior));
  settings.number("prior-growth", parameters.prior_growth, "G",
                  "With bayes and several levels: factor by which --sigma-prior grows with each "
                  "coarser level, 1 to 4; " +
                      shared(book.prior_growth));
  settings.choice<PriorSmoothing>(
      "prior-smoothing", parameters.prior_smoothing,
      {{"sum", PriorSmoothing::kSum}, {"maximum", PriorSmoothing::kMaximum}},
      "With bayes: combine the probabilities of a neighbour's disparities by their sum "
      "(sum-product, the book's) or their maximum (max-product, several times faster, the "
      "presets'); auto: sum");
  settings.number("level-weight", parameters.level_weight, "W",
                  "With bayes and several levels: costs of a coarse pixel are W times the sum of "
                  "the four it covers, above 0, at most 1; smaller: coarse levels decide less; " +
                      shared(book.level_weight));
  settings.number("edge-weight", parameters.edge_weight, "W",
                  "With bayes: weight of neighbours across strong intensity edges, 0 to 1; 1: "
                  "edges do not matter; " +
                      shared(book.edge_weight));
  settings.number("edge-contrast", parameters.edge_contrast, "C",
                  "With bayes: intensity difference in grey levels over which the weight falls to "
                  "--edge-weight, above 0; " +
                      shared(book.edge_contrast));
}

void add_selection_settings(Settings& settings, MatchOptions& options) {
  settings.begin_group("Matching: selection");
  settings.choice<Subpixel>(
      "subpixel", options.parameters.subpixel,
      {{"parabola", Subpixel::kParabola}, {"none", Subpixel::kNone}},
      "Sub-pixel disparities by a parabola through the costs, or whole pixels; auto: parabola");
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
  add_usual_pixels(settings, "edge-snapping", refinement.edge_snapping_px, kUsualPx,
                   fmt::format("Move disparity edges to intensity edges up to PX columns away, 0 "
                               "(off) to 16; on: {}; auto: 0",
                               kUsualPx));
}

void add_surface_fit_setting(Settings& settings, RefinementOverrides& refinement) {
  constexpr int kUsualPx = 10;
  add_usual_pixels(settings, "surface-fit", refinement.surface_fit_px, kUsualPx,
                   fmt::format("Smooth matched pixels by planes fitted to the matched pixels up to "
                               "PX away, 0 (off) to 16; on: {}; auto: 0",
                               kUsualPx));
}

void add_cross_check_setting(Settings& settings, RefinementOverrides& refinement) {
  Setting& setting = settings.add(
      "cross-check", "PX|none",
      "Pixels whose left and right disparities differ by PX or more count as unmatched, at least "
      "1; none: no check; auto: number of candidates / 15, at least 1");
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
                   "Pixels whose confidence (see --confidence of match) is X or less count as "
                   "unmatched; none: no threshold; auto: 0 with cost gradient, else none");
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
  settings.flag("raw", options.raw, "Winner-take-all map without any step of this group");
  add_edge_snapping_setting(settings, options.refinement);
  add_cross_check_setting(settings, options.refinement);
  settings.integer(
      "cross-check-level", options.refinement.cross_check_level, "N",
      "With bayes and several levels: cross-check against the other map at 1/2^N of the size, 0 to "
      "9; if that map is not an output, its finer levels are skipped, which is faster; auto: 0");
  add_confidence_setting(settings, options.refinement);
  settings.integer("speckle-size", options.refinement.speckle_size_px, "PX",
                   "Matched regions of fewer than PX pixels count as unmatched; auto: 0");
  add_surface_fit_setting(settings, options.refinement);
  settings.choice<Fill>("fill", options.refinement.fill,
                        {{"constant", Fill::kConstant},
                         {"linear", Fill::kLinear},
                         {"median", Fill::kMedian},
                         {"none", Fill::kNone}},
                        "Value of unmatched pixels. constant: disparity of the background beside "
                        "them; linear: interpolated where both sides nearly agree, else constant; "
                        "median: median of similar pixels around; none: unknown; auto: constant");
}

void add_parameter_settings(Settings& settings, MatchOptions& options) {
  add_cost_settings(settings, options.parameters);
  add_aggregation_settings(settings, options.parameters);
  add_selection_settings(settings, options);
  add_refinement_settings(settings, options);
}

void add_method_settings(Settings& settings, MatchOptions& options) {
  settings.choice("method", options.method, method_names(),
                  "A method of the book, for comparison; for photographs use --preset; auto: the "
                  "preset's, without a preset ssd");
  settings.choice(
      "preset", options.preset, preset_names(),
      "Parameters for photographs, shown by --print-config:\nfast      0.5 times the time of "
      "balanced, 8.5 % bad pixels\nbalanced  the default, 7.6 % bad pixels (mean of 18 "
      "scenes)\nquality   1.4 times the time of balanced, 7.5 % bad pixels\nauto: balanced, but "
      "none with --method, --aggregate, --disparities-y or several images");
}

/// Name → value in force of all parameters that are read.
SettingValue resolved_parameters(const MatchOptions& options) {
  MatchOptions in_force = options.fully_resolved();
  Settings resolved("", "");
  add_parameter_settings(resolved, in_force);
  SettingValue values = resolved.values();
  const MethodParameters parameters = options.resolved();
  visit_fields(
      [&](const MethodField& field, const auto& /*value*/) {
        if (!field.readers.are_in_force(parameters)) {
          values.erase(std::string(field.option));
        }
      },
      parameters);
  if (options.disparities_auto && !options.preset_in_force()) {
    values.erase("cross-check");  // depends on the range, which is estimated later
  }
  return values;
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
                  "With cost gradient: weight of the difference of the gradients, at least 0; " +
                      shared(book_parameters(MatchMethod::kGradient).alpha));
  settings.choice<GradientNorm>("norm", parameters.norm,
                                {{"l2", GradientNorm::kL2}, {"octagon", GradientNorm::kOctagon}},
                                "With cost gradient: norm of the gradients; auto: l2");
  settings.choice<GradientFilter>("gradient", parameters.gradient,
                                  {{"central", GradientFilter::kCentral},
                                   {"sobel", GradientFilter::kSobel},
                                   {"simoncelli3", GradientFilter::kSimoncelli3},
                                   {"simoncelli5", GradientFilter::kSimoncelli5}},
                                  "With cost gradient: derivative filter; its gain scales "
                                  "--confidence-threshold; auto: central");
  settings.choice<bool>(
      "prefilter", parameters.prefilter, {{"gaussian", true}, {"none", false}},
      "With cost gradient: smooth the images first with a Gaussian of 0.5 px; auto: gaussian");
}

void add_match_settings(Settings& settings, MatchOptions& options) {
  settings.begin_group("Matching");
  Setting& disparities =
      settings.add("disparities", "MIN:MAX|auto",
                   "Search range x_left - x_right in whole pixels, ends included; auto: estimated "
                   "from the pair, in sequences from up to 16 pairs");
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
      "Also search vertical disparities, y_left - y_right, for pairs that are not rectified; auto: "
      "estimated from the pair; none: rows only");
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
  settings.show_resolved([&options] { return resolved_parameters(options); });
}

void add_reference_setting(Settings& settings, MatchOptions& options) {
  settings.begin_group("Matching");
  settings.choice<Side>("reference", options.reference,
                        {{"left", Side::kLeft}, {"right", Side::kRight}},
                        "Image that the disparity map belongs to");
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
