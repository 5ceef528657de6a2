#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <memory>
#include <vector>

#include "engine/io/files/random_access_file.h"

struct AVFormatContext;
struct AVIOContext;

namespace vantage {

/// A film at an address, as libav reads it. Thread rule: one thread at a time.
class RemoteInput {
 public:
  /// Throws Error when it is missing.
  explicit RemoteInput(const std::filesystem::path& address);
  RemoteInput(const RemoteInput&) = delete;
  RemoteInput& operator=(const RemoteInput&) = delete;
  ~RemoteInput();

  /// Makes `input`, not yet opened, read it. Destroy it after `input`.
  void attach_to(AVFormatContext& input);
  /// What reading has thrown, which no exception can carry through libav.
  void rethrow() const;

 private:
  static int read(void* self, std::uint8_t* bytes, int size);
  static std::int64_t seek(void* self, std::int64_t offset, int origin);

  std::unique_ptr<RandomAccessFile> file_;
  std::uint64_t place_ = 0;
  std::exception_ptr problem_;
  AVIOContext* io_;
};

}  // namespace vantage
