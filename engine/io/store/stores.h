#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "engine/io/store/address.h"
#include "engine/io/store/aws_credentials.h"
#include "engine/io/store/http_client.h"
#include "engine/io/store/object_store.h"

namespace vantage {

/// The stores that a process uses, each opened once, with their connections and keys. Thread rule:
/// may be used concurrently.
class Stores {
 public:
  /// Transfers end with scheduler::Interrupted once `is_interrupted`, which any thread may call.
  explicit Stores(std::function<bool()> is_interrupted);

  /// The bucket or server of an address. It must not outlive this object. Throws Error where its
  /// settings are wrong; nothing is sent yet.
  std::shared_ptr<ObjectStore> of(const Address& address);
  [[nodiscard]] const HttpClient& client() const { return client_; }

  /// Objects below a place: keys begin with `prefix`.
  struct Place {
    std::shared_ptr<ObjectStore> store;
    std::string prefix;  ///< empty, or ends in /
  };
  /// That of results: s3://bucket/prefix, or a local folder. As of().
  Place place_of(const std::string& name);

 private:
  HttpClient client_;
  AwsCredentials credentials_{client_};
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<ObjectStore>> stores_;
};

}  // namespace vantage
