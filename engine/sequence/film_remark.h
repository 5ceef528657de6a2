#pragma once

#include <optional>

#include "engine/remark.h"
#include "engine/sequence/options/sequence_options.h"

namespace vantage {

/// What becomes of what the input states of its pictures (`film`), of which `options.film` is what
/// videos state; `is_streamed`: the output is a stream. Empty: there is nothing but the usual.
std::optional<Remark> film_remark(const FilmFormat& film, const SequenceOptions& options,
                                  bool is_streamed);

}  // namespace vantage
