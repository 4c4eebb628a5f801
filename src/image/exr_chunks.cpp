// image/exr_chunks.cpp - compresses the scan lines of OpenEXR files: ZIP, on all threads.
// SPDX-License-Identifier: Apache-2.0
#include "image/exr_chunks.h"

#include "base/page_map.h"
#include "base/parallel.h"
#include "base/unset_array.h"
#include "image/exr_pixels.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfPartType.h>

#include <Imath/ImathBox.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstring>
#include <isa-l/igzip_lib.h>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>

namespace obscura {

namespace {

static_assert(std::endian::native == std::endian::little, "OpenEXR files are little-endian");

constexpr float largest_zip_half = 65504;

/// Interleaved channels in memory, and where each of them begins in a row of the file.
struct ChunkGroup {
    const float* pixels = nullptr;  ///< of the part's first row
    bool may_have_unused_pages = false;
    bool is_half = false;
    std::vector<size_t> offsets = {};  ///< in bytes
};

/// A part as its chunks have it: in each row all of a channel, then all of the next.
struct ChunkedPart {
    size_t width, height;
    size_t rows;  ///< of a chunk; the last may have fewer
    int top;
    size_t row_bytes = 0;
    std::vector<ChunkGroup> groups = {};

    size_t chunks() const { return (height + rows - 1) / rows; }
};

/// A part without its groups.
///
/// Out     offsets: where each channel begins in a row
ChunkedPart measured(const Imf::Header& header, std::map<std::string, size_t>& offsets) {
    const Imath::Box2i& window = header.dataWindow();
    const Imath::V2i size = window.max - window.min + Imath::V2i(1);
    const size_t rows = header.compression() == Imf::ZIPS_COMPRESSION ? 1 : 16;
    ChunkedPart out{static_cast<size_t>(size.x), static_cast<size_t>(size.y), rows, window.min.y};
    const Imf::ChannelList& channels = header.channels();
    for (auto one = channels.begin(); one != channels.end(); ++one) {
        offsets[one.name()] = out.row_bytes;
        const bool is_half = one.channel().type == Imf::HALF;
        out.row_bytes += out.width * (is_half ? sizeof(half) : sizeof(float));
    }
    return out;
}

ChunkedPart chunked(const ExrPart& part, const Imf::Header& header) {
    std::map<std::string, size_t> offsets;
    ChunkedPart out = measured(header, offsets);
    const auto first = static_cast<size_t>(part.rows.first);
    for (const ExrGroup& group : part.groups) {
        const std::vector<std::string>& names = *group.channels;
        const Imf::Channel& channel = header.channels()[names.front()];
        for_planes(group, [&](const ChannelPlane& plane) {
            ChunkGroup& to = out.groups.emplace_back();
            to.pixels =
                group.pixels->data() + plane.first_value + first * out.width * plane.channels;
            to.is_half = channel.type == Imf::HALF;
            to.may_have_unused_pages = PageMap::can_look_at(*group.pixels);
            for (size_t c = 0; c < plane.channels; ++c)
                to.offsets.push_back(offsets.at(names[plane.first_channel + c]));
        });
    }
    return out;
}

/// What one thread works with.
struct Scratch {
    std::vector<UsedPages> used_pages = {};  ///< of each group, in the rows of a chunk
    UnsetArray<float> floats = {};
    UnsetArray<half> halves = {};
    UnsetArray<unsigned char> plain = {}, planes = {}, packed = {}, matches = {};
    std::unique_ptr<isal_zstream> stream = {};
};

/// A stream that compresses in the format of zlib. Most channels of most layers are nearly
/// constant; level 1 passes over what repeats itself without looking for better matches in it.
void begin_stream(Scratch& scratch, std::span<unsigned char> out) {
    if (!scratch.stream) scratch.stream = std::make_unique<isal_zstream>();
    scratch.matches.resize(ISAL_DEF_LVL1_DEFAULT);
    isal_zstream& stream = *scratch.stream;
    isal_deflate_init(&stream);
    stream.gzip_flag = IGZIP_ZLIB;
    stream.level = 1;
    stream.level_buf = scratch.matches.data();
    stream.level_buf_size = ISAL_DEF_LVL1_DEFAULT;
    stream.next_out = out.data();
    stream.avail_out = static_cast<uint32_t>(out.size());
}

/// Compresses the planes of a chunk.
///
/// Out     empty: they would be no smaller
std::span<const unsigned char> pack(Scratch& scratch) {
    scratch.packed.resize(scratch.planes.size());
    const auto size = static_cast<uint32_t>(scratch.planes.size());  // is_zip_lines: it fits
    begin_stream(scratch, scratch.packed);
    isal_zstream& stream = *scratch.stream;
    // Where a stream begins, ISA-L 2.30 takes its third byte for one that depends on the stream's
    // address, and then finds other matches in one run than in another. A first block that is too
    // short for matches is where that code does not come to; it costs ten bytes.
    const uint32_t first_block = std::min(size, 8U);
    stream.next_in = scratch.planes.data();
    stream.avail_in = first_block;
    stream.flush = SYNC_FLUSH;
    if (isal_deflate(&stream) != COMP_OK) return {};
    stream.avail_in = size - first_block;
    stream.flush = NO_FLUSH;
    stream.end_of_stream = 1;
    const bool fits = isal_deflate(&stream) == COMP_OK &&
                      stream.internal_state.state == ZSTATE_END && stream.total_out < size;
    return fits ? std::span{scratch.packed}.first(stream.total_out) : std::span<unsigned char>{};
}

/// Writes each channel of interleaved pixels for itself.
template <typename Value>
void separate(std::span<const Value> pixels,
              const std::vector<size_t>& offsets,
              unsigned char* row) {
    for (size_t c = 0; c < offsets.size(); ++c) {
        unsigned char* to = row + offsets[c];
        for (size_t i = c; i < pixels.size(); i += offsets.size(), to += sizeof(Value))
            std::memcpy(to, &pixels[i], sizeof(Value));
    }
}

/// Finds the pages of a chunk's rows that hold values; the others are not read.
void find_used_pages(const ChunkedPart& part,
                     const PageMap& map,
                     size_t first,
                     size_t end,
                     std::vector<UsedPages>& out) {
    out.clear();
    for (const ChunkGroup& group : part.groups) {
        const size_t values = part.width * group.offsets.size();
        out.emplace_back();
        if (group.may_have_unused_pages)
            out.back() = map.look_at({group.pixels + first * values, (end - first) * values});
    }
}

/// Writes one row as the file has it before it is compressed.
///
/// Out     how many values were clamped
uint64_t write_row(const ChunkedPart& part, size_t y, Scratch& scratch, unsigned char* row) {
    uint64_t clamped = 0;
    for (size_t i = 0; i < part.groups.size(); ++i) {
        const ChunkGroup& group = part.groups[i];
        const size_t values = part.width * group.offsets.size();
        std::span<const float> floats{group.pixels + y * values, values};
        if (!scratch.used_pages[i].has_all_of(floats)) {
            scratch.floats.resize(values);
            scratch.used_pages[i].copy(floats, scratch.floats.data());
            floats = scratch.floats;
        }
        if (group.is_half) {
            scratch.halves.resize(values);
            clamped += store_halves(floats, largest_zip_half, scratch.halves);
            separate<half>(scratch.halves, group.offsets, row);
        } else {
            separate(floats, group.offsets, row);
        }
    }
    return clamped;
}

/// Two halves of a chunk that are easy to compress, in the way of OpenEXR's ZIP: the bytes at even
/// places and those at odd ones, each as how much it is more than the one before it, plus 128. The
/// very first stays as it is, and the first odd one comes after the last even one.
class BytePlanes {
public:
    explicit BytePlanes(std::span<unsigned char> out)
        : first_even_(out.data()), even_(first_even_), odd_(first_even_ + out.size() / 2) {}

