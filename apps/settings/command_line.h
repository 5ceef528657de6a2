#pragma once

#include <string>
#include <vector>

#include "engine/options/settings.h"

namespace vantage::apps {

/// Reads the command line, and the file of --config before it. Returns false if nothing is left to
/// do, because --help, --help-all, --help-json or --print-config has been printed. Throws
/// UsageError, and Error if the file of --config cannot be read.
[[nodiscard]] bool read_command_line(Settings& settings, const std::vector<std::string>& arguments);

/// All settings as --print-config writes them; `auto` is followed by a comment that says what it
/// means.
[[nodiscard]] std::string to_toml(const Settings& settings);

}  // namespace vantage::apps
