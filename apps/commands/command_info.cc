#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <optional>

#include "apps/commands/commands.h"
#include "apps/settings/command_line.h"
#include "engine/build_info.h"
#include "engine/options/settings.h"
#include "engine/simd.h"
#include "scheduler/control_groups.h"
#include "scheduler/topology.h"

namespace vantage::apps {
namespace {

std::string counted(int count, const std::string& what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

void print_table(const BuildInfo& build, const SystemInfo& system,
                 const scheduler::Topology& topology) {
  const scheduler::Machine& machine = topology.machine;
  constexpr std::size_t kKib = 1024;
  const std::string ffmpeg = ffmpeg_version();
  const std::optional<double> quota = scheduler::read_system_limits().processors;
  fmt::print("Vantage            {}\n", build.version);
  fmt::print("compiler           {}\n", build.compiler);
  fmt::print("libraries          OpenCV {}, TBB {}, FFmpeg {}\n", build.opencv, build.tbb,
             ffmpeg.empty() ? "none" : ffmpeg);
  fmt::print("system             {}, {}\n", system.distribution, system.kernel);
  fmt::print("processor          {}\n", system.processor);
  fmt::print("instruction sets   {} in use\n", instruction_set_in_use());
  fmt::print("  available here   {}\n", fmt::join(available_instruction_sets(), " "));
  fmt::print("  in this build    {}\n", fmt::join(built_instruction_sets(), " "));
  fmt::print("hardware threads   {} on {}, {}{}\n", machine.hardware_threads,
             counted(machine.cores, "core"), counted(machine.numa_nodes, "NUMA node"),
             topology.system == nullptr ? " (simulated)"
             : quota                    ? fmt::format(", with a quota of {:.3g} processors", *quota)
                                        : "");
  for (const scheduler::NumaNode& node : topology.nodes) {
    fmt::print("  {:<17}{} on {}, {} MiB\n", fmt::format("NUMA node {}", node.number),
               counted(node.hardware_threads(), "thread"),
               counted(static_cast<int>(node.cores.size()), "core"),
               node.memory_bytes / kKib / kKib);
  }
  fmt::print("caches             L1 {} KiB, L2 {} KiB, L3 {} KiB\n", machine.l1_data_bytes / kKib,
             machine.l2_bytes / kKib, machine.l3_bytes / kKib);
  fmt::print("memory             {} MiB\n", machine.memory_bytes / kKib / kKib);
}

SettingValue machine_json(const BuildInfo& build, const SystemInfo& system,
                          const scheduler::Topology& topology) {
  const scheduler::Machine& machine = topology.machine;
  SettingValue nodes = SettingValue::array();
  for (const scheduler::NumaNode& node : topology.nodes) {
    nodes.push_back({{"node", node.number},
                     {"hardware_threads", node.hardware_threads()},
                     {"cores", node.cores},
                     {"memory_bytes", node.memory_bytes}});
  }
  return {{"version", build.version},
          {"compiler", build.compiler},
          {"opencv", build.opencv},
          {"tbb", build.tbb},
          {"ffmpeg", ffmpeg_version()},
          {"distribution", system.distribution},
          {"kernel", system.kernel},
          {"processor", system.processor},
          {"isa", instruction_set_in_use()},
          {"isa_available", available_instruction_sets()},
          {"isa_built", built_instruction_sets()},
          {"hardware_threads", machine.hardware_threads},
          {"cores", machine.cores},
          {"numa_nodes", machine.numa_nodes},
          {"nodes", nodes},
          {"is_simulated", topology.system == nullptr},
          {"l1_data_bytes", machine.l1_data_bytes},
          {"l2_bytes", machine.l2_bytes},
          {"l3_bytes", machine.l3_bytes},
          {"memory_bytes", machine.memory_bytes}};
}

}  // namespace

int command_info(const Arguments& arguments) {
  bool json = false;
  Settings settings(
      "info",
      "Prints the versions of the program and its libraries, the system, and what the "
      "program can use of this machine.");
  settings.flag("json", json, "Write JSON instead of a table");
  if (!read_command_line(settings, arguments)) {
    return kExitDone;
  }
  const BuildInfo build = build_info();
  const SystemInfo system = system_info();
  const scheduler::Topology topology = scheduler::detect_topology();
  if (json) {
    fmt::print("{}\n", machine_json(build, system, topology).dump(2));
  } else {
    print_table(build, system, topology);
  }
  return kExitDone;
}

}  // namespace vantage::apps
