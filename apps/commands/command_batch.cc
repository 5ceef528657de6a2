#include "apps/batch/batch_run.h"
#include "apps/batch/batch_settings.h"
#include "apps/commands/commands.h"
#include "apps/settings/command_line.h"

namespace vantage::apps {

int command_batch(const Arguments& arguments) {
  BatchJob job;
  Settings settings("batch",
                    "Disparity maps and new views of many films and pairs, by any number "
                    "of workers.");
  add_batch_settings(settings, job);
  return read_command_line(settings, arguments) ? run_batch(job, settings) : kExitDone;
}

}  // namespace vantage::apps
