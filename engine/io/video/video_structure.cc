#include "engine/io/video/video_structure.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/error.h"
#include "engine/io/files/random_access_file.h"
#include "engine/io/files/remote_files.h"

namespace vantage {
namespace {

constexpr std::uint64_t kTransportPacketBytes = 188;

/// Reads a few scattered bytes of a file too large to load, with caching.
class SparseFile {
 public:
  explicit SparseFile(const std::filesystem::path& path)
      : path_(path), file_(open_random_access(path)), size_(file_->size()) {}

  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(fmt::format("{}: {}", path_.string(), problem));
  }

  [[nodiscard]] bool holds(std::uint64_t offset, std::uint64_t bytes) const {
    return offset <= size_ && bytes <= size_ - offset;
  }

  /// `bytes` ≤ 8; they must be in the file.
  std::uint64_t big_endian(std::uint64_t offset, int bytes) {
    std::uint64_t value = 0;
    for (const char c : text(offset, bytes)) {
      value = value << 8 | static_cast<unsigned char>(c);
    }
    return value;
  }

  /// `count` ≤ 8 bytes; they must be in the file.
  std::string_view text(std::uint64_t offset, int count) {
    const auto bytes = static_cast<std::size_t>(count);
    if (offset < begin_ || offset + bytes > begin_ + buffer_.size()) {
      load(offset);
    }
    return {reinterpret_cast<const char*>(buffer_.data()) + (offset - begin_), bytes};
  }

 private:
  void load(std::uint64_t offset) {
    constexpr std::uint64_t kMaxBytes = 4096;
    begin_ = offset;
    buffer_.resize(static_cast<std::size_t>(std::min(kMaxBytes, size_ - offset)));
    if (file_->read(offset, buffer_) < buffer_.size()) {
      throw Error(fmt::format("cannot read {}", path_.string()));
    }
  }

