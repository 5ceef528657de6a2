#include "scheduler/thread_places.h"

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>

namespace vantage::scheduler {
namespace {

int core_count(const NumaNode& node) { return static_cast<int>(node.cores.size()); }

/// How many of `threads` run on each node.
std::vector<int> spread(const std::vector<NumaNode>& nodes, int threads) {
  std::vector<int> weights;
  int cores = 0;
  for (const NumaNode& node : nodes) {
    if (cores >= threads) {
      break;
    }
    weights.push_back(core_count(node));
    cores += core_count(node);
  }
  if (cores < threads) {
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      weights[k] = nodes[k].hardware_threads();
    }
  }
  return divide_in_proportion(threads, weights);
}

std::vector<int> all_hardware_threads(const NumaNode& node) {
  std::vector<int> all;
  for (const Core& core : node.cores) {
    all.insert(all.end(), core.begin(), core.end());
  }
  return all;
}

}  // namespace

int NumaNode::hardware_threads() const {
  std::size_t count = 0;
  for (const Core& core : cores) {
    count += core.size();
  }
  return static_cast<int>(count);
}

int ThreadPlaces::thread_count() const {
  int count = 0;
  for (const NodeThreads& node : nodes) {
    count += node.count();
  }
  return count;
}

std::vector<int> ThreadPlaces::threads_of_nodes() const {
  std::vector<int> counts;
  for (const NodeThreads& node : nodes) {
    counts.push_back(node.count());
  }
  return counts;
}

ThreadBinding default_binding(const Topology& topology, int threads) {
  return threads > core_count(topology.nodes.front()) && topology.nodes.size() > 1
             ? ThreadBinding::kNodes
             : ThreadBinding::kNone;
}

ThreadPlaces unbound_threads(int threads) {
  ThreadPlaces places;
  places.nodes.emplace_back();
  places.nodes.front().allowed.resize(static_cast<std::size_t>(threads));
  return places;
}

ThreadPlaces place_threads(const Topology& topology, int threads, ThreadBinding binding) {
  if (binding == ThreadBinding::kNone) {
    return unbound_threads(threads);
  }
  ThreadPlaces places;
  places.binding = binding;
  places.system = topology.system;
  const std::vector<int> counts = spread(topology.nodes, threads);
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const NumaNode& node = topology.nodes[k];
    NodeThreads here;
    here.number = node.number;
    for (int thread = 0; thread < counts[k]; ++thread) {
      here.allowed.push_back(binding == ThreadBinding::kCores
                                 ? node.cores[static_cast<std::size_t>(thread) % node.cores.size()]
                                 : all_hardware_threads(node));
    }
    if (!here.allowed.empty()) {
      places.nodes.push_back(std::move(here));
    }
  }
  return places;
}

std::vector<int> divide_in_proportion(int total, const std::vector<int>& weights) {
  const auto sum = std::accumulate(weights.begin(), weights.end(), std::int64_t{0});
  std::vector<int> parts;
  std::int64_t weight_so_far = 0;
  std::int64_t given = 0;
  for (const int weight : weights) {
    weight_so_far += weight;
    // Rounding sums, not parts: the last one is the total.
    const std::int64_t end = (2 * std::int64_t{total} * weight_so_far + sum) / (2 * sum);
    parts.push_back(static_cast<int>(end - given));
    given = end;
  }
  return parts;
}

}  // namespace vantage::scheduler
