#include "engine/simd.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "engine/error.h"
#include "engine/quoted_text.h"
#include "kernels/simd_target.h"

namespace vantage {
namespace {

template <typename Visit>
void for_each_target(long long targets, const Visit& visit) {
  for (int bit = 0; bit < 63; ++bit) {  // Highway gives better targets lower bits
    if (const long long target = 1LL << bit; (targets & target) != 0) {
      visit(target);
    }
  }
}

bool same_name(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  });
}

std::vector<std::string> names_of(long long targets) {
  std::vector<std::string> names;
  for_each_target(targets,
                  [&](long long target) { names.emplace_back(kernels::target_name(target)); });
  return names;
}

}  // namespace

std::vector<std::string> built_instruction_sets() { return names_of(kernels::built_targets()); }

std::vector<std::string> available_instruction_sets() {
  return names_of(kernels::available_targets());
}

void force_instruction_set(const std::string& name) {
  if (kernels::available_targets() == 0) {
    throw Error(
        fmt::format("this processor has no instruction set that this build needs, expected {}",
                    built_instruction_sets().back()));
  }
  long long chosen = 0;
  for_each_target(kernels::available_targets(), [&](long long target) {
    if (same_name(kernels::target_name(target), name)) {
      chosen = target;
    }
  });
  if (chosen == 0 && !same_name(name, "best")) {
    throw UsageError(fmt::format("isa is '{}', expected one of: best, {}", quotable(name),
                                 fmt::join(available_instruction_sets(), ", ")));
  }
  kernels::force_target(chosen);
}

std::string instruction_set_in_use() {
  return std::string(kernels::target_name(kernels::target_in_use()));
}

}  // namespace vantage
