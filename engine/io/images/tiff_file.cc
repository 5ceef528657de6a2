#include "engine/io/images/tiff_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdarg>
#include <cstdio>
#include <cstring>

namespace vantage {

const LibtiffFunctions& libtiff() {
  static const LibtiffFunctions functions;
  return functions;
}

void TiffFile::open() {
  const LibtiffFunctions& functions = libtiff();
  const std::unique_ptr<TIFFOpenOptions, decltype(functions.TIFFOpenOptionsFree)> options(
      functions.TIFFOpenOptionsAlloc(), functions.TIFFOpenOptionsFree);
  functions.TIFFOpenOptionsSetErrorHandlerExtR(
      options.get(),
      [](TIFF*, void* self, const char*, const char* format, va_list values) {
        std::string& problem = static_cast<TiffFile*>(self)->problem_;
        std::array<char, 160> text{};
        std::vsnprintf(text.data(), text.size(), format, values);
        problem = problem.empty() ? text.data() : problem;
        std::replace(problem.begin(), problem.end(), '\n', ' ');
        return 1;
      },
      this);
  functions.TIFFOpenOptionsSetWarningHandlerExtR(
      options.get(), [](TIFF*, void*, const char*, const char*, va_list) { return 1; }, nullptr);
  tiff_.reset(functions.TIFFClientOpenExt(
      "", "rm", this,  // m: not mapped into memory, where it is already
      [](thandle_t self, void* target, tmsize_t count) {
        auto& file = *static_cast<TiffFile*>(self);
        const auto rest = file.file_.all().subspan(std::min(file.position_, file.file_.size()));
        const std::size_t bytes = std::min(static_cast<std::size_t>(count), rest.size());
        std::memcpy(target, rest.data(), bytes);
        file.position_ += bytes;
        return static_cast<tmsize_t>(bytes);
      },
      [](thandle_t, void*, tmsize_t) { return tmsize_t{0}; },
      [](thandle_t self, toff_t offset, int origin) {
        auto& file = *static_cast<TiffFile*>(self);
        file.position_ = offset + (origin == SEEK_CUR   ? file.position_
                                   : origin == SEEK_END ? file.file_.size()
                                                        : 0);
        return toff_t{file.position_};
      },
      [](thandle_t) { return 0; },
      [](thandle_t self) { return toff_t{static_cast<TiffFile*>(self)->file_.size()}; }, nullptr,
      nullptr, options.get()));
  if (tiff_ == nullptr) {
    fail();
  }
}

TiffFile::TiffFile(const FileBytes& file, int page) : file_(file) {
  constexpr std::uint32_t kReducedOrMask = FILETYPE_REDUCEDIMAGE | FILETYPE_MASK;
  constexpr int kMaxDirectories = 65535;
  open();
  int found = -1;
  for (int directory = 0; directory < kMaxDirectories; ++directory) {
    if (directory > 0 && libtiff().TIFFReadDirectory(tiff_.get()) == 0) {
      break;
    }
    const auto kind = number<std::uint32_t>(TIFFTAG_SUBFILETYPE, 0);
    if (directory == 0 || (kind & kReducedOrMask) == 0) {
      found = pages_ == page ? directory : found;
      ++pages_;
    }
  }
  problem_.clear();
  if (found < 0) {
    file_.fail(fmt::format("has {} page{}, expected number {} to be below that", pages_,
                           pages_ == 1 ? "" : "s", page));
  }
  if (libtiff().TIFFSetDirectory(tiff_.get(), static_cast<tdir_t>(found)) == 0) {
    fail();
  }
}

std::string TiffFile::text(std::uint32_t tag) const {
  const TIFFField* const field = libtiff().TIFFFieldWithTag(tiff_.get(), tag);
  std::uint32_t count = 0;
  const char* text = nullptr;
  // GDAL, if the process has it, defines its tags for all.
  const bool has_count = field != nullptr && libtiff().TIFFFieldPassCount(field) != 0;
  const bool is_found =
      field != nullptr && (has_count ? libtiff().TIFFGetField(tiff_.get(), tag, &count, &text)
                                     : libtiff().TIFFGetField(tiff_.get(), tag, &text)) != 0;
  if (!is_found || text == nullptr) {
    return "";
  }
  // libtiff ends texts by a zero, but a damaged file may hold other values under the tag.
  return has_count ? std::string(text, ::strnlen(text, count)) : text;
}

std::optional<double> TiffFile::white_level() const {
  std::uint16_t count = 0;
  const std::uint32_t* levels = nullptr;
  std::uint16_t max_sample = 0;
  double white = 0;
  if (libtiff().TIFFGetField(tiff_.get(), TIFFTAG_WHITELEVEL, &count, &levels) != 0 && count > 0) {
    white = levels[0];
  } else if (libtiff().TIFFGetField(tiff_.get(), TIFFTAG_MAXSAMPLEVALUE, &max_sample) != 0) {
    white = static_cast<double>((1U << std::bit_width(static_cast<unsigned>(max_sample))) - 1);
  }
  return white > 0 && white < 65535 ? std::optional(white) : std::nullopt;
}

void TiffFile::fail() const {
  file_.fail(fmt::format("is damaged or of an unsupported kind, expected a sound TIFF ({})",
                         problem_.empty() ? "its pixels cannot be decoded" : problem_));
}

}  // namespace vantage
