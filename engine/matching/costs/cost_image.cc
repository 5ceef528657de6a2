#include "engine/matching/costs/cost_image.h"

#include "engine/matching/costs/cost_planes.h"
#include "engine/matching/costs/cost_table.h"

namespace vantage {

CostImage::CostImage() = default;
CostImage::CostImage(CostImage&&) noexcept = default;
CostImage& CostImage::operator=(CostImage&&) noexcept = default;
CostImage::~CostImage() = default;

void CostImage::set_up(const Photograph& photograph, const MethodParameters& parameters,
                       int phases) {
  if (cost_ != parameters.cost) {
    planes_ = cost_of(parameters).make_planes();
    cost_ = parameters.cost;
  }
  width_ = photograph.width();
  height_ = photograph.height();
  channels_ = parameters.colour == ColourUse::kChannels && photograph.channels() >= 3 ? 3 : 1;
  phases_ = phases;
}

void CostImage::prepare(const Photograph& photograph, const MethodParameters& parameters,
                        const kernels::CandidateGeometry& geometry, CostImageUse use,
                        Execution& execution) {
  const bool is_partner = use.as_partner_of_left || use.as_partner_of_right;
  set_up(photograph, parameters, is_partner ? use.phases : 1);
  // Whole columns last: those are what the image is as a reference.
  for (int phase = phases_ - 1; phase >= 0; --phase) {
    prepare_phase({photograph, phase}, parameters, geometry, use, execution);
  }
}

void CostImage::prepare_samples(std::span<const Photograph> at_phases,
                                const MethodParameters& parameters,
                                const kernels::CandidateGeometry& geometry, CostImageUse use,
                                Execution& execution) {
  set_up(at_phases.front(), parameters, static_cast<int>(at_phases.size()));
  for (int phase = phases_ - 1; phase >= 0; --phase) {
    prepare_phase({at_phases[static_cast<std::size_t>(phase)], phase, true}, parameters, geometry,
                  use, execution);
  }
}

void CostImage::prepare_phase(const Phase& phase, const MethodParameters& parameters,
                              const kernels::CandidateGeometry& geometry, const CostImageUse& use,
                              Execution& execution) {
  planes_->prepare({phase.photograph,
                    channels_,
                    margins_of(geometry),
                    use.as_partner_of_left,
                    use.as_partner_of_right,
                    {phase.index, phases_},
                    execution,
                    phase.is_sampled},
                   parameters);
}

std::size_t CostImage::held_bytes() const { return planes_ ? planes_->held_bytes() : 0; }

}  // namespace vantage
