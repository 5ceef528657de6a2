#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/files/random_access_file.h"

namespace vantage {

/// What is known of a file, or of a folder, before it is read.
struct FileStatus {
  bool is_folder = false;
  std::uint64_t bytes = 0;
  std::string version = {};  ///< at an address: another one once the content is another
};

/// Reads and writes files at addresses. All functions throw Error naming the address,
/// scheduler::Interrupted. Thread rule: may be used concurrently.
class RemoteFiles {
 public:
  RemoteFiles() = default;
  RemoteFiles(const RemoteFiles&) = delete;
  RemoteFiles& operator=(const RemoteFiles&) = delete;
  virtual ~RemoteFiles() = default;

  /// Empty if there is none. A file that has been asked for, listed or read is that file from then
  /// on: reading another content at its address is an error.
  virtual std::optional<FileStatus> status(const std::string& address) = 0;
  /// The whole file. Error beyond `max_bytes`.
  virtual std::vector<std::uint8_t> read(const std::string& address, std::uint64_t max_bytes) = 0;
  /// read() of this file will follow soon: begins with it.
  virtual void read_ahead(const std::string& address) = 0;
  virtual std::unique_ptr<RandomAccessFile> open(const std::string& address) = 0;
  /// Names of the files directly in a folder, in no order.
  virtual std::vector<std::string> names(const std::string& folder) = 0;
  /// Throws Error if nothing can be written at `address`, as far as that can be told.
  virtual void check_writable(const std::string& address) = 0;
  /// Makes the content of the local `file` that of `address`; false if `if_absent` and one is
  /// there.
  virtual bool write(const std::string& address, const std::filesystem::path& file,
                     bool if_absent) = 0;
  /// What is at addresses, and how they are reached, may be another from now on.
  virtual void forget() = 0;
};

/// Whether `path` is none of this machine's: s3://, https://, http://.
bool is_address(const std::filesystem::path& path);

/// What opens addresses in this process from now on. The program and the Python module install
/// one; without it addresses are refused. Call it once, before they are used.
void install_remote_files(std::unique_ptr<RemoteFiles> files);
/// The installed one. Throws Error naming `address` where there is none.
RemoteFiles& remote_files(const std::filesystem::path& address);
/// forget() of the installed one, if there is one.
void forget_remote_files();

// Of inputs, local or at an address; links are followed.
/// Whether there is a file or a folder.
bool is_there(const std::filesystem::path& path);
bool is_file(const std::filesystem::path& path);
bool is_folder(const std::filesystem::path& path);
/// Of a file; 0 where it is missing.
std::uint64_t bytes_of_file(const std::filesystem::path& path);

/// RemoteFiles::read_ahead(); nothing for a local file, which the system reads ahead.
void read_ahead(const std::filesystem::path& path);

/// `folder` / `name`; an address is itself.
std::filesystem::path joined_path(const std::filesystem::path& folder,
                                  const std::filesystem::path& name);
/// As std::filesystem::absolute(); an address is itself.
std::filesystem::path absolute_path(const std::filesystem::path& path);
/// Throws Error for an address: folders of results are local.
void require_local_folder(const std::filesystem::path& folder);

}  // namespace vantage
