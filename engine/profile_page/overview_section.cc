#include <fmt/format.h>

#include <vector>

#include "engine/io/markup_text.h"
#include "engine/profile_page/page_sections.h"
#include "engine/profile_page/quantity_text.h"
#include "engine/profiling/profile_findings.h"

namespace vantage {
namespace {

struct KeyFigure {
  std::string name;
  std::string value;
  std::string detail;
};

std::string range_text(const ProfileSample& sample, std::string_view unit) {
  return fmt::format("{} to {}", quantity_text(sample.least, unit),
                     quantity_text(sample.most, unit));
}

std::string number_of(int count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::vector<KeyFigure> figures_of_runs(const ThreadCountProfile& most) {
  std::vector<KeyFigure> figures;
  figures.push_back(
      {"wall time on " + number_of(most.threads, "thread"), quantity_text(most.wall_s.median, "s"),
       fmt::format("median of {}, {}", number_of(most.runs, "run"), range_text(most.wall_s, "s"))});
  if (most.frames_per_s.median > 0) {
    figures.push_back({"frames per second", number_text(most.frames_per_s.median),
                       fmt::format("{} to {}", number_text(most.frames_per_s.least),
                                   number_text(most.frames_per_s.most))});
  } else if (most.cells_per_s.median > 0) {
    figures.push_back({"cells per second", quantity_text(most.cells_per_s.median, ""),
                       range_text(most.cells_per_s, "")});
  }
  if (!most.workers.empty()) {
    figures.push_back(
        {"threads work", percent_text(most.work_share.median), "of their time; else they wait"});
  }
  return figures;
}

std::vector<KeyFigure> key_figures(const Profile& profile) {
  std::vector<KeyFigure> figures;
  if (!profile.thread_counts.empty()) {
    figures = figures_of_runs(profile.thread_counts.back());
  }
  if (profile.speed_ups.size() > 1) {
    const SpeedUp& speed_up = profile.speed_ups.back();
    figures.push_back({fmt::format("speed-up, {} to {} threads", profile.speed_ups.front().threads,
                                   speed_up.threads),
                       number_text(speed_up.ratio.median) + "×",
                       "efficiency " + percent_text(speed_up.efficiency)});
  }
  if (profile.serial_fraction) {
    figures.push_back(
        {"serial fraction", percent_text(*profile.serial_fraction), "of Amdahl's law as fitted"});
  }
  if (profile.peak_memory_bytes > 0) {
    figures.push_back({"peak memory",
                       quantity_text(static_cast<double>(profile.peak_memory_bytes), "B"),
                       "resident, of the process"});
  }
  return figures;
}

std::string head(const Profile& profile) {
  std::string items;
  const auto add = [&](std::string_view name, const std::string& value) {
    if (!value.empty()) {
      items += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, escaped_markup(value));
    }
  };
  add("processor", profile.processor);
  add("hardware threads", std::to_string(profile.hardware_threads));
  add("instruction set", profile.isa);
  add("date", profile.date);
  add("Vantage", profile.version);
  return fmt::format(
      "<header>\n<p class=\"kind\">Vantage profile</p>\n<h1><code>{}</code></h1>\n"
      "<dl class=\"facts\">\n{}</dl>\n</header>\n",
      escaped_markup(profile.command), items);
}

std::string advice_markup(const Profile& profile) {
  std::string items;
  for (const std::string& sentence : profile.advice) {
    items += fmt::format("<li>{}</li>\n", escaped_markup(sentence));
  }
  return items.empty() ? ""
                       : section_markup("What you can do about the time",
                                        "<ul class=\"findings\">\n" + items + "</ul>\n");
}

std::string findings_markup(const Profile& profile) {
  const std::vector<ProfileFinding> findings = profile_findings(profile);
  if (findings.empty()) {
    return note("The figures do not suffice to say what holds it back.");
  }
  std::string items;
  for (const ProfileFinding& finding : findings) {
    items += fmt::format("<li>{}</li>\n", escaped_markup(finding.text));
  }
  return "<ul class=\"findings\">\n" + items + "</ul>\n";
}

}  // namespace

std::string section_markup(std::string_view title, const std::string& content) {
  return fmt::format("<section>\n<h2>{}</h2>\n{}</section>\n", escaped_markup(title), content);
}

std::string side_by_side(const std::string& left, const std::string& right) {
  return fmt::format(
      "<div class=\"pair\">\n<div class=\"column\">\n{}</div>\n<div "
      "class=\"column\">\n{}</div>\n</div>\n",
      left, right);
}

std::string paragraph(std::string_view text) {
  return fmt::format("<p>{}</p>\n", escaped_markup(text));
}

std::string note(std::string_view text) {
  return fmt::format("<p class=\"note\">{}</p>\n", escaped_markup(text));
}

std::string overview_section(const Profile& profile) {
  std::string figures;
  for (const KeyFigure& figure : key_figures(profile)) {
    figures += fmt::format("<div><dt>{}</dt><dd>{}</dd><dd class=\"detail\">{}</dd></div>\n",
                           escaped_markup(figure.name), escaped_markup(figure.value),
                           escaped_markup(figure.detail));
  }
  const std::string list = figures.empty() ? note("No run was measured.")
                                           : "<dl class=\"figures\">\n" + figures + "</dl>\n";
  return head(profile) + list + advice_markup(profile) +
         section_markup("What holds it back", findings_markup(profile));
}

}  // namespace vantage
