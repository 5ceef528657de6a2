#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/book/figure_job.h"
#include "apps/commands/commands.h"
#include "apps/settings/command_line.h"
#include "engine/evaluation/method_comparison.h"
#include "engine/options/parameter_settings.h"
#include "engine/options/settings.h"

namespace vantage::apps {
namespace {

/// A list of values, as texts with commas, as members of an array, or as several options.
template <typename T, typename Convert>
Setting& add_list(Settings& settings, std::string name, std::vector<T>& field,
                  const std::string& help, const Convert& convert) {
  Setting& setting = settings.add(std::move(name), "LIST", help);
  setting.list = true;
  setting.set = [&field, convert](const SettingValue& value) {
    std::vector<T> values;
    for (const SettingValue& member : to_list(value)) {
      const auto parts =
          member.is_string() ? split(member.get<std::string>(), ',') : std::vector<std::string>{};
      for (const std::string& part : parts) {
        values.push_back(convert(SettingValue(part)));
      }
      if (parts.empty()) {
        values.push_back(convert(member));
      }
    }
    field = std::move(values);
  };
  setting.get = [&field] { return field; };
  return setting;
}

std::string names_of_methods() {
  std::string text;
  for (const ComparedMethod& method : compared_methods()) {
    text += fmt::format("{:<23} {}\n", method.name, method.description);
  }
  return text;
}

void add_figure_settings(Settings& settings, FigureJob& job) {
  settings.start_group("Figures");
  Setting& names = add_list(
      settings, "figure", job.names,
      "Figures by their numbers in the book, such as 6.16; 6: those of a chapter; all. --list says "
      "what there is",
      [](const SettingValue& value) { return to_text(value); });
  names.value_name = "FIGURE";
  names.positional = true;
  settings.flag("list", job.list, "List the figures and what can be chosen for each");
  Setting& output = settings.path(
      "output", job.output, "DIR",
      "Output folder: figure-N.csv with the numbers, figure-N.svg, figure-N-book.csv with what the "
      "book says beside what came out, and a page with all of them, figures.html");
  output.short_name = 'o';
  add_overwrite_setting(settings, job.overwrite);

  settings.start_group("Settings (auto and empty lists: as in the book)");
  settings.integer("size", job.settings.size_px, "PX",
                   "Width and height of the synthetic pairs; of scenes: their width");
  add_list(settings, "iterations", job.settings.iterations, "Numbers of iterations", to_integer);
  add_list(settings, "noise", job.settings.noise_sigmas,
           "Standard deviations of the noise in grey levels", to_number);
  add_list(settings, "methods", job.settings.methods, "Methods:\n" + names_of_methods(),
           [](const SettingValue& value) { return to_text(value); });
  add_list(settings, "pairs", job.settings.pairs,
           fmt::format("Synthetic pairs: {}", fmt::join(kBookPairNames, ", ")),
           [](const SettingValue& value) { return to_text(value); });
  Setting& seed = settings.add("seed", "N", "Seed of the generated images; auto: the figure's");
  seed.set = [&job](const SettingValue& value) { job.settings.seed = to_seed(value); };
  seed.get = [&job]() -> SettingValue {
    return job.settings.seed ? SettingValue(*job.settings.seed) : SettingValue("auto");
  };
  add_figure_input_settings(settings, job.inputs);
  add_shared_method_parameters(settings, job.settings.parameters);
  add_common_settings(settings, job.common);
  settings.set_short_help(
      {"figure", "list", "output", "size", "iterations", "noise", "methods", "pairs", "seed",
       "threads", "quiet"},
      {"vantage book figure --list", "vantage book figure all -o figures",
       "vantage book figure 6.16 6.17 -o figures",
       "vantage book figure 6.10 --noise 0,4 --methods bayes,membrane -o figures",
       "vantage book figure 6.9 --beta 0.2 -o figures"});
}

}  // namespace

int command_book_figure(const Arguments& arguments) {
  FigureJob job;
  Settings settings(
      "book figure",
      "Computes figures and tables of D. Scharstein, View Synthesis Using Stereo Vision (1999): "
      "numbers (CSV), charts and pictures (SVG), and one page (HTML) with what the book says "
      "beside what came out.");
  add_figure_settings(settings, job);
  job.command = fmt::format("vantage book figure {}", fmt::join(arguments, " "));
  return read_command_line(settings, arguments) ? run_figures(job, settings) : kExitDone;
}

}  // namespace vantage::apps
