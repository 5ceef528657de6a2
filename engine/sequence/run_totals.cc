#include "engine/sequence/run_totals.h"

#include <algorithm>
#include <string>

namespace vantage {
namespace {

void add_range_check(SequenceReport& report, const FrameSlot& slot) {
  report.frames_maybe_cut += slot.may_be_cut ? 1 : 0;
  const auto share = [](const CutRange& cut) {
    return std::max(cut.below ? cut.share_below : 0, cut.above ? cut.share_above : 0);
  };
  if (slot.cut && slot.cut->any() && (!report.cut || share(*slot.cut) > share(*report.cut))) {
    report.cut = slot.cut;
    report.cut_frame = slot.frame;
  }
}

void add_match_remarks(SequenceReport& report, const FrameSlot& slot) {
  for (const Remark& remark : slot.match.remarks) {
    const auto known = std::ranges::find_if(report.match_remarks, [&](const MatchRemark& one) {
      return one.remark.kind == remark.kind && one.remark.subject == remark.subject;
    });
    if (known == report.match_remarks.end()) {
      report.match_remarks.push_back({remark, slot.frame, 1});
    } else {
      ++known->frames;
    }
  }
}

void add_stage(SequenceReport& report, std::string_view name, double seconds) {
  const auto known = std::ranges::find(report.stages, name, &SequenceStage::name);
  if (known != report.stages.end()) {
    known->seconds += seconds;
  } else {
    report.stages.push_back({std::string(name), seconds});
  }
}

}  // namespace

void add_frame(SequenceReport& report, const FrameSlot& slot) {
  ++(slot.stored != nullptr ? report.pictures_again : report.frames);
  report.width_px = slot.left->width();
  report.height_px = slot.left->height();
  report.cells += slot.match.cells;
  if (slot.match.cells > 0) {
    report.plan = slot.match.plan;
    if (slot.match.searched_share) {
      report.reuse.add(*slot.match.searched_share);
    }
    add_range_check(report, slot);
    add_match_remarks(report, slot);
    if (slot.match.shares) {
      report.map_shares.emplace(slot.frame, *slot.match.shares);
    }
  }
  for (const auto& times : {slot.match.stages, slot.times}) {
    for (const StageTime& stage : times) {
      add_stage(report, stage.name, stage.seconds);
    }
  }
}

MapShares mean_shares(const SequenceReport& sequence) {
  MapShares mean;
  const auto frames = static_cast<double>(sequence.map_shares.size());
  for (const auto& [frame, shares] : sequence.map_shares) {
    mean.matched += shares.matched / frames;
    mean.filled += shares.filled / frames;
    mean.unknown += shares.unknown / frames;
    mean.reliable += shares.reliable / frames;
  }
  return mean;
}

void add_processor_time(SequenceReport& report, const StepAccounts& accounts, double all_seconds,
                        double wall_seconds, int threads) {
  double other = all_seconds;
  for (const StepAccounts::Account& account : accounts.all()) {
    report.processor.push_back({std::string(account.name), account.time.seconds()});
    other -= account.time.seconds();
  }
  report.processor.push_back({"other", std::max(0.0, other)});
  report.share_busy = all_seconds / (wall_seconds * threads);
}

}  // namespace vantage