  std::filesystem::path path_;
  std::unique_ptr<RandomAccessFile> file_;
  std::uint64_t size_;
  std::vector<std::uint8_t> buffer_;  ///< bytes from begin_ on
  std::uint64_t begin_ = 0;
};

/// A box of an MP4, including its header.
struct Box {
  std::string type;
  std::uint64_t begin = 0;  ///< start of its contents
  std::uint64_t end = 0;
};

/// The box at `offset`; empty when it is incomplete.
std::optional<Box> whole_box(SparseFile& file, std::uint64_t offset) {
  if (!file.holds(offset, 8)) {
    return std::nullopt;
  }
  std::uint64_t header = 8;
  std::uint64_t length = file.big_endian(offset, 4);
  if (length == 0) {
    length = file.size() - offset;  // a last box that extends to the end of the file
  } else if (length == 1) {
    header = 16;
    if (!file.holds(offset, header)) {
      return std::nullopt;
    }
    length = file.big_endian(offset + 8, 8);
  }
  if (length < header || !file.holds(offset, length)) {
    return std::nullopt;
  }
  return Box{std::string(file.text(offset + 4, 4)), offset + header, offset + length};
}

bool holds_boxes(const std::string& type) {
  for (const char* container : {"moov", "trak", "mdia", "minf", "stbl", "moof", "traf"}) {
    if (type == container) {
      return true;
    }
  }
  return false;
}

/// Number of samples that a table promises without an entry for each; 0 in other boxes.
std::uint64_t samples_without_entries(SparseFile& file, const Box& box) {
  if (box.type == "stsz" && box.end - box.begin >= 12) {
    return file.big_endian(box.begin + 4, 4) != 0 ? file.big_endian(box.begin + 8, 4) : 0;
  }
  constexpr std::uint64_t kFieldsOfASample = 0xF00;
  if (box.type == "trun" && box.end - box.begin >= 8) {
    return (file.big_endian(box.begin, 4) & kFieldsOfASample) == 0
               ? file.big_endian(box.begin + 4, 4)
               : 0;
  }
  return 0;
}

/// Readers allocate an entry for each sample that a table promises. Each takes at least one byte of
/// the file; samples of compressed sound may be counted as decoded ones.
void check_sample_tables(SparseFile& file, std::uint64_t begin, std::uint64_t end, int level = 0) {
  constexpr int kMaxLevels = 6;  // moov, trak, mdia, minf, stbl, stsz
  constexpr std::uint64_t kMaxSamplesPerByte = 16;
  for (std::uint64_t offset = begin; offset < end;) {
    const std::optional<Box> box = whole_box(file, offset);
    if (!box) {
      return;
    }
    if (const std::uint64_t samples = samples_without_entries(file, *box);
        samples / kMaxSamplesPerByte > file.size()) {
      file.fail(fmt::format("is damaged, {} bytes cannot hold the {} samples of its index",
                            file.size(), samples));
    }
    if (level + 1 < kMaxLevels && holds_boxes(box->type)) {
      check_sample_tables(file, box->begin, std::min(box->end, end), level + 1);
    }
    offset = box->end;
  }
}

/// Bytes of a box before the boxes in it, from the movie down to the descriptions of its samples;
/// empty: it holds none of interest.
std::optional<std::uint64_t> bytes_before_boxes(const std::string& type) {
  constexpr std::uint64_t kVisualSampleEntry = 78;
  for (const char* entry : {"hvc1", "hev1", "avc1", "avc3", "mvc1", "mvc2"}) {
    if (type == entry) {
      return kVisualSampleEntry;
    }
  }
  const bool holds_only_boxes =
      holds_boxes(type) || type == "vexu" || type == "eyes" || type == "pack";
  return type == "stsd"     ? std::optional<std::uint64_t>(8)
         : holds_only_boxes ? std::optional<std::uint64_t>(0)
                            : std::nullopt;
}

void gather_boxes(SparseFile& file, std::uint64_t begin, std::uint64_t end, int level,
                  std::set<std::string>& types) {
  constexpr int kMaxLevels = 10;
  for (std::uint64_t offset = begin; offset < end;) {
    const std::optional<Box> box = whole_box(file, offset);
    if (!box) {
      return;
    }
    types.insert(box->type);
    if (const auto before = bytes_before_boxes(box->type); before && level < kMaxLevels) {
      gather_boxes(file, box->begin + *before, std::min(box->end, end), level + 1, types);
    }
    offset = box->end;
  }
}

VideoExtent extent_of_boxes(SparseFile& file) {
  bool has_index = false;
  for (std::uint64_t offset = 0; offset < file.size();) {
    const std::optional<Box> box = whole_box(file, offset);
    if (!box) {
      return has_index ? VideoExtent::kCutOff : VideoExtent::kWithoutIndex;
    }
    has_index = has_index || box->type == "moov";
    offset = box->end;
  }
  return has_index ? VideoExtent::kWhole : VideoExtent::kWithoutIndex;
}

/// An element of Matroska: position and length of its contents.
struct Element {
  std::string id;  ///< empty: its header is missing
  std::uint64_t begin = 0;
  std::uint64_t length = 0;
  bool has_length = false;  ///< else it extends to the end of its parent
};

/// Length in bytes of the variable-length number at `offset`; 0 when it is missing.
int number_bytes(SparseFile& file, std::uint64_t offset) {
  if (!file.holds(offset, 1)) {
    return 0;
  }
  const int bytes = std::countl_zero(static_cast<std::uint8_t>(file.big_endian(offset, 1))) + 1;
  return bytes <= 8 && file.holds(offset, static_cast<std::uint64_t>(bytes)) ? bytes : 0;
}

Element read_element(SparseFile& file, std::uint64_t offset) {
  const int id_bytes = number_bytes(file, offset);
  const std::uint64_t length_offset = offset + static_cast<std::uint64_t>(id_bytes);
  const int length_bytes = id_bytes == 0 ? 0 : number_bytes(file, length_offset);
  if (length_bytes == 0) {
    return {};
  }
  const std::uint64_t mask = (std::uint64_t{1} << (7 * length_bytes)) - 1;
  Element element;
  element.id = file.text(offset, id_bytes);
  element.begin = length_offset + static_cast<std::uint64_t>(length_bytes);
  element.length = file.big_endian(length_offset, length_bytes) & mask;
  element.has_length = element.length != mask;
  return element;
}

/// If only the data after the frames is missing (the seek index, tags), the video is complete.
bool has_whole_clusters(SparseFile& file) {
  const Element header = read_element(file, 0);
  const Element segment = read_element(file, header.begin + header.length);
  if (header.id.empty() || segment.id != "\x18\x53\x80\x67" || !segment.has_length ||
      file.holds(segment.begin, segment.length)) {
    return true;
  }
  bool has_cluster = false;
  for (std::uint64_t offset = segment.begin;;) {
    const Element element = read_element(file, offset);
    const bool is_cluster = element.id == "\x1F\x43\xB6\x75";
    if (element.id.empty() || !element.has_length || !file.holds(element.begin, element.length)) {
      const bool is_index = element.id == "\x1C\x53\xBB\x6B";
      const bool is_tags = element.id == "\x12\x54\xC3\x67";
      return has_cluster && (is_index || is_tags);
    }
    has_cluster = has_cluster || is_cluster;
    offset = element.begin + element.length;
  }
}

/// As above: the index follows the chunk of the frames.
bool has_whole_movie(SparseFile& file) {
  const auto length_at = [&](std::uint64_t offset) {
    return std::uint64_t{__builtin_bswap32(static_cast<std::uint32_t>(file.big_endian(offset, 4)))};
  };
  if (file.holds(8, length_at(4))) {
    return true;
  }
  for (std::uint64_t offset = 12; file.holds(offset, 12);) {
    const std::uint64_t length = length_at(offset + 4);
    if (file.text(offset, 4) == "LIST" && file.text(offset + 8, 4) == "movi") {
      return file.holds(offset + 8, length);
    }
    offset += 8 + length + length % 2;
  }
  return false;
}

/// For MPEG-TS, which consists of packets of equal length. A recording may start in the middle of
/// one.
bool has_whole_packets(SparseFile& file, std::uint64_t first) {
  return (file.size() - first) % kTransportPacketBytes == 0;
}

/// Position of the first packet of an MPEG-TS; empty for other files.
std::optional<std::uint64_t> find_transport_packet(SparseFile& file) {
  constexpr std::uint64_t kPacketsLookedAt = 5;
  for (std::uint64_t first = 0; first < kTransportPacketBytes; ++first) {
    std::uint64_t packets = 0;
    while (packets < kPacketsLookedAt && file.holds(first + packets * kTransportPacketBytes, 1) &&
           file.text(first + packets * kTransportPacketBytes, 1) == "G") {
      ++packets;
    }
    if (packets == kPacketsLookedAt) {
      return first;
    }
  }
  return std::nullopt;
}

}  // namespace

