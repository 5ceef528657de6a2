#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/matching/costs/cost_planes.h"
#include "engine/matching/costs/partner_rows.h"
#include "kernels/ray_census/ray_census.h"

namespace vantage {

/// Bytes of ray census codes; ray_census_bytes(thresholds) planes are used.
class RayCensusPlanes final : public CostPlanes {
 public:
  ChannelPlanes<std::uint8_t, kernels::kMaxRayCensusBytes> codes;

  void prepare(const PlaneSource& source, const MethodParameters& parameters) override;
  [[nodiscard]] std::size_t held_bytes() const override {
    return held_bytes_of(codes) + held_bytes_of(intensities_) + bytes_.held_bytes();
  }

 private:
  void prepare_codes(const PlaneSource& source, int thresholds);
  void prepare_byte_codes(const PlaneSource& source, const Image<std::uint8_t>& image);

  FilterIntensities intensities_;
  IntensityPlane<std::uint8_t> bytes_;  ///< intensities of 8-bit grey images
};

/// thresholds: those the images were prepared with. `memory`: as for PartnerRows::pairs().
inline kernels::RayCensusPairs ray_codes(const PartnerRows& partner, int y,
                                         scheduler::Range columns, GatherMemory* memory,
                                         int thresholds) {
  return {partner.pairs(y, columns, memory, &RayCensusPlanes::codes,
                        static_cast<std::size_t>(kernels::ray_census_bytes(thresholds))),
          thresholds};
}

}  // namespace vantage
