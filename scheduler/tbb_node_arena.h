#pragma once

#include <oneapi/tbb/task_arena.h>

#include "scheduler/bound_thread.h"
#include "scheduler/thread_places.h"

namespace vantage::scheduler {

/// A TBB arena for the threads of one NUMA node. NodeVisit binds them, not an observer of the
/// arena: TBB does not call observers when the last threads leave an arena that is being destroyed,
/// and those threads would stay bound in other arenas. TBB's own constraints (tbbbind) know whole
/// nodes only, neither cores nor a part of a node's threads, and no simulated machine.
class NodeArena {
 public:
  /// `callers`: number of threads that enter by arena().execute(); TBB provides the others.
  NodeArena(int node, const ThreadPlaces& places, int callers);

  [[nodiscard]] tbb::task_arena& arena() { return arena_; }
  /// Index in ThreadPlaces::nodes.
  [[nodiscard]] int node() const { return node_; }
  [[nodiscard]] int thread_count() const { return threads_.count(); }
  /// Binds the calling thread, which must be in the arena, according to its slot there.
  [[nodiscard]] BoundThread bind_this_thread() const;

 private:
  int node_;
  NodeThreads threads_;
  std::shared_ptr<hwloc_topology> system_;
  tbb::task_arena arena_;
};

/// While it exists, the calling thread works for an executor: it is bound to the node of `arena`,
/// and loops that it starts know their node.
class NodeVisit {
 public:
  /// `loops_stay`: loops that this thread starts meanwhile run on this node only.
  NodeVisit(const NodeArena& arena, bool loops_stay);
  NodeVisit(const NodeVisit&) = delete;
  NodeVisit& operator=(const NodeVisit&) = delete;
  ~NodeVisit() { innermost_ = outer_; }

  /// The innermost visit of this thread; null if there is none.
  [[nodiscard]] static const NodeVisit* innermost() { return innermost_; }
  [[nodiscard]] const NodeArena& arena() const { return arena_; }
  [[nodiscard]] bool loops_stay() const { return loops_stay_; }

 private:
  static thread_local const NodeVisit* innermost_;

  const NodeArena& arena_;
  bool loops_stay_;
  const NodeVisit* outer_;
  BoundThread bound_;
};

}  // namespace vantage::scheduler
