// gltf/materials/environment_light.cpp - an image-based light becomes the environment map.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/materials/environment_light.h"

#include "base/parallel.h"
#include "gltf/parse/trs.h"
#include "image/cube_environment.h"
#include "image/decode.h"
#include "image/rendering_space.h"

#include <array>
#include <utility>

namespace obscura::gltf {

namespace {

Result<ImageRgb32f> load_face(const ImageSources& sources, size_t image, Log& log) {
    const Result<EncodedImage> encoded = load_encoded(sources, image);
    if (!encoded) return fail(encoded.error());
    const Result<ImageRgba8> decoded =
        decode_image(encoded->bytes, sources.document.at("images", image), log);
    if (!decoded) return fail(decoded.error());
    return light_from_image(*decoded);
}

/// The inverse of a unit quaternion's rotation.
Affined inverse_rotation(const std::array<double, 4>& q) {
    return affine_from_trs({0, 0, 0}, {-q[0], -q[1], -q[2], q[3]}, {1, 1, 1});
}

Result<std::shared_ptr<const ImageRgb32f>> load_map(const ImageSources& sources,
                                                    size_t light,
                                                    Log& log) {
    const GltfEnvironment& record = sources.document.environments[light];
    const std::string where =
        sources.document.at("extensions/EXT_lights_image_based/lights", light);
    CubeFaces faces;
    std::array<Result<void>, 6> done;
    parallel_for(faces.size(), [&](size_t i) {
        Result<ImageRgb32f> face = load_face(sources, static_cast<size_t>(record.images[i]), log);
        if (face) {
            faces[i] = std::move(*face);
        } else {
            done[i] = fail(std::move(face.error()));
        }
    });
    for (const Result<void>& face : done) {
        if (!face) return fail(face.error());
    }
    if (record.side != static_cast<uint64_t>(faces[0].width)) {
        log.warn(where,
                 "specularImageSize is " + std::to_string(record.side) + ", but the images are " +
                     std::to_string(faces[0].width) + " wide; the images count");
    }
    Result<ImageRgb32f> map = environment_from_cube(
        faces, inverse_rotation(record.rotation), where + "/specularImages/0");
    if (!map) return fail(std::move(map.error()));
    for (float& value : map->pixels)
        value *= static_cast<float>(record.intensity);
    if (sources.document.from_rec709) convert_colors(*sources.document.from_rec709, map->pixels);
    return std::make_shared<const ImageRgb32f>(std::move(*map));
}

}  // namespace

Result<void> add_environment_light(
    const ImageSources& sources, int scene, EnvironmentStore& store, Scene& out, Log& log) {
    const Document& document = sources.document;
    const int light = scene < 0 ? -1 : document.scenes[static_cast<size_t>(scene)].environment;
    if (light < 0) return {};
    const auto index = static_cast<size_t>(light);
    out.info.environment = document.environments[index].name;
    if (sources.measure_only) return {};
    const GltfEnvironment& from = document.environments[index];
    if (store.map == nullptr || store.intensity != from.intensity ||
        store.rotation != from.rotation) {
        auto loaded = load_map(sources, index, log);
        if (!loaded) return fail(std::move(loaded.error()));
        store = {std::move(*loaded), from.intensity, from.rotation};
    }
    out.environment = store.map;
    return {};
}

}  // namespace obscura::gltf
