#include "engine/io/maps/npy_volume_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <span>
#include <utility>

#include "engine/error.h"
#include "engine/io/maps/npy.h"

namespace vantage {
namespace {

FileDescriptor open_to_write(const std::filesystem::path& file, const std::filesystem::path& path) {
  FileDescriptor descriptor(::open(file.c_str(), O_WRONLY | O_CLOEXEC));
  if (!descriptor.valid()) {
    fail_to_write(path, errno);
  }
  return descriptor;
}

}  // namespace

NpyVolumeFile::NpyVolumeFile(const std::filesystem::path& path, std::optional<VolumeRows> rows,
                             bool transposed)
    : path_(path),
      target_(path),
      file_(open_to_write(target_.temporary_path(), path)),
      rows_(rows),
      transposed_(transposed) {}

std::vector<int> NpyVolumeFile::file_shape() const {
  std::vector<int> shape = {rows_->end - rows_->begin, width()};
  if (shape_.disparities_y) {
    shape.push_back(shape_.disparities_y->count());
  }
  shape.push_back(shape_.row_candidates());
  return shape;
}

void NpyVolumeFile::start(const VolumeShape& shape) {
  shape_ = shape;
  if (!rows_) {
    rows_ = VolumeRows{0, height()};
  }
  if (rows_->begin < 0 || rows_->begin >= rows_->end || rows_->end > height()) {
    throw UsageError(fmt::format("volume-rows is {}:{}, expected rows within 0:{}", rows_->begin,
                                 rows_->end - 1, height() - 1));
  }
  const std::vector<std::uint8_t> header = npy_float_header(file_shape());
  first_byte_ = header.size();
  if (!write_all_at(file_.get(), 0, header)) {
    fail_to_write(path_, errno);
  }
}

void NpyVolumeFile::write(int x, int y, int columns, const float* values) {
  if (!transposed_) {
    write_part(x, y, columns, values);
    return;
  }
  for (int j = 0; j < columns; ++j) {
    write_part(y, x + j, 1, values + static_cast<std::ptrdiff_t>(j) * shape_.candidates());
  }
}

void NpyVolumeFile::write_part(int x, int y, int columns, const float* values) const {
  if (y < rows_->begin || y >= rows_->end) {
    return;
  }
  const auto candidates = static_cast<std::size_t>(shape_.candidates());
  const std::size_t pixel =
      static_cast<std::size_t>(y - rows_->begin) * static_cast<std::size_t>(width()) +
      static_cast<std::size_t>(x);
  const std::span<const std::uint8_t> bytes(
      reinterpret_cast<const std::uint8_t*>(values),
      sizeof(float) * candidates * static_cast<std::size_t>(columns));
  if (!write_all_at(file_.get(), first_byte_ + sizeof(float) * candidates * pixel, bytes)) {
    fail_to_write(path_, errno);
  }
}

void NpyVolumeFile::commit() {
  if (!file_.close()) {
    fail_to_write(path_, errno);
  }
  target_.commit();
}

}  // namespace vantage
