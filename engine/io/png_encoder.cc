#include "engine/io/png_encoder.h"

#include <png.h>

#include <bit>
#include <csetjmp>
#include <new>

namespace vantage {
namespace {

/// Output of libpng.
struct Sink {
  std::vector<std::uint8_t>& bytes;
  bool out_of_memory = false;
};

void append(png_structp png, png_bytep data, png_size_t size) {
  auto& sink = *static_cast<Sink*>(png_get_io_ptr(png));
  try {
    sink.bytes.insert(sink.bytes.end(), data, data + size);
  } catch (const std::bad_alloc&) {
    sink.out_of_memory = true;
  }
  if (sink.out_of_memory) {
    png_error(png, "out of memory");  // does not return
  }
}

void keep_in_memory(png_structp) {}
void keep_quiet(png_structp, png_const_charp) {}
void jump_back(png_structp png, png_const_charp) { png_longjmp(png, 1); }

/// Objects that libpng allocates for a file.
class PngWriter {
 public:
  PngWriter()
      : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, jump_back, keep_quiet)),
        info_(png_ == nullptr ? nullptr : png_create_info_struct(png_)) {
    if (info_ == nullptr) {
      png_destroy_write_struct(&png_, nullptr);
      throw std::bad_alloc();
    }
  }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }

  /// False when libpng reports an error, which it does by longjmp: no object in between may have a
  /// destructor.
  template <typename T>
  bool write(const Image<T>& image, Sink& sink) {
    if (setjmp(png_jmpbuf(png_)) != 0) {
      return false;
    }
    png_set_write_fn(png_, &sink, append, keep_in_memory);
    // The fastest filter for photographs, with nearly the best compression.
    png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_compression_level(png_, 1);
    constexpr int kRunLengths = 3;  // zlib's Z_RLE
    png_set_compression_strategy(png_, kRunLengths);
    const int colour = image.channels() == 1   ? PNG_COLOR_TYPE_GRAY
                       : image.channels() == 3 ? PNG_COLOR_TYPE_RGB
                                               : PNG_COLOR_TYPE_RGBA;
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(image.width()),
                 static_cast<png_uint_32>(image.height()), 8 * sizeof(T), colour,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png_, info_);
    if (sizeof(T) == 2 && std::endian::native == std::endian::little) {
      png_set_swap(png_);
    }
    for (int y = 0; y < image.height(); ++y) {
      png_write_row(png_, reinterpret_cast<png_const_bytep>(image.row(y)));
    }
    png_write_end(png_, info_);
    return true;
  }

 private:
  png_structp png_;
  png_infop info_;
};

template <typename T>
void encode(const Image<T>& image, std::vector<std::uint8_t>& bytes) {
  bytes.clear();
  Sink sink{bytes};
  PngWriter writer;
  if (!writer.write(image, sink)) {
    bytes.clear();
  }
  if (sink.out_of_memory) {
    throw std::bad_alloc();
  }
}

}  // namespace

void encode_png(const Image<std::uint8_t>& image, std::vector<std::uint8_t>& bytes) {
  encode(image, bytes);
}

void encode_png(const Image<std::uint16_t>& image, std::vector<std::uint8_t>& bytes) {
  encode(image, bytes);
}

}  // namespace vantage
