#include "engine/matching/options/method_fields.h"

#include <fmt/format.h>

#include "engine/error.h"
#include "engine/matching/options/method_names.h"
#include "kernels/census/census.h"

namespace vantage {

static_assert(visits_every_field<MethodParameters>(), "visit_fields() lacks a field");
static_assert(kernels::kMaxRayCensusThresholds == 3, "so say the limits of census-thresholds");

OptionValues values_of(const MethodParameters& in_force, const MethodOverrides& set) {
  OptionValues values;
  visit_fields(
      [&](const MethodField& field, const auto& value, const auto& chosen) {
        using Value = std::remove_cvref_t<decltype(value)>;
        if (field.readers.are_in_force == reads && !reads(in_force, field.option)) {
          return;
        }
        if constexpr (std::is_enum_v<Value>) {
          values.set(field.option, name_of(value), chosen.has_value());
        } else if constexpr (!std::is_same_v<Value, bool>) {  // no rule is about one
          values.set(field.option, value, chosen.has_value());
        }
      },
      in_force, set);
  return values;
}

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
