#include "engine/sequence/work_plan.h"

#include <algorithm>

namespace vantage {

FrameRange FrameSelection::all() const {
  const FrameRange input{0, frame_count};
  return frames ? frames->intersection(input) : input;
}

FrameRange FrameSelection::own() const {
  const FrameRange selected = all();
  if (!shard || selected.empty()) {
    return selected;
  }
  const long long first_chunk = selected.first / chunk_frames;
  const long long chunks = (selected.end - 1) / chunk_frames + 1 - first_chunk;
  const auto boundary = [&](long long shards_before) {
    return static_cast<int>(std::min<long long>(
        frame_count, (first_chunk + chunks * shards_before / shard->count) * chunk_frames));
  };
  return selected.intersection({boundary(shard->index - 1), boundary(shard->index)});
}

FrameRange FrameSelection::chunk_of(int frame) const {
  const int begin = chunk_begin(frame);
  return all().intersection({begin, begin + std::min(chunk_frames, frame_count - begin)});
}

FrameRun run_of(const FrameSelection& selection, FrameDependence dependence, FrameRange frames) {
  return {frames, dependence.on_past ? frames.first - selection.chunk_begin(frames.first) : 0};
}

std::vector<FrameRun> plan_work(const FrameSelection& selection, FrameDependence dependence,
                                const std::function<bool(int frame)>& is_done) {
  std::vector<FrameRun> runs;
  const auto add = [&](FrameRange frames) {
    runs.push_back(run_of(selection, dependence, frames));
  };
  const FrameRange own = selection.own();
  for (int frame = own.first; frame < own.end;) {
    const FrameRange chunk = selection.chunk_of(frame);
    if (dependence.whole_chunks) {
      bool done = true;
      for (int member = chunk.first; member < chunk.end; ++member) {
        done = done && is_done(member);
      }
      if (!done) {
        add(chunk);
      }
    } else {
      for (int first = chunk.first; first < chunk.end;) {
        int end = first;
        while (end < chunk.end && !is_done(end)) {
          ++end;
        }
        if (end > first) {
          add({first, end});
        }
        first = std::max(end, first + 1);
      }
    }
    frame = chunk.end;
  }
  return runs;
}

}  // namespace vantage
