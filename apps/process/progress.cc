#include "apps/process/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/process/tell.h"

namespace vantage::apps {
namespace {

constexpr std::chrono::milliseconds kBarInterval{100};
constexpr std::chrono::seconds kLineInterval{5};
constexpr std::chrono::seconds kWindow{60};
constexpr std::chrono::milliseconds kSampleInterval{250};

std::string bar(double fraction) {
  constexpr int kWidth = 24;
  const int filled = static_cast<int>(std::lround(fraction * kWidth));
  return "[" + std::string(static_cast<std::size_t>(filled), '=') +
         std::string(static_cast<std::size_t>(kWidth - filled), ' ') + "] ";
}

std::string duration(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(seconds));
  return whole >= 3600 ? fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
                       : fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

Progress::Progress(std::string command, std::string unit, ProgressStyle style)
    : command_(std::move(command)), unit_(std::move(unit)), style_(style) {
  if (style_ == ProgressStyle::kAuto) {
    style_ = ::isatty(STDERR_FILENO) != 0 ? ProgressStyle::kBar : ProgressStyle::kPlain;
  }
  const Clock::time_point now = Clock::now();
  samples_.push_back({now, 0, 0});
  next_print_ = style_ == ProgressStyle::kBar ? now : now + kLineInterval;
}

Progress::~Progress() {
  if (line_open_) {
    tell("\n");
  }
}

void Progress::update(int done, std::optional<int> total, double cells) {
  if (style_ == ProgressStyle::kNone) {
    return;
  }
  const Sample now{Clock::now(), done, cells};
  const bool last = total && done == *total;
  // Without a terminal, the final summary of the command is enough.
  if (now.time >= next_print_ || (last && style_ == ProgressStyle::kBar)) {
    const std::string text = describe(now, total);
    if (style_ == ProgressStyle::kBar) {
      next_print_ = now.time + kBarInterval;
      tell("\r{}\x1b[K", text);
      line_open_ = true;
    } else {
      next_print_ = now.time + kLineInterval;
      tell("{}\n", text);
    }
  }
  if (now.time - samples_.back().time >= kSampleInterval) {
    samples_.push_back(now);
    while (samples_.size() > 2 && now.time - samples_[1].time >= kWindow) {
      samples_.pop_front();
    }
  }
}

std::string Progress::describe(const Sample& now, std::optional<int> total) const {
  const Sample& past = samples_.front();
  const double seconds =
      std::max(1e-9, std::chrono::duration<double>(now.time - past.time).count());
  const double rate = (now.done - past.done) / seconds;
  std::string text = command_ + ": ";
  if (total && *total > 0) {
    // The length of a video can be an estimate, so limit the share to 100 %.
    const int end = std::max(*total, now.done);
    if (style_ == ProgressStyle::kBar) {
      text += bar(static_cast<double>(now.done) / end);
    }
    text += fmt::format("{}/{} {}", now.done, end, unit_);
  } else {
    text += fmt::format("{} {}", now.done, unit_);
  }
  text += fmt::format(", {:.2f} {}/s", rate, unit_);
  if (now.cells > 0) {
    text += fmt::format(", {:.0f} million cells/s", (now.cells - past.cells) / seconds * 1e-6);
  }
  if (total && rate > 0 && now.done <= *total) {
    text += fmt::format(", {} left", duration((*total - now.done) / rate));
  }
  return text;
}

}  // namespace vantage::apps
