#include "scheduler/tbb_node_arena.h"

#include <cstddef>

namespace vantage::scheduler {

NodeArena::NodeArena(int node, const ThreadPlaces& places, int callers)
    : node_(node),
      threads_(places.nodes[static_cast<std::size_t>(node)]),
      system_(places.system),
      arena_(threads_.count(), static_cast<unsigned>(callers)) {}

BoundThread NodeArena::bind_this_thread() const {
  // Places are numbered from 0; an arena of one thread may use the second one, too.
  const auto place = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
  return {system_, threads_.allowed[place % threads_.allowed.size()]};
}

thread_local const NodeVisit* NodeVisit::innermost_ = nullptr;

NodeVisit::NodeVisit(const NodeArena& arena, bool loops_stay)
    : arena_(arena),
      loops_stay_(loops_stay),
      outer_(innermost_),
      bound_(outer_ != nullptr && &outer_->arena_ == &arena ? BoundThread()
                                                            : arena.bind_this_thread()) {
  innermost_ = this;
}

}  // namespace vantage::scheduler
