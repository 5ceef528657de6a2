#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "engine/image/volume_sink.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/file_descriptor.h"

namespace vantage {

/// Rows [begin, end) of a volume.
struct VolumeRows {
  int begin = 0;
  int end = 0;
};

/// Writes a volume as a NumPy array file: <f4 in C order, of shape (rows, columns, candidates) or,
/// for a two-dimensional search, (rows, columns, vertical candidates, horizontal candidates). Parts
/// are written where they belong as they come; nothing is kept in memory. The file has its final
/// name after commit().
///
/// Thread rule: write() may be called concurrently, as VolumeSink says; all else one thread at a
/// time.
class NpyVolumeFile final : public VolumeSink {
 public:
  /// `rows`: the only ones to store; empty: all. `transposed`: rows of the file are columns of the
  /// volume. Throws Error where no file can be created.
  NpyVolumeFile(const std::filesystem::path& path, std::optional<VolumeRows> rows, bool transposed);

  /// Throws UsageError for rows that the volume does not have, Error when the file cannot be
  /// written; so does write().
  void start(const VolumeShape& shape) override;
  void write(int x, int y, int columns, const float* values) override;
  /// Call it once, after all parts. Throws Error.
  void commit();

  /// Of the volume, and of the file; after start().
  [[nodiscard]] const VolumeShape& volume() const { return shape_; }
  [[nodiscard]] std::vector<int> file_shape() const;
  [[nodiscard]] VolumeRows rows() const { return *rows_; }

 private:
  /// Values of `columns` columns that follow each other in row y of the file.
  void write_part(int x, int y, int columns, const float* values) const;
  /// Of the file.
  [[nodiscard]] int width() const { return transposed_ ? shape_.height_px : shape_.width_px; }
  [[nodiscard]] int height() const { return transposed_ ? shape_.width_px : shape_.height_px; }

  std::filesystem::path path_;
  AtomicFile target_;
  FileDescriptor file_;
  std::optional<VolumeRows> rows_;
  bool transposed_;
  VolumeShape shape_;
  std::size_t first_byte_ = 0;  ///< of the values
};

}  // namespace vantage
