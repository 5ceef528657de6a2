#include "apps/reports/remarks.h"

#include "apps/process/tell.h"
#include "engine/thread_placement.h"

namespace vantage::apps {

void tell_remarks(std::span<const Remark> remarks, const CommonOptions& common, RunReport& report) {
  for (const Remark& remark : remarks) {
    report.add_remark(remark);
    if (!common.quiet) {
      tell("{}: {}{}\n", report.command(), remark.is_warning() ? "warning: " : "",
           with_dashes(remark.text));
    }
  }
}

void tell_threads(const Execution& execution, const CommonOptions& common, RunReport& report) {
  tell_remarks(thread_remarks(execution.options(), execution.machine()), common, report);
}

void tell_match(const MatchReport& match, const CommonOptions& common, RunReport& report) {
  report.add_match(match);
  if (match.shares) {
    report.add_result("map", map_values(*match.shares));
  }
  tell_remarks(match.remarks, common, report);
}

void tell_shares(const MatchReport& match, const CommonOptions& common, const RunReport& report) {
  if (match.shares && !common.quiet) {
    tell("{}: {}\n", report.command(), to_text(*match.shares));
  }
}

SettingValue noise_values(const FoundNoise& noise) {
  switch (noise.kind) {
    case NoiseKind::kNone:
      break;
    case NoiseKind::kSensor:
      return {{"kind", "sensor"}, {"grey_levels", noise.grey_levels}};
    case NoiseKind::kCodec:
      return {{"kind", "codec"}, {"block_score", noise.block_score}};
  }
  return nullptr;
}

SettingValue map_values(const MapShares& shares) {
  return {{"matched_share", shares.matched},
          {"filled_share", shares.filled},
          {"unknown_share", shares.unknown},
          {"expected_share_within_1_px", shares.reliable}};
}

}  // namespace vantage::apps
