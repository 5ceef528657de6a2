#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/sequence/pairs/forwarded_pairs.h"

namespace vantage {

/// The pairs of pictures with that layout.
std::unique_ptr<PairSource> make_packed_pairs(std::unique_ptr<FrameSource> source,
                                              StereoPacking packing);

/// Opens a source and adds what it says of itself to `notes`. Throws as open_frame_source() does.
std::unique_ptr<FrameSource> open_noted_source(const std::string& spec,
                                               const PhotographReading& reading,
                                               std::vector<std::string>& notes);

/// The pairs of PairSourceOptions::stereo, which is no stream: packed as the options say, else as
/// the film says, else of its two video tracks. Adds what was assumed to `notes`. Throws Error for
/// a second view that FFmpeg does not decode, UsageError where nothing says how it is packed.
std::unique_ptr<PairSource> open_stereo_pairs(const PairSourceOptions& options,
                                              std::vector<std::string>& notes);

/// Pairs with remarks on all of them before their own.
class NotedPairs final : public ForwardedPairs {
 public:
  NotedPairs(std::unique_ptr<PairSource> source, std::vector<std::string> notes)
      : ForwardedPairs(std::move(source)), notes_(std::move(notes)) {}

  [[nodiscard]] std::vector<std::string> remarks() const override;

 private:
  std::vector<std::string> notes_;
};

}  // namespace vantage
