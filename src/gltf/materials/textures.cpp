// gltf/materials/textures.cpp - images of materials become texels in the arena.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/materials/textures.h"

#include "base/parallel.h"
#include "gltf/decode/encoded_image.h"
#include "gltf/materials/image_texels.h"
#include "gltf/parse/uri.h"
#include "image/decode.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace obscura::gltf {

namespace {

constexpr size_t max_texels = (1U << 31) - 1;

class TextureBuilder {
public:
    TextureBuilder(const TextureSources& sources,
                   MaterialTable& materials,
                   Problems& problems,
                   Scene& scene,
                   Log& log)
        : sources_(sources), materials_(materials), problems_(problems), scene_(scene), log_(log) {}

    Result<void> build();

private:
    const Document& document() const { return sources_.document; }
    ImageSources image_sources() const {
        return {sources_.document, sources_.buffers, sources_.folder, sources_.measure_only};
    }
    const GltfTexture& texture(int index) const {
        return document().textures[static_cast<size_t>(index)];
    }
    size_t original(size_t image) const { return original_image(document(), image); }
    std::string place(size_t image) const { return place_of_image(document(), image); }
    size_t arena_texels(const ImageState& image, bool srgb) const {
        return gltf::arena_texels(document(), image, srgb);
    }

    bool is_planned(size_t material) const;
    void find_uses();
    bool take_stored();
    Result<void> decode_afresh();
    Result<ImageRgba8> probe(size_t image) const;
    void probe_all();
    void break_image(size_t image, const Error& error);
    void warn_wrong_mime(size_t image, const std::string& mime, const std::string& format) const;
    void warn_wrong_encoding(size_t image, ImageEncoding encoding) const;
    Result<size_t> place_images(size_t multiple);
    Result<void> lay_out();
    std::string name_for_charge(size_t image) const;
    Result<void> charge_texels();
    Result<MemoryCharge> charge_decoding() const;
    int record_index(const TextureSlot& slot, bool srgb);
    void resolve_slots();
    Result<void> decode_all();

