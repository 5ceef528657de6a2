#include <png.h>

#include <fmt/format.h>

#include <array>
#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <new>
#include <vector>

#include "engine/io/images/png_decoder.h"

namespace vantage {
namespace {

/// Input and error message of libpng.
struct Source {
  std::span<const std::uint8_t> rest;
  std::array<char, 128> problem{};
};

void read_bytes(png_structp png, png_bytep target, png_size_t count) {
  auto& source = *static_cast<Source*>(png_get_io_ptr(png));
  if (count > source.rest.size()) {
    png_error(png, "the data ends too early");  // does not return
  }
  std::memcpy(target, source.rest.data(), count);
  source.rest = source.rest.subspan(count);
}

void keep_quiet(png_structp, png_const_charp) {}
void jump_back(png_structp png, png_const_charp problem) {
  auto& source = *static_cast<Source*>(png_get_error_ptr(png));
  std::snprintf(source.problem.data(), source.problem.size(), "%s", problem);
  png_longjmp(png, 1);
}

/// Objects that libpng allocates for a file. Each call returns false when libpng reports an error,
/// which it does by longjmp: no object in between may have a destructor.
class PngReader {
 public:
  explicit PngReader(Source& source)
      : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, jump_back, keep_quiet)),
        info_(png_ == nullptr ? nullptr : png_create_info_struct(png_)) {
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
    png_set_read_fn(png_, &source, read_bytes);
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

  bool begin() {
    if (setjmp(png_jmpbuf(png_)) != 0) {
      return false;
    }
    png_read_info(png_, info_);
    const int colour = png_get_color_type(png_, info_);
    if (colour == PNG_COLOR_TYPE_PALETTE) {
      png_set_palette_to_rgb(png_);
    }
    if ((colour & PNG_COLOR_MASK_COLOR) != 0 && png_get_valid(png_, info_, PNG_INFO_tRNS) != 0) {
      png_set_tRNS_to_alpha(png_);
    }
    if (colour == PNG_COLOR_TYPE_GRAY) {
      png_set_expand_gray_1_2_4_to_8(png_);
    } else if (colour == PNG_COLOR_TYPE_GRAY_ALPHA) {
      png_set_gray_to_rgb(png_);
    }
    if (std::endian::native == std::endian::little) {
      png_set_swap(png_);
    }
    passes_ = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }

  [[nodiscard]] bool has_16_bits() const { return png_get_bit_depth(png_, info_) == 16; }
  [[nodiscard]] ImageShape shape() const {
    return {static_cast<int>(png_get_image_width(png_, info_)),
            static_cast<int>(png_get_image_height(png_, info_)), png_get_channels(png_, info_)};
  }

  template <typename T>
  bool read(Image<T>& image) {
    if (setjmp(png_jmpbuf(png_)) != 0) {
      return false;
    }
    for (int pass = 0; pass < passes_; ++pass) {
      for (int y = 0; y < image.height(); ++y) {
        png_read_row(png_, reinterpret_cast<png_bytep>(image.row(y)), nullptr);
      }
    }
    png_read_end(png_, nullptr);
    return true;
  }

 private:
  png_structp png_;
  png_infop info_;
  int passes_ = 1;
};

[[noreturn]] void fail(const FileBytes& file, const Source& source) {
  file.fail(fmt::format("is damaged, its pixels cannot be decoded ({})", source.problem.data()));
}

template <typename T>
Photograph read_pixels(const FileBytes& file, const Source& source, PngReader& reader,
                       Photograph& memory) {
  Image<T> image = take_image<T>(memory, reader.shape());
  if (!reader.read(image)) {
    fail(file, source);
  }
  return {std::move(image)};
}

}  // namespace

Photograph decode_any_png(const FileBytes& file, std::span<const std::uint8_t> png,
                          Photograph& memory) {
  Source source{png};
  PngReader reader(source);
  if (!reader.begin()) {
    fail(file, source);
  }
  return reader.has_16_bits() ? read_pixels<std::uint16_t>(file, source, reader, memory)
                              : read_pixels<std::uint8_t>(file, source, reader, memory);
}

}  // namespace vantage
