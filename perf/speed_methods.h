#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/matching/options/match_options.h"

namespace vantage::perf {

/// A matching method whose speed is measured.
struct SpeedMethod {
  std::string name;
  MatchOptions options;  ///< one map, winner only, disparities from 0
};

/// All methods with their usual parameters and ten iterations (if iterative), filtered by names
/// that contain `only`.
inline std::vector<SpeedMethod> speed_methods(int disparities, const std::string& only = {}) {
  constexpr int kIterations = 10;
  std::vector<SpeedMethod> methods;
  const auto add = [&](std::string name, MatchMethod method) -> MethodOverrides& {
    MatchOptions options;
    options.method = method;
    options.disparities = {0, disparities - 1};
    options.raw = true;
    options.parameters.subpixel = Subpixel::kNone;
    if (method != MatchMethod::kSsd && method != MatchMethod::kGradient) {
      options.parameters.iterations = kIterations;
    }
    methods.push_back({std::move(name), options});
    return methods.back().options.parameters;
  };
  add("ssd", MatchMethod::kSsd);
  add("census, box", MatchMethod::kSsd).cost = MatchCost::kCensus;
  add("gradient", MatchMethod::kGradient);
  add("diffusion", MatchMethod::kDiffusion);
  add("membrane", MatchMethod::kMembrane);
  add("local stopping, margin", MatchMethod::kLocalStopping);
  add("local stopping, entropy", MatchMethod::kLocalStopping).certainty = Certainty::kEntropy;
  add("bayes", MatchMethod::kBayes);
  add("bayes, mu 0.45", MatchMethod::kBayes).mu = 0.45;
  std::erase_if(methods, [&](const SpeedMethod& method) {
    return method.name.find(only) == std::string::npos;
  });
  return methods;
}

}  // namespace vantage::perf
