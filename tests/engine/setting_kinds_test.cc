#include "engine/error.h"
#include "engine/jobs/sequence_job.h"
#include "engine/options/execution_settings.h"
#include "engine/options/frame_step_setting.h"
#include "engine/options/match_settings.h"
#include "engine/options/metric_settings.h"
#include "engine/options/rig_scale.h"
#include "engine/options/synthesis_settings.h"
#include "engine/options/volume_output.h"
#include "engine/options/wanted_views.h"
#include "tests/engine/engine_test.h"

namespace vantage::setting_kinds_test {
namespace {

struct AllOptions {
  SequenceJob job;
  WantedViews views;
  VolumeOutput volume;
  CloudOptions cloud;
  std::optional<double> disparity_resolution_px;
  ExecutionOptions execution;
  Settings settings;

  AllOptions() {
    add_input_settings(settings, job);
    add_save_setting(settings, job);
    add_picture_settings(settings, job);
    add_poses_setting(settings, job);
    add_steadiness_settings(settings, job);
    add_chunk_frames_setting(settings, job);
    add_in_flight_setting(settings, job);
    add_live_setting(settings, job);
    add_frames_setting(settings, job.frames, job.step_of_frames);
    add_rig_scale_settings(settings, job.rig);
    add_match_settings(settings, job.sequence.match);
    add_synthesis_settings(settings, job.sequence.synthesis);
    add_wanted_views(settings, views);
    add_volume_settings(settings, volume);
    add_cloud_settings(settings, cloud);
    add_disparity_resolution_setting(settings, disparity_resolution_px);
    add_execution_settings(settings, execution);
  }
};

struct Values {
  std::vector<SettingValue> taken;  ///< by all settings of a kind; texts are as on the command line
  std::vector<SettingValue> refused;
};

const Values& values_of_kind(ValueKind kind) {
  using enum ValueKind;
  static const std::map<ValueKind, Values> values = {
      {kText, {{}, {3, true}}},
      {kWord, {{}, {"no-such-word", 3}}},
      {kTruth, {{true, "false"}, {"no-such-word", 3}}},
      {kInteger, {{3, "3"}, {3.5, "3.5", "no-such-word"}}},
      {kNumber, {{1, 0.5, "0.25"}, {"no-such-word", true}}},
      {kNumbers, {{0.5, "0.5,2", SettingValue::array({1, 2.5})}, {"no-such-word"}}},
      {kIntegerOrText, {{3, "3"}, {"0.5", true}}},
      {kNumberOrText, {{0.5, "0.25"}, {"no-such-word", true}}},
      {kRange, {{"-3:12"}, {"1,2", "1:2.5", "1", 1}}},
      {kPoint, {{"0.25,-3"}, {"1:2", "1,2,3", "1"}}},
      {kRectangle, {{"1,2,30,40"}, {"1,2", "1,2,3,4.5"}}},
      {kPoses, {{"poses.toml", SettingValue::array()}, {3, true}}}};
  return values.at(kind);
}

TEST(SettingKinds, SayWhatSettingsTake) {
  const AllOptions all;
  std::set<ValueKind> seen;
  for (const Setting& setting : all.settings.all()) {
    seen.insert(setting.kind);
    for (const SettingValue& value : values_of_kind(setting.kind).taken) {
      EXPECT_NO_THROW(setting.set(value)) << setting.name << ' ' << value;
    }
    for (const SettingValue& value : values_of_kind(setting.kind).refused) {
      EXPECT_THROW(setting.set(value), UsageError) << setting.name << ' ' << value;
    }
  }
  EXPECT_EQ(seen.size(), static_cast<std::size_t>(ValueKind::kPoses) + 1);
}

TEST(SettingKinds, HaveTheWordsThatSettingsTake) {
  const AllOptions all;
  for (const Setting& setting : all.settings.all()) {
    const SettingValue initial = setting.get();
    const bool is_word = setting.kind == ValueKind::kWord || setting.kind == ValueKind::kInteger ||
                         setting.kind == ValueKind::kNumber;
    if (initial.is_string() && is_word) {
      EXPECT_THAT(setting.words, Contains(initial.get<std::string>())) << setting.name;
    }
    for (const std::string& word : setting.words) {
      EXPECT_NO_THROW(setting.set(word)) << setting.name << ' ' << word;
    }
    // What --help names beside a placeholder in capitals.
    for (const std::string& part : split(setting.value_name, '|')) {
      const bool is_placeholder =
          std::ranges::any_of(part, [](unsigned char letter) { return std::isupper(letter) != 0; });
      if (!part.empty() && !is_placeholder && setting.path == PathRole::kNone) {
        EXPECT_THAT(setting.words, Contains(part)) << setting.name;
      }
    }
  }
}

}  // namespace
}  // namespace vantage::setting_kinds_test
