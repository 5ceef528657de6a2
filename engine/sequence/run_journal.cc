#include "engine/sequence/run_journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "engine/build_info.h"
#include "engine/error.h"
#include "engine/io/atomic_file.h"
#include "engine/sequence/sequence_layout.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kFormat = 1;
constexpr const char* kIdentityFile = "run.json";

std::string system_message(int error_number) {
  return std::generic_category().message(error_number);
}

/// Throws what nlohmann throws unless it is a whole number from 0 on.
int count_of(const Json& json) {
  constexpr Json::number_unsigned_t kMost = std::numeric_limits<int>::max() - 1;
  return static_cast<int>(std::min(json.get_ref<const Json::number_unsigned_t&>(), kMost));
}

Json range_json(FrameRange frames) { return Json::array({frames.first, frames.end}); }
FrameRange range_of(const Json& json) { return {json.at(0).get<int>(), json.at(1).get<int>()}; }

Json flicker_json(const FlickerSums& sums) {
  Json views = Json::array();
  for (const ViewFlickerSums& view : sums.views) {
    views.push_back({view.compared, view.grey_change, view.brightness_jump});
  }
  return {{"pixels", sums.pixels},
          {"still", sums.still},
          {"grey_change", sums.grey_change},
          {"compared", sums.compared},
          {"jumped", sums.jumped},
          {"disparity_change", sums.disparity_change},
          {"views", views}};
}

FlickerSums flicker_of(const Json& json) {
  FlickerSums sums;
  sums.frames = 1;
  sums.pixels = json.at("pixels").get<std::int64_t>();
  sums.still = json.at("still").get<std::int64_t>();
  sums.grey_change = json.at("grey_change").get<std::int64_t>();
  sums.compared = json.at("compared").get<std::int64_t>();
  sums.jumped = json.at("jumped").get<std::int64_t>();
  sums.disparity_change = json.at("disparity_change").get<std::int64_t>();
  for (const Json& view : json.at("views")) {
    sums.views.push_back({view.at(0).get<std::int64_t>(), view.at(1).get<std::int64_t>(),
                          view.at(2).get<std::int64_t>()});
  }
  return sums;
}

struct ToJson {
  Json operator()(const FrameRecord& record) const {
    Json json = {{"frame", record.frame}};
    if (record.skipped) {
      json["skipped"] = record.problem;
    }
    const auto add_list = [&](const char* key, const auto& list) {
      if (!list.empty()) {
        json[key] = list;
      }
    };
    add_list("files", record.files);
    add_list("remarks", record.remarks);
    if (record.flicker.frames > 0) {
      json["flicker"] = flicker_json(record.flicker);
    }
    return json;
  }
  Json operator()(const SegmentRecord& record) const {
    return {{"segment", range_json(record.frames)}};
  }
  Json operator()(const JoinRecord& record) const {
    return {{"joined", range_json(record.frames)}};
  }
};

/// Throws what nlohmann throws when the line is none of ours.
JournalRecord record_of(const Json& json) {
  if (json.contains("segment")) {
    return SegmentRecord{range_of(json.at("segment"))};
  }
  if (json.contains("joined")) {
    return JoinRecord{range_of(json.at("joined"))};
  }
  FrameRecord record;
  record.frame = count_of(json.at("frame"));
  record.skipped = json.contains("skipped");
  record.problem = json.value("skipped", "");
  record.files = json.value("files", record.files);
  record.remarks = json.value("remarks", record.remarks);
  if (json.contains("flicker")) {
    record.flicker = flicker_of(json.at("flicker"));
  }
  return record;
}

