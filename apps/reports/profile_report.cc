#include "apps/reports/profile_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/reports/text_table.h"
#include "engine/options/setting_value.h"
#include "engine/profiling/profile_figures.h"
#include "engine/profiling/profile_findings.h"
#include "engine/profiling/quantity_text.h"
#include "engine/profiling/roofline.h"
#include "engine/profiling/stage_figures.h"

namespace vantage::apps {
namespace {

constexpr const char* kUnknown = "-";

std::string threads_text(int threads) {
  return fmt::format("{} thread{}", threads, threads == 1 ? "" : "s");
}

std::string share_text(double seconds, double all_s) {
  return all_s > 0 ? percent_text(seconds / all_s) : kUnknown;
}

/// `sentence` in lines that fit, indented.
std::string wrapped(const std::string& sentence) {
  constexpr std::size_t kColumns = 98;
  std::string text;
  std::string line;
  for (const std::string& word : split(sentence, ' ')) {
    if (!line.empty() && line.size() + 1 + word.size() > kColumns) {
      text += "  " + line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return text + "  " + line + "\n";
}

std::string advice(const Profile& profile) {
  std::string text;
  for (const std::string& sentence : profile.advice) {
    text += wrapped(sentence);
  }
  return text.empty() ? "" : "What you can do about the time\n" + text + "\n";
}

std::string findings(const Profile& profile) {
  std::string text;
  for (const ProfileFinding& finding : profile_findings(profile)) {
    text += wrapped(finding.text);
  }
  return text.empty() ? "" : "What holds it back\n" + text + "\n";
}

std::string scaling(const Profile& profile) {
  const bool has_frames = profile.thread_counts.back().frames_per_s.median > 0;
  TextTable table("Threads", {"", "wall", "compute", has_frames ? "frames/s" : "cells/s", "work",
                              "imbalance", "speed-up", "efficiency", "serial"});
  for (std::size_t i = 0; i < profile.thread_counts.size(); ++i) {
    const ThreadCountProfile& count = profile.thread_counts[i];
    const SpeedUp& speed_up = profile.speed_ups[i];
    table.add({fmt::format("{}", count.threads), sample_text(count.wall_s, "s"),
               quantity_text(count.compute_s.median, "s"),
               has_frames ? number_text(count.frames_per_s.median)
                          : quantity_text(count.cells_per_s.median, ""),
               percent_text(count.work_share.median), fmt::format("{:.2f}", count.imbalance.median),
               fmt::format("{:.2f}", speed_up.ratio.median), percent_text(speed_up.efficiency),
               speed_up.serial_fraction ? percent_text(*speed_up.serial_fraction) : kUnknown});
  }
  std::string text = table.text();
  if (profile.serial_fraction) {
    text += fmt::format("  Amdahl's law fits best with a serial fraction of {}.\n",
                        percent_text(*profile.serial_fraction));
  }
  return text;
}

std::string growth(const Profile& profile) {
  std::vector<std::string> heads = {"", ""};
  for (const ThreadCountProfile& count : profile.thread_counts) {
    heads.push_back(threads_text(count.threads));
    if (count.threads > profile.thread_counts.front().threads) {
      heads.emplace_back("growth");
    }
  }
  TextTable table("Processor time by stage, ms a frame, and its growth by threads", heads);
  for (const ProcessorGrowth& one : processor_growth(profile)) {
    std::vector<std::string> cells = {one.name, one.kind, number_text(one.ms.front())};
    for (std::size_t i = 1; i < one.ms.size(); ++i) {
      cells.push_back(number_text(one.ms[i]));
      cells.push_back(fmt::format("{:+.0f} %", 100 * one.growth[i]));
    }
    table.add(std::move(cells));
  }
  return table.empty() || profile.thread_counts.size() < 2 ? "" : "\n" + table.text();
}

std::string stages(const Profile& profile, const ThreadCountProfile& count) {
  const std::optional<ThreadRoofs> roofs = roofs_on(profile, count.threads);
  TextTable table(
      fmt::format("Stages of matching on {}, time over all threads, rates of one thread",
                  threads_text(count.threads)),
      {"", "time", "of work", "ns/cell", "cells/s", "halo", "GB/s", "GFLOP/s", "of roof", "roof"});
  for (const StageProfile& stage : count.stages) {
    const bool known = stage.cells > 0;
    const auto place = roofs ? place_on_roofline(stage, *roofs) : std::nullopt;
    table.add({stage.name, quantity_text(stage.seconds.median, "s"),
               percent_text(work_share(stage, count)),
               known ? number_text(nanoseconds_per_cell(stage)) : kUnknown,
               known ? quantity_text(cells_per_second(stage), "") : kUnknown,
               percent_text(halo_share(stage)), place ? number_text(place->gb_per_s) : kUnknown,
               place ? number_text(place->gflops) : kUnknown,
               place ? percent_text(place->roof_share) : kUnknown,
               !place                             ? kUnknown
               : place->roof == Roof::kArithmetic ? "arithmetic"
                                                  : "level 2"});
  }
  return table.empty() ? "" : "\n" + table.text();
}

/// Those that can be seen, and the others in one row.
void add_parts(const std::vector<PartProfile>& parts, const char* kind,
               const ThreadCountProfile& count, TextTable& table) {
  constexpr double kMinPartShare = 1e-3;
  PartProfile others;
  int hidden = 0;
  for (const PartProfile& part : parts) {
    if (part.seconds.median < kMinPartShare * pool_time_s(count)) {
      ++hidden;
      others.seconds.median += part.seconds.median;
      others.count += part.count;
    } else {
      table.add({part.name, kind, sample_text(part.seconds, "s"),
                 share_text(part.seconds.median, pool_time_s(count)), number_text(part.count)});
    }
  }
  if (hidden > 0) {
    table.add({fmt::format("{} more", hidden), kind, quantity_text(others.seconds.median, "s"),
               share_text(others.seconds.median, pool_time_s(count)), number_text(others.count)});
  }
}

std::string parts(const ThreadCountProfile& count) {
  TextTable table(
      fmt::format("Work and waiting on {}, over all threads", threads_text(count.threads)),
      {"", "", "time", "of time", "times"});
  add_parts(count.parts, "work", count, table);
  add_parts(count.waits, "wait", count, table);
  std::string text = "\n" + table.text();
  const auto share_of = [&](const ProfileSample& seconds) {
    return share_text(seconds.median, pool_time_s(count));
  };
  const WaitingProfile& waiting = count.waiting_for;
  text += fmt::format(
      "  Of the pool's time {} are lost to reading and decoding, {} to encoding and writing,\n"
      "  {} to work of others that is not shared; {} pass while nothing recorded is done.\n",
      share_of(waiting.reading_s), share_of(waiting.writing_s), share_of(waiting.computing_s),
      share_of(waiting.nothing_s));
  return text;
}

std::string memory(const Profile& profile) {
  TextTable table(fmt::format("Memory: {} at the peak",
                              quantity_text(static_cast<double>(profile.peak_memory_bytes), "B")),
                  {"", "bytes"});
  for (const MemoryOwner& owner : profile.memory) {
    table.add({owner.name, quantity_text(static_cast<double>(owner.bytes), "B")});
  }
  return "\n" +
         (table.empty()
              ? fmt::format("Memory: {} at the peak; the command does not tell whose\n",
                            quantity_text(static_cast<double>(profile.peak_memory_bytes), "B"))
              : table.text());
}

std::string ceilings(const Profile& profile) {
  TextTable table("What the machine can do", {"", "GFLOP/s", "level 2, GB/s", "triad, GB/s"});
  const auto add = [&](const std::string& name, double gflops, double level2, double memory_rate) {
    table.add({name, number_text(gflops), number_text(level2), number_text(memory_rate)});
  };
  if (!profile.ceilings.empty()) {
    const MachineCeilings& any = profile.ceilings.front();
    add("one core", any.core_gflops, any.core_l2_gb_per_s, any.core_memory_gb_per_s);
  }
  for (const MachineCeilings& one : profile.ceilings) {
    if (one.threads > 1) {
      add(threads_text(one.threads), one.all_gflops, one.all_l2_gb_per_s, one.all_memory_gb_per_s);
    }
  }
  return table.empty() ? "" : "\n" + table.text();
}

}  // namespace

std::string describe(const Profile& profile) {
  const ThreadCountProfile& max = profile.thread_counts.back();
  return fmt::format("{}\n{}, {}, vantage {}; {} run{} each\n\n", profile.command,
                     profile.processor, profile.isa, profile.version, max.runs,
                     max.runs == 1 ? "" : "s") +
         advice(profile) + findings(profile) + scaling(profile) + growth(profile) +
         stages(profile, max) + parts(max) + ceilings(profile) + memory(profile);
}

}  // namespace vantage::apps
