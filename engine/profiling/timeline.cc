#include "engine/profiling/timeline.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>

#include "engine/profiling/waiting_causes.h"

namespace vantage {
namespace {

using Activity = std::tuple<std::string_view, bool, int>;

Activity activity_of(const ThreadPiece& piece) { return {piece.name, piece.is_wait, piece.frame}; }

/// Neighbours merged into one span.
class Group {
 public:
  [[nodiscard]] bool empty() const { return durations_ns_.empty(); }
  [[nodiscard]] std::int64_t end_ns() const { return end_ns_; }
  [[nodiscard]] std::int64_t length_ns() const { return end_ns_ - begin_ns_; }

  void add(const ThreadPiece& piece) {
    if (empty()) {
      begin_ns_ = piece.begin_ns;
    }
    end_ns_ = piece.end_ns;
    durations_ns_[activity_of(piece)] += piece.end_ns - piece.begin_ns;
  }

  [[nodiscard]] ThreadPiece joined() const {
    const auto longest = std::ranges::max_element(durations_ns_, {},
                                                  &std::pair<const Activity, std::int64_t>::second);
    const auto& [name, is_wait, frame] = longest->first;
    return {name, is_wait, begin_ns_, end_ns_, frame};
  }

 private:
  std::map<Activity, std::int64_t> durations_ns_;
  std::int64_t begin_ns_ = 0;
  std::int64_t end_ns_ = 0;
};

void append(const ThreadPiece& piece, std::vector<ThreadPiece>& pieces) {
  if (!pieces.empty() && pieces.back().end_ns == piece.begin_ns &&
      activity_of(pieces.back()) == activity_of(piece)) {
    pieces.back().end_ns = piece.end_ns;
  } else {
    pieces.push_back(piece);
  }
}

/// `pieces` in order; merges runs of pieces shorter than `shortest_ns`; only the last of a run may
/// still be shorter.
std::vector<ThreadPiece> with_short_ones_joined(const std::vector<ThreadPiece>& pieces,
                                                std::int64_t shortest_ns) {
  std::vector<ThreadPiece> joined;
  Group group;
  const auto flush = [&] {
    if (!group.empty()) {
      append(group.joined(), joined);
      group = {};
    }
  };
  for (const ThreadPiece& piece : pieces) {
    const bool is_long = piece.end_ns - piece.begin_ns >= shortest_ns;
    if (is_long || (!group.empty() && piece.begin_ns != group.end_ns())) {
      flush();
    }
    group.add(piece);
    if (group.length_ns() >= shortest_ns) {
      flush();
    }
  }
  flush();
  return joined;
}

}  // namespace

std::vector<TimelineRow> timeline_of(const scheduler::TraceData& trace, int max_spans) {
  std::vector<TimelineRow> rows;
  const auto spans_per_row = std::max<std::int64_t>(
      1, max_spans / std::max<int>(1, static_cast<int>(trace.threads.size())));
  const std::int64_t shortest_ns = trace.wall_ns / spans_per_row;
  for (const scheduler::ThreadTrace& thread : trace.threads) {
    TimelineRow& row = rows.emplace_back(TimelineRow{thread.name, thread.is_in_pool, {}});
    std::vector<ThreadPiece> pieces;
    for (const ThreadPiece& piece : thread_pieces(thread)) {
      append(piece, pieces);
    }
    for (const ThreadPiece& piece : with_short_ones_joined(pieces, shortest_ns)) {
      row.spans.push_back({std::string(piece.name), piece.is_wait,
                           static_cast<double>(piece.begin_ns) * 1e-9,
                           static_cast<double>(piece.end_ns) * 1e-9, piece.frame});
    }
  }
  return rows;
}

}  // namespace vantage
