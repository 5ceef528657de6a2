#include "scheduler/topology.h"

#include <hwloc.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <mutex>
#include <new>
#include <stdexcept>

#include "scheduler/control_groups.h"

namespace vantage::scheduler {
namespace {

using Handle = std::shared_ptr<hwloc_topology>;

Handle new_handle() {
  hwloc_topology_t topology = nullptr;
  if (hwloc_topology_init(&topology) != 0) {
    return nullptr;
  }
  return {topology, hwloc_topology_destroy};
}

/// This machine, or what the environment has stand for it. Null when hwloc cannot tell.
Handle loaded(unsigned long flags) {
  Handle handle = new_handle();
  if (handle == nullptr || hwloc_topology_set_flags(handle.get(), flags) != 0 ||
      hwloc_topology_load(handle.get()) != 0) {
    return nullptr;
  }
  return handle;
}

/// The topology as the operating system reports it. Where that lists no caches, hwloc asks each
/// processor in turn instead, which is slow: the thread waits until each one is free.
Handle loaded() {
  Handle handle = loaded(HWLOC_TOPOLOGY_FLAG_DONT_CHANGE_BINDING);
  if (handle == nullptr || hwloc_get_obj_by_type(handle.get(), HWLOC_OBJ_L1CACHE, 0) == nullptr) {
    handle = loaded(0);
  }
  return handle;
}

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string() : name + ('=' + std::string(value));
}

/// The topology, which is loaded once per process and environment: hwloc takes 5 to 10 ms, mostly
/// to open its plugins, and a command asks several times. Nobody changes it.
Handle known_topology() {
  static std::mutex mutex;
  static std::map<std::string, Handle> known;
  const std::lock_guard lock(mutex);
  const auto [place, is_new] =
      known.try_emplace(environment("HWLOC_SYNTHETIC") + environment("HWLOC_XMLFILE"));
  if (is_new) {
    place->second = loaded();
  }
  return place->second;
}

using ThreadSet = std::unique_ptr<hwloc_bitmap_s, decltype(&hwloc_bitmap_free)>;

/// The hardware threads of the affinity mask of this process; of another machine all, and where
/// none would be left. cgroups hwloc knows itself.
ThreadSet usable_threads(hwloc_topology_t topology) {
  ThreadSet usable(hwloc_bitmap_dup(hwloc_topology_get_topology_cpuset(topology)),
                   hwloc_bitmap_free);
  const ThreadSet mask(hwloc_bitmap_alloc(), hwloc_bitmap_free);
  if (usable == nullptr || mask == nullptr) {
    throw std::bad_alloc();
  }
  if (hwloc_topology_is_thissystem(topology) != 0 &&
      hwloc_get_cpubind(topology, mask.get(), HWLOC_CPUBIND_PROCESS) == 0 &&
      hwloc_bitmap_intersects(usable.get(), mask.get()) != 0) {
    hwloc_bitmap_and(usable.get(), usable.get(), mask.get());
  }
  return usable;
}

/// Of a hardware thread.
void read_cache(hwloc_topology_t topology, hwloc_obj_t thread, hwloc_obj_type_t type,
                std::size_t& bytes) {
  const hwloc_obj_t cache = hwloc_get_ancestor_obj_by_type(topology, type, thread);
  if (cache != nullptr && cache->attr->cache.size > 0) {
    bytes = cache->attr->cache.size;
  }
}

/// The model that the package of a hardware thread, or else the machine, tells of.
void read_processor(hwloc_topology_t topology, hwloc_obj_t thread, std::string& processor) {
  for (const hwloc_obj_t object :
       {hwloc_get_ancestor_obj_by_type(topology, HWLOC_OBJ_PACKAGE, thread),
        hwloc_get_root_obj(topology)}) {
    const char* model =
        object == nullptr ? nullptr : hwloc_obj_get_info_by_name(object, "CPUModel");
    if (model != nullptr && *model != '\0') {
      processor = model;
      return;
    }
  }
}

/// Nodes in hwloc's order. A hardware thread next to several kinds of memory counts for the first.
std::vector<NumaNode> read_nodes(hwloc_topology_t topology) {
  const ThreadSet usable = usable_threads(topology);
  std::vector<NumaNode> nodes;
  hwloc_obj_t last_core = nullptr;
  for (hwloc_obj_t thread = nullptr;
       (thread = hwloc_get_next_obj_by_type(topology, HWLOC_OBJ_PU, thread)) != nullptr;) {
    if (hwloc_bitmap_isset(usable.get(), thread->os_index) == 0) {
      continue;
    }
    const int number = std::max(0, hwloc_bitmap_first(thread->nodeset));
    auto node = std::ranges::find(nodes, number, &NumaNode::number);
    if (node == nodes.end()) {
      const hwloc_obj_t memory =
          hwloc_get_numanode_obj_by_os_index(topology, static_cast<unsigned>(number));
      nodes.push_back(
          {.number = number,
           .cores = {},
           .memory_bytes = memory == nullptr ? 0 : memory->attr->numanode.local_memory});
      node = nodes.end() - 1;
    }
    const hwloc_obj_t core = hwloc_get_ancestor_obj_by_type(topology, HWLOC_OBJ_CORE, thread);
    if (core == nullptr || core != last_core || node->cores.empty()) {
      node->cores.emplace_back();
    }
    last_core = core;
    node->cores.back().push_back(static_cast<int>(thread->os_index));
  }
  return nodes;
}

Topology read(const Handle& handle) {
  hwloc_topology_t topology = handle.get();
  Topology known;
  known.nodes = read_nodes(topology);
  Machine& machine = known.machine;
  const hwloc_obj_t first = hwloc_get_pu_obj_by_os_index(
      topology, static_cast<unsigned>(known.nodes.front().cores.front().front()));
  read_processor(topology, first, machine.processor);
  machine.hardware_threads = 0;
  machine.cores = 0;
  for (const NumaNode& node : known.nodes) {
    machine.hardware_threads += node.hardware_threads();
    machine.cores += static_cast<int>(node.cores.size());
  }
  machine.numa_nodes = static_cast<int>(known.nodes.size());
  machine.memory_bytes = hwloc_get_root_obj(topology)->total_memory;
  read_cache(topology, first, HWLOC_OBJ_L1CACHE, machine.l1_data_bytes);
  read_cache(topology, first, HWLOC_OBJ_L2CACHE, machine.l2_bytes);
  read_cache(topology, first, HWLOC_OBJ_L3CACHE, machine.l3_bytes);
  if (hwloc_topology_is_thissystem(topology) != 0) {
    known.system = handle;
  }
  return known;
}

}  // namespace

Topology detect_topology() {
  const Handle handle = known_topology();
  if (handle == nullptr) {
    Topology unknown;
    unknown.nodes = {{.number = 0, .cores = {{0}}, .memory_bytes = 0}};
    return unknown;
  }
  Topology topology = read(handle);
  if (topology.system != nullptr) {
    const SystemLimits limits = read_system_limits();
    Machine& machine = topology.machine;
    machine.hardware_threads = limits.threads_of(machine.hardware_threads);
    // Not the sum of the nodes: virtual machines tell of less than there is.
    machine.memory_bytes = limits.memory_bytes > 0 ? limits.memory_bytes : machine.memory_bytes;
  }
  return topology;
}

Topology synthetic_topology(const std::string& description) {
  const Handle handle = new_handle();
  if (handle == nullptr || hwloc_topology_set_synthetic(handle.get(), description.c_str()) != 0 ||
      hwloc_topology_load(handle.get()) != 0) {
    throw std::invalid_argument("'" + description +
                                "' is no topology, expected hwloc's synthetic notation");
  }
  return read(handle);
}

}  // namespace vantage::scheduler
