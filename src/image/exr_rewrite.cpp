// image/exr_rewrite.cpp - writes an OpenEXR file again with other values in some channels.
// SPDX-License-Identifier: Apache-2.0
#include "image/exr_document.h"
#include "image/exr_guard.h"
#include "image/exr_parts.h"
#include "image/exr_pixels.h"
#include "image/exr_stream.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTiledInputPart.h>
#include <OpenEXR/ImfTiledOutputPart.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

namespace obscura {

namespace {

/// One part of the file that is written.
struct PlannedPart {
    int from = 0;         ///< index of the part that it is made from
    bool is_new = false;  ///< it has no channel of that
    Imf::Header header;
    std::vector<const ExrChange*> changes = {};  ///< none: it is copied
};

/// A rewritten part keeps its codec if that does not round what is not changed: PXR24 has rounded
/// it for good, B44 leaves floats and DWA alpha as they are.
void choose_codec(const Imf::ChannelList& channels, PlannedPart& part) {
    const Imf::Compression codec = part.header.compression();
    const bool is_dwa = codec == Imf::DWAA_COMPRESSION || codec == Imf::DWAB_COMPRESSION;
    const bool is_b44 = codec == Imf::B44_COMPRESSION || codec == Imf::B44A_COMPRESSION;
    if (part.is_new || !(is_dwa || is_b44)) return;
    std::set<std::string> changed;
    for (const ExrChange* const change : part.changes)
        changed.insert(change->channels.begin(), change->channels.end());
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        const std::string name = channel.name();
        const bool is_kept = is_dwa ? name == "A" : channel.channel().type == Imf::FLOAT;
        if (is_kept || changed.contains(name)) continue;
        part.header.compression() = Imf::ZIP_COMPRESSION;
    }
}

void add_change(const ExrChange& change, PlannedPart& part) {
    part.changes.push_back(&change);
    Imf::ChannelList& channels = part.header.channels();
    for (const std::string& name : change.channels) {
        if (channels.findChannel(name) != nullptr) continue;
        channels.insert(name,
                        Imf::Channel(change.depth == ExrDepth::half ? Imf::HALF : Imf::FLOAT));
    }
    for (const ImageAttribute& attribute : change.attributes)
        insert_attribute(part.header, attribute);
}

/// Takes away what a header says of its part's own channels.
void make_empty(const std::string& name, Imf::Header& header) {
    header.channels() = {};
    header.setName(name);
    std::vector<std::string> own;
    for (auto one = header.begin(); one != header.end(); ++one) {
        const std::string attribute = one.name();
        if (attribute.starts_with("cryptomatte/") || attribute.starts_with("obscura:layer:"))
            own.push_back(attribute);
    }
    for (const std::string& attribute : own)
        header.erase(attribute);
}

std::vector<PlannedPart> plan_parts(const Imf::MultiPartInputFile& in,
                                    std::span<const ExrChange> changes,
                                    std::span<const ImageAttribute> attributes) {
    std::vector<PlannedPart> parts;
    for (int i = 0; i < in.parts(); ++i)
        parts.push_back({.from = i, .header = in.header(i)});
    for (const ExrChange& change : changes) {
        const auto from = static_cast<int>(change.part);
        if (change.new_part.empty()) {
            add_change(change, parts[change.part]);
            continue;
        }
        parts.push_back({.from = from, .is_new = true, .header = in.header(from)});
        make_empty(change.new_part, parts.back().header);
        add_change(change, parts.back());
    }
    for (PlannedPart& part : parts) {
        if (!part.changes.empty()) {
            choose_codec(in.header(part.from).channels(), part);
            part.header.zipCompressionLevel() = 3;  // see insert_storage in exr_header.cpp
        }
        for (const ImageAttribute& attribute : attributes)
            insert_attribute(part.header, attribute);
    }
    return parts;
}

/// Channels of some rows in memory, of the types that the file has.
class NativeRows {
public:
    NativeRows(const Imf::Header& header, const Imath::Box2i& window)
        : channels_(header.channels()), window_(window), largest_(largest_half(header)) {
        for (auto one = channels_.begin(); one != channels_.end(); ++one) {
            const size_t size = value_bytes(one.channel().type);
            UnsetArray<char>& values = values_[one.name()];
            values.resize(size * width() * height());
            frame_.insert(
                one.name(),
                Imf::Slice::Make(one.channel().type, values.data(), window, size, size * width()));
        }
    }

