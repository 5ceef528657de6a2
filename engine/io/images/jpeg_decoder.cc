#include "engine/io/images/jpeg_decoder.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <csetjmp>
#include <cstdio>
#include <new>
#include <vector>

#include <jpeglib.h>  // needs <cstdio> before it

#include <jerror.h>

namespace vantage {
namespace {

/// libjpeg's error manager, and the target of its longjmp.
struct Problem {
  jpeg_error_mgr manager{};  // first: libjpeg passes a pointer to it
  std::jmp_buf jump{};
  std::array<char, JMSG_LENGTH_MAX> text{};
  int code = 0;
};

[[noreturn]] void jump_back(j_common_ptr common) {
  auto& problem = *reinterpret_cast<Problem*>(common->err);
  problem.code = problem.manager.msg_code;
  problem.manager.format_message(common, problem.text.data());
  std::longjmp(problem.jump, 1);
}

/// Level −1 is a warning: damaged data was replaced. Others are remarks.
void take_message(j_common_ptr common, int level) {
  if (level < 0) {
    jump_back(common);
  }
}

void keep_quiet(j_common_ptr) {}

void invert_cmyk(const std::uint8_t* cmyk, int width, std::uint8_t* rgb) {
  for (int x = 0; x < width; ++x, cmyk += 4, rgb += 3) {
    const int black = cmyk[3];
    for (int c = 0; c < 3; ++c) {
      rgb[c] = static_cast<std::uint8_t>(black - ((255 - cmyk[c]) * black >> 8));
    }
  }
}

/// Objects that libjpeg allocates for a file. Each call returns false when libjpeg reports an
/// error, which it does by longjmp: no object in between may have a destructor.
class JpegReader {
 public:
  explicit JpegReader(const FileBytes& file) {
    decoder_.err = jpeg_std_error(&problem_.manager);
    problem_.manager.error_exit = jump_back;
    problem_.manager.emit_message = take_message;
    problem_.manager.output_message = keep_quiet;
    is_ready_ = setjmp(problem_.jump) == 0;
    if (is_ready_) {
      jpeg_create_decompress(&decoder_);
      jpeg_mem_src(&decoder_, file.all().data(), file.size());
    }
  }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
  ~JpegReader() { jpeg_destroy_decompress(&decoder_); }

  bool begin() {
    if (!is_ready_ || setjmp(problem_.jump) != 0) {
      return false;
    }
    jpeg_read_header(&decoder_, TRUE);
    decoder_.out_color_space = decoder_.num_components == 1   ? JCS_GRAYSCALE
                               : decoder_.num_components == 4 ? JCS_CMYK
                                                              : JCS_EXT_RGB;
    jpeg_start_decompress(&decoder_);
    return true;
  }

  /// `cmyk_row`: buffer for a row of CMYK pixels, if they are.
  bool read(Image<std::uint8_t>& image, std::uint8_t* cmyk_row) {
    if (setjmp(problem_.jump) != 0) {
      return false;
    }
    while (decoder_.output_scanline < decoder_.output_height) {
      std::uint8_t* row = image.row(static_cast<int>(decoder_.output_scanline));
      JSAMPROW target = cmyk_row != nullptr ? cmyk_row : row;
      jpeg_read_scanlines(&decoder_, &target, 1);
      if (cmyk_row != nullptr) {
        invert_cmyk(cmyk_row, image.width(), row);
      }
    }
    jpeg_finish_decompress(&decoder_);
    return true;
  }

  [[nodiscard]] ImageShape shape() const {
    return {static_cast<int>(decoder_.output_width), static_cast<int>(decoder_.output_height),
            decoder_.num_components == 1 ? 1 : 3};
  }
  /// Of the first component: luminance. Valid from begin(), which reads the tables of all scans of
  /// a progressive file, to read(), which frees them.
  [[nodiscard]] double step_of_low_frequencies() const {
    const JQUANT_TBL* table = decoder_.comp_info[0].quant_table;
    constexpr std::array<int, 5> kLowest = {1, 8, 16, 9, 2};  // of rows of eight, without 0
    double sum = 0;
    for (const int place : kLowest) {
      sum += table == nullptr ? 0 : table->quantval[place];
    }
    return sum / static_cast<double>(kLowest.size());
  }
  [[nodiscard]] bool is_cmyk() const { return decoder_.out_color_space == JCS_CMYK; }
  [[nodiscard]] int rows_read() const { return static_cast<int>(decoder_.output_scanline); }

  [[nodiscard]] bool is_out_of_memory() const { return problem_.code == JERR_OUT_OF_MEMORY; }
  /// libjpeg's message in lower case, without the common prefix of its warnings.
  [[nodiscard]] std::string problem() const {
    std::string text = problem_.text.data();
    const std::string common = "Corrupt JPEG data: ";
    text.erase(0, text.starts_with(common) ? common.size() : 0);
    if (!text.empty()) {
      text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
    }
    return text;
  }

 private:
  jpeg_decompress_struct decoder_{};
  Problem problem_;
  bool is_ready_ = false;
};

[[noreturn]] void fail(const FileBytes& file, const JpegReader& reader) {
  if (reader.is_out_of_memory()) {
    throw std::bad_alloc();
  }
  file.fail(
      fmt::format("is damaged or of an unsupported kind at row {}, expected a sound JPEG ({})",
                  reader.rows_read(), reader.problem()));
}

}  // namespace

Photograph decode_jpeg(const FileBytes& file, Photograph& memory) {
  JpegReader reader(file);
  if (!reader.begin()) {
    fail(file, reader);
  }
  const ImageShape shape = reader.shape();
  file.check_dimensions(shape.width, shape.height);
  Image<std::uint8_t> image = take_image<std::uint8_t>(memory, shape);
  std::vector<std::uint8_t> cmyk_row(reader.is_cmyk() ? 4 * static_cast<std::size_t>(shape.width)
                                                      : std::size_t{0});
  const LossyCoding coding{.codec = "JPEG", .step_grey_levels = reader.step_of_low_frequencies()};
  if (!reader.read(image, cmyk_row.empty() ? nullptr : cmyk_row.data())) {
    fail(file, reader);
  }
  return {std::move(image), {.coding = coding}};
}

}  // namespace vantage
