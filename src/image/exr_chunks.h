// image/exr_chunks.h - compresses the scan lines of OpenEXR files: ZIP, on all threads.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/exr_parts.h"
#include "image/exr_stream.h"

#include <OpenEXR/ImfHeader.h>

#include <cstdint>
#include <vector>

namespace obscura {

/// True when write_zip_chunks can write a part: scan lines with ZIP or ZIPS.
bool is_zip_lines(const Imf::Header& header);

/// Writes what follows the headers of a file: the parts' pixels, in chunks, and where in the file
/// these are. OpenEXR's own functions would write the same pixels, but pack them on one thread and
/// compress them with zlib, which takes several times as long.
///
/// In      out: a file whose headers are written and whose tables of offsets, which end here, are
///         still empty; headers: those of the parts, for each of which is_zip_lines is true
/// Out     how many values were clamped
uint64_t write_zip_chunks(ExrMemoryWriter& out,
                          const std::vector<ExrPart>& parts,
                          const std::vector<Imf::Header>& headers);

}  // namespace obscura
