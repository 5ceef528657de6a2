#pragma once

#include <memory>

#include "engine/io/video/sound_input.h"
#include "engine/io/video/sound_packets.h"

namespace vantage {

/// Decodes the sound of `input`, which must have some, cuts it to the part's samples and encodes it
/// as AAC: mono stays mono, everything else becomes stereo. Throws Error naming the file when it
/// cannot be decoded.
std::unique_ptr<SoundPackets> make_encoded_sound(SoundInput input);

}  // namespace vantage
