#include "engine/options/frame_step_setting.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <optional>
#include <string_view>

namespace vantage {
namespace {

template <typename Number>
std::optional<Number> parsed(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole ? std::optional(number) : std::nullopt;
}

FrameStep to_frame_step(const SettingValue& value) {
  const std::string text = value.is_number() ? value.dump() : vantage::to_text(value);
  FrameStep step;
  if (text.ends_with('s')) {
    if (const auto seconds = parsed<double>(std::string_view(text).substr(0, text.size() - 1))) {
      step.seconds = *seconds;
      return step;
    }
  }
  const auto parts = split(text, '+');
  const auto pairs = parts.size() <= 2 ? parsed<int>(parts.front()) : std::nullopt;
  const auto first = parts.size() == 2 ? parsed<int>(parts[1]) : std::optional(0);
  if (!pairs || !first) {
    reject_value(value,
                 "a number of frames such as 10, 10+5 (from frame 5 on), or seconds such as 4s");
  }
  step.pairs = *pairs;
  step.first = *first;
  return step;
}

}  // namespace

std::optional<std::pair<int, int>> two_numbers(const std::string& text, char separator) {
  const auto parts = split(text, separator);
  if (parts.size() != 2) {
    return std::nullopt;
  }
  const auto first = parsed<long long>(parts[0]);
  const auto second = parsed<long long>(parts[1]);
  constexpr int kMax = std::numeric_limits<int>::max() - 1;
  if (!first || !second || *first < 0 || *second < 0 || *first > kMax || *second > kMax) {
    return std::nullopt;
  }
  return std::pair(static_cast<int>(*first), static_cast<int>(*second));
}

std::string to_text(const FrameStep& every) {
  if (every.seconds) {
    return fmt::format("{}s", *every.seconds);
  }
  return every.first == 0 ? fmt::format("{}", every.pairs)
                          : fmt::format("{}+{}", every.pairs, every.first);
}

void add_frame_step_setting(Settings& settings, FrameStep& every) {
  Setting& setting =
      settings.add("every", "N|Ts",
                   "Take every N-th frame (N+P: from frame P on) or a frame every T seconds, such "
                   "as 4s. Results are numbered 0, 1, 2 …; videos keep the duration of the input");
  setting.kind = ValueKind::kIntegerOrText;
  setting.set = [&every](const SettingValue& value) { every = to_frame_step(value); };
  setting.get = [&every] { return to_text(every); };
}

void add_frames_setting(Settings& settings, std::optional<FrameRange>& frames,
                        std::optional<int>& step) {
  Setting& setting =
      settings.add("frames", "A-B[:N]",
                   "Process frames A to B of the input only, counted from 0; with :N only A, A + "
                   "N, A + 2 N …");
  setting.words = {"all"};
  setting.set = [&frames, &step](const SettingValue& value) {
    frames.reset();
    step.reset();
    if (value == "all") {
      return;
    }
    const auto parts = split(to_text(value), ':');
    const auto range = two_numbers(parts.front(), '-');
    const long long number = parts.size() == 2 ? parsed<long long>(parts[1]).value_or(0) : 1;
    if (!range || range->first > range->second || parts.size() > 2 || number < 1 ||
        number > FrameStep::kMaxPairs) {
      reject_value(value, "a range of frames such as 100-199 or 100-199:10, or all");
    }
    frames = FrameRange{range->first, range->second + 1};
    if (parts.size() == 2) {
      step = static_cast<int>(number);
    }
  };
  setting.get = [&frames, &step]() -> SettingValue {
    if (!frames) {
      return "all";
    }
    const std::string range = fmt::format("{}-{}", frames->first, frames->end - 1);
    return step ? fmt::format("{}:{}", range, *step) : range;
  };
}

}  // namespace vantage
