// gltf/materials/image_texels.h - decodes images to texels: in the arena, or in files that it maps.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/log.h"
#include "gltf/decode/encoded_image.h"
#include "gltf/materials/textures.h"
#include "image/decode.h"

#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace obscura::gltf {

/// The image in the file, also of one that the loader has made from it.
size_t original_image(const Document& document, size_t image);
std::string place_of_image(const Document& document, size_t image);

/// True when a use of an image has 16 bits: colours of another space would show the steps of 8
/// bits.
bool is_wide(const Document& document, const ImageState& image, bool srgb);

/// Words of the arena that one use of an image takes.
size_t arena_texels(const Document& document, const ImageState& image, bool srgb);

/// Fills the places that the arena has for images. Different images may be decoded at once.
class ImageTexels {
public:
    ImageTexels(const TextureSources& sources,
                const std::vector<ImageState>& images,
                TextureArena& arena,
                Log& log)
        : sources_(sources), images_(images), arena_(arena), log_(log) {}

    /// Errors  of load_encoded and decode_image; 67 E-IMG-CHANGED
    Result<void> decode(size_t image);
    /// Makes the colours of a broken image magenta.
    void fill_broken(size_t image);
    /// Whether files and memory could be had for all.
    ///
    /// Errors  33 E-MEMORY; those of write_texel_file and MappedTexels
    Result<void> stored();

private:
    const Document& document() const { return sources_.document; }
    size_t texels_of_use(const ImageState& image, bool srgb) const {
        return arena_texels(document(), image, srgb);
    }
    void note_failure(const Error& error);
    Result<ImageRgba8> decoded_image(size_t image, EncodedImage& encoded, Log& log) const;
    TexelKey key_of(size_t image, bool srgb, std::span<const std::byte> encoded) const;
    Result<void> map_image(size_t image, EncodedImage& encoded);
    Result<void> map_file(size_t image, bool srgb, const TexelKey& key);
    Result<void> write_and_map(size_t image,
                               const ImageRgba8& decoded,
                               bool srgb,
                               const TexelKey& key);
    Result<void> keep_in_memory(size_t image, const ImageRgba8& decoded, bool srgb);
    void store_texels(const ImageState& state,
                      const ImageRgba8& decoded,
                      bool srgb,
                      uint32_t* base) const;

    const TextureSources& sources_;
    const std::vector<ImageState>& images_;
    TextureArena& arena_;
    Log& log_;
    std::mutex failing_;
    std::optional<Error> failure_;  ///< the first that is no fault of an image
};

}  // namespace obscura::gltf
