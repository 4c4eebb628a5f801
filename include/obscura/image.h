// include/obscura/image.h - a rendered image: float pixels with named channels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "obscura/view.h"
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

OBSCURA_BEGIN_API

struct ImageStatistics {
    double render_seconds = 0;
    std::uint64_t paths = 0;
    std::uint64_t rays = 0;
    std::uint64_t nonfinite_samples = 0;  ///< they count as zero
};

/// How the numbers of a layer may be used: colours may be rounded to 16 bits; ids must keep every
/// bit, and are never mixed.
enum class LayerKind { color, data, id };

/// A name that a Cryptomatte layer knows, and its id in the layer's channels.
struct CryptomatteName {
    std::string name;  ///< "/room/lamp/shade"
    float id = 0;      ///< as pixels have it
};

/// A layer beside the beauty, as Sampling::aov asked for it; docs/layers.md has the units.
struct Layer {
    std::string name;                   ///< "normal"
    std::vector<std::string> channels;  ///< as in a file: "normal.X", "normal.Y", "normal.Z"
    LayerKind kind = LayerKind::data;
    /// How a pixel's samples became its value: "mean", "nearest", "count", "variance",
    /// "cryptomatte".
    std::string reduction;
    std::string expression;              ///< the light path expression that it shows; may be empty
    std::vector<float> pixels;           ///< as many as the image has, channels interleaved
    std::vector<CryptomatteName> names;  ///< of Cryptomatte layers
    /// What the EXR's header says of the layer besides: the Cryptomatte attributes.
    std::vector<std::pair<std::string, std::string>> attributes;
};

/// Scene-linear Rec.709 in nit (docs/conventions.md), alpha premultiplied.
struct Image {
    int width = 0, height = 0;          ///< of the whole image
    Rect part;                          ///< which part of it the pixels are; without a crop all
    std::vector<std::string> channels;  ///< "R" "G" "B" "A", or what the integrator computes
    /// part.width x part.height pixels, row after row from the top, channels interleaved.
    std::vector<float> pixels;
    std::vector<Layer> layers;  ///< in the order in which they were asked for
    /// What the EXR's header says besides: "obscura:camera", "obscura:cameraParameters", ...
    std::vector<std::pair<std::string, std::string>> attributes;
    ImageStatistics statistics;

    struct Source;
    std::shared_ptr<const Source> source;  ///< what Session::write() needs to know
};

/// Where an EXR has the layers: in one part with the beauty, each in a part of its own, or each in
/// a file of its own, shot.normal.exr beside shot.exr.
enum class ExrLayout { single, multipart, separate };

/// How an image becomes a file.
struct WriteOptions {
    bool float32 = false;  ///< EXR: 32 bits a channel in place of 16; data always has 32
    ExrLayout exr_layout = ExrLayout::single;
    double exposure_ev = 0;      ///< all but EXR, as all below: values are multiplied by 2^EV
    std::string ocio_config;     ///< a file; empty: $OCIO, else the built-in config
    std::string display;         ///< empty: the config's default
    std::string view;            ///< empty: the display's default
    int bits = 8;                ///< of a channel: 8, or 16 in PNG and TIFF
    std::optional<int> quality;  ///< 1 to 100, of JPEG (else 95), WebP (else 90) and AVIF (else 90)
    bool dither = true;          ///< 8-bit colours, so that smooth areas show no bands
    /// A colour behind an image with alpha, in the display's encoded values from 0 to 1; the file
    /// has no alpha then.
    std::optional<std::array<float, 3>> page;
};

OBSCURA_END_API
