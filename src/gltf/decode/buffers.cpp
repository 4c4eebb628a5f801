// gltf/decode/buffers.cpp - loads a document's buffers; bounds-checked access to their bytes.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/decode/buffers.h"

#include "gltf/parse/uri.h"

#include <utility>

namespace obscura::gltf {

namespace {

std::string bytes_text(uint64_t have, uint64_t need) {
    return "has " + std::to_string(have) + " bytes, but byteLength is " + std::to_string(need);
}

bool accepted_buffer_mime(const std::string& mime) {
    return mime.empty() || mime == "application/octet-stream" || mime == "application/gltf-buffer";
}

/// Out     charge: what the bytes take
Result<Bytes> load_from_uri(const GltfBuffer& buffer,
                            const BufferSources& sources,
                            const std::string& where,
                            MemoryCharge& charge) {
    const std::string name = is_data_uri(*buffer.uri) ? where : *buffer.uri;
    const auto take = [&](uint64_t bytes) -> Result<void> {
        Result<MemoryCharge> taken = charge_memory(MemoryUse::buffers, name, bytes);
        if (!taken) return fail(std::move(taken.error()));
        charge = std::move(*taken);
        return {};
    };
    const ReadLimits limits{UINT64_MAX, buffer.byte_length, take};
    Result<UriBytes> read = read_uri(*buffer.uri, {sources.folder, where + "/uri"}, limits);
    if (!read) return fail(std::move(read.error()));
    const bool inline_data = is_data_uri(*buffer.uri);
    if (inline_data && !accepted_buffer_mime(read->mime)) {
        return fail(ExitCode::bad_data,
                    "E-URI-DATA",
                    where + "/uri",
                    "the media type \"" + read->mime +
                        "\" is not accepted for a buffer; accepted are application/octet-stream "
                        "and application/gltf-buffer");
    }
    if (read->size < buffer.byte_length) {
        return fail(inline_data ? ExitCode::bad_data : ExitCode::bad_resource,
                    inline_data ? "E-BUF-LENGTH" : "E-RES-SHORT",
                    where,
                    "the buffer's " + std::string(inline_data ? "data URI " : "file ") +
                        bytes_text(read->size, buffer.byte_length));
    }
    read->bytes.resize(buffer.byte_length);
    return std::move(read->bytes);
}

/// A buffer without uri: the GLB's own chunk.
Result<std::span<const std::byte>> bytes_without_uri(const Document& document,
                                                     size_t index,
                                                     const BufferSources& sources) {
    const GltfBuffer& buffer = document.buffers[index];
    const std::string where = document.at("buffers", index);
    if (index == 0 && sources.glb_binary) {
        if (sources.glb_binary->size() < buffer.byte_length) {
            return fail(ExitCode::bad_data,
                        "E-BUF-LENGTH",
                        where + "/byteLength",
                        "the GLB's binary chunk " +
                            bytes_text(sources.glb_binary->size(), buffer.byte_length));
        }
        return sources.glb_binary->first(buffer.byte_length);
    }
    return fail(ExitCode::bad_data,
                "E-BUF-SOURCE",
                where,
                "the buffer has no uri, and there is no binary chunk of a GLB for it");
}

/// True for buffers that hold nothing but uncompressed copies of compressed views.
std::vector<char> find_placeholders(const Document& document) {
    enum : char { unused, copies, data };
    std::vector<char> uses(document.buffers.size(), unused);
    for (const GltfBufferView& view : document.views) {
        char& use = uses[static_cast<size_t>(view.buffer)];
        if (view.meshopt.buffer < 0) {
            use = data;
            continue;
        }
        if (use == unused) use = copies;
        uses[static_cast<size_t>(view.meshopt.buffer)] = data;
    }
    for (char& use : uses)
        use = use == copies ? 1 : 0;
    return uses;
}

}  // namespace

Result<BufferStore> load_buffers(const Document& document, const BufferSources& sources, Log& log) {
    BufferStore store;
    store.buffers.resize(document.buffers.size());
    store.owned.resize(document.buffers.size());
    store.charges.resize(document.buffers.size());
    const std::vector<char> placeholders = find_placeholders(document);
    std::vector<Error> errors;
    for (size_t i = 0; i < document.buffers.size(); ++i) {
        if (placeholders[i] != 0) continue;
        const GltfBuffer& buffer = document.buffers[i];
        if (buffer.uri) {
            Result<Bytes> bytes =
                load_from_uri(buffer, sources, document.at("buffers", i), store.charges[i]);
            if (bytes) store.owned[i] = std::move(*bytes);
            if (!bytes) errors.push_back(std::move(bytes.error()));
            store.buffers[i] = store.owned[i];
        } else {
            const auto bytes = bytes_without_uri(document, i, sources);
            if (bytes) store.buffers[i] = *bytes;
            if (!bytes) errors.push_back(bytes.error());
        }
    }
    if (!errors.empty()) return fail(joined(std::move(errors)));
    if (sources.glb_binary && document.buffers.empty()) {
        log.warn(document.file, "no buffer refers to the GLB's binary chunk");
    }
    return store;
}

std::optional<uint64_t> range_extent(const ElementRange& range, uint64_t total) {
    if (range.offset > total) return std::nullopt;
    if (range.count == 0) return 0;
    uint64_t steps = 0;
    uint64_t extent = 0;
    uint64_t end = 0;
    if (__builtin_mul_overflow(range.count - 1, range.stride, &steps) ||
        __builtin_add_overflow(steps, range.element_size, &extent) ||
        __builtin_add_overflow(range.offset, extent, &end) || end > total) {
        return std::nullopt;
    }
    return extent;
}

std::optional<std::span<const std::byte>> checked_span(std::span<const std::byte> bytes,
                                                       const ElementRange& range) {
    const std::optional<uint64_t> extent = range_extent(range, bytes.size());
    if (!extent) return std::nullopt;
    return bytes.subspan(range.offset, *extent);
}

std::span<const std::byte> view_bytes(const Document& document,
                                      const BufferStore& store,
                                      int view) {
    const GltfBufferView& record = document.views[static_cast<size_t>(view)];
    if (record.meshopt.buffer >= 0) {
        const size_t index = static_cast<size_t>(view);
        return index < store.decoded.size() ? store.decoded[index] : std::span<const std::byte>();
    }
    const std::span<const std::byte> buffer = store.buffers[static_cast<size_t>(record.buffer)];
    const auto bytes = checked_span(buffer, {record.byte_offset, 1, record.byte_length, 1});
    return bytes.value_or(std::span<const std::byte>());
}

void release_geometry(const Document& document, BufferStore& store) {
    std::vector<char> needed(store.buffers.size(), 0);
    std::vector<Bytes> decoded(store.decoded.size());
    for (const GltfImage& image : document.images) {
        if (image.view < 0) continue;
        const size_t view = static_cast<size_t>(image.view);
        needed[static_cast<size_t>(document.views[view].buffer)] = 1;
        if (view < decoded.size() && decoded[view].empty()) {
            decoded[view].swap(store.decoded[view]);
        }
    }
    for (size_t i = 0; i < needed.size(); ++i) {
        if (needed[i] != 0) continue;
        store.owned[i] = Bytes();
        store.buffers[i] = {};
        store.charges[i] = {};
    }
    store.decoded = std::move(decoded);
    uint64_t kept = 0;
    for (const Bytes& view : store.decoded)
        kept += view.size();
    if (kept == 0) store.decoded_charge = {};
}

}  // namespace obscura::gltf
