#pragma once

#include <functional>
#include <memory>
#include <string>

#include "engine/io/store/object_store.h"

namespace vantage {

/// The objects below a folder: one of this machine, or s3://bucket/prefix; keys are relative to it.
/// Transfers end with scheduler::Interrupted once `is_interrupted`, which any thread may call.
/// Throws UsageError for other addresses.
std::unique_ptr<ObjectStore> open_store(const std::string& folder,
                                        std::function<bool()> is_interrupted);

}  // namespace vantage
