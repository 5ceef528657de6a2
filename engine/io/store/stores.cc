#include "engine/io/store/stores.h"

#include <utility>

#include "engine/io/files/remote_files.h"
#include "engine/io/store/folder_store.h"
#include "engine/io/store/http_store.h"
#include "engine/io/store/s3_store.h"

namespace vantage {

Stores::Stores(std::function<bool()> is_interrupted) : client_(std::move(is_interrupted)) {}

std::shared_ptr<ObjectStore> Stores::of(const Address& address) {
  const std::scoped_lock lock(mutex_);
  std::shared_ptr<ObjectStore>& store = stores_[address.with_key("")];
  if (store == nullptr && address.is_s3) {
    store = std::make_shared<S3Store>(address.place, aws_settings(), client_, credentials_);
  } else if (store == nullptr) {
    store = std::make_shared<HttpStore>(address.place, client_);
  }
  return store;
}

Stores::Place Stores::place_of(const std::string& name) {
  if (!is_address(name)) {
    return {std::make_shared<FolderStore>(name), ""};
  }
  const Address address = parse_address(name);
  const bool is_prefix = address.key.empty() || address.key.ends_with('/');
  return {of(address), address.key + (is_prefix ? "" : "/")};
}

}  // namespace vantage
