#include "engine/matching/options/method_fields.h"

#include <fmt/format.h>

#include "engine/error.h"
#include "engine/matching/options/method_names.h"
#include "kernels/census/census.h"

namespace vantage {

static_assert(visits_every_field<MethodParameters>(), "visit_fields() lacks a field");
static_assert(kernels::kMaxRayCensusThresholds == 3, "so say the limits of census-thresholds");

void require_read(const MethodOverrides& overrides, const MethodParameters& in_force,
                  std::string_view chosen) {
  visit_fields(
      [&](const MethodField& field, const auto& value) {
        if (value && !field.is_read(in_force)) {
          throw UsageError(fmt::format("{} is set but has no effect with {} ({}); it is read by {}",
                                       field.option, chosen, summary_of(in_force),
                                       names_of(field.readers, field.option)));
        }
      },
      overrides);
}

}  // namespace vantage