    const TextureSources& sources_;
    MaterialTable& materials_;
    Problems& problems_;
    Scene& scene_;
    Log& log_;
    std::vector<ImageState> images_;
    std::map<std::pair<int, uint32_t>, int> records_;  ///< (image, packed sampler) -> arena record
};

Wrap wrap_of(int mode) {
    return mode == 33071 ? Wrap::clamp : mode == 33648 ? Wrap::mirror : Wrap::repeat;
}

uint32_t packed_sampler(const GltfSampler& sampler, bool srgb) {
    const int min = sampler.min_filter;
    const bool min_nearest = min == 9728 || min == 9984 || min == 9986;
    const MipMode mip = min < 9984   ? MipMode::none
                        : min < 9986 ? MipMode::nearest
                                     : MipMode::linear;
    return pack_sampler(wrap_of(sampler.wrap_s),
                        wrap_of(sampler.wrap_t),
                        sampler.mag_filter == 9728,
                        min_nearest,
                        mip,
                        srgb);
}

/// Whether a later scene may draw a material. Record 0 is the default material; copies, behind the
/// file's, have textures of those.
bool TextureBuilder::is_planned(size_t material) const {
    const std::vector<char>& planned = document().planned_materials;
    return material > 0 && material <= planned.size() && planned[material - 1] != 0;
}

/// Which materials use an image: drawn ones decide what is decoded, all what is reported.
void TextureBuilder::find_uses() {
    images_.resize(document().images.size());
    scene_.info.images.resize(document().images.size());
    for (size_t i = 0; i < document().images.size(); ++i) {
        scene_.info.images[i].name = document().images[i].name;
        images_[i].glossiness = document().images[i].glossiness;
    }
    for (size_t material = 0; material < materials_.records.size(); ++material) {
        for (size_t i = 0; i < slot_count; ++i) {
            const TextureSlot& slot =
                *slot_of(i, materials_.records[material], materials_.layers[material]);
            if (slot.texture < 0) continue;
            const size_t image = static_cast<size_t>(texture(slot.texture).image);
            const bool color = slot_entries[i].color;
            ImageInfo& info = scene_.info.images[image];
            (color ? info.used_as_color : info.used_as_data) = true;
            if (materials_.used[material] != 0 || is_planned(material))
                images_[image].uses[color ? 1 : 0].used = true;
        }
    }
}

/// The format that a file's name suggests; "" where it suggests none.
std::string format_of_name(const GltfImage& image) {
    if (!image.uri || is_data_uri(*image.uri)) return {};
    std::string ending = std::filesystem::path(*image.uri).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    if (ending == ".jpg") return "jpeg";
    for (const char* format : {"png", "jpeg", "webp", "ktx2"}) {
        if (ending == std::string(".") + format) return format;
    }
    return {};
}

void TextureBuilder::warn_wrong_mime(size_t image,
                                     const std::string& mime,
                                     const std::string& format) const {
    if (!mime.empty() && mime != "image/" + format) {
        log_.warn(
            place(image),
            "the media type is \"" + mime + "\" but the data are " + format + "; the data count");
    }
    const GltfImage& from = document().images[image];
    const std::string promised = format_of_name(from);
    if (!promised.empty() && promised != format) {
        log_.warn(place(image),
                  "the file \"" + *from.uri + "\" is named as " + promised + " but the data are " +
                      format + "; the data count");
    }
}

void TextureBuilder::warn_wrong_encoding(size_t image, ImageEncoding encoding) const {
    const std::array<ImageUse, 2>& uses = images_[image].uses;
    if (encoding == ImageEncoding::srgb && uses[0].used) {
        log_.warn(place(image),
                  "the image says that it is sRGB, but a material reads it as data; it is read as "
                  "data");
    }
    if (encoding == ImageEncoding::linear && uses[1].used) {
        log_.warn(place(image),
                  "the image says that it is linear, but a material reads it as colour, which is "
                  "sRGB in glTF; it is read as sRGB");
    }
}

Result<ImageRgba8> TextureBuilder::probe(size_t image) const {
    Result<EncodedImage> encoded = load_encoded(image_sources(), image);
    if (!encoded) return fail(std::move(encoded.error()));
    Result<ImageRgba8> header = probe_image(encoded->bytes, place(image));
    if (header) warn_wrong_mime(image, encoded->mime, header->format);
    return header;
}

void TextureBuilder::break_image(size_t image, const Error& error) {
    images_[image].broken = true;
    problems_.add(error,
                  {Loss::texture, "magenta stands for its colours, and for its data the factor"});
}

/// Measures every image, so that the arena can be laid out before anything is decoded.
void TextureBuilder::probe_all() {
    std::vector<std::optional<Result<ImageRgba8>>> headers(images_.size());
    parallel_for(images_.size(), [&](size_t i) { headers[i] = probe(i); });
    for (size_t i = 0; i < images_.size(); ++i) {
        Result<ImageRgba8>& header = *headers[i];
        if (!header) {
            if (images_[i].used()) {
                images_[i].width = images_[i].height = 1;
                break_image(i, header.error());
                continue;
            }
            log_.warn(header.error().where,
                      header.error().message + "; no drawn material uses the image");
            continue;
        }
        warn_wrong_encoding(i, header->encoding);
        images_[i].width = header->width;
        images_[i].height = header->height;
        images_[i].wide = header->bits == 16;
        ImageInfo& info = scene_.info.images[i];
        info.format = header->format;
        info.width = header->width;
        info.height = header->height;
        info.bits = header->bits;
    }
}

/// Gives each image its place in the arena, which begins at a multiple of so many texels. Returns
/// how many there are.
Result<size_t> TextureBuilder::place_images(size_t multiple) {
    size_t total = 0;
    for (size_t i = 0; i < images_.size(); ++i) {
        for (size_t srgb = 0; srgb < 2; ++srgb) {
            ImageUse& use = images_[i].uses[srgb];
            if (!use.used) continue;
            use.base = total;
            total += arena_texels(images_[i], srgb == 1);
            total = (total + multiple - 1) / multiple * multiple;
            if (total <= max_texels) continue;
            return fail(ExitCode::refused,
                        "E-LIMIT-TEXELS",
                        place(i),
                        "the images used have more than 2^31 - 1 texels with their mip chains; "
                        "make them smaller");
        }
    }
    return total;
}

/// Lays out the arena: in memory, or in files where it is larger than it may be.
Result<void> TextureBuilder::lay_out() {
    Result<size_t> total = place_images(1);
    const TextureLimit* const limit = sources_.limit;
    const bool in_files = total && limit != nullptr && *total * sizeof(uint32_t) > limit->max_bytes;
    if (in_files) total = place_images(MappedTexels::texels_per_page);
    if (!total) return fail(total.error());
    if (sources_.measure_only) return {};
    if (!in_files) {
        if (auto charged = charge_texels(); !charged) return charged;
        scene_.textures.texels.resize(*total);
        return {};
    }
    Result<MemoryCharge> charge =
        charge_memory(MemoryUse::textures, "those in memory", limit->max_bytes);
    if (!charge) return fail(std::move(charge.error()));
    sources_.store.charges.push_back(std::move(*charge));
    auto mapped = MappedTexels::reserve(*total, limit->max_bytes);
    if (!mapped) return fail(mapped.error());
    scene_.textures.mapped = std::move(*mapped);
    return {};
}

std::string TextureBuilder::name_for_charge(size_t image) const {
    const GltfImage& from = document().images[original(image)];
    if (from.uri && !is_data_uri(*from.uri)) return *from.uri;
    return from.name.empty() ? place(image) : from.name;
}

/// Charges the arena image by image, so that messages can name the largest.
Result<void> TextureBuilder::charge_texels() {
    std::vector<MemoryCharge>& charges = sources_.store.charges;
    for (size_t i = 0; i < images_.size(); ++i) {
        uint64_t texels = 0;
        for (size_t srgb = 0; srgb < 2; ++srgb) {
            if (images_[i].uses[srgb].used) texels += arena_texels(images_[i], srgb == 1);
        }
        if (texels == 0) continue;
        Result<MemoryCharge> charge =
            charge_memory(MemoryUse::textures, name_for_charge(i), texels * sizeof(uint32_t));
        if (!charge) return fail(std::move(charge.error()));
        charges.push_back(std::move(*charge));
    }
    return {};
}

/// Charges what decoding takes beside the arena: the largest images, as many as there are threads.
Result<MemoryCharge> TextureBuilder::charge_decoding() const {
    std::vector<uint64_t> sizes;
    for (const ImageState& image : images_) {
        // The decoder's rows and what becomes of them; 16 bits have a plane more.
        uint64_t bytes_per_texel = image.wide ? 13 : 8;
        if (scene_.textures.mapped != nullptr)
            bytes_per_texel += image.wide ? 11 : 6;  // its levels
        if (image.used() && !image.broken)
            sizes.push_back(bytes_per_texel * static_cast<uint64_t>(image.width) *
                            static_cast<uint64_t>(image.height));
    }
    std::sort(sizes.rbegin(), sizes.rend());
    sizes.resize(std::min(sizes.size(), max_thread_index()));
    uint64_t sum = 0;
    for (const uint64_t size : sizes)
        sum += size;
    return charge_memory(MemoryUse::textures, "images being decoded", sum);
}

int TextureBuilder::record_index(const TextureSlot& slot, bool srgb) {
    const GltfTexture& from = texture(slot.texture);
    const GltfSampler sampler =
        from.sampler < 0 ? GltfSampler{} : document().samplers[static_cast<size_t>(from.sampler)];
    const uint32_t packed = packed_sampler(sampler, srgb);
    std::vector<TextureRecord>& records = scene_.textures.records;
    const auto [entry, is_new] =
        records_.try_emplace({from.image, packed}, static_cast<int>(records.size()));
    if (!is_new) return entry->second;

    const ImageState& image = images_[static_cast<size_t>(from.image)];
    TextureRecord record;
    record.width = image.width;
    record.height = image.height;
    record.levels = mip_level_count(image.width, image.height);
    record.sampler = packed;
    if (is_wide(document(), image, srgb)) {
        record.low_plane = static_cast<int32_t>(mip_chain_texels(image.width, image.height));
    }
    size_t offset = image.uses[srgb ? 1 : 0].base;
    for (int level = 0; level < record.levels; ++level) {
        record.level_offset[level] = static_cast<int32_t>(offset);
        offset += static_cast<size_t>(std::max(1, image.width >> level)) *
                  static_cast<size_t>(std::max(1, image.height >> level));
    }
    records.push_back(record);
    return entry->second;
}

void TextureBuilder::resolve_slots() {
    for (size_t material = 0; material < materials_.records.size(); ++material) {
        for (size_t i = 0; i < slot_count; ++i) {
            TextureSlot& slot =
                *slot_of(i, materials_.records[material], materials_.layers[material]);
            if (materials_.used[material] == 0) slot = TextureSlot{};
            if (slot.texture < 0) continue;
            const auto image = static_cast<size_t>(texture(slot.texture).image);
            if (images_[image].broken && !slot_entries[i].color) {
                slot = TextureSlot{};
            } else {
                slot.texture = record_index(slot, slot_entries[i].color);
            }
        }
    }
}

Result<void> TextureBuilder::decode_all() {
    ImageTexels texels(sources_, images_, scene_.textures, log_);
    std::vector<Result<void>> done(images_.size());
    parallel_for(images_.size(), [&](size_t i) { done[i] = texels.decode(i); });
    for (size_t i = 0; i < images_.size(); ++i) {
        if (!done[i]) break_image(i, done[i].error());
        if (images_[i].broken) texels.fill_broken(i);
    }
    return texels.stored();
}

/// Reuses an earlier scene's texels if it has all images that this one needs. Otherwise images of
/// both are decoded, lest two scenes keep displacing each other's.
bool TextureBuilder::take_stored() {
    TextureStore& store = sources_.store;
    if (store.images.empty() || store.images.size() != images_.size()) return false;
    bool has_all = !store.texels.empty() || store.mapped != nullptr || sources_.measure_only;
    for (size_t i = 0; i < images_.size(); ++i) {
        has_all = has_all && images_[i].glossiness == store.images[i].glossiness;
        for (size_t srgb = 0; srgb < 2; ++srgb) {
            ImageUse& use = images_[i].uses[srgb];
            has_all = has_all && (!use.used || store.images[i].uses[srgb].used);
            use.used = use.used || store.images[i].uses[srgb].used;
        }
    }
    if (!has_all) return false;
    images_ = store.images;
    for (size_t i = 0; i < images_.size(); ++i) {
        const bool told = original(i) != i && images_[original(i)].broken;
        if (images_[i].broken && !told) problems_.count(Loss::texture, 1);
    }
    scene_.info.images = store.infos;
    scene_.textures.texels = std::move(store.texels);
    store.texels = {};
    scene_.textures.mapped = store.mapped;
    resolve_slots();
    return true;
}

Result<void> TextureBuilder::decode_afresh() {
    sources_.store.texels = {};
    sources_.store.mapped = nullptr;
    sources_.store.charges.clear();
    probe_all();
    Result<void> done = lay_out();
    if (!done) return done;
    if (!sources_.measure_only) {
        const Result<MemoryCharge> decoding = charge_decoding();
        if (!decoding) return fail(decoding.error());
        if (done = decode_all(); !done) return done;
    }
    resolve_slots();
    sources_.store.images = images_;
    sources_.store.infos = scene_.info.images;
    sources_.store.mapped = scene_.textures.mapped;
    return {};
}

Result<void> TextureBuilder::build() {
    find_uses();
    return take_stored() ? Result<void>{} : decode_afresh();
}

}  // namespace

Result<void> add_textures(const TextureSources& sources,
                          MaterialTable& materials,
                          Problems& problems,
                          Scene& scene,
                          Log& log) {
    return TextureBuilder(sources, materials, problems, scene, log).build();
}

}  // namespace obscura::gltf