    Imf::FrameBuffer& frame() { return frame_; }

    /// Those of them that the part has in the file that is read.
    Imf::FrameBuffer frame_of(const Imf::ChannelList& read) {
        Imf::FrameBuffer out;
        for (auto one = frame_.begin(); one != frame_.end(); ++one) {
            if (read.findChannel(one.name()) != nullptr) out.insert(one.name(), one.slice());
        }
        return out;
    }

    /// Replaces channels by some of interleaved pixels, from that value on.
    ///
    /// Out     how many values were clamped
    uint64_t store(const ExrChange& change, const float* from) {
        const size_t stride = change.channels.size();
        UnsetArray<float> plain(width() * height());
        uint64_t clamped = 0;
        for (size_t c = 0; c < stride; ++c) {
            for (size_t i = 0; i < plain.size(); ++i)
                plain[i] = from[i * stride + c];
            UnsetArray<char>& to = values_.at(change.channels[c]);
            if (channels_.findChannel(change.channels[c])->type == Imf::FLOAT) {
                std::memcpy(to.data(), plain.data(), to.size());
            } else {
                UnsetArray<half> halves(plain.size());
                clamped += store_many_halves(plain, largest_, halves);
                std::memcpy(to.data(), halves.data(), to.size());
            }
        }
        return clamped;
    }

private:
    static size_t value_bytes(Imf::PixelType type) {
        return type == Imf::HALF ? sizeof(half) : sizeof(float);  // whole numbers have four, too
    }
    size_t width() const {
        const int width = window_.max.x - window_.min.x + 1;
        return static_cast<size_t>(width);
    }
    size_t height() const {
        const int height = window_.max.y - window_.min.y + 1;
        return static_cast<size_t>(height);
    }

    const Imf::ChannelList& channels_;
    Imath::Box2i window_;
    float largest_;
    std::map<std::string, UnsetArray<char>> values_;
    Imf::FrameBuffer frame_;
};

/// Files that are read and written at once.
struct Files {
    Imf::MultiPartInputFile& in;
    Imf::MultiPartOutputFile& out;
};

uint64_t rewrite_lines(const Files& files, int index, const PlannedPart& part) {
    Imf::InputPart in(files.in, part.from);
    Imf::OutputPart out(files.out, index);
    const Imath::Box2i whole = part.header.dataWindow();
    const int height = whole.max.y - whole.min.y + 1;
    const int columns = whole.max.x - whole.min.x + 1;
    const auto width = static_cast<size_t>(columns);
    // Enough blocks of each codec for all threads; lines that begin below are written in one go.
    constexpr int many_rows = 4096;
    const int step = part.header.lineOrder() == Imf::INCREASING_Y ? many_rows : height;
    uint64_t clamped = 0;
    for (int first = 0; first < height; first += step) {
        Imath::Box2i window = whole;
        window.min.y = whole.min.y + first;
        window.max.y = std::min(window.min.y + step - 1, whole.max.y);
        NativeRows rows(part.header, window);
        if (!part.is_new) {
            in.setFrameBuffer(rows.frame_of(in.header().channels()));
            in.readPixels(window.min.y, window.max.y);
        }
        for (const ExrChange* const change : part.changes) {
            const size_t before = static_cast<size_t>(first) * width * change->channels.size();
            clamped += rows.store(*change, change->pixels.data() + before);
        }
        out.setFrameBuffer(rows.frame());
        out.writePixels(window.max.y - window.min.y + 1);
    }
    return clamped;
}

/// What a level of a mipmap has of changed channels.
struct Shrunken {
    const ExrChange& change;
    PixelView view;
    UnsetArray<float> level = {};

