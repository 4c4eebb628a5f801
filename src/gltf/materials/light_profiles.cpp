// gltf/materials/light_profiles.cpp - the photometric files of EXT_lights_ies become tables.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/materials/light_profiles.h"

#include "gltf/parse/uri.h"
#include "image/ies_file.h"

#include <string>
#include <utility>

namespace obscura::gltf {

namespace {

constexpr uint64_t largest_profile_file = 1U << 24;  // thousands of times a measured lamp's

Result<LightProfile> load_profile(const Document& document,
                                  const BufferStore& buffers,
                                  const GltfLightProfile& profile,
                                  const UriContext& context) {
    if (!profile.uri) {
        return read_ies(view_bytes(document, buffers, profile.view), context.where);
    }
    const Result<UriBytes> read =
        read_uri(*profile.uri, context, {largest_profile_file, largest_profile_file});
    if (!read) return fail(read.error());
    return read_ies(read->bytes, context.where);
}

}  // namespace

Result<std::vector<LightProfile>> load_light_profiles(const Document& document,
                                                      const BufferStore& buffers,
                                                      const std::filesystem::path& folder,
                                                      size_t max_numbers) {
    std::vector<LightProfile> out(document.profiles.size());
    std::vector<char> used(out.size(), 0);
    for (const GltfNode& node : document.nodes) {
        if (node.ies.profile >= 0) used[static_cast<size_t>(node.ies.profile)] = 1;
    }
    size_t numbers = 0;
    for (size_t i = 0; i < out.size(); ++i) {
        if (used[i] == 0) continue;
        const std::string where = document.at("extensions/EXT_lights_ies/lights", i);
        Result<LightProfile> profile =
            load_profile(document, buffers, document.profiles[i], {folder, where});
        if (!profile) return fail(std::move(profile.error()));
        numbers += profile->candela.size() + profile->polar_deg.size();
        if (numbers > max_numbers) {
            return fail(ExitCode::refused,
                        "E-LIMIT-PROFILES",
                        where,
                        "the light profiles have more than " + std::to_string(max_numbers) +
                            " numbers together");
        }
        out[i] = std::move(*profile);
    }
    return out;
}

}  // namespace obscura::gltf
