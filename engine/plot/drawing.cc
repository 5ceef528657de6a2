#include "engine/plot/drawing.h"

#include "engine/io/files/atomic_file.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/images/photograph_io.h"

namespace vantage {

double text_width(const std::string& text, double size) {
  constexpr double kMeanLetterWidth = 0.56;  // of common sans-serif fonts
  return kMeanLetterWidth * size * static_cast<double>(text.size());
}

void write_drawing(const std::filesystem::path& path, const Drawing& drawing) {
  constexpr int kPixelsPerUnit = 2;
  if (lower_case_extension(path) == ".svg") {
    write_text_file(path, to_svg(drawing));
  } else {
    write_photograph(path, {rasterize(drawing, kPixelsPerUnit)});
  }
}

}  // namespace vantage
