#include "apps/reports/remarks.h"

#include "apps/process/tell.h"

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

}  // namespace vantage::apps
