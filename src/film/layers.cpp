// film/layers.cpp - the layers that an image may have beside its beauty, by name.
// SPDX-License-Identifier: Apache-2.0
#include "film/layers.h"

#include "film/cryptomatte.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace obscura {

namespace {

constexpr std::string_view name_of(Reduction reduction) {
    return reduction == Reduction::mean ? "mean" : "nearest";
}

struct StatisticEntry {
    SampleStatistic statistic;
    const char* name;
    const char* reduction;
    const char* help;
};

constexpr std::array statistic_entries = {
    StatisticEntry{SampleStatistic::sample_count, "sample_count", "count", "samples of the pixel"},
    StatisticEntry{SampleStatistic::variance,
                   "variance",
                   "variance",
                   "of the pixel's mean luminance, estimated from its samples"},
    StatisticEntry{
        SampleStatistic::cost, "cost", "count", "rays that the pixel's samples have cast"}};

struct CryptomatteEntry {
    CryptomatteNames names;
    const char* name;
    const char* help;
};

constexpr std::array cryptomatte_entries = {
    CryptomatteEntry{CryptomatteNames::objects, "crypto_object", "mattes by the nodes' paths"},
    CryptomatteEntry{CryptomatteNames::materials, "crypto_material", "mattes by materials"},
    CryptomatteEntry{CryptomatteNames::assets, "crypto_asset", "mattes by root nodes"}};

std::vector<std::string> channels_of(std::string_view layer, std::string_view letters) {
    std::vector<std::string> channels;
    for (const char letter : letters)
        channels.push_back(std::string(layer) + "." + letter);
    return channels;
}

/// The layer with a name; its channels are empty if there is none.
Layer layer_named(const std::string& name, int crypto_levels) {
    for (const AovEntry& entry : aov_entries) {
        if (entry.name != name) continue;
        return {name,
                channels_of(name, entry.letters),
                entry.kind,
                std::string(name_of(entry.reduction)),
                entry.aov};
    }
    for (const StatisticEntry& entry : statistic_entries) {
        if (entry.name != name) continue;
        return {name, channels_of(name, "X"), LayerKind::data, entry.reduction, entry.statistic};
    }
    for (const CryptomatteEntry& entry : cryptomatte_entries) {
        if (entry.name != name) continue;
        return {name,
                cryptomatte_channels(name, static_cast<size_t>(crypto_levels)),
                LayerKind::id,
                "cryptomatte",
                entry.names};
    }
    return {};
}

}  // namespace

std::vector<LayerDescription> all_layers() {
    std::vector<LayerDescription> out;
    for (const AovEntry& entry : aov_entries) {
        out.push_back({entry.name,
                       std::string(entry.letters),
                       std::string(name_of(entry.reduction)),
                       entry.help});
    }
    for (const StatisticEntry& entry : statistic_entries)
        out.push_back({entry.name, "X", entry.reduction, entry.help});
    for (const CryptomatteEntry& entry : cryptomatte_entries)
        out.push_back({entry.name, "rgba", "cryptomatte", entry.help});
    return out;
}

Result<std::vector<Layer>> layers_of(std::span<const std::string> names, int crypto_levels) {
    std::vector<Layer> layers;
    for (const std::string& name : names) {
        const bool known = std::any_of(
            layers.begin(), layers.end(), [&](const Layer& layer) { return layer.name == name; });
        if (known) continue;
        Layer layer = layer_named(name, crypto_levels);
        if (layer.channels.empty()) {
            std::string accepted;
            for (const LayerDescription& one : all_layers())
                accepted += (accepted.empty() ? "" : ", ") + one.name;
            return fail(ExitCode::usage,
                        "E-AOV-NAME",
                        "--aov",
                        "'" + name + "' is no layer; there are " + accepted);
        }
        layers.push_back(std::move(layer));
    }
    return layers;
}

}  // namespace obscura
