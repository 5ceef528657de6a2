#include "apps/book/figure_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <set>

#include "apps/book/figure_files.h"
#include "apps/commands/commands.h"
#include "apps/pages/figure_page.h"
#include "apps/process/command_work.h"
#include "apps/process/interrupt.h"
#include "apps/process/outputs.h"
#include "apps/process/progress.h"
#include "apps/process/tell.h"
#include "engine/error.h"
#include "engine/figures/figure_table.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/existing_files.h"
#include "engine/io/files/file_bytes.h"
#include "engine/sequence/options/sequence_layout.h"
#include "engine/simd.h"
#include "scheduler/machine.h"

namespace vantage::apps {
namespace {

constexpr const char* kPageName = "figures.html";

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

/// Figures may join those of another time, whose page tells that they are ours.
void require_own_folder(const std::filesystem::path& folder) {
  const std::filesystem::path page = folder / kPageName;
  if (!std::filesystem::exists(page)) {
    require_no_existing_file(folder,
                             [](const std::string& name) { return name.starts_with("figure-"); });
  } else if (read_file_text(page, true).find("content=\"Vantage ") == std::string::npos) {
    refuse_to_replace(page);
  }
}

void check(const FigureJob& job, const std::vector<const BookFigure*>& figures,
           const Settings& settings) {
  if (job.output.empty()) {
    throw UsageError("--output is missing, expected --output DIR");
  }
  check_settings(figures, job.settings);
  check_figure_inputs(job.inputs, settings);
  const auto shows_photographs = [](const BookFigure* figure) {
    return figure->images != BookImages::kNone;
  };
  if (job.inputs.given() && std::ranges::none_of(figures, shows_photographs)) {
    settings.refuse_idle({"left", "right"}, "on figures of synthetic pairs");
  }
  if (job.inputs.given() && std::ranges::all_of(figures, shows_photographs)) {
    settings.refuse_idle({"size", "seed"}, "with photographs: nothing is generated");
  }
  job.common.execution.validate();
  FileChecks files(settings);
  files.add_made_folder(job.output, "--output");
  if (!job.overwrite) {
    require_own_folder(job.output);
  }
  check_common_files(job.common, files);
}

/// Makes the figures and writes their files until `stop` is raised. `results`: for the report.
std::vector<MadeFigure> make_figures(const FigureJob& job,
                                     const std::vector<const BookFigure*>& figures,
                                     CommandWork& work, const std::atomic<bool>& stop,
                                     SettingValue& results) {
  std::optional<FigureImages> given;
  if (job.inputs.given()) {
    given = work.report.timed_file_access(
        "read", [&] { return read_figure_inputs(job.inputs, work.execution); });
  }
  std::vector<MadeFigure> made;
  Progress progress("book figure", "figures",
                    job.common.quiet ? ProgressStyle::kNone : ProgressStyle::kAuto);
  for (const BookFigure* figure : figures) {
    MadeFigure& one =
        made.emplace_back(MadeFigure{figure, settings_in_force(*figure, job.settings), {}});
    one.content = work.report.timed_compute("figures", [&] {
      return figure->make({.settings = one.settings,
                           .execution = work.execution,
                           .stop = &stop,
                           .given = given ? &*given : nullptr});
    });
    if (stop) {
      break;
    }
    results[std::string(figure->key)] = describe_figure(
        one, work.report.timed_file_access(
                 "write", [&] { return write_figure(job.output, *figure, one.content); }));
    progress.update(static_cast<int>(made.size()), static_cast<int>(figures.size()), 0);
  }
  return made;
}

}  // namespace

int run_figures(const FigureJob& job, const Settings& settings) {
  if (job.list) {
    print_list();
    return kExitDone;
  }
  const std::vector<const BookFigure*> figures = figures_of(job);
  check(job, figures, settings);
  CommandWork work(settings, job.common);
  make_folder(job.output);
  const std::atomic<bool>& interrupted = interrupt_flag();
  SettingValue results = SettingValue::object();
  const std::vector<MadeFigure> made = make_figures(job, figures, work, interrupted, results);
  if (interrupted) {
    if (!job.common.quiet) {
      tell("book figure: interrupted\n");
    }
    return kExitInterrupted;
  }
  const std::string machine =
      fmt::format("{}, {} threads, instruction set {}", scheduler::detect_machine().processor,
                  work.execution.executor().thread_count(), instruction_set_in_use());
  work.report.timed_file_access("write", [&] {
    write_text_file(std::filesystem::path(job.output) / kPageName,
                    make_figure_page(made, job.command, machine));
  });
  return work.finish(std::move(results),
                     fmt::format("{} figures -> {}/{}", made.size(), job.output, kPageName));
}

}  // namespace vantage::apps
