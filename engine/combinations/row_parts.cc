#include <fmt/format.h>

#include <string>

#include "engine/combinations/combination_rows.h"

namespace vantage {

void add_idle(std::vector<Combination>& rows, CombinationScope scope, OptionNames options,
              const std::vector<Condition>& only_with, std::string_view why) {
  for (const std::string_view option : options) {
    rows.push_back({.scope = scope,
                    .option = set(option),
                    .only_with = only_with,
                    .reason = "no effect",
                    .message = fmt::format("--{} has no effect {}", option, why)});
  }
}

void add_idle_with(std::vector<Combination>& rows, CombinationScope scope, OptionNames options,
                   const Condition& with, std::string_view why) {
  for (const std::string_view option : options) {
    rows.push_back({.scope = scope,
                    .option = set(option),
                    .with = {with},
                    .reason = "no effect",
                    .message = fmt::format("--{} has no effect {}", option, why)});
  }
}

void add_refused(std::vector<Combination>& rows, CombinationScope scope, const Condition& option,
                 const std::vector<Condition>& with, std::string_view reason,
                 std::string_view message) {
  rows.push_back({.scope = scope,
                  .option = option,
                  .with = with,
                  .reason = reason,
                  .message = std::string(message)});
}

void add_several(std::vector<Combination>& rows, CombinationScope scope) {
  for (const Condition& several : {given("baselines"), given("more")}) {
    add_idle_with(rows, scope, {"cross-check-level"}, several,
                  "with several images: they are checked against whole maps");
    add_idle_with(rows, scope, {"search-size", "window-levels"}, several,
                  "with several images: all candidates are searched at full size");
    add_idle_with(rows, scope, {"tuning"}, several, "with several images: tuning is for pairs");
  }
}

void add_idle_unrectified(std::vector<Combination>& rows, CombinationScope scope) {
  add_idle(rows, scope, {"rectified-pixels"}, {given("unrectified")}, "without --unrectified");
  add_idle_with(rows, scope, {"cross-check-level"}, given("unrectified"),
                "with --unrectified: whole maps are compared");
}

}  // namespace vantage
