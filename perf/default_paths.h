#pragma once

namespace vantage::perf {

/// Default inputs of the programs, for calls from the root folder of the checkout. Relative, so
/// that objects are the same in every folder.
inline constexpr const char* kDefaultData = "../shared/data";
inline constexpr const char* kDefaultExperiments = "perf/experiments.toml";

}  // namespace vantage::perf
