#include "scheduler/machine.h"

#include "scheduler/topology.h"

namespace vantage::scheduler {

Machine detect_machine() { return detect_topology().machine; }

}  // namespace vantage::scheduler
