#include "engine/io/store/object_store.h"

#include "engine/io/files/random_access_file.h"

namespace vantage {

std::optional<std::string> ObjectStore::put_file(const std::string& key,
                                                 const std::filesystem::path& file,
                                                 const PutCondition& condition) {
  const std::unique_ptr<RandomAccessFile> source = open_random_access(file);
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(source->size()));
  bytes.resize(source->read(0, bytes));
  return put(key, bytes, condition);
}

}  // namespace vantage
