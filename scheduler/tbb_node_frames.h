#pragma once

#include <memory>
#include <vector>

#include "scheduler/executor.h"
#include "scheduler/tbb_node_arena.h"

namespace vantage::scheduler {

/// Division of the frames between nodes.
struct FramePlaces {
  std::vector<int> node_of_slot;
  /// Whether loops within a frame run on its node only. Else all nodes take part.
  bool loops_stay = false;
};

/// Places for at most `in_flight` frames at a time: as many as give each node its share of them,
/// within a quarter, so that loops can stay on their node. With fewer frames than nodes, or frames
/// computed in order: `in_flight` places, and loops run on all nodes.
FramePlaces place_frames(int in_flight, bool compute_in_order,
                         const std::vector<int>& threads_of_nodes);

/// Executor::run_frame_steps() for nodes; each step runs on the node of its slot.
/// `caller_works`: the calling thread is one of the first node's, else it sleeps.
void run_frames_on_nodes(const std::vector<std::unique_ptr<NodeArena>>& nodes, bool caller_works,
                         int in_flight, const FrameSteps& steps);

}  // namespace vantage::scheduler
