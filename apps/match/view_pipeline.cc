#include "apps/match/view_pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <utility>
#include <vector>

#include "apps/process/interrupt.h"
#include "apps/process/progress.h"
#include "apps/process/tell.h"
#include "engine/seconds_since.h"
#include "engine/sequence/steps/busy_clock.h"
#include "scheduler/frame_pipeline.h"

namespace vantage::apps {
namespace {

using Clock = std::chrono::steady_clock;

struct Slot {
  int view = 0;
  RenderedView rendered;
  double read_seconds = 0;
  double render_seconds = 0;  // preparation included
  double write_seconds = 0;
};

}  // namespace

int views_in_flight(Execution& execution, int views) {
  return std::min(execution.executor().thread_count() + 2, views);
}

ViewPipelineResult render_views(const std::string& command, int views, const ViewSteps& steps,
                                bool has_two_eyes, ViewOutputs& outputs,
                                const CommonOptions& common, Execution& execution,
                                RunReport& report) {
  const int in_flight = views_in_flight(execution, views);
  std::vector<Slot> slots(static_cast<std::size_t>(in_flight));
  const auto slot_of = [&](int number) -> Slot& { return slots[static_cast<std::size_t>(number)]; };
  ViewPipelineResult result;
  BusyClock computing;
  int next = 0;
  int written = 0;
  {
    Progress progress(command, "views",
                      common.quiet || views == 1 ? ProgressStyle::kNone : ProgressStyle::kAuto);
    scheduler::FrameSteps frame_steps;
    frame_steps.read = [&](int number) {
      if (next == views) {
        return false;
      }
      Slot& slot = slot_of(number);
      slot.view = next++;
      slot.render_seconds = 0;
      const auto start = Clock::now();
      if (steps.read) {
        steps.read(number, slot.view);
      }
      slot.read_seconds = seconds_since(start);
      if (steps.prepare) {
        const BusyClock::Activity activity(computing);
        steps.prepare(number, slot.view);
        slot.render_seconds = seconds_since(start) - slot.read_seconds;
      }
      return true;
    };
    frame_steps.prepare = [](int /*slot*/) {};
    frame_steps.compute = [&](int number) {
      Slot& slot = slot_of(number);
      const BusyClock::Activity activity(computing);
      const auto start = Clock::now();
      steps.render(number, slot.view, slot.rendered);
      slot.render_seconds += seconds_since(start);
    };
    // Images are separate files; frames of a video must be in order.
    frame_steps.encode = [&](int number) {
      Slot& slot = slot_of(number);
      const auto start = Clock::now();
      outputs.write_at_once(slot.view, slot.rendered.picture(has_two_eyes), slot.rendered.eyes[0]);
      slot.write_seconds = seconds_since(start);
    };
    frame_steps.write = [&](int number) {
      Slot& slot = slot_of(number);
      const Photograph& picture = slot.rendered.picture(has_two_eyes);
      const auto start = Clock::now();
      outputs.write_in_order(slot.view, picture, slot.rendered.eyes[0]);
      report.add_stage("write", slot.write_seconds + seconds_since(start));
      if (steps.read) {
        report.add_stage("read", slot.read_seconds);
      }
      report.add_stage("views", slot.render_seconds);
      result.views.push_back(steps.describe(number, slot.view, slot.rendered));
      result.width_px = picture.width();
      result.height_px = picture.height();
      progress.update(++written, views, 0);
    };
    result.interrupted =
        scheduler::run_frames(execution.executor(), in_flight, frame_steps, {}, &interrupt_flag())
            .interrupted;
  }
  report.add_compute_seconds(computing.seconds());
  if (result.interrupted) {
    if (!common.quiet) {
      tell("{}: interrupted after {} of {} views\n", command, written, views);
    }
    return result;
  }
  report.timed_file_access("write", [&] { outputs.finish(); });
  return result;
}

}  // namespace vantage::apps
