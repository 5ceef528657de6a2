#pragma once

#include <memory>
#include <vector>

#include "scheduler/executor.h"
#include "scheduler/topology.h"

namespace vantage::scheduler {

/// Threads of an executor that run on one NUMA node.
struct NodeThreads {
  int number = 0;  ///< the system's number of the node
  /// Per thread, the system's numbers of the hardware threads that it may run on; empty:
  /// all.
  std::vector<std::vector<int>> allowed;

  [[nodiscard]] int count() const { return static_cast<int>(allowed.size()); }
};

/// Where each thread of an executor runs.
struct ThreadPlaces {
  ThreadBinding binding = ThreadBinding::kNone;
  std::vector<NodeThreads> nodes;  ///< at least one, each with at least one thread
  /// hwloc's topology for binding; null if threads are not bound, because of `binding` or because
  /// the topology is not that of this system.
  std::shared_ptr<hwloc_topology> system;

  [[nodiscard]] int thread_count() const;
  /// Threads of each node.
  [[nodiscard]] std::vector<int> threads_of_nodes() const;
};

/// kNodes where `threads` need the cores of more than one node, else kNone.
ThreadBinding default_binding(const Topology& topology, int threads);

/// `threads` ≥ 1 that may run anywhere, as one node.
ThreadPlaces unbound_threads(int threads);

/// Places `threads` ≥ 1. They use the first nodes that have a core for each thread, else all nodes,
/// in proportion to cores or, if there are more threads than cores, to hardware threads. A thread
/// then works on memory of its own node. With kNone: unbound_threads().
ThreadPlaces place_threads(const Topology& topology, int threads, ThreadBinding binding);

/// `wanted`, or where the build is without it, the first of TBB, OpenMP and serial that it has.
ExecutorKind built_in_executor(ExecutorKind wanted);

/// Like make_executor() of executor.h, for given places: built_in_executor(kind). Throws
/// std::invalid_argument for a serial executor with binding.
std::unique_ptr<Executor> make_executor(ExecutorKind kind, const ThreadPlaces& places);

/// `total` divided in proportion to `weights` (≥ 0, not all 0), each part rounded to a neighbour.
std::vector<int> divide_in_proportion(int total, const std::vector<int>& weights);

}  // namespace vantage::scheduler