/// One line of UTF-8 whatever file names hold.
std::string line_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string identity_text(const RunIdentity& identity) {
  const Json json = {{"format", kFormat},
                     {"version", build_info().version},
                     {"frame_count", identity.frame_count},
                     {"inputs", identity.inputs},
                     {"sound",
                      {{"file", identity.sound_file.string()},
                       {"first_frame", identity.sound_first_frame},
                       {"rate", to_string(identity.sound_rate)}}},
                     {"settings", Json::parse(identity.settings)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// The part of an input's line that tells what is in its files: machines may see them at different
/// paths.
std::string_view content_of(std::string_view input) {
  const std::size_t name_end = input.rfind(": ");
  return name_end == std::string_view::npos ? input : input.substr(name_end);
}

/// What of `now` is not as in `then`; empty when nothing is.
std::string difference(const RunIdentity& then, const RunIdentity& now) {
  const Json old_settings = Json::parse(then.settings);
  // Through text and back, so that numbers compare as they are stored.
  const Json new_settings = Json::parse(now.settings);
  std::vector<std::string> found;
  for (const auto& [key, value] : new_settings.items()) {
    const Json before = old_settings.value(key, Json());
    if (before != value) {
      found.push_back(fmt::format("{} was {}, now {}", key, before.dump(), value.dump()));
    }
  }
  for (const auto& [key, value] : old_settings.items()) {
    if (!new_settings.contains(key)) {
      found.push_back(fmt::format("{} was {}, now not set", key, value.dump()));
    }
  }
  for (std::size_t i = 0; i < std::max(then.inputs.size(), now.inputs.size()); ++i) {
    const std::string before = i < then.inputs.size() ? then.inputs[i] : "none";
    const std::string after = i < now.inputs.size() ? now.inputs[i] : "none";
    if (content_of(before) != content_of(after)) {
      found.push_back(fmt::format("the input was '{}', now '{}'", before, after));
    }
  }
  if (found.empty() && then.frame_count != now.frame_count) {
    found.push_back(
        fmt::format("the input had {} frames, now {}", then.frame_count, now.frame_count));
  }
  if (found.empty()) {
    return "";
  }
  return found.front() +
         (found.size() > 1 ? fmt::format(" (and {} more)", found.size() - 1) : std::string());
}

/// Gives `text` the name `path` unless something has it; false then.
bool create_whole(const fs::path& path, const std::string& text) {
  if (fs::exists(path)) {
    return false;
  }
  const AtomicFile file(path);  // never committed: the link below is what stays
  {
    std::ofstream stream(file.temporary_path(), std::ios::binary);
    stream << text;
    if (!stream.flush()) {
      throw Error(fmt::format("cannot write {}: {}", path.string(), system_message(errno)));
    }
  }
  if (::link(file.temporary_path().c_str(), path.c_str()) == 0) {
    return true;
  }
  if (errno == EEXIST) {
    return false;
  }
  // File systems without links have no better way; two first starts at one moment are rare.
  if (fs::exists(path)) {
    return false;
  }
  write_text_file(path, text);
  return true;
}

bool is_journal_of_part(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with("frames-") && name.ends_with(".jsonl");
}

/// Throws when a process works on a part of the run.
void require_idle(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (!is_journal_of_part(entry->path())) {
      continue;
    }
    const int descriptor = ::open(entry->path().c_str(), O_RDWR | O_CLOEXEC);
    const bool is_busy =
        descriptor >= 0 && ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (descriptor >= 0) {
      ::close(descriptor);
    }
    if (is_busy) {
      throw Error(fmt::format("{}: another process works on this run ({}), expected none",
                              folder.parent_path().string(), entry->path().filename().string()));
    }
  }
}

void remove_journal(const fs::path& folder) {
  require_idle(folder);
  std::error_code error;
  fs::remove_all(folder, error);
  if (error) {
    throw Error(fmt::format("{}: cannot be removed: {}", folder.string(), error.message()));
  }
}

/// The lines of a file that end in a line end, and the bytes they take.
std::pair<std::vector<std::string>, std::uintmax_t> whole_lines(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream content;
  content << stream.rdbuf();
  const std::string text = content.str();
  std::vector<std::string> lines;
  std::size_t begin = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', begin)) {
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return {std::move(lines), begin};
}

}  // namespace

struct RunJournal::State {
  /// So much space is set aside ahead: what is finished can then be told although the disk is full.
  static constexpr off_t kReservedBytes = off_t{64} << 10;

  fs::path path;
  int descriptor = -1;
  off_t bytes = 0;
  off_t reserved_end = 0;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (reserved_end > 0) {
      (void)!::ftruncate(descriptor, bytes);  // gives back what was set aside
    }
    if (descriptor >= 0) {
      ::close(descriptor);
    }
  }
  /// False when the disk is full. File systems that cannot set space aside do without.
  bool reserve() {
    if (reserved_end - bytes > kReservedBytes / 2) {
      return true;
    }
    if (::fallocate(descriptor, FALLOC_FL_KEEP_SIZE, bytes, kReservedBytes) != 0) {
      return errno != ENOSPC;
    }
    reserved_end = bytes + kReservedBytes;
    return true;
  }
  [[noreturn]] void fail(int error_number) const {
    throw Error(fmt::format("cannot write {}: {}", path.string(), system_message(error_number)));
  }
};

