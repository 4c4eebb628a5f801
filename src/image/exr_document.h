// image/exr_document.h - an OpenEXR file of parts and layers: read, some channels changed, written.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/unset_array.h"
#include "image/image_metadata.h"
#include "image/pixels.h"
#include "image/write.h"

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace obscura {

struct ExrChannel {
    std::string name;
    bool is_half = false;  ///< else 32 bits
};

/// What is known of a part without its pixels.
struct ExrPartInfo {
    std::string name, view;  ///< empty: it has none
    int width = 0, height = 0;
    ImagePart place;                                   ///< of its data window in the display window
    std::vector<ExrChannel> channels;                  ///< but those of whole numbers
    std::map<std::string, AttributeValue> attributes;  ///< of those types; others are kept as well
    std::vector<float> world_to_camera;                ///< rows; empty: the header has none
};

/// New values for channels of a part, interleaved.
struct ExrChange {
    size_t part = 0;                    ///< index
    std::vector<std::string> channels;  ///< those that the part has not are added
    UnsetArray<float> pixels;
    ExrDepth depth = ExrDepth::float32;           ///< of channels that are added
    std::vector<ImageAttribute> attributes = {};  ///< that the part's header gets
    /// Not empty: the channels become a part of this name, behind the others, with the header of
    /// `part` but for what that says of its own channels.
    std::string new_part = {};
};

/// A file in memory. OpenEXR's exceptions become errors.
class ExrDocument {
public:
    /// Reads the headers.
    ///
    /// Errors  65 E-EXR-FORMAT no OpenEXR file, or of a kind that is not read; E-EXR-CORRUPT it is
    ///         cut off or damaged; 77 E-EXR-LIMIT sides beyond 2^20
    static Result<ExrDocument> read(std::vector<std::byte> bytes, const std::string& where);

    const std::vector<ExrPartInfo>& parts() const { return parts_; }
    const std::string& where() const { return where_; }

    /// Values of channels that the part has, interleaved.
    ///
    /// Errors  65 E-EXR-CORRUPT; 33 E-EXR-MEMORY
    Result<UnsetArray<float>> values(size_t part, std::span<const std::string> channels) const;

    /// The file with other values in some channels. Parts without changes are copied without being
    /// decoded; of the others all channels but the changed ones keep their bits: where their codec
    /// would round those again, the part has ZIP instead. Smaller copies of changed channels are
    /// made anew, as means. The order of lines, tiles, windows and all attributes stay.
    ///
    /// In      attributes: that all parts' headers get
    /// Errors  65 E-EXR-CORRUPT; 33 E-EXR-MEMORY
    Result<EncodedFile> with_changes(std::span<const ExrChange> changes,
                                     std::span<const ImageAttribute> attributes) const;

private:
    ExrDocument() = default;

    std::shared_ptr<const std::vector<std::byte>> bytes_;
    std::string where_;
    std::vector<ExrPartInfo> parts_;
};

}  // namespace obscura
