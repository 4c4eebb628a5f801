// gltf/materials/image_texels.cpp - decodes images to texels: in the arena, or in files.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/materials/image_texels.h"

#include "base/checksum.h"
#include "base/text.h"
#include "gltf/parse/specular_glossiness.h"
#include "scene/texel_colors.h"
#include "scene/texel_file.h"

#include <algorithm>
#include <array>
#include <utility>

namespace obscura::gltf {

namespace {

constexpr uint32_t magenta = 0xFFFF00FF;  // RGBA8: no surface looks like it by chance

}  // namespace

size_t original_image(const Document& document, size_t image) {
    const int of = document.images[image].glossiness_of;
    return of < 0 ? image : static_cast<size_t>(of);
}

std::string place_of_image(const Document& document, size_t image) {
    return document.at("images", original_image(document, image));
}

bool is_wide(const Document& document, const ImageState& image, bool srgb) {
    return image.wide || (srgb && document.from_rec709.has_value());
}

size_t arena_texels(const Document& document, const ImageState& image, bool srgb) {
    return (is_wide(document, image, srgb) ? 2U : 1U) * mip_chain_texels(image.width, image.height);
}

/// Decodes an image, and checks that it is the one that was measured.
///
/// In/Out  encoded: given back as soon as it is decoded
Result<ImageRgba8> ImageTexels::decoded_image(size_t image, EncodedImage& encoded, Log& log) const {
    const ImageState& state = images_[image];
    const std::string where = place_of_image(document(), image);
    Result<ImageRgba8> decoded = decode_image(encoded.bytes, where, log, Extent::stored);
    if (!decoded) return decoded;
    encoded.owned = Bytes();
    encoded.charge = {};
    // Levels that the file stores are taken as they are; the others are made from its last one.
    const int width = std::max(state.width >> (decoded->levels - 1), 1);
    const int height = std::max(state.height >> (decoded->levels - 1), 1);
    const size_t last_level =
        mip_chain_texels(state.width, state.height) - mip_chain_texels(width, height);
    const size_t texels = last_level + static_cast<size_t>(width) * static_cast<size_t>(height);
    if (decoded->width != state.width || decoded->height != state.height ||
        decoded->texels.size() != texels || decoded->low_bytes.empty() == state.wide) {
        return fail(ExitCode::bad_resource,
                    "E-IMG-CHANGED",
                    where,
                    "the image's size is not what its header said a moment ago");
    }
    const GltfImage& source = document().images[image];
    if (source.glossiness_of >= 0) {
        roughness_from_glossiness(decoded->texels, decoded->low_bytes, source.glossiness);
    }
    return decoded;
}

Result<void> ImageTexels::decode(size_t image) {
    const ImageState& state = images_[image];
    if (!state.used() || state.broken) return {};
    Result<EncodedImage> encoded =
        load_encoded({document(), sources_.buffers, sources_.folder, sources_.measure_only}, image);
    if (!encoded) return fail(std::move(encoded.error()));
    if (arena_.mapped != nullptr) return map_image(image, *encoded);
    Result<ImageRgba8> decoded = decoded_image(image, *encoded, log_);
    if (!decoded) return fail(std::move(decoded.error()));
    for (size_t srgb = 0; srgb < 2; ++srgb) {
        uint32_t* const base = arena_.texels.data() + state.uses[srgb].base;
        if (state.uses[srgb].used) store_texels(state, *decoded, srgb == 1, base);
    }
    return {};
}

/// All that the texels of an image depend on.
TexelKey ImageTexels::key_of(size_t image, bool srgb, std::span<const std::byte> encoded) const {
    const GltfImage& source = document().images[image];
    std::string settings = OBSCURA_VERSION;
    settings += srgb ? " color" : " data";
    if (source.glossiness_of >= 0) settings += " glossiness " + shortest(source.glossiness);
    if (srgb && document().from_rec709) {
        for (const Xyz& row : *document().from_rec709) {
            for (const double number : row)
                settings += " " + shortest(number);
        }
    }
    return {checksum(encoded), checksum(std::as_bytes(std::span(settings)))};
}

/// Maps the files of an image, which are made where they are not there yet. What its decoding warns
/// of would not be told again: such an image stays in memory.
Result<void> ImageTexels::map_image(size_t image, EncodedImage& encoded) {
    const ImageState& state = images_[image];
    std::array<TexelKey, 2> keys;
    bool has_all = true;
    for (size_t srgb = 0; srgb < 2; ++srgb) {
        if (!state.uses[srgb].used) continue;
        keys[srgb] = key_of(image, srgb == 1, encoded.bytes);
        has_all = has_all && has_texels(texel_file(sources_.limit->folder, keys[srgb]),
                                        keys[srgb],
                                        texels_of_use(state, srgb == 1));
    }
    bool has_warned = false;
    Log heard(log_.verbosity(), [&](const LogMessage& message) {
        has_warned = has_warned || message.is_warning;
        if (message.is_warning) log_.warn(message.where, message.text);
    });
    std::optional<ImageRgba8> decoded;
    if (!has_all) {
        Result<ImageRgba8> done = decoded_image(image, encoded, heard);
        if (!done) return fail(std::move(done.error()));
        decoded = std::move(*done);
    }
    for (size_t srgb = 0; srgb < 2; ++srgb) {
        if (!state.uses[srgb].used) continue;
        Result<void> done = has_warned ? keep_in_memory(image, *decoded, srgb == 1)
                            : has_all  ? map_file(image, srgb == 1, keys[srgb])
                                       : write_and_map(image, *decoded, srgb == 1, keys[srgb]);
        if (!done) note_failure(done.error());
    }
    return {};
}

void ImageTexels::note_failure(const Error& error) {
    const std::lock_guard lock(failing_);
    if (!failure_) failure_ = error;
}

Result<void> ImageTexels::map_file(size_t image, bool srgb, const TexelKey& key) {
    const ImageState& state = images_[image];
    return arena_.mapped->map(state.uses[srgb ? 1 : 0].base,
                              texels_of_use(state, srgb),
                              texel_file(sources_.limit->folder, key),
                              texel_file_head);
}

Result<void> ImageTexels::write_and_map(size_t image,
                                        const ImageRgba8& decoded,
                                        bool srgb,
                                        const TexelKey& key) {
    const ImageState& state = images_[image];
    UnsetArray<uint32_t> texels(texels_of_use(state, srgb));
    store_texels(state, decoded, srgb, texels.data());
    const std::filesystem::path file = texel_file(sources_.limit->folder, key);
    if (auto written = write_texel_file(file, key, texels); !written) return written;
    return map_file(image, srgb, key);
}

Result<void> ImageTexels::keep_in_memory(size_t image, const ImageRgba8& decoded, bool srgb) {
    const ImageState& state = images_[image];
    const size_t base = state.uses[srgb ? 1 : 0].base;
    const Result<uint32_t*> texels = arena_.mapped->memory(base, texels_of_use(state, srgb));
    if (!texels) return fail(texels.error());
    store_texels(state, decoded, srgb, *texels);
    return {};
}

/// Copies an image's texels into the arena, colours in the rendering space, and completes the mip
/// chain below its last stored level.
void ImageTexels::store_texels(const ImageState& state,
                               const ImageRgba8& decoded,
                               bool srgb,
                               uint32_t* base) const {
    const int width = std::max(state.width >> (decoded.levels - 1), 1);
    const int height = std::max(state.height >> (decoded.levels - 1), 1);
    const size_t chain = mip_chain_texels(state.width, state.height);
    const size_t last_level = chain - mip_chain_texels(width, height);
    std::copy(decoded.texels.begin(), decoded.texels.end(), base);
    if (!is_wide(document(), state, srgb))
        return build_mip_chain(base + last_level, width, height, srgb);
    uint32_t* low = base + chain;
    // The low byte of an 8-bit code in 16 bits is the code itself: 255 becomes 65535.
    const auto& low_bytes = state.wide ? decoded.low_bytes : decoded.texels;
    std::copy(low_bytes.begin(), low_bytes.end(), low);
    if (srgb && document().from_rec709) {
        convert_texels(*document().from_rec709, base, low, decoded.texels.size());
    }
    build_wide_mip_chain(base + last_level, low + last_level, width, height, srgb);
}

void ImageTexels::fill_broken(size_t image) {
    const ImageState& state = images_[image];
    const ImageUse& color = state.uses[1];
    if (!color.used) return;
    const size_t texels = texels_of_use(state, true);
    const std::shared_ptr<MappedTexels>& mapped = arena_.mapped;
    if (mapped == nullptr) {
        std::fill_n(arena_.texels.data() + color.base, texels, magenta);
    } else if (const Result<uint32_t*> memory = mapped->memory(color.base, texels)) {
        std::fill_n(*memory, texels, magenta);
    } else {
        note_failure(memory.error());
    }
}

Result<void> ImageTexels::stored() {
    if (failure_) return fail(std::move(*failure_));
    return {};
}

}  // namespace obscura::gltf
