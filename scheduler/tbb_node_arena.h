#pragma once

#include <oneapi/tbb/task_arena.h>

#include "scheduler/bound_thread.h"
#include "scheduler/thread_places.h"

namespace vantage::scheduler {

/// TBB's arena for the threads of one NUMA node. They are bound by NodeVisit, not by an observer of
/// the arena: TBB tells no observer when the last threads leave an arena that is being destroyed,
/// and they would stay bound in whatever arena they work next.
class NodeArena {
 public:
  /// `callers`: how many of the threads come by arena().execute(), the rest are sent by TBB.
  NodeArena(int node, const ThreadPlaces& places, int callers);

  [[nodiscard]] tbb::task_arena& arena() { return arena_; }
  /// Index in ThreadPlaces::nodes.
  [[nodiscard]] int node() const { return node_; }
  [[nodiscard]] int thread_count() const { return threads_.count(); }
  /// Binds the calling thread, which is inside, as the place in the arena that it has taken says.
  [[nodiscard]] BoundThread bind_this_thread() const;

 private:
  int node_;
  NodeThreads threads_;
  std::shared_ptr<hwloc_topology> system_;
  tbb::task_arena arena_;
};

/// What the calling thread does for the tasks of an executor, from construction to destruction: it
/// is bound to the node of `arena`, and loops begun meanwhile know where they are.
class NodeVisit {
 public:
  /// `loops_stay`: loops begun meanwhile are for the threads of this node alone.
  NodeVisit(const NodeArena& arena, bool loops_stay);
  NodeVisit(const NodeVisit&) = delete;
  NodeVisit& operator=(const NodeVisit&) = delete;
  ~NodeVisit() { innermost_ = outer_; }

  /// This thread's; null outside of all.
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
