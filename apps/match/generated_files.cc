#include "apps/match/generated_files.h"

#include <fmt/format.h>

#include <utility>
#include <variant>

#include "apps/process/outputs.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/existing_files.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "engine/sequence/options/sequence_layout.h"

namespace vantage::apps {

GeneratedFiles::GeneratedFiles(std::filesystem::path folder, bool sequence)
    : folder_(std::move(folder)), sequence_(sequence) {
  make_folder(folder_);
}

void GeneratedFiles::check(const std::filesystem::path& folder, bool sequence,
                           const std::vector<std::string>& names, FileChecks& checks) {
  for (const std::string& name : names) {
    if (sequence) {
      checks.add_made_folder(folder / name, "--output");
      continue;
    }
    for (const char* extension : {".png", ".pfm"}) {
      checks.add_made_file(folder / (name + extension), "--output");
    }
  }
}

std::filesystem::path GeneratedFiles::file(const std::string& name, int frame,
                                           const std::string& extension) const {
  if (!sequence_) {
    return folder_ / fmt::format("{}.{}", name, extension);
  }
  make_folder(folder_ / name);
  return folder_ / name / fmt::format("{:06}.{}", frame, extension);
}

void GeneratedFiles::write(const std::string& name, int frame, const Photograph& photograph) const {
  const bool is_float = std::holds_alternative<Image<float>>(photograph.pixels);
  write_photograph(file(name, frame, is_float ? "pfm" : "png"), photograph);
}

void GeneratedFiles::write(const std::string& name, int frame,
                           const DisparityMap& disparity) const {
  write_disparity(file(name, frame, "pfm"), disparity.view());
}

void GeneratedFiles::write(const std::string& name, int frame, const Mask& mask) const {
  write_mask(file(name, frame, "png"), mask.view());
}

void GeneratedFiles::write_text(const std::string& name, const std::string& text,
                                bool overwrite) const {
  const std::filesystem::path file = folder_ / name;
  if (!overwrite && std::filesystem::exists(file) && read_file_text(file, true) != text) {
    refuse_to_replace(file);
  }
  write_text_file(file, text);
}

}  // namespace vantage::apps
