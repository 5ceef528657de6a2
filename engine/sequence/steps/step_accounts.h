#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "scheduler/processor_account.h"

namespace vantage {

/// Steps of a run whose processor time is told apart.
enum class RunStep : std::uint8_t {
  kRead,    ///< files, and decoding videos unless the codec has threads of its own
  kDecode,  ///< images, colours of video frames, splitting packed ones
  kRectify,
  kMatch,
  kViews,
  kPictures,  ///< previews, stereo pictures, depth
  kComfort,
  kEncode,  ///< files of the frame
  kWrite,   ///< videos
  kDeliver  ///< flushing, naming, journal
};

inline constexpr std::array<std::string_view, 10> kRunStepNames = {
    "read",     "decode",  "rectify", "match", "views",
    "pictures", "comfort", "encode",  "write", "deliver"};

/// Processor time of a run by step, in the order of kRunStepNames.
class StepAccounts {
 public:
  [[nodiscard]] scheduler::ProcessorAccount* of(RunStep step) {
    return &accounts_[static_cast<std::size_t>(step)];
  }
  [[nodiscard]] double seconds(std::size_t step) const { return accounts_[step].seconds(); }

 private:
  std::array<scheduler::ProcessorAccount, kRunStepNames.size()> accounts_;
};

}  // namespace vantage
