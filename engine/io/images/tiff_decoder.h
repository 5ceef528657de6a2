#pragma once

#include "engine/image/photograph.h"
#include "engine/image/photograph_reading.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/images/image_header.h"

namespace vantage {

/// The pixels of a TIFF or BigTIFF file, by libtiff, as stored. Unsigned integers of 8 bits are
/// 8-bit pixels, of up to 16 bits 16-bit ones (fewer are scaled to 16), all other numbers floats:
/// signed and wide integers, floats of 16 to 64 bits. Palettes, fewer than 8 bits, YCbCr and CMYK
/// become 8-bit grey or RGB. Without a band in `reading`: of more bands than grey or RGB and alpha,
/// the first three if they are RGB, else the mean of all; a remark of the origin says so, and which
/// page was read where none is asked for and there are several. Floats of GDAL's no-data value are
/// NaN. `stated`: what the file says.
/// Reuses `memory` if it has the pixels' depth and size. Throws Error, also for sizes that the file
/// cannot hold, before memory is taken. Thread rule: may be called concurrently.
Photograph decode_tiff(const FileBytes& file, const PhotographReading& reading, Photograph& memory,
                       StatedByFile& stated);

}  // namespace vantage
