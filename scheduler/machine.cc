#include "scheduler/machine.h"

#include <hwloc.h>

#include <algorithm>

namespace vantage::scheduler {
namespace {

void read_cache(hwloc_topology_t topology, hwloc_obj_type_t type, std::size_t& bytes) {
  const hwloc_obj_t cache = hwloc_get_obj_by_type(topology, type, 0);
  if (cache != nullptr && cache->attr->cache.size > 0) {
    bytes = cache->attr->cache.size;
  }
}

/// The model that the first package, or else the machine, tells of.
void read_processor(hwloc_topology_t topology, std::string& processor) {
  for (const hwloc_obj_t object :
       {hwloc_get_obj_by_type(topology, HWLOC_OBJ_PACKAGE, 0), hwloc_get_root_obj(topology)}) {
    const char* model =
        object == nullptr ? nullptr : hwloc_obj_get_info_by_name(object, "CPUModel");
    if (model != nullptr && *model != '\0') {
      processor = model;
      return;
    }
  }
}

}  // namespace

Machine detect_machine() {
  Machine machine;
  hwloc_topology_t topology = nullptr;
  if (hwloc_topology_init(&topology) != 0) {
    return machine;
  }
  if (hwloc_topology_load(topology) == 0) {
    read_processor(topology, machine.processor);
    machine.hardware_threads = std::max(1, hwloc_get_nbobjs_by_type(topology, HWLOC_OBJ_PU));
    machine.cores = std::max(1, hwloc_get_nbobjs_by_type(topology, HWLOC_OBJ_CORE));
    machine.numa_nodes = std::max(1, hwloc_get_nbobjs_by_type(topology, HWLOC_OBJ_NUMANODE));
    machine.memory_bytes = hwloc_get_root_obj(topology)->total_memory;
    read_cache(topology, HWLOC_OBJ_L1CACHE, machine.l1_data_bytes);
    read_cache(topology, HWLOC_OBJ_L2CACHE, machine.l2_bytes);
    read_cache(topology, HWLOC_OBJ_L3CACHE, machine.l3_bytes);
  }
  hwloc_topology_destroy(topology);
  return machine;
}

}  // namespace vantage::scheduler
