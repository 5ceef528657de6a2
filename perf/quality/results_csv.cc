#include <fmt/format.h>

#include <fstream>
#include <limits>

#include "engine/error.h"
#include "perf/quality/results.h"

namespace vantage::perf {

void write_csv(const Results& results, const std::string& file) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  std::ofstream csv(file);
  csv << "contender,scene,group,tuning,visible_bad_0.5,visible_bad_1,visible_bad_2,all_bad_0.5,"
         "all_bad_1,all_bad_2,hidden_bad_0.5,hidden_bad_1,hidden_bad_2,visible_unmatched_bad_0.5,"
         "visible_unmatched_bad_1,visible_unmatched_bad_2,near_edges_bad_0.5,near_edges_bad_1,"
         "near_edges_bad_2,d1,median_error_px,wall_ms,processor_ms\n";
  for (std::size_t i = 0; i < results.contenders.size(); ++i) {
    for (std::size_t j = 0; j < results.scenes.size(); ++j) {
      const TrueScene& scene = *results.scenes[j];
      const Outcome& outcome = results.outcomes[i][j];
      csv << fmt::format("{},{},{},{}", results.contenders[i].name, scene.name, scene.group,
                         scene.is_tuning ? 1 : 0);
      for (const BadPercent& bad :
           {outcome.bad.visible, outcome.bad.all, outcome.bad.hidden, outcome.bad.visible_unmatched,
            outcome.bad.near_discontinuity}) {
        csv << fmt::format(",{:.4f},{:.4f},{:.4f}", bad[0], bad[1], bad[2]);
      }
      csv << fmt::format(",{:.4f},{:.4f}", outcome.bad.d1, outcome.bad.median_error_px);
      const FrameTime time = outcome.time.value_or(FrameTime{kNan, kNan});
      csv << fmt::format(",{:.3f},{:.3f}\n", time.wall * 1e3, time.processor * 1e3);
    }
  }
  if (!csv.flush()) {
    throw Error(fmt::format("{}: cannot be written", file));
  }
}

}  // namespace vantage::perf
