#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <set>

#include "apps/book/figure_files.h"
#include "apps/book/figure_inputs.h"
#include "apps/commands/commands.h"
#include "apps/pages/figure_page.h"
#include "apps/process/command_work.h"
#include "apps/process/interrupt.h"
#include "apps/process/outputs.h"
#include "apps/process/progress.h"
#include "apps/process/tell.h"
#include "apps/reports/run_report.h"
#include "apps/settings/command_line.h"
#include "apps/settings/common_options.h"
#include "engine/error.h"
#include "engine/evaluation/method_comparison.h"
#include "engine/figures/figure_table.h"
#include "engine/io/files/atomic_file.h"
#include "engine/options/parameter_settings.h"
#include "engine/options/settings.h"
#include "engine/sequence/sequence_layout.h"
#include "engine/simd.h"
#include "scheduler/machine.h"

namespace vantage::apps {
namespace {

constexpr const char* kPageName = "figures.html";

struct FigureJob {
  std::vector<std::string> names;
  bool list = false;
  FigureSettings settings;
  FigureInputs inputs;
  FigurePictures pictures = FigurePictures::kSvg;
  CommonOptions common;
  std::string output;
};

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
  settings.choice<FigurePictures>("pictures", job.pictures,
                                  {{"svg", FigurePictures::kSvg}, {"png", FigurePictures::kPng}},
                                  "File format of charts and pictures");

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
}

std::vector<const BookFigure*> figures_of(const FigureJob& job) {
  if (job.names.empty()) {
    throw UsageError("FIGURE is missing; see 'vantage book figure --list'");
  }
  std::set<const BookFigure*> wanted;
  for (const std::string& name : job.names) {
    for (const BookFigure* figure : figures_named(name)) {
      wanted.insert(figure);
    }
  }
  return {wanted.begin(), wanted.end()};  // by place in the table, the order of the book
}

void print_list() {
  for (const BookFigure& figure : book_figures()) {
    const std::string settings = describe_settings(figure, figure.defaults);
    fmt::print("{:<12} {}\n{:<12} {}{}\n", figure.key, figure.title, "",
               settings.empty() ? "nothing to choose" : "", settings);
  }
}

/// What a report says of a figure.
SettingValue describe_figure(const MadeFigure& made, const std::vector<std::string>& files) {
  SettingValue comparisons = SettingValue::array();
  for (const BookComparison& comparison : made.content.comparisons) {
    comparisons.push_back(
        {{"what", comparison.what}, {"book", comparison.book}, {"here", comparison.ours}});
  }
  return {{"title", made.figure->title},
          {"images", made.content.images},
          {"settings", describe_settings(*made.figure, made.settings)},
          {"comparisons", comparisons},
          {"files", files}};
}

std::string describe_machine(Execution& execution) {
  return fmt::format("{}, {} threads, instruction set {}", scheduler::detect_machine().processor,
                     execution.executor().thread_count(), instruction_set_in_use());
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
  add_common_settings(settings, job.common);
  settings.set_short_help(
      {"figure", "list", "output", "size", "iterations", "noise", "methods", "pairs", "seed",
       "threads", "quiet"},
      {"vantage book figure --list", "vantage book figure all -o figures",
       "vantage book figure 6.16 6.17 -o figures",
       "vantage book figure 6.10 --noise 0,4 --methods bayes,membrane -o figures",
       "vantage book figure 6.9 --beta 0.2 -o figures"});
  if (!read_command_line(settings, arguments)) {
    return kExitDone;
  }
  if (job.list) {
    print_list();
    return kExitDone;
  }
  const std::vector<const BookFigure*> figures = figures_of(job);
  if (job.output.empty()) {
    throw UsageError("--output is missing, expected --output DIR");
  }
  check_settings(figures, job.settings);
  check_figure_inputs(job.inputs, settings);
  if (job.inputs.given() && std::ranges::none_of(figures, [](const BookFigure* figure) {
        return figure->images != BookImages::kNone;
      })) {
    settings.refuse_idle({"left", "right", "data"}, "on figures of synthetic pairs");
  }
  if (job.inputs.given() && std::ranges::all_of(figures, [](const BookFigure* figure) {
        return figure->images != BookImages::kNone;
      })) {
    settings.refuse_idle({"size", "seed"}, "with photographs: nothing is generated");
  }
  job.common.execution.validate();
  FileChecks files(settings);
  files.add_made_folder(job.output, "--output");
  check_common_files(job.common, files);
  CommandWork work(settings, job.common);
  RunReport& report = work.report;
  Execution& execution = work.execution;
  const std::filesystem::path folder = job.output;
  make_folder(folder);

  const std::atomic<bool>& interrupted = interrupt_flag();
  std::optional<FigureImages> given;
  if (job.inputs.given()) {
    given =
        report.timed_file_access("read", [&] { return read_figure_inputs(job.inputs, execution); });
  }
  std::vector<MadeFigure> made;
  SettingValue results = SettingValue::object();
  {
    Progress progress("book figure", "figures",
                      job.common.quiet ? ProgressStyle::kNone : ProgressStyle::kAuto);
    for (const BookFigure* figure : figures) {
      MadeFigure& one =
          made.emplace_back(figure, settings_in_force(*figure, job.settings), FigureContent{});
      one.content = report.timed_compute("figures", [&] {
        return figure->make({.settings = one.settings,
                             .execution = execution,
                             .stop = &interrupted,
                             .given = given ? &*given : nullptr});
      });
      if (interrupted) {
        break;
      }
      results[std::string(figure->key)] =
          describe_figure(one, report.timed_file_access("write", [&] {
            return write_figure(folder, *figure, one.content, job.pictures);
          }));
      progress.update(static_cast<int>(made.size()), static_cast<int>(figures.size()), 0);
    }
  }
  if (interrupted) {
    if (!job.common.quiet) {
      tell("book figure: interrupted\n");
    }
    return kExitInterrupted;
  }
  report.timed_file_access("write", [&] {
    write_text_file(
        folder / kPageName,
        make_figure_page(made, fmt::format("vantage book figure {}", fmt::join(arguments, " ")),
                         describe_machine(execution)));
  });
  report.set_results(std::move(results));
  report.write(job.common.report);
  if (!job.common.quiet) {
    tell("book figure: {} figures -> {}/{}\n", made.size(), job.output, kPageName);
    report.print_summary();
  }
  return kExitDone;
}

}  // namespace vantage::apps
