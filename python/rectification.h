#pragma once

#include "engine/vantage.h"

namespace vantage::python {

/// Calibration of the rectified images of `cameras`.
StereoCalibration rectified_calibration(const RectifiedPair& pair,
                                        const StereoCalibration& cameras);

}  // namespace vantage::python
