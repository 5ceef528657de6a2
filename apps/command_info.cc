#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>

#include "apps/commands.h"
#include "apps/settings.h"
#include "engine/build_info.h"
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
  Settings settings("info", "Tells the version and what it can use of this machine.");
  settings.flag("json", json, "Write JSON instead of a table");
  if (!settings.read(arguments)) {
    return kExitDone;
  }
  const BuildInfo build = build_info();
  const scheduler::Machine machine = scheduler::detect_machine();
  if (json) {
    fmt::print("{}\n", as_json(build, machine).dump(2));
  } else {
    print_table(build, machine);
  }
  return kExitDone;
}

}  // namespace vantage::apps
