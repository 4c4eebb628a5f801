// session/exr_layers.cpp - the beauty and the layers of a file of `obscura render`.
// SPDX-License-Identifier: Apache-2.0
#include "session/exr_layers.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

namespace obscura {

namespace {

const ExrChannel* find_channel(const ExrPartInfo& part, const std::string& name) {
    const auto found = std::find_if(part.channels.begin(),
                                    part.channels.end(),
                                    [&](const ExrChannel& one) { return one.name == name; });
    return found != part.channels.end() ? &*found : nullptr;
}

bool has_all(const ExrPartInfo& part, std::span<const std::string> channels) {
    return std::all_of(channels.begin(), channels.end(), [&](const std::string& name) {
        return find_channel(part, name) != nullptr;
    });
}

bool is_alike(const ExrPartInfo& a, const ExrPartInfo& b) {
    return a.width == b.width && a.height == b.height && a.place.x == b.place.x &&
           a.place.y == b.place.y;
}

/// The layer whose light path expression an attribute of a part is; none: it is another.
std::optional<std::string> layer_of_expression(const ExrPartInfo& part,
                                               const std::string& attribute) {
    const std::string_view prefix = "obscura:layer:";
    const std::string_view suffix = ":expression";
    if (attribute == "obscura:expression") {
        const std::string view = part.view.empty() ? "" : "-" + part.view;
        const bool is_last = part.name.ends_with(view);
        return part.name.substr(0, part.name.size() - (is_last ? view.size() : 0));
    }
    if (!attribute.starts_with(prefix) || !attribute.ends_with(suffix)) return {};
    return attribute.substr(prefix.size(), attribute.size() - prefix.size() - suffix.size());
}

}  // namespace

Result<ExrLayers> ExrLayers::find(const ExrDocument& document) {
    ExrLayers out(document);
    const std::vector<ExrPartInfo>& parts = document.parts();
    const std::map<std::string, AttributeValue>& attributes = parts[0].attributes;
    if (!attributes.contains("obscura:samplesPerPixel") ||
        !attributes.contains("obscura:integrator")) {
        return fail(ExitCode::bad_data,
                    "E-DENOISE-SOURCE",
                    document.where(),
                    "it is not from `obscura render`: its header lacks obscura:samplesPerPixel or "
                    "obscura:integrator");
    }
    const std::vector<std::string> colors = {"R", "G", "B"};
    for (size_t i = 0; i < parts.size(); ++i) {
        const bool is_known =
            std::any_of(out.beauty_.parts.begin(), out.beauty_.parts.end(), [&](size_t before) {
                return parts[before].view == parts[i].view;
            });
        if (!is_known && has_all(parts[i], colors)) out.beauty_.parts.push_back(i);
    }
    if (out.beauty_.parts.empty()) {
        return fail(ExitCode::bad_data,
                    "E-DENOISE-LAYER",
                    document.where(),
                    "it has no beauty: no part has the channels R, G and B");
    }
    out.beauty_.channels = colors;
    if (find_channel(out.first(), "A") != nullptr) out.beauty_.channels.emplace_back("A");
    out.beauty_.is_half = find_channel(out.first(), "R")->is_half;
    for (const size_t part : out.beauty_.parts) {
        out.height_ += parts[part].height;
        if (parts[part].width == out.width() && has_all(parts[part], out.beauty_.channels))
            continue;
        return fail(ExitCode::bad_data,
                    "E-EXR-CORRUPT",
                    document.where(),
                    "the beauty of one view has not the width and channels of the other's");
    }
    return out;
}

ImagePart ExrLayers::place() const {
    ImagePart out = first().place;
    out.height *= static_cast<int>(beauty_.parts.size());
    return out;
}

std::optional<ExrPlace> ExrLayers::place_of(std::span<const std::string> channels) const {
    ExrPlace out;
    out.channels.assign(channels.begin(), channels.end());
    const std::vector<ExrPartInfo>& parts = document_->parts();
    for (const size_t beauty : beauty_.parts) {
        const auto found = std::find_if(parts.begin(), parts.end(), [&](const ExrPartInfo& part) {
            return part.view == parts[beauty].view && is_alike(part, parts[beauty]) &&
                   has_all(part, channels);
        });
        if (found == parts.end()) return {};
        out.parts.push_back(static_cast<size_t>(found - parts.begin()));
        out.is_half |= std::any_of(channels.begin(), channels.end(), [&](const std::string& name) {
            return find_channel(*found, name)->is_half;
        });
    }
    return out;
}

std::map<std::string, std::string> ExrLayers::layers_of_light() const {
    std::map<std::string, std::string> out;
    for (const ExrPartInfo& part : document_->parts()) {
        if (part.view != first().view) continue;
        for (const auto& [name, value] : part.attributes) {
            const auto layer = layer_of_expression(part, name);
            const auto* const expression = std::get_if<std::string>(&value);
            if (layer && expression != nullptr) out.emplace(*layer, *expression);
        }
    }
    return out;
}

Result<UnsetArray<float>> ExrLayers::read(const ExrPlace& place) const {
    UnsetArray<float> out;
    for (const size_t part : place.parts) {
        Result<UnsetArray<float>> values = document_->values(part, place.channels);
        if (!values) return values;
        out.insert(out.end(), values->begin(), values->end());
    }
    const auto odd =
        std::find_if(out.begin(), out.end(), [](float value) { return !std::isfinite(value); });
    if (odd == out.end()) return out;
    const size_t index = static_cast<size_t>(odd - out.begin());
    const size_t pixel = index / place.channels.size();
    const auto columns = static_cast<size_t>(width());
    return fail(
        ExitCode::bad_data,
        "E-EXR-CORRUPT",
        document_->where(),
        fmt::format("channel {} has the value {} at column {}, row {}; expected finite ones",
                    place.channels[index % place.channels.size()],
                    *odd,
                    pixel % columns,
                    pixel / columns));
}

std::vector<ExrChange> ExrLayers::changes_of(const ExrPlace& place,
                                             const UnsetArray<float>& pixels) const {
    std::vector<ExrChange> out;
    const float* from = pixels.data();
    for (const size_t part : place.parts) {
        const ExrPartInfo& info = document_->parts()[part];
        const size_t count = static_cast<size_t>(info.width) * static_cast<size_t>(info.height) *
                             place.channels.size();
        ExrChange change{part, place.channels, UnsetArray<float>(from, from + count)};
        from += count;
        out.push_back(std::move(change));
    }
    return out;
}

std::vector<ExrChange> ExrLayers::new_layer(const std::string& name,
                                            const std::vector<std::string>& channels,
                                            const UnsetArray<float>& pixels) const {
    const std::vector<ExrPartInfo>& parts = document_->parts();
    const bool has_parts = parts.size() > beauty_.parts.size();
    const std::string prefix = has_parts ? "obscura:" : "obscura:layer:" + name + ":";
    std::vector<ExrChange> out = changes_of({channels, beauty_.parts}, pixels);
    for (ExrChange& change : out) {
        const std::string& view = parts[change.part].view;
        change.depth = beauty_.is_half ? ExrDepth::half : ExrDepth::float32;
        change.attributes = {{prefix + "kind", "color"}, {prefix + "reduction", "mean"}};
        if (has_parts) change.new_part = view.empty() ? name : name + "-" + view;
    }
    return out;
}

}  // namespace obscura
