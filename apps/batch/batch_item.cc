#include "apps/batch/batch_item.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "apps/settings/command_line.h"
#include "engine/error.h"
#include "engine/io/files/checksum.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/images/scene_mask.h"
#include "engine/io/video/image_sequence.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

/// Options of the batch itself, and those that each worker chooses for its machine.
constexpr std::array<std::string_view, 10> kOfBatch = {"output",  "resume", "dry-run",  "report",
                                                       "quiet",   "worker", "manifest", "progress",
                                                       "threads", "memory"};
/// What pairs of one list need not share.
constexpr std::array<std::string_view, 4> kOfPair = {"left", "right", "disparities", "output"};

bool is_one_image(const std::string& source) {
  return has_image_extension(source) && source.find_first_of("%*?[") == std::string::npos &&
         (is_address(source) || !fs::is_directory(source));
}

/// What an item's options say beside its images.
bool is_plain_pair(const RunJob& job) {
  const SequenceOptions& options = job.sequence;
  return job.input.more.empty() && job.input.every.takes_all() && !job.frames &&
         job.input.offset_frames == 0 && options.video.empty() && !options.is_film();
}

}  // namespace

SettingValue options_of_all(const Settings& settings) {
  RunJob job;
  Settings of_run("run", "");
  add_run_settings(of_run, job);
  SettingValue options = SettingValue::object();
  for (const Setting& setting : of_run.all()) {
    if (settings.is_set(setting.name) &&
        std::ranges::find(kOfBatch, setting.name) == kOfBatch.end()) {
      options[setting.name] = settings.find(setting.name)->stored();
    }
  }
  return options;
}

void check_items(const BatchJob& batch, const std::vector<ManifestItem>& items,
                 const SettingValue& options_of_all) {
  for (const ManifestItem& item : items) {
    const BatchItem checked(item, batch, options_of_all);
  }
}

BatchItem::BatchItem(const ManifestItem& item, const BatchJob& batch,
                     const SettingValue& options_of_all)
    : settings_("run", "") {
  add_run_settings(settings_, job_);
  try {
    settings_.take_values(options_of_all);
    settings_.take_values(item.options);
    job_.output = (fs::path(batch.run.output) / item.output).string();
    job_.common.quiet = true;
    job_.common.execution.threads = batch.run.common.execution.threads;
    job_.memory_bytes = batch.run.memory_bytes;
    if (job_.input.is_stream()) {
      throw UsageError("the input is a stream, expected files: an item may be tried again");
    }
    complete(job_, settings_);
  } catch (const Error& error) {
    throw UsageError(fmt::format("{} line {}: {}", batch.manifest, item.line, error.what()));
  }
}

bool BatchItem::is_pair() const {
  return is_one_image(job_.input.left) && is_one_image(job_.input.right) && is_plain_pair(job_);
}

bool BatchItem::goes_with_others() const {
  const SequenceOptions& options = job_.sequence;
  const auto& masks = job_.input.masks;
  const bool has_mask_files =
      std::ranges::any_of(masks.files(), [](const std::string& file) { return !file.empty(); });
  return is_pair() && !has_mask_files && !options.temporal.uses_past() && !options.needs_shots() &&
         job_.poses.empty() && options.rows.keys.empty();
}

std::uint64_t BatchItem::options_hash() const {
  SettingValue values = settings_.values();
  for (const std::string_view name : kOfPair) {
    values.erase(std::string(name));
  }
  Fnv1aHash hash;
  hash.add(values.dump(-1, ' ', false, SettingValue::error_handler_t::replace));
  return hash.value();
}

std::string BatchItem::to_job_file(const std::string& output) {
  job_.output = output;
  job_.resume = true;
  return to_toml(settings_);
}

std::string BatchItem::to_job_file_of_list(const std::string& list, const std::string& output) {
  job_.input.left.clear();
  job_.input.right.clear();
  job_.input.pair_by.reset();
  job_.input.pairs = list;
  // The list has the ranges that are given.
  job_.sequence.match.disparities_auto = true;
  job_.search_scope = SearchScope::kPair;
  job_.keep_going = true;
  return to_job_file(output);
}

}  // namespace vantage::apps
