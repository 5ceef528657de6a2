#include "apps/run/run_window.h"

#include <chrono>
#include <future>
#include <mutex>
#include <optional>
#include <utility>

#include "apps/process/interrupt.h"
#include "engine/image/eight_bit.h"
#include "engine/io/images/picture_window.h"
#include "engine/io/images/preview.h"
#include "engine/sequence/shots/depth_picture.h"
#include "engine/sequence/steps/frame_slot.h"

namespace vantage::apps {
namespace {

constexpr int kLookInterval_ms = 20;

struct ShownFrame {
  Image<std::uint8_t> map;
  Image<std::uint8_t> picture;
};

}  // namespace

SequenceReport beside_window(const RunJob& job, SequenceRun run,
                             const std::function<SequenceReport(const SequenceRun&)>& work) {
  if (!job.show) {
    return work(run);
  }
  std::mutex mutex;
  std::optional<ShownFrame> next;  // until the window has taken it
  run.on_frame = [&](const FrameSlot& slot) {
    const auto map = slot.maps.of(job.sequence.match.reference).disparity_px.view();
    const std::scoped_lock lock(mutex);
    if (next || map.height() == 0) {
      return;
    }
    const PreviewRange range =
        preview_range_of_frame(job.sequence, run.shots, slot.frame, slot.pair.details.disparities);
    next = {colour_preview(map, range.min_px, range.max_px),
            eight_bit(slot.views.empty() ? *slot.left : slot.views.front().image)};
  };
  PictureWindow window("vantage run: map and " +
                       std::string(job.sequence.views.empty() ? "left image" : "view"));
  auto done = std::async(std::launch::async, [&] { return work(run); });
  while (done.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    std::optional<ShownFrame> shown;
    {
      const std::scoped_lock lock(mutex);
      shown.swap(next);
    }
    if (shown) {
      window.show(shown->map, shown->picture);
    }
    if (!window.stays_open(kLookInterval_ms)) {
      request_end();
      done.wait();
    }
  }
  return done.get();
}

}  // namespace vantage::apps
