// session/exr_layers.h - the beauty and the layers of a file of `obscura render`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/exr_document.h"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace obscura {

/// Channels of an image: the part that has them, for each view.
struct ExrPlace {
    std::vector<std::string> channels;
    std::vector<size_t> parts;
    bool is_half = false;
};

/// Finds and reads layers wherever --exr-layout has put them. Views of a stereo image that have
/// parts of their own are joined, one above the other, as they were rendered.
class ExrLayers {
public:
    /// Errors  65 E-DENOISE-SOURCE another program's file; E-DENOISE-LAYER no beauty;
    ///         E-EXR-CORRUPT views of different sizes
    static Result<ExrLayers> find(const ExrDocument& document);

    int width() const { return first().width; }
    int height() const { return height_; }
    ImagePart place() const;
    const ExrPlace& beauty() const { return beauty_; }

    /// An attribute of the file, if it is of that type.
    template <typename Value>
    const Value* attribute(const std::string& name) const {
        const auto found = first().attributes.find(name);
        return found != first().attributes.end() ? std::get_if<Value>(&found->second) : nullptr;
    }

    /// None unless every view has all the channels.
    std::optional<ExrPlace> place_of(std::span<const std::string> channels) const;

    /// The layers of the light: their names, and the light path expressions that the header has.
    std::map<std::string, std::string> layers_of_light() const;

    /// Rows of the matrix; empty: the header has none.
    const std::vector<float>& world_to_camera() const { return first().world_to_camera; }

    /// Errors  those of ExrDocument::values; 65 E-EXR-CORRUPT a value is not finite
    Result<UnsetArray<float>> read(const ExrPlace& place) const;

    /// What replaces the pixels of an image there.
    std::vector<ExrChange> changes_of(const ExrPlace& place, const UnsetArray<float>& pixels) const;

    /// What adds a layer with as many bits as the beauty: beside it, or in parts of its own if the
    /// file has several.
    std::vector<ExrChange> new_layer(const std::string& name,
                                     const std::vector<std::string>& channels,
                                     const UnsetArray<float>& pixels) const;

private:
    explicit ExrLayers(const ExrDocument& document) : document_(&document) {}

    const ExrPartInfo& first() const { return document_->parts()[beauty_.parts[0]]; }

    const ExrDocument* document_;
    ExrPlace beauty_;  ///< its parts in the order of the views
    int height_ = 0;   ///< of all views
};

}  // namespace obscura
