#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <optional>

#include "apps/commands.h"
#include "apps/settings.h"
#include "engine/build_info.h"
#include "engine/profiling/machine_ceilings.h"
#include "engine/simd.h"
#include "scheduler/machine.h"

namespace vantage::apps {
namespace {

void print_table(const BuildInfo& build, const scheduler::Machine& machine) {
  constexpr std::size_t kKib = 1024;
  fmt::print("Vantage            {}\n", build.version);
  fmt::print("compiler           {}\n", build.compiler);
  fmt::print("libraries          OpenCV {}, TBB {}\n", build.opencv, build.tbb);
  fmt::print("instruction sets   {} in use\n", instruction_set_in_use());
  fmt::print("  available here   {}\n", fmt::join(available_instruction_sets(), " "));
  fmt::print("  in this build    {}\n", fmt::join(built_instruction_sets(), " "));
  fmt::print("hardware threads   {} on {} core{}, {} NUMA node{}\n", machine.hardware_threads,
             machine.cores, machine.cores == 1 ? "" : "s", machine.numa_nodes,
             machine.numa_nodes == 1 ? "" : "s");
  fmt::print("caches             L1 {} KiB, L2 {} KiB, L3 {} KiB\n", machine.l1_data_bytes / kKib,
             machine.l2_bytes / kKib, machine.l3_bytes / kKib);
  fmt::print("memory             {} MiB\n", machine.memory_bytes / kKib / kKib);
}

void print_table(const MachineCeilings& ceilings) {
  fmt::print("at best            one thread, {} threads\n", ceilings.threads);
  fmt::print("  float arithmetic {:.0f}, {:.0f} GFLOP/s\n", ceilings.core_gflops,
             ceilings.all_gflops);
  fmt::print("  loads from L2    {:.0f}, {:.0f} GB/s\n", ceilings.core_l2_gb_per_s,
             ceilings.all_l2_gb_per_s);
  fmt::print("  memory (triad)   {:.1f}, {:.1f} GB/s\n", ceilings.core_memory_gb_per_s,
             ceilings.all_memory_gb_per_s);
}

SettingValue as_json(const MachineCeilings& ceilings) {
  return {{"threads", ceilings.threads},
          {"core_gflops", ceilings.core_gflops},
          {"all_gflops", ceilings.all_gflops},
          {"core_l2_gb_per_s", ceilings.core_l2_gb_per_s},
          {"all_l2_gb_per_s", ceilings.all_l2_gb_per_s},
          {"core_memory_gb_per_s", ceilings.core_memory_gb_per_s},
          {"all_memory_gb_per_s", ceilings.all_memory_gb_per_s}};
}

SettingValue as_json(const BuildInfo& build, const scheduler::Machine& machine) {
  return {{"version", build.version},
          {"compiler", build.compiler},
          {"opencv", build.opencv},
          {"tbb", build.tbb},
          {"isa", instruction_set_in_use()},
          {"isa_available", available_instruction_sets()},
          {"isa_built", built_instruction_sets()},
          {"hardware_threads", machine.hardware_threads},
          {"cores", machine.cores},
          {"numa_nodes", machine.numa_nodes},
          {"l1_data_bytes", machine.l1_data_bytes},
          {"l2_bytes", machine.l2_bytes},
          {"l3_bytes", machine.l3_bytes},
          {"memory_bytes", machine.memory_bytes}};
}

}  // namespace

int command_info(const Arguments& arguments) {
  bool json = false;
  bool measure = false;
  Settings settings("info", "Tells the version and what it can use of this machine.");
  settings.flag("json", json, "Write JSON instead of a table");
  settings.flag("measure", measure,
                "Measure what the machine can do at best: arithmetic, caches, memory; 2 seconds");
  if (!settings.read(arguments)) {
    return kExitDone;
  }
  const BuildInfo build = build_info();
  Execution execution({});
  const scheduler::Machine& machine = execution.machine();
  std::optional<MachineCeilings> ceilings;
  if (measure) {
    constexpr double kSeconds = 2;
    ceilings = measure_ceilings(execution, kSeconds);
  }
  if (json) {
    SettingValue document = as_json(build, machine);
    if (ceilings) {
      document["ceilings"] = as_json(*ceilings);
    }
    fmt::print("{}\n", document.dump(2));
  } else {
    print_table(build, machine);
    if (ceilings) {
      print_table(*ceilings);
    }
  }
  return kExitDone;
}

}  // namespace vantage::apps
