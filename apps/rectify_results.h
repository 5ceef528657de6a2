#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/setting_value.h"
#include "engine/rectification/rectified_pair.h"
#include "engine/rectification/rig_validation.h"
#include "engine/rectification/uncalibrated_rig.h"
#include "engine/rectification/vertical_error.h"

namespace vantage::apps {

/// Inputs and results of a rectification.
struct Rectification {
  StereoCalibration calibration;
  std::optional<UncalibratedRig> estimate;  ///< without a calibration file
  std::vector<PointMatch> matches = {};     ///< in the photographs, that the estimate is made from
  std::optional<VerticalError> remaining;
  std::optional<RigValidation> validation;  ///< of the estimate
};

/// The entry `results` of the report of 'rectify'.
SettingValue results_of(const Rectification& rectification, const RectifiedPair& pair,
                        int pair_count);

/// Prints the results to stderr. `calibration` is the path to the file; empty: none.
void print_results(const Rectification& rectification, const RectifiedPair& pair, int pair_count,
                   const std::string& calibration);

}  // namespace vantage::apps
