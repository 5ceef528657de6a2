#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/options/match_settings.h"
#include "engine/vantage.h"
#include "python/match_result.h"
#include "python/remark_warnings.h"
#include "python/unrectified_pairs.h"

namespace vantage::python {

/// Options of matching, and the threads to use.
struct MatchSetup {
  MatchOptions options = options_with_found_range();
  std::optional<double> white_level;  ///< see WhiteLevelSearch
  RowMode rows = RowMode::kAuto;
  Execution* execution = nullptr;
};

/// Takes all options of matching from keyword arguments. Throws UsageError.
MatchSetup match_setup(pybind11::dict keywords);

/// Arrays to match.
struct ImageArguments {
  pybind11::object left;
  pybind11::object right;
  pybind11::list more;            ///< of cameras on the same line
  std::vector<double> baselines;  ///< of all but the first; empty: a pair
  bool bgr = false;
  pybind11::object mask = pybind11::none();  ///< array, None: borders are found, "none"
  pybind11::object mask_right = pybind11::none();

  [[nodiscard]] MatchedImages images(std::optional<double> white_level) const;
};

/// Matcher of the package.
class Matcher {
 public:
  /// `unrectified`: cameras of photographs that are not rectified; `on_rectified`: whose maps are
  /// on the pixels of the rectified images.
  Matcher(const std::optional<StereoCalibration>& unrectified, bool on_rectified,
          const pybind11::dict& keywords);

  [[nodiscard]] std::unique_ptr<MatchResult> compute(const ImageArguments& arguments,
                                                     Wanted wanted) const;
  /// (values, VolumeShape as a tuple): see volumes.cc.
  [[nodiscard]] pybind11::tuple volume(const ImageArguments& arguments,
                                       const pybind11::dict& keywords) const;
  /// Option → value.
  [[nodiscard]] pybind11::dict options();
  [[nodiscard]] std::string text() const;
  [[nodiscard]] int threads() const { return setup_.execution->executor().thread_count(); }

 private:
  void check(const ImageArguments& arguments) const;
  void check_unrectified(const ImageArguments& arguments, Wanted wanted) const;

  MatchSetup setup_;
  PairMatcher matcher_;
  std::shared_ptr<const UnrectifiedPairs> unrectified_;  ///< null: pairs are rectified
  std::shared_ptr<SpareMaps> spare_ = std::make_shared<SpareMaps>();
  mutable RemarkWarnings warnings_;
  std::optional<std::string> pair_option_;  ///< an option that is given, for pairs only
};

}  // namespace vantage::python
