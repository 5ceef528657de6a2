#pragma once

#include <tiffio.h>

#include <memory>
#include <optional>
#include <string>

#include "engine/io/files/file_bytes.h"
#include "engine/late_library.h"

namespace vantage {

/// The functions of libtiff that the engine calls, opened with the first file: the library loads
/// those of its codecs. Throws Error when it cannot be opened.
struct LibtiffFunctions {
  LateLibrary library{VANTAGE_TIFF_LIBRARY, "cannot read TIFF files"};

// NOLINTNEXTLINE(cppcoreguidelines-macro-usage)
#define VANTAGE_LIBTIFF_FUNCTION(name) \
  decltype(&::name) name = library.function<decltype(&::name)>(#name)

  VANTAGE_LIBTIFF_FUNCTION(TIFFClientOpenExt);
  VANTAGE_LIBTIFF_FUNCTION(TIFFClose);
  VANTAGE_LIBTIFF_FUNCTION(TIFFComputeStrip);
  VANTAGE_LIBTIFF_FUNCTION(TIFFComputeTile);
  VANTAGE_LIBTIFF_FUNCTION(TIFFFieldPassCount);
  VANTAGE_LIBTIFF_FUNCTION(TIFFFieldWithTag);
  VANTAGE_LIBTIFF_FUNCTION(TIFFGetField);
  VANTAGE_LIBTIFF_FUNCTION(TIFFGetFieldDefaulted);
  VANTAGE_LIBTIFF_FUNCTION(TIFFIsTiled);
  VANTAGE_LIBTIFF_FUNCTION(TIFFOpenOptionsAlloc);
  VANTAGE_LIBTIFF_FUNCTION(TIFFOpenOptionsFree);
  VANTAGE_LIBTIFF_FUNCTION(TIFFOpenOptionsSetErrorHandlerExtR);
  VANTAGE_LIBTIFF_FUNCTION(TIFFOpenOptionsSetWarningHandlerExtR);
  VANTAGE_LIBTIFF_FUNCTION(TIFFReadDirectory);
  VANTAGE_LIBTIFF_FUNCTION(TIFFReadEncodedStrip);
  VANTAGE_LIBTIFF_FUNCTION(TIFFReadEncodedTile);
  VANTAGE_LIBTIFF_FUNCTION(TIFFReadRGBAImageOriented);
  VANTAGE_LIBTIFF_FUNCTION(TIFFScanlineSize64);
  VANTAGE_LIBTIFF_FUNCTION(TIFFSetDirectory);
  VANTAGE_LIBTIFF_FUNCTION(TIFFSetField);
  VANTAGE_LIBTIFF_FUNCTION(TIFFTileRowSize64);
#undef VANTAGE_LIBTIFF_FUNCTION
};
const LibtiffFunctions& libtiff();

/// A TIFF or BigTIFF file in memory, at one of its pages. Pages are its directories but thumbnails,
/// reduced copies (pyramids of maps) and masks. Thread rule: one thread at a time.
class TiffFile {
 public:
  /// At page `page`, counted from 0. Throws Error naming the file when it is damaged, or has no
  /// such page. `file` must outlive it.
  TiffFile(const FileBytes& file, int page);

  [[nodiscard]] TIFF* get() const { return tiff_.get(); }
  [[nodiscard]] int pages() const { return pages_; }
  /// The number that a tag holds; `otherwise` if there is none, and libtiff knows no default.
  template <typename T>
  [[nodiscard]] T number(std::uint32_t tag, T otherwise) const {
    T value = otherwise;
    return libtiff().TIFFGetFieldDefaulted(tiff_.get(), tag, &value) != 0 ? value : otherwise;
  }
  /// The text of a tag that libtiff does not define; empty if there is none.
  [[nodiscard]] std::string text(std::uint32_t tag) const;
  /// What the file states as white: WhiteLevel (of DNG), else 2ⁿ − 1 of the bits of MaxSampleValue;
  /// empty if neither is below 65535.
  [[nodiscard]] std::optional<double> white_level() const;

  /// Throws Error "<name>: is damaged …" with what libtiff said.
  [[noreturn]] void fail() const;

 private:
  struct Close {
    void operator()(TIFF* tiff) const { libtiff().TIFFClose(tiff); }
  };
  void open();

  const FileBytes& file_;
  std::size_t position_ = 0;
  std::string problem_;  ///< libtiff's first
  std::unique_ptr<TIFF, Close> tiff_;
  int pages_ = 0;
};

}  // namespace vantage
