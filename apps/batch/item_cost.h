#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "apps/batch/batch_item.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage::apps {

/// What an item needs, estimated from the headers of its inputs.
struct ItemCost {
  int frames = 0;
  double core_seconds = 0;
  std::size_t memory_bytes = 0;
  bool is_pair = false;
  bool goes_with_others = false;  ///< of a pair: with those of the same options
  std::uint64_t options_hash = 0;
  int chunk_frames = 1;
  std::uint64_t bytes_in = 0;
  std::uint64_t bytes_out = 0;
  std::string problem;  ///< why the input cannot be opened; empty: it can
};

/// Estimates what items need. Of each set of options the first pair that can be read is matched on
/// one thread; others cost as much per pixel and candidate. Thread rule: may be used
/// concurrently.
class CostModel {
 public:
  /// Looks at no more than the headers where a pair of such options is known. Does not throw for
  /// inputs that cannot be read.
  ItemCost cost_of(const BatchItem& item);

 private:
  /// One pair of a set of options.
  struct Sample {
    double seconds_per_cell = 0;   ///< a cell: one candidate of a pixel
    double candidates_per_px = 0;  ///< per pixel of the width, where the range is found
    double memory_per_pixel = 0;   ///< bytes
  };
  Sample sample_of(const BatchItem& item, std::uint64_t options_hash, const ImageExtent& size,
                   PairSource* pairs);

  std::mutex mutex_;
  std::map<std::uint64_t, Sample> samples_;  ///< by options
};

}  // namespace vantage::apps
