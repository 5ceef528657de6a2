#pragma once

#include <functional>
#include <memory>

#include "engine/io/files/remote_files.h"

namespace vantage {

/// Opens s3://, https:// and http:// addresses; the network is used by the first one. Transfers end
/// with scheduler::Interrupted once `is_interrupted`, which any thread may call.
std::unique_ptr<RemoteFiles> make_store_files(std::function<bool()> is_interrupted);

}  // namespace vantage
