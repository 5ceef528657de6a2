#pragma once

#include <cstddef>
#include <new>
#include <optional>
#include <string>

#include "apps/settings.h"
#include "engine/execution.h"

namespace vantage::apps {

/// A size in bytes such as 800M or 4G; the field is empty for "auto".
Setting& add_size_setting(Settings& settings, std::string name, std::optional<std::size_t>& field,
                          std::string help);

/// --max-pixels: what this process accepts as an image.
void add_pixel_limit_setting(Settings& settings);

/// --max-pixels and --memory. The latter holds for the whole process from the moment it is read:
/// what it asks for beyond fails. Work that can do with less is planned for half of it.
void add_input_limit_settings(Settings& settings, ExecutionOptions& execution);

/// What to say when memory did not suffice.
std::string memory_problem(const std::bad_alloc& error);

}  // namespace vantage::apps
