#include "engine/matching/volume/stage_volume.h"

#include <cstddef>
#include <string_view>
#include <utility>

#include "kernels/cells/fixed_energy.h"

namespace vantage {
namespace {

using kernels::FixedEnergy;
using scheduler::Extent;
using scheduler::Range;

/// Common base.
class VolumeStage : public scheduler::RowStage {
 public:
  VolumeStage(Extent extent, int lanes, const VolumeWriter& writer)
      : RowStage(extent), lanes_(lanes), writer_(writer) {}

  [[nodiscard]] std::string_view name() const override { return "volume"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  [[nodiscard]] std::size_t state_bytes(Range /*columns*/, Extent /*input*/) const override {
    return sizeof(float) * writer_.work_floats();
  }

 protected:
  [[nodiscard]] const VolumeWriter& writer() const { return writer_; }
  [[nodiscard]] static float* work(const scheduler::RowTask& task) {
    return reinterpret_cast<float*>(task.state);
  }
  template <typename Cell>
  [[nodiscard]] VolumeWriter::Columns<Cell> columns(const scheduler::RowTask& task,
                                                    Range of_task) const {
    return {
        .cells = task.input.row<Cell>(task.y) +
                 static_cast<std::ptrdiff_t>(of_task.begin - task.input.columns().begin) * lanes_,
        .pitch = lanes_,
        .x = of_task.begin,
        .y = task.y,
        .count = of_task.size()};
  }

 private:
  int lanes_;
  const VolumeWriter& writer_;
};

class ValueVolumeStage final : public VolumeStage {
 public:
  using VolumeStage::VolumeStage;

  void make_row(const scheduler::RowTask& task) const override {
    writer().write_values(columns<float>(task, task.columns), work(task));
  }
};

class LikelihoodVolumeStage final : public VolumeStage {
 public:
  using VolumeStage::VolumeStage;

  void make_row(const scheduler::RowTask& task) const override {
    writer().write_likelihoods(columns<float>(task, task.columns), work(task));
  }
};

class FixedEnergyVolumeStage final : public VolumeStage {
 public:
  FixedEnergyVolumeStage(Extent extent, int lanes, float steps_per_nat,
                         const CandidateBlocks* blocks, const VolumeWriter& writer)
      : VolumeStage(extent, blocks == nullptr ? lanes : blocks->lanes(), writer),
        values_(writer.shape().content, steps_per_nat),
        blocks_(blocks) {}

  void make_row(const scheduler::RowTask& task) const override {
    for (int x = task.columns.begin; x < task.columns.end;) {
      CandidateBlocks::Run run{{x, task.columns.end}, {}};
      if (blocks_ != nullptr) {
        run = blocks_->run_at(x, task.y, task.columns.end);
      }
      auto of_run = columns<FixedEnergy>(task, run.columns);
      of_run.blocks = run.blocks;
      writer().write_fixed_energies(of_run, values_, work(task));
      x = run.columns.end;
    }
  }

 private:
  FixedEnergyValues values_;
  const CandidateBlocks* blocks_;
};

class StageBesideVolume final : public scheduler::RowStage {
 public:
  StageBesideVolume(std::unique_ptr<scheduler::RowStage> last,
                    std::unique_ptr<scheduler::RowStage> volume)
      : RowStage(last->extent()), last_(std::move(last)), volume_(std::move(volume)) {}

  [[nodiscard]] std::string_view name() const override { return last_->name(); }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  [[nodiscard]] bool needs_whole_rows() const override { return last_->needs_whole_rows(); }
  [[nodiscard]] Range input_columns(Range columns, Extent input) const override {
    return last_->input_columns(columns, input);
  }
  [[nodiscard]] std::size_t state_bytes(Range columns, Extent input) const override {
    return of_volume() + last_->state_bytes(columns, input);
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override { return last_->column_work(); }

  void make_row(const scheduler::RowTask& task) const override {
    volume_->make_row(task);
    scheduler::RowTask of_last = task;
    of_last.state += of_volume();
    last_->make_row(of_last);
  }

 private:
  /// Bytes of its state, in multiples of the alignment; the same for all columns.
  [[nodiscard]] std::size_t of_volume() const {
    constexpr std::size_t kAlignment = 64;
    return (volume_->state_bytes({}, {}) + kAlignment - 1) / kAlignment * kAlignment;
  }

  std::unique_ptr<scheduler::RowStage> last_;
  std::unique_ptr<scheduler::RowStage> volume_;
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_value_volume_stage(
    const kernels::CandidateGeometry& geometry, int height, const VolumeWriter& writer) {
  return std::make_unique<ValueVolumeStage>(Extent{geometry.width, height}, geometry.lanes(),
                                            writer);
}

std::unique_ptr<scheduler::RowStage> make_likelihood_volume_stage(
    const kernels::CandidateGeometry& geometry, int height, const VolumeWriter& writer) {
  return std::make_unique<LikelihoodVolumeStage>(Extent{geometry.width, height}, geometry.lanes(),
                                                 writer);
}

std::unique_ptr<scheduler::RowStage> make_fixed_energy_volume_stage(
    const kernels::CandidateGeometry& geometry, int height, float steps_per_nat,
    const CandidateBlocks* blocks, const VolumeWriter& writer) {
  return std::make_unique<FixedEnergyVolumeStage>(Extent{geometry.width, height}, geometry.lanes(),
                                                  steps_per_nat, blocks, writer);
}

std::unique_ptr<scheduler::RowStage> make_stage_beside_volume(
    std::unique_ptr<scheduler::RowStage> last, std::unique_ptr<scheduler::RowStage> volume) {
  return std::make_unique<StageBesideVolume>(std::move(last), std::move(volume));
}

}  // namespace vantage