    void shrink() {
        UnsetArray<float> smaller = half_as_large(view, true);
        level = std::move(smaller);
        view = {
            level.data(), std::max(view.width / 2, 1), std::max(view.height / 2, 1), view.channels};
    }
};

uint64_t rewrite_tiles(const Files& files, int index, const PlannedPart& part) {
    Imf::TiledInputPart in(files.in, part.from);
    Imf::TiledOutputPart out(files.out, index);
    const Imath::Box2i whole = part.header.dataWindow();
    std::vector<Shrunken> changed;
    for (const ExrChange* const change : part.changes) {
        changed.push_back({*change,
                           {change->pixels.data(),
                            whole.max.x - whole.min.x + 1,
                            whole.max.y - whole.min.y + 1,
                            change->channels.size()}});
    }
    uint64_t clamped = 0;
    for (int level = 0; level < out.numLevels(); ++level) {
        NativeRows rows(part.header, out.dataWindowForLevel(level));
        const int last_x = out.numXTiles(level) - 1;
        const int last_y = out.numYTiles(level) - 1;
        if (!part.is_new) {
            in.setFrameBuffer(rows.frame_of(in.header().channels()));
            in.readTiles(0, last_x, 0, last_y, level);
        }
        for (Shrunken& one : changed) {
            if (level > 0) one.shrink();
            const uint64_t here = rows.store(one.change, one.view.pixels);
            if (level == 0) clamped += here;
        }
        out.setFrameBuffer(rows.frame());
        out.writeTiles(0, last_x, 0, last_y, level);
    }
    return clamped;
}

bool is_tiled(const Imf::Header& header) {
    return header.hasTileDescription();
}

void copy_part(const Files& files, int index, const PlannedPart& part) {
    if (is_tiled(part.header)) {
        Imf::TiledInputPart in(files.in, part.from);
        Imf::TiledOutputPart(files.out, index).copyPixels(in);
    } else {
        Imf::InputPart in(files.in, part.from);
        Imf::OutputPart(files.out, index).copyPixels(in);
    }
}

Result<void> check_levels(const PlannedPart& part, const std::string& where) {
    const Imf::Header& header = part.header;
    if (part.changes.empty() || !is_tiled(header)) return {};
    const Imf::TileDescription& tiles = header.tileDescription();
    if (tiles.mode != Imf::RIPMAP_LEVELS && tiles.roundingMode == Imf::ROUND_DOWN) return {};
    return fail(ExitCode::bad_data,
                "E-EXR-FORMAT",
                where,
                "its smaller copies are ripmaps or rounded up; expected mipmaps, rounded down");
}

}  // namespace

Result<EncodedFile> ExrDocument::with_changes(std::span<const ExrChange> changes,
                                              std::span<const ImageAttribute> attributes) const {
    return guarded_exr(where_, [&]() -> Result<EncodedFile> {
        ExrMemoryReader reader(*bytes_, where_.c_str());
        const int threads = compression_threads(bytes_->size() / sizeof(half));
        Imf::MultiPartInputFile in(reader, threads);
        const std::vector<PlannedPart> parts = plan_parts(in, changes, attributes);
        std::vector<Imf::Header> headers;
        EncodedFile file;
        for (const PlannedPart& part : parts) {
            if (auto sound = check_levels(part, where_); !sound) return fail(sound.error());
            headers.push_back(part.header);
            file.report.lossless_instead |=
                part.header.compression() != in.header(part.from).compression();
            file.report.largest_half =
                std::min(file.report.largest_half, largest_half(part.header));
        }
        ExrMemoryWriter writer(where_.c_str());
        {
            Imf::MultiPartOutputFile out(
                writer, headers.data(), static_cast<int>(headers.size()), false, threads);
            const Files files{in, out};
            for (size_t i = 0; i < parts.size(); ++i) {
                const int index = static_cast<int>(i);
                if (parts[i].changes.empty()) {
                    copy_part(files, index, parts[i]);
                } else if (is_tiled(parts[i].header)) {
                    file.report.clamped_values += rewrite_tiles(files, index, parts[i]);
                } else {
                    file.report.clamped_values += rewrite_lines(files, index, parts[i]);
                }
            }
        }  // the tables of offsets are written here
        file.bytes = writer.take();
        return file;
    });
}

}  // namespace obscura
