#pragma once

#include <memory>
#include <vector>

#include "scheduler/executor.h"
#include "scheduler/tbb_node_arena.h"

namespace vantage::scheduler {

/// How frames are divided between nodes.
struct FramePlaces {
  std::vector<int> node_of_slot;
  /// Whether loops within a frame are for its node alone. Else all nodes take part.
  bool loops_stay = false;
};

/// Places for at most `in_flight` frames at a time: as many as give each node its share of them,
/// within a quarter, so that loops can stay; all of them, and loops of all nodes, where there are
/// fewer frames than nodes or only one of them is computed at a time.
FramePlaces place_frames(int in_flight, bool compute_in_order,
                         const std::vector<int>& threads_of_nodes);

/// Executor::run_frame_steps() for nodes; each step runs on the node of its slot.
/// `caller_works`: the calling thread is one of the first node's, else it sleeps.
void run_frames_on_nodes(const std::vector<std::unique_ptr<NodeArena>>& nodes, bool caller_works,
                         int in_flight, const FrameSteps& steps);

}  // namespace vantage::scheduler
