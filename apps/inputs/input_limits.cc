#include "apps/inputs/input_limits.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <thread>
#include <utility>

#include "engine/data_limit.h"
#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/matching/levels/level_bands.h"
#include "engine/out_of_memory.h"

namespace vantage::apps {
namespace {

constexpr const char* kNoLimit = "auto";

// The limit set by --memory, for messages.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
std::optional<std::size_t> memory_limit;

/// "512M", "4G", "1.5GiB", "800000000".
std::size_t to_bytes(const SettingValue& value) {
  const std::string text = value.is_number() ? value.dump() : to_text(value);
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  std::string unit(end, text.data() + text.size());
  if (unit.ends_with("iB")) {
    unit.resize(unit.size() - 2);
  } else if (unit.ends_with("B")) {
    unit.pop_back();
  }
  constexpr std::string_view kUnits = "KMGT";
  const std::size_t power = unit.empty() ? 0 : kUnits.find(unit) + 1;
  const double bytes = std::ldexp(number, 10 * static_cast<int>(power));
  if (error != std::errc{} || unit.size() > 1 || (!unit.empty() && power == 0) ||
      !(bytes >= 1 && bytes <= 0x1p50)) {
    reject_value(value, "a size in bytes such as 800M or 4G (units of 1024)");
  }
  return static_cast<std::size_t>(bytes);
}

std::string bytes_text(std::size_t bytes) {
  constexpr std::string_view kUnits = "KMGT";
  std::size_t power = 0;
  while (power < kUnits.size() && bytes % 1024 == 0 && bytes > 0) {
    bytes /= 1024;
    ++power;
  }
  return power == 0 ? fmt::format("{}", bytes) : fmt::format("{}{}", bytes, kUnits[power - 1]);
}

void limit_memory(std::size_t bytes) {
  // Stacks count with their full size, although little of it is used.
  constexpr std::size_t kStackBytes = std::size_t{8} << 20;
  const std::size_t stacks = kStackBytes * std::max(1U, std::thread::hardware_concurrency());
  rlimit limit{};
  if (::getrlimit(RLIMIT_DATA, &limit) == 0) {
    limit.rlim_cur = std::min<rlim_t>(data_bytes() + stacks + bytes, limit.rlim_max);
    (void)::setrlimit(RLIMIT_DATA, &limit);
  }
  memory_limit = bytes;
}

}  // namespace

Setting& add_size_setting(Settings& settings, std::string name, std::optional<std::size_t>& field,
                          std::string help) {
  Setting& setting = settings.add(std::move(name), "SIZE", std::move(help));
  setting.set = [&field](const SettingValue& value) {
    if (value == kNoLimit) {
      field.reset();
    } else {
      field = to_bytes(value);
    }
  };
  setting.get = [&field]() -> SettingValue {
    return field ? SettingValue(bytes_text(*field)) : SettingValue(kNoLimit);
  };
  return setting;
}

void add_pixel_limit_setting(Settings& settings) {
  Setting& setting = settings.add(
      "max-pixels", "N", "Maximum number of pixels of input images, 1 to 268435456 (2^28)");
  setting.set = [](const SettingValue& value) {
    const int pixels = to_integer(value);
    if (pixels < 1 || pixels > kMaxImagePixels) {
      reject_value(value, fmt::format("a whole number from 1 to {}", kMaxImagePixels));
    }
    set_max_image_pixels(pixels);
  };
  setting.get = [] { return max_image_pixels(); };
}

void add_input_limit_settings(Settings& settings, ExecutionOptions& execution) {
  settings.start_group("Limits", false);
  add_pixel_limit_setting(settings);
  Setting& memory = add_size_setting(settings, "memory", memory_limit,
                                     "Memory limit for images and results, such as 800M or 4G; the "
                                     "command fails beyond it. 8 MiB per processor are free, for "
                                     "stacks: small inputs fit any limit. auto: no limit");
  const auto set_field = std::move(memory.set);
  memory.set = [&execution, set_field](const SettingValue& value) {
    set_field(value);
    if (memory_limit) {
      limit_memory(*memory_limit);
      constexpr std::size_t kUsualChainBytes = std::size_t{1} << 30;
      execution.chain_memory_bytes = std::min(kUsualChainBytes, *memory_limit / 2);
      execution.level_memory_bytes = std::min(kDefaultLevelBytes, *memory_limit / 4);
    }
  };
}

std::string memory_problem(const std::bad_alloc& error) {
  const bool is_known = dynamic_cast<const OutOfMemory*>(&error) != nullptr;
  std::string text = is_known ? error.what() : "out of memory";
  if (memory_limit) {
    return text +
           fmt::format(", expected to need no more than --memory {}", bytes_text(*memory_limit));
  }
  rusage usage{};
  (void)::getrusage(RUSAGE_SELF, &usage);
  return text + fmt::format(", {} MiB are in use", usage.ru_maxrss / 1024);
}

}  // namespace vantage::apps
