#pragma once

#include <string_view>

namespace vantage {

enum class ComfortVerdict { kSafe, kBorderline, kUnsafe };

std::string_view name_of(ComfortVerdict verdict);

/// From which values on a shot is borderline, and unsafe.
struct ComfortLimit {
  double borderline = 0;
  double unsafe = 0;

  [[nodiscard]] ComfortVerdict of(double value) const {
    return value > unsafe       ? ComfortVerdict::kUnsafe
           : value > borderline ? ComfortVerdict::kBorderline
                                : ComfortVerdict::kSafe;
  }
};

/// The limits of the report; kComfortSources says where they are from.
struct ComfortLimits {
  ComfortLimit crossed = {1.0, 2.5};       ///< in front of the screen, % of the width
  ComfortLimit uncrossed = {2.0, 4.0};     ///< behind the screen, % of the width
  ComfortLimit depth_budget = {3.0, 6.5};  ///< nearest to farthest, % of the width
  ComfortLimit border = {5.0, 20.0};       ///< rows with something cut at a side, % of the height
  ComfortLimit jump = {1.0, 2.0};          ///< of the median at a cut, % of the width
  ComfortLimit vertical = {0.1, 0.3};      ///< % of the height
  ComfortLimit colour = {5.0, 13.0};       ///< mean difference of a channel, levels of 255
};

/// Where the limits come from, one paragraph each, for people.
inline constexpr std::string_view kComfortSources[] = {
    "Crossed, uncrossed and depth budget: BSkyB Technical Guidelines for Plano Stereoscopic (3D) "
    "Programme Content (2010-2011): 1 % of the width in front of and 2 % behind the screen, 3 % "
    "together; short excursions to 2.5 % and 4 %. Safe is the first, unsafe is what exceeds the "
    "excursions. They are meant for screens of 46 to 70 inches (1.2 to 1.8 m).",
    "The rule of one degree says about the same: seen from three picture heights, a 16:9 screen is "
    "33 degrees wide, so one degree is 3 % of the width. Comfort depends on the distance and on "
    "the sign: T. Shibata, J. Kim, D. M. Hoffman, M. S. Banks, The zone of comfort, Journal of "
    "Vision 11(8):11, 2011.",
    "Cut objects at the left and right border (window violations), jumps of depth at cuts: the "
    "defects are described by S. Delis, I. Mademlis, N. Nikolaidis, I. Pitas, Automatic detection "
    "of 3D quality defects in stereoscopic videos using binocular disparity, IEEE Transactions on "
    "Circuits and Systems for Video Technology, 2017. The limits are ours.",
    "Vertical error, exchanged images, colour difference: the defects are described by D. Vatolin, "
    "A. Bokov, M. Erofeev, V. Napadovsky, Trends in S3D-movie quality evaluated on 105 films using "
    "10 metrics, Electronic Imaging, 2016. The limits are ours: 0.1 % of the height is one line of "
    "1080, about one minute of arc from three picture heights; a shot is exchanged if hidden "
    "pixels belong to the wrong side in more than two thirds of at least 100 places."};

}  // namespace vantage
