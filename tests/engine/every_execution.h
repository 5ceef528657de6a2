#pragma once

#include "engine/execution.h"
#include "engine/simd.h"
#include "tests/engine/engine_test.h"

namespace vantage {
inline namespace test {

/// Of all channels; unknown values have one place.
template <typename T>
std::vector<double> values_of(const Image<T>& image) {
  std::vector<double> values;
  for (const auto [i, y] : positions_of(image.width() * image.channels(), image.height())) {
    const auto value = static_cast<double>(image.row(y)[i]);
    values.push_back(std::isnan(value) ? std::numeric_limits<double>::lowest() : value);
  }
  return values;
}
inline std::vector<double> values_of(const Photograph& photograph) {
  return std::visit([](const auto& image) { return values_of(image); }, photograph.pixels);
}

/// What make(Execution&) returns for executors and numbers of threads, and for instruction sets:
/// expects it to be equal to that of one thread.
template <typename Make>
void expect_equal_for_every_execution(const Make& make) {
  Execution serial({.threads = 1, .executor = scheduler::ExecutorKind::kSerial});
  const auto expected = make(serial);
  for (const auto kind : {scheduler::ExecutorKind::kTbb, scheduler::ExecutorKind::kOpenMp}) {
    for (const int threads : {1, 2, 7}) {
      Execution execution({.threads = threads, .executor = kind});
      EXPECT_TRUE(make(execution) == expected) << threads << " threads";
    }
  }
  for (const std::string& name : available_instruction_sets()) {
    force_instruction_set(name);
    EXPECT_TRUE(make(serial) == expected) << name;
  }
  force_instruction_set("best");
}

}  // namespace test
}  // namespace vantage
