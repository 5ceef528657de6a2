#include "apps/inputs/sampled_matches.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "engine/error.h"

namespace vantage::apps {

std::vector<int> sampled_pairs(int pairs, int max_pairs) {
  const int count = std::min(pairs, max_pairs);
  std::vector<int> indices;
  for (int i = 0; i < count; ++i) {
    indices.push_back(
        count == 1 ? 0 : static_cast<int>(static_cast<long long>(i) * (pairs - 1) / (count - 1)));
  }
  return indices;
}

void read_equal_pair(PairSource& pairs, int index, FramePair& pair) {
  pairs.skip_to(index);
  if (!pairs.fetch(pair)) {
    throw Error(fmt::format("pair {} cannot be read, the input ends before it", index));
  }
  pairs.decode(pair);
  if (pair.left.width() != pair.right.width() || pair.left.height() != pair.right.height()) {
    throw Error(fmt::format("{}: the images are {}x{} and {}x{}, expected equal sizes",
                            pairs.describe(index), pair.left.width(), pair.left.height(),
                            pair.right.width(), pair.right.height()));
  }
}

void for_each_sampled_pair(PairSource& pairs, const std::vector<int>& indices, ImageSize size,
                           Execution& execution, RunReport& report,
                           const std::function<void(std::size_t i, FramePair& pair)>& work) {
  const std::size_t together = static_cast<std::size_t>(execution.executor().thread_count());
  std::vector<FramePair> group(std::min(together, indices.size()));
  for (std::size_t first = 0; first < indices.size(); first += group.size()) {
    const std::size_t count = std::min(group.size(), indices.size() - first);
    report.timed_file_access("read", [&] {
      for (std::size_t i = 0; i < count; ++i) {
        read_equal_pair(pairs, indices[first + i], group[i]);
        const Photograph& left = group[i].left;
        if (left.width() != size.width_px || left.height() != size.height_px) {
          throw Error(fmt::format("{}: the images are {}x{}, expected {}x{} as before",
                                  pairs.describe(indices[first + i]), left.width(), left.height(),
                                  size.width_px, size.height_px));
        }
      }
    });
    report.timed_compute("features", [&] {
      execution.executor().parallel_for(static_cast<int>(count), [&](int task) {
        const auto i = static_cast<std::size_t>(task);
        work(first + i, group[i]);
      });
    });
  }
}

std::vector<PointMatch> gather_matches(
    PairSource& pairs, const std::vector<int>& indices, ImageSize size, Execution& execution,
    RunReport& report, const std::function<std::vector<PointMatch>(FramePair&)>& matches_of) {
  std::vector<std::vector<PointMatch>> found(indices.size());
  for_each_sampled_pair(pairs, indices, size, execution, report,
                        [&](std::size_t i, FramePair& pair) { found[i] = matches_of(pair); });
  std::vector<PointMatch> all;
  for (const std::vector<PointMatch>& matches : found) {
    all.insert(all.end(), matches.begin(), matches.end());
  }
  return all;
}

}  // namespace vantage::apps
