#pragma once

#include <string_view>

#include "engine/evaluation/disparity_evaluation.h"

namespace vantage::apps {

/// A score of a map: on stdout, in tables and reports.
struct ScoreColumn {
  std::string_view label;
  std::string_view key;
  double DisparityScores::*value;
  std::string_view unit;

  [[nodiscard]] bool is_share() const { return unit == "%"; }
};

inline constexpr ScoreColumn kScoreColumns[] = {
    {"coverage", "coverage_percent", &DisparityScores::coverage_percent, "%"},
    {"bad 0.5", "bad_0_5_percent", &DisparityScores::bad_0_5_percent, "%"},
    {"bad 1", "bad_1_percent", &DisparityScores::bad_1_percent, "%"},
    {"bad 2", "bad_2_percent", &DisparityScores::bad_2_percent, "%"},
    {"bad 3", "bad_3_percent", &DisparityScores::bad_3_percent, "%"},
    {"bad 4", "bad_4_percent", &DisparityScores::bad_4_percent, "%"},
    {"D1", "d1_percent", &DisparityScores::d1_percent, "%"},
    {"average", "average_px", &DisparityScores::average_px, "px"},
    {"RMS", "rms_px", &DisparityScores::rms_px, "px"},
    {"A50", "a50_px", &DisparityScores::a50_px, "px"},
    {"A90", "a90_px", &DisparityScores::a90_px, "px"},
    {"A95", "a95_px", &DisparityScores::a95_px, "px"},
    {"A99", "a99_px", &DisparityScores::a99_px, "px"}};

}  // namespace vantage::apps