VideoExtent find_video_extent(const std::filesystem::path& path) {
  SparseFile file(path);
  const auto extent = [](bool is_whole) {
    return is_whole ? VideoExtent::kWhole : VideoExtent::kCutOff;
  };
  if (!file.holds(0, 12)) {
    return VideoExtent::kWhole;
  }
  if (file.text(4, 4) == "ftyp") {
    return extent_of_boxes(file);
  }
  if (file.text(0, 4) == "\x1A\x45\xDF\xA3") {
    return extent(has_whole_clusters(file));
  }
  if (file.text(0, 4) == "RIFF" && file.text(8, 4) == "AVI ") {
    return extent(has_whole_movie(file));
  }
  if (const auto first = find_transport_packet(file)) {
    return extent(has_whole_packets(file, *first));
  }
  return VideoExtent::kWhole;
}

void check_video_tables(const std::filesystem::path& path) {
  SparseFile file(path);
  if (!file.holds(0, 8)) {
    return;
  }
  for (const char* first :
       {"ftyp", "moov", "mdat", "wide", "free", "skip", "styp", "sidx", "moof"}) {
    if (file.text(4, 4) == first) {
      check_sample_tables(file, 0, file.size());
      return;
    }
  }
}

std::string_view further_views_in_boxes(const std::filesystem::path& path) {
  SparseFile file(path);
  std::set<std::string> types;
  if (file.holds(0, 8) && file.text(4, 4) == "ftyp") {
    gather_boxes(file, 0, file.size(), 0, types);
  }
  const bool tells_eyes = types.contains("vexu") && !types.contains("pkin");
  return types.contains("lhvC") || tells_eyes ? "MV-HEVC" : types.contains("mvcC") ? "MVC" : "";
}

void check_video_is_whole(const std::filesystem::path& path) {
  if (find_video_extent(path) != VideoExtent::kWhole) {
    throw Error(fmt::format("{}: is truncated, the video file ends after {} bytes before its end",
                            path.string(), bytes_of_file(path)));
  }
}

}  // namespace vantage