RunJournal::RunJournal(const fs::path& journal_folder, const RunIdentity& identity,
                       JournalOpening opening, const std::string& part)
    : state_(std::make_unique<State>()) {
  const fs::path folder = journal_folder.parent_path();
  if (opening == JournalOpening::kOverwrite && is_present(journal_folder)) {
    remove_journal(journal_folder);
  }
  make_folder(journal_folder);
  state_->path = journal_folder / fmt::format("frames-{}.jsonl", part);
  const bool is_new = create_whole(journal_folder / kIdentityFile, identity_text(identity));
  if (!is_new) {
    if (opening == JournalOpening::kNew && (part == "all" || fs::exists(state_->path))) {
      throw Error(fmt::format(
          "{} holds a run already, expected --resume to continue it or --overwrite to begin anew",
          folder.string()));
    }
    const std::string differs = difference(read_identity(journal_folder), identity);
    if (!differs.empty()) {
      if (opening != JournalOpening::kForce) {
        throw Error(fmt::format(
            "{} holds a run that differs: {}; expected the same, --force to go on all the same or "
            "--overwrite to begin anew",
            folder.string(), differs));
      }
      write_text_file(journal_folder / kIdentityFile, identity_text(identity));
    }
  }
  state_->descriptor = ::open(state_->path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (state_->descriptor < 0) {
    state_->fail(errno);
  }
  if (::flock(state_->descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    throw Error(fmt::format("{}: another process works on this part of the run ({})",
                            folder.string(), part));
  }
  // A line that a crash cut off must not run into the next one.
  state_->bytes = static_cast<off_t>(whole_lines(state_->path).second);
  if (::ftruncate(state_->descriptor, state_->bytes) != 0 || !state_->reserve()) {
    state_->fail(errno);
  }
}

RunJournal::RunJournal(RunJournal&&) noexcept = default;

RunJournal::~RunJournal() = default;

void RunJournal::append(std::span<const JournalRecord> records) {
  std::string text;
  for (const JournalRecord& record : records) {
    text += line_of(std::visit(ToJson(), record));
  }
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t written = ::write(state_->descriptor, text.data() + done, text.size() - done);
    if (written < 0 && errno != EINTR) {
      state_->fail(errno);
    }
    done += static_cast<std::size_t>(std::max<ssize_t>(written, 0));
  }
  state_->bytes += static_cast<off_t>(text.size());
  (void)state_->reserve();
  if (::fdatasync(state_->descriptor) != 0) {
    state_->fail(errno);
  }
}

bool RunJournal::is_present(const fs::path& journal_folder) {
  std::error_code ignored;
  return fs::exists(journal_folder / kIdentityFile, ignored);
}

RunIdentity RunJournal::read_identity(const fs::path& journal_folder) {
  const fs::path path = journal_folder / kIdentityFile;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    throw Error(fmt::format("{} holds no run: there is no {}",
                            journal_folder.parent_path().string(), path.string()));
  }
  try {
    const Json json = Json::parse(stream);
    if (json.at("format").get<int>() != kFormat) {
      throw Error(fmt::format("{}: is of format {}, expected {} (written by Vantage {})",
                              path.string(), json.at("format").dump(), kFormat,
                              json.value("version", "?")));
    }
    RunIdentity identity;
    // Throws unless it is an object.
    identity.settings = Json(json.at("settings").get_ref<const Json::object_t&>()).dump();
    identity.inputs = json.at("inputs").get<std::vector<std::string>>();
    identity.frame_count = count_of(json.at("frame_count"));
    identity.sound_file = json.at("sound").at("file").get<std::string>();
    identity.sound_first_frame = json.at("sound").at("first_frame").get<int>();
    identity.sound_rate =
        parse_frame_rate(json.at("sound").at("rate").get<std::string>()).value_or(FrameRate());
    return identity;
  } catch (const nlohmann::json::exception&) {
    throw Error(fmt::format("{}: is damaged, expected the description of a run", path.string()));
  }
}

std::vector<JournalRecord> RunJournal::read_records(const fs::path& journal_folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(journal_folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (is_journal_of_part(entry->path())) {
      files.push_back(entry->path());
    }
  }
  std::ranges::sort(files);
  std::vector<JournalRecord> records;
  for (const fs::path& file : files) {
    for (const std::string& line : whole_lines(file).first) {
      try {
        records.push_back(record_of(Json::parse(line)));
      } catch (const nlohmann::json::exception&) {
        // Damaged: the frame counts as not done and is made again.
      }
    }
  }
  return records;
}

}  // namespace vantage
