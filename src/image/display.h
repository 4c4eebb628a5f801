// image/display.h - converts scene-linear values by an OpenColorIO display and view.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"
#include "image/rgb_primaries.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

struct DisplayOptions {
    std::string ocio_file;   ///< a config; empty: $OCIO, else the built-in config
    std::string display;     ///< empty: the config's default
    std::string view;        ///< empty: the config's default for that display
    double exposure_ev = 0;  ///< scene values are multiplied by 2^EV first
    /// From the space of the scene values (image/rendering_space.h); none: it is Rec.709.
    std::optional<Matrix3> rec709_from_scene = {};
};

/// A display of a config, and the views that it has.
struct DisplayChoice {
    std::string name;
    std::vector<std::string> views;  ///< the display's own choice first
};

/// The displays of a config, its own choice first.
///
/// In      ocio_file: as in DisplayOptions
/// Errors  78 E-OCIO-FILE
Result<std::vector<DisplayChoice>> display_choices(const std::string& ocio_file, Log& log);

/// What RGB code values mean, as ITU-T H.273 counts it and PNG's cICP chunk stores it: full range,
/// no matrix.
struct ColorCodePoints {
    int primaries = 2;  ///< ColourPrimaries; 2: unspecified
    int transfer = 2;   ///< TransferCharacteristics; 2: unspecified

    bool operator==(const ColorCodePoints&) const = default;
};
inline constexpr ColorCodePoints srgb_code_points = {1, 13};

/// Scene-linear values to display code values in [0, 1].
class DisplayTransform {
public:
    /// Errors  78 E-OCIO-FILE unreadable or bad config, E-OCIO-DISPLAY / E-OCIO-VIEW unknown name
    ///         (the message lists the valid ones), E-OCIO-CYCLE circular references
    static Result<DisplayTransform> create(const DisplayOptions& options, Log& log);

    DisplayTransform(DisplayTransform&&) noexcept;
    DisplayTransform& operator=(DisplayTransform&&) noexcept;
    ~DisplayTransform();

    /// Converts `count` RGB triples in place. Thread-safe.
    void apply(float* rgb, size_t count) const;

    /// What the display's codes mean; none: data, or nothing that has a number.
    const std::optional<ColorCodePoints>& code_points() const;

private:
    struct Impl;
    explicit DisplayTransform(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace obscura
