#include "perf/quality/map_contender.h"

#include <fmt/format.h>

#include <utility>

#include "apps/settings/toml_file.h"
#include "engine/error.h"
#include "engine/options/match_settings.h"
#include "engine/options/settings.h"

namespace vantage::perf {
namespace {

class OurMaps : public MapMaker {
 public:
  OurMaps(const MatchOptions& options, const ScenePair& pair, Execution& execution)
      : pair_(pair), matcher_(in_range(options, pair.range), execution) {}
  void match(TimedMaps which) override {
    const bool both = which == TimedMaps::kBoth;
    matcher_.match(pair_.left, pair_.right, {.left = true, .right = both},
                   both ? maps_ : left_only_);
  }
  const DisparityMaps& maps() override { return maps_; }

 private:
  static MatchOptions in_range(MatchOptions options, DisparityRange range) {
    options.disparities = range;
    return options;
  }

  const ScenePair& pair_;
  StereoMatcher matcher_;
  DisparityMaps maps_;
  DisparityMaps left_only_;
};

class SgbmMaps : public MapMaker {
 public:
  SgbmMaps(const SgbmSetting& setting, const ScenePair& pair, Execution& execution)
      : setting_(setting),
        pair_(pair),
        execution_(execution),
        matcher_(make_sgbm_matcher(setting, pair)) {}
  void match(TimedMaps which) override {
    cv::setNumThreads(execution_.executor().thread_count());
    const cv::Mat& left = pair_.left_opencv;
    const cv::Mat& right = pair_.right_opencv;
    if (which == TimedMaps::kBoth) {
      disparities_ = both_disparities(*matcher_, left, right, pair_.range);
      filter_opencv_speckles(setting_.post_processing, pair_.range, disparities_.left);
      filter_opencv_speckles(setting_.post_processing, pair_.range, disparities_.right);
    } else {
      cv::Mat disparities = left_disparities(*matcher_, left, right, pair_.range);
      filter_opencv_speckles(setting_.post_processing, pair_.range, disparities);
    }
    cv::setNumThreads(1);
  }
  const DisparityMaps& maps() override {
    refine_peer_maps(setting_.post_processing, pair_, disparities_, execution_, maps_);
    return maps_;
  }

 private:
  SgbmSetting setting_;
  const ScenePair& pair_;
  Execution& execution_;
  cv::Ptr<cv::StereoSGBM> matcher_;
  PeerDisparities disparities_;
  DisparityMaps maps_;
};

/// Removes `note` from the entry and returns it.
std::string take_note(SettingValue& entry) {
  const auto note = entry.find("note");
  if (note == entry.end()) {
    return "";
  }
  std::string text = vantage::to_text(*note);
  entry.erase(note);
  return text;
}

MapContender experiment(const std::string& name, SettingValue entry) {
  if (!entry.is_object()) {
    reject_value(entry, "a table of settings");
  }
  std::string note = take_note(entry);
  MatchOptions options;
  Settings settings;
  add_match_settings(settings, options);
  settings.set_values(entry);
  options.validate();
  return {name, std::move(note), false, [options](const ScenePair& pair, Execution& execution) {
            return std::make_unique<OurMaps>(options, pair, execution);
          }};
}

}  // namespace

MapContender sgbm_contender(const SgbmSetting& setting) {
  return {setting.name, "StereoSGBM, " + to_text(setting.post_processing), true,
          [setting](const ScenePair& pair, Execution& execution) {
            return std::make_unique<SgbmMaps>(setting, pair, execution);
          }};
}

std::vector<MapContender> experiments(const std::filesystem::path& file) {
  std::vector<MapContender> contenders;
  const SettingValue entries = apps::read_toml_document(file.string());
  for (const auto& [name, entry] : entries.items()) {
    try {
      contenders.push_back(experiment(name, entry));
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("{}: {}: {}", file.string(), name, error.what()));
    }
  }
  return contenders;
}

}  // namespace vantage::perf
