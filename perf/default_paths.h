#pragma once

namespace vantage::perf {

/// What programs read unless they are told otherwise, for whoever starts them in the folder of the
/// checkout. Relative, so that objects are the same in every folder.
inline constexpr const char* kDefaultData = "../shared/data";
inline constexpr const char* kDefaultExperiments = "perf/experiments.toml";

}  // namespace vantage::perf
