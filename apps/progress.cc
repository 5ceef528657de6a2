#include "apps/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace vantage::apps {
namespace {

constexpr std::chrono::milliseconds kTerminalInterval{100};
constexpr std::chrono::seconds kLineInterval{5};

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

Progress::Progress(std::string command, std::string unit, bool quiet)
    : command_(std::move(command)),
      unit_(std::move(unit)),
      quiet_(quiet),
      terminal_(::isatty(STDERR_FILENO) != 0),
      next_print_(start_ + (terminal_ ? Clock::duration::zero() : kLineInterval)) {}

Progress::~Progress() {
  if (line_open_) {
    std::fputc('\n', stderr);
  }
}

void Progress::update(int done, std::optional<int> total, double cells) {
  const Clock::time_point now = Clock::now();
  const bool last = total && done == *total;
  // Elsewhere than on a terminal the final summary of the command says the rest.
  if (quiet_ || (now < next_print_ && !(last && terminal_))) {
    return;
  }
  const std::string text = describe(done, total, cells);
  if (terminal_) {
    next_print_ = now + kTerminalInterval;
    fmt::print(stderr, "\r{}\x1b[K", text);
    std::fflush(stderr);
    line_open_ = true;
  } else {
    next_print_ = now + kLineInterval;
    fmt::print(stderr, "{}\n", text);
  }
}

std::string Progress::describe(int done, std::optional<int> total, double cells) const {
  const double seconds =
      std::max(1e-9, std::chrono::duration<double>(Clock::now() - start_).count());
  std::string text = command_ + ": ";
  if (total && *total > 0) {
    // The length of a video can be an estimate: never past the end.
    const int end = std::max(*total, done);
    if (terminal_) {
      text += bar(static_cast<double>(done) / end);
    }
    text += fmt::format("{}/{} {}", done, end, unit_);
  } else {
    text += fmt::format("{} {}", done, unit_);
  }
  text += fmt::format(", {:.2f} {}/s", done / seconds, unit_);
  if (cells > 0) {
    text += fmt::format(", {:.0f} million cells/s", cells / seconds * 1e-6);
  }
  if (total && done > 0 && done <= *total) {
    text += fmt::format(", {} left", duration(seconds / done * (*total - done)));
  }
  return text;
}

}  // namespace vantage::apps