    void add(std::span<const unsigned char> row) {
        const size_t count = row.size() / 2;  // values have two or four bytes
        even_[0] = difference(row[0], last_even_);
        odd_[0] = difference(row[1], last_odd_);
        for (size_t i = 1; i < count; ++i) {
            even_[i] = difference(row[2 * i], row[2 * i - 2]);
            odd_[i] = difference(row[2 * i + 1], row[2 * i - 1]);
        }
        if (even_ == first_even_) {
            first_ = row[0];
            first_odd_ = row[1];
        }
        last_even_ = row[2 * count - 2];
        last_odd_ = row[2 * count - 1];
        even_ += count;
        odd_ += count;
    }

    /// When all rows are added.
    void finish() {
        first_even_[0] = first_;
        *even_ = difference(first_odd_, last_even_);  // where even ones end, odd ones begin
    }

private:
    static unsigned char difference(unsigned char value, unsigned char before) {
        return static_cast<unsigned char>(value - before + 128);
    }

    unsigned char* first_even_;
    unsigned char *even_, *odd_;  ///< where the next row's go
    unsigned char first_ = 0, first_odd_ = 0, last_even_ = 0, last_odd_ = 0;
};

/// The bytes of a chunk: compressed, or plain where that makes them no smaller. They lie in
/// `scratch`.
///
/// In/Out  clamped: counts values that were clamped
std::span<const unsigned char> chunk_bytes(const ChunkedPart& part,
                                           const PageMap& map,
                                           size_t first,
                                           Scratch& scratch,
                                           std::atomic<uint64_t>& clamped) {
    const size_t end = std::min(first + part.rows, part.height);
    const size_t size = (end - first) * part.row_bytes;
    scratch.planes.resize(size);
    scratch.plain.resize(part.row_bytes);
    find_used_pages(part, map, first, end, scratch.used_pages);
    BytePlanes planes(scratch.planes);
    for (size_t y = first; y < end; ++y) {
        clamped += write_row(part, y, scratch, scratch.plain.data());
        planes.add(scratch.plain);
    }
    planes.finish();
    if (const auto packed = pack(scratch); !packed.empty()) return packed;
    scratch.plain.resize(size);
    for (size_t y = first; y < end; ++y)
        write_row(part, y, scratch, &scratch.plain[(y - first) * part.row_bytes]);
    return scratch.plain;
}

void append(int32_t number, std::vector<char>& out) {
    const auto bytes = std::bit_cast<std::array<char, sizeof number>>(number);
    out.insert(out.end(), bytes.begin(), bytes.end());
}

using Chunk = std::vector<char>;

/// Its part's number, its first row and the size of its data.
constexpr size_t max_chunk_header = 3 * sizeof(int32_t);

/// Appends a part's chunks as they lie in the file.
///
/// In      number: of the part, in a file of several
void append_chunks(const ChunkedPart& part,
                   std::optional<int32_t> number,
                   std::vector<Chunk>& chunks,
                   std::atomic<uint64_t>& clamped) {
    const size_t before = chunks.size();
    chunks.resize(before + part.chunks());
    std::vector<Scratch> scratches(max_thread_index());
    const PageMap map;
    parallel_for(part.chunks(), [&](size_t i) {
        const size_t first = i * part.rows;
        const std::span<const unsigned char> data =
            chunk_bytes(part, map, first, scratches[thread_index()], clamped);
        Chunk& chunk = chunks[before + i];
        chunk.reserve(max_chunk_header + data.size());
        if (number) append(*number, chunk);
        append(part.top + static_cast<int32_t>(first), chunk);
        append(static_cast<int32_t>(data.size()), chunk);
        chunk.insert(chunk.end(), data.begin(), data.end());
    });
}

}  // namespace

bool is_zip_lines(const Imf::Header& header) {
    const Imf::Compression codec = header.compression();
    std::map<std::string, size_t> offsets;
    const ChunkedPart part = measured(header, offsets);
    return header.type() == Imf::SCANLINEIMAGE && header.lineOrder() == Imf::INCREASING_Y &&
           (codec == Imf::ZIP_COMPRESSION || codec == Imf::ZIPS_COMPRESSION) &&
           part.rows * part.row_bytes < std::numeric_limits<int32_t>::max() - max_chunk_header;
}

uint64_t write_zip_chunks(ExrMemoryWriter& out,
                          const std::vector<ExrPart>& parts,
                          const std::vector<Imf::Header>& headers) {
    std::atomic<uint64_t> clamped = 0;
    std::vector<Chunk> chunks;
    for (size_t i = 0; i < parts.size(); ++i) {
        std::optional<int32_t> number;
        if (parts.size() > 1) number = static_cast<int32_t>(i);
        append_chunks(chunked(parts[i], headers[i]), number, chunks, clamped);
    }
    uint64_t bytes = 0;
    for (const Chunk& chunk : chunks)
        bytes += chunk.size();
    const uint64_t end_of_tables = out.tellp();
    out.expect(bytes);
    std::vector<uint64_t> offsets;
    for (Chunk& chunk : chunks) {
        offsets.push_back(out.tellp());
        out.write(chunk.data(), static_cast<int>(chunk.size()));
        chunk = Chunk();  // so that the file is not in memory twice; = {} would keep it
    }
    const std::span<const uint64_t> table = offsets;
    out.seekp(end_of_tables - table.size_bytes());
    out.write(reinterpret_cast<const char*>(table.data()), static_cast<int>(table.size_bytes()));
    return clamped;
}

}  // namespace obscura
