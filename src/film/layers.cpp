// film/layers.cpp - the layers that an image may have beside its beauty, by name.
// SPDX-License-Identifier: Apache-2.0
#include "film/layers.h"

#include "base/setting_names.h"
#include "film/cryptomatte.h"
#include "film/light_components.h"

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

struct PartEntry {
    PartMean source;
    const char* name;
    const char* letters;
    LayerKind kind;
    const char* help;
};

constexpr std::array part_entries = {PartEntry{{{}, SamplePart::first_half},
                                               "half_1",
                                               "RGB",
                                               LayerKind::color,
                                               "the beauty of one half of the samples"},
                                     PartEntry{{{}, SamplePart::second_half},
                                               "half_2",
                                               "RGB",
                                               LayerKind::color,
                                               "the beauty of the other half"},
                                     PartEntry{{Aov::albedo, SamplePart::first_half},
                                               "albedo_half_1",
                                               "RGB",
                                               LayerKind::color,
                                               "the albedo of one half of the samples"},
                                     PartEntry{{Aov::albedo, SamplePart::second_half},
                                               "albedo_half_2",
                                               "RGB",
                                               LayerKind::color,
                                               "the albedo of the other half"},
                                     PartEntry{{Aov::normal, SamplePart::first_half},
                                               "normal_half_1",
                                               "XYZ",
                                               LayerKind::data,
                                               "the normal of one half of the samples"},
                                     PartEntry{{Aov::normal, SamplePart::second_half},
                                               "normal_half_2",
                                               "XYZ",
                                               LayerKind::data,
                                               "the normal of the other half"}};

constexpr const char* shadow_name = "shadow";
constexpr const char* shadow_reduction = "ratio";

std::vector<std::string> channels_of(std::string_view layer, std::string_view letters) {
    std::vector<std::string> channels;
    for (const char letter : letters)
        channels.push_back(std::string(layer) + "." + letter);
    return channels;
}

/// One for each channel of a layer. Texture coordinates have a mask behind them, as Cycles' have:
/// Blender reads layers of one, three and four channels.
std::string letters_of(const AovEntry& entry) {
    return std::string(entry.letters) + (entry.aov == Aov::uv ? "A" : "");
}

/// The layer with a name; its channels are empty if there is none.
Layer layer_named(const std::string& name, int crypto_levels) {
    for (const AovEntry& entry : aov_entries) {
        if (entry.name != name) continue;
        return {name,
                channels_of(name, letters_of(entry)),
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
    for (const PartEntry& entry : part_entries) {
        if (entry.name != name) continue;
        return {name, channels_of(name, entry.letters), entry.kind, "mean", entry.source};
    }
    for (const LightComponent& component : light_components()) {
        if (component.name != name) continue;
        return light_layer(name, parse_light_path_expression(component.expression).value());
    }
    if (name == shadow_name) {
        return {name, channels_of(name, "RGB"), LayerKind::data, shadow_reduction, ShadowRatio{}};
    }
    return {};
}

}  // namespace

bool is_cryptomatte(const Layer& layer) {
    return std::holds_alternative<CryptomatteNames>(layer.source);
}

bool is_reduced(const Layer& layer, Reduction reduction) {
    const Aov* aov = std::get_if<Aov>(&layer.source);
    return aov != nullptr && entry_of(*aov).reduction == reduction;
}

std::vector<LayerDescription> all_layers() {
    std::vector<LayerDescription> out;
    for (const AovEntry& entry : aov_entries) {
        out.push_back(
            {entry.name, letters_of(entry), std::string(name_of(entry.reduction)), entry.help});
    }
    for (const StatisticEntry& entry : statistic_entries)
        out.push_back({entry.name, "X", entry.reduction, entry.help});
    for (const CryptomatteEntry& entry : cryptomatte_entries)
        out.push_back({entry.name, "rgba", "cryptomatte", entry.help});
    for (const PartEntry& entry : part_entries)
        out.push_back({entry.name, entry.letters, "mean", entry.help});
    for (const LightComponent& one : light_components())
        out.push_back({one.name, "RGB", "mean", one.help, one.expression});
    out.push_back({shadow_name,
                   "RGB",
                   shadow_reduction,
                   "direct light that arrives, of what would if nothing were in its way"});
    return out;
}

Layer segmentation_layer() {
    return {"segmentation", {"segmentation.X"}, LayerKind::id, "majority", MajorityNode{}};
}

size_t samples_in(const PartMean& mean, size_t samples) {
    if (mean.part == SamplePart::all) return samples;
    const size_t pair = 2 * mean.run;
    const size_t first = samples / pair * mean.run + std::min(samples % pair, mean.run);
    return mean.part == SamplePart::first_half ? first : samples - first;
}

size_t half_run(int samples_per_pixel) {
    size_t run = 8;
    while (run > 1 && 2 * run > static_cast<size_t>(samples_per_pixel))
        run /= 2;
    return run;
}

std::vector<Layer> denoising_layers() {
    std::vector<Layer> out;
    for (const PartEntry& entry : part_entries)
        out.push_back(layer_named(entry.name, 0));
    for (const Aov aov : {Aov::depth, Aov::opacity})
        out.push_back(layer_named(entry_of(aov).name, 0));
    return out;
}

Layer noisy_layer() {
    return {"noisy", channels_of("noisy", "RGB"), LayerKind::color, "mean", PartMean{}};
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
                        setting("aov"),
                        "'" + name + "' is no layer; there are " + accepted);
        }
        layers.push_back(std::move(layer));
    }
    return layers;
}

bool is_layer_name(std::string_view name) {
    return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '-';
    });
}

Layer light_layer(const std::string& name,
                  const LightPathExpression& expression,
                  std::optional<size_t> group) {
    return {name,
            channels_of(name, "RGB"),
            LayerKind::color,
            "mean",
            LightLayer{expression, group, expression.text}};
}

Result<Layer> light_layer_of(const std::string& text) {
    const size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    if (equals == std::string::npos || !is_layer_name(name)) {
        return fail(ExitCode::usage,
                    "E-LAYER-NAME",
                    text.substr(0, max_shown_expression),
                    "expected NAME=EXPRESSION such as key=C.*<L'key'>, with a name of letters, "
                    "digits, - and _");
    }
    const Layer known = layer_named(name, 0);
    const bool is_of_data =
        !known.channels.empty() && !std::holds_alternative<LightLayer>(known.source);
    if (is_of_data) {
        return fail(ExitCode::usage,
                    "E-LAYER-NAME",
                    text.substr(0, max_shown_expression),
                    "the layer '" + name +
                        "' is another, which programs know by this name; give it one of its own");
    }
    Result<LightPathExpression> expression =
        parse_light_path_expression(std::string_view(text).substr(equals + 1));
    if (!expression) return fail(expression.error());
    return light_layer(name, *expression);
}

bool has_light_layers(std::span<const Layer> layers) {
    return std::any_of(layers.begin(), layers.end(), [](const Layer& layer) {
        return std::holds_alternative<LightLayer>(layer.source) ||
               std::holds_alternative<ShadowRatio>(layer.source);
    });
}

}  // namespace obscura
