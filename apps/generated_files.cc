#include "apps/generated_files.h"

#include <fmt/format.h>

#include <utility>
#include <variant>

#include "engine/error.h"
#include "engine/io/disparity_io.h"
#include "engine/io/photograph_io.h"

namespace vantage::apps {

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder, error)) {
    throw Error(fmt::format("{}: cannot be made a folder{}{}", folder.string(), error ? ": " : "",
                            error ? error.message() : ""));
  }
}

GeneratedFiles::GeneratedFiles(std::filesystem::path folder, bool sequence)
    : folder_(std::move(folder)), sequence_(sequence) {
  make_folder(folder_);
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

}  // namespace vantage::apps
