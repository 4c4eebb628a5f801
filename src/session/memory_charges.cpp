// session/memory_charges.cpp - charges what a session's images take to the process's memory budget.
// SPDX-License-Identifier: Apache-2.0
#include "session/memory_charges.h"

#include "base/parallel.h"
#include "film/layer_sums.h"
#include "film/light_groups.h"
#include "film/light_path_plan.h"
#include "render/integrators.h"
#include "scene/scene_memory.h"
#include "session/image_parts.h"

#include <algorithm>
#include <utility>

namespace obscura {

namespace {

/// Replaces a charge: what it stood for is gone, or counts in the new one.
Result<void> recharge(MemoryCharge& charge,
                      MemoryUse use,
                      const std::string& where,
                      uint64_t bytes) {
    charge = {};
    Result<MemoryCharge> taken = charge_memory(use, where, bytes);
    if (!taken) return fail(std::move(taken.error()));
    charge = std::move(*taken);
    return {};
}

/// The layers of an image, those of light groups too.
Result<std::vector<Layer>> all_layers(const Scene& scene, const RenderOptions& options) {
    std::vector<Layer> layers = options.layers;
    if (!options.light_groups.each) return layers;
    const Result<LightGroups> groups = make_light_groups(scene, options.light_groups);
    if (!groups) return fail(groups.error());
    for (Layer& layer : light_group_layers(groups->names, options.light_groups.components))
        layers.push_back(std::move(layer));
    return layers;
}

/// Bytes a pixel that are kept between passes; as if there were shadow catchers.
uint64_t pass_bytes(const std::vector<Layer>& layers) {
    uint64_t bytes = sizeof(PixelSum) + sizeof(CatcherSum) + sizeof(int);
    for (const Layer& layer : layers)
        bytes += sum_bytes(layer, true);
    return bytes;
}

/// Bytes a pixel of the finished blocks that a part of samples keeps: their floats.
uint64_t block_bytes(const RenderRequest& request, uint64_t channels) {
    if (!is_part_of_samples(request)) return 0;
    const int samples = samples_of_part(samples_taken(request.options), *request.part).count;
    return static_cast<uint64_t>(samples) / sum_block_samples * channels * sizeof(float);
}

bool is_display_format(const std::filesystem::path& file) {
    return file.extension() != ".exr";
}

/// Bytes a pixel while the image is finished: the denoiser's planes, a display's copy, or an EXR,
/// which is made in memory: half floats, or compressed floats.
uint64_t finishing_bytes(const RenderRequest& request, uint64_t film_bytes) {
    constexpr uint64_t denoising = 96;
    constexpr uint64_t display = 20;  // four floats, then four bytes
    const bool shown =
        request.standard_output ||
        std::any_of(request.outputs.begin(), request.outputs.end(), is_display_format);
    return std::max({request.denoise ? denoising : 0, shown ? display : 0, film_bytes / 2});
}

}  // namespace

Result<void> charge_geometry(const Scene& scene, MemoryCharges& charges) {
    return recharge(charges.geometry, MemoryUse::geometry, "", geometry_bytes(scene));
}

Result<void> charge_film(const Scene& scene,
                         const RenderRequest& request,
                         const RenderOptions& options,
                         MemoryCharges& charges) {
    const Result<std::vector<Layer>> layers = all_layers(scene, options);
    if (!layers) return fail(layers.error());
    uint64_t layer_channels = 0;
    for (const Layer& layer : *layers)
        layer_channels += layer.channels.size();
    const uint64_t beauty = film_channels(options.integrator).size();
    const uint64_t film_bytes = (beauty + layer_channels) * sizeof(float);
    uint64_t bytes_per_pixel = film_bytes + finishing_bytes(request, film_bytes);
    // What adaptive passes plan with: the pixels before the latest ones, four counts, a deviation,
    // a mark.
    if (options.adaptive) bytes_per_pixel += beauty * sizeof(float) + 21;
    if (options.adaptive || takes_passes(request)) bytes_per_pixel += pass_bytes(*layers);
    bytes_per_pixel += block_bytes(request, 4 + layer_channels);
    // What a viewer is still to see, of this image and of the one before.
    if (request.display_server) bytes_per_pixel += 2 * beauty * sizeof(float);
    const auto width = static_cast<uint64_t>(options.crop ? options.crop->width : options.width);
    const auto height = static_cast<uint64_t>(options.crop ? options.crop->height : options.height);
    constexpr uint64_t bytes_per_thread = 8U << 20;  // its batch of paths and its tile's sums
    const std::string where = std::to_string(width) + "x" + std::to_string(height) + " with " +
                              std::to_string(options.layers.size()) + " layers";
    return recharge(charges.film,
                    MemoryUse::film,
                    where,
                    width * height * bytes_per_pixel + bytes_per_thread * max_thread_index());
}

}  // namespace obscura
