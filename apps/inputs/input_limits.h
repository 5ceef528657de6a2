#pragma once

#include <cstddef>
#include <new>
#include <optional>
#include <string>

#include "engine/execution.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// A size in bytes such as 800M or 4G; the field is empty for "auto".
Setting& add_size_setting(Settings& settings, std::string name, std::optional<std::size_t>& field,
                          std::string help);

/// --max-pixels: the largest image that this process accepts.
void add_pixel_limit_setting(Settings& settings);

/// --max-pixels and --memory. The memory limit applies to the whole process once it is read:
/// allocations beyond it fail. Work with a flexible need is planned for half of it.
void add_input_limit_settings(Settings& settings, ExecutionOptions& execution);

/// The message for a failed allocation.
std::string memory_problem(const std::bad_alloc& error);

}  // namespace vantage::apps
