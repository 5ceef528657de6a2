#pragma once

#include <cstddef>
#include <optional>

#include "engine/execution.h"
#include "engine/sequence/options/sequence_options.h"
#include "engine/sequence/pairs/pair_shape.h"
#include "engine/sequence/pairs/pair_source.h"
#include "scheduler/strip_plan.h"

namespace vantage {

/// Planned memory of a run.
struct MemoryPlan {
  int in_flight = 1;
  /// Memory budget for what the iterations of one map store between passes plus the scratch of all
  /// threads; ExecutionOptions::chain_memory_bytes of the run.
  std::size_t chain_bytes = 0;
  std::size_t frame_bytes = 0;  ///< images, maps, views and files of a frame in flight
  std::size_t total_bytes = 0;  ///< peak of the whole process
  scheduler::ChainPlan chain;   ///< of one map
};

struct MemoryRequest {
  std::optional<int> in_flight;             ///< as requested by the user; default: threads + 2
  std::optional<std::size_t> memory_bytes;  ///< upper limit; default: none
  std::size_t free_bytes = 0;  ///< where `memory_bytes` is not the user's: of which it is a part

  /// One frame may need more than is free.
  [[nodiscard]] bool allows(const MemoryPlan& plan) const {
    return !memory_bytes || plan.total_bytes <= *memory_bytes;
  }
};

/// Without `memory_bytes`: four fifths of what is free in this system, limits of control groups
/// included.
MemoryRequest memory_request(std::optional<int> in_flight,
                             std::optional<std::size_t> memory_bytes = std::nullopt);

inline constexpr int kMaxFramesInFlight = 64;

/// Frames in flight if neither the user nor memory limits them.
int default_frames_in_flight(int threads);

/// Chooses the number of frames in flight and the memory of each, within the request: reduces the
/// frames first, then the memory for iterations. `first` is the first pair, ready for matching.
/// Throws Error when one frame does not fit into the user's limit, naming its size; for views that
/// cannot be rendered, naming the frame.
MemoryPlan plan_memory(const SequenceOptions& options, const MemoryRequest& request,
                       const PairShape& shape, const FramePair& first,
                       const ExecutionOptions& execution);

}  // namespace vantage
