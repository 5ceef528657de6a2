#pragma once

#include <span>

#include "apps/reports/run_report.h"
#include "apps/settings/common_options.h"
#include "engine/remark.h"

namespace vantage::apps {

/// Prints remarks of the engine on stderr, unless that is quiet, and adds them to the report.
void tell_remarks(std::span<const Remark> remarks, const CommonOptions& common, RunReport& report);

}  // namespace vantage::apps
