// gltf/pose.h - poses a document: writes animated values at a time into it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/animation.h"
#include "gltf/parse/light_camera_entries.h"
#include "gltf/set_value.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace obscura::gltf {

/// Which animations are played and what they change.
class Animator {
public:
    /// Reads the keyframes of animations (indices into Document::animations); where several change
    /// the same thing, the later one counts.
    ///
    /// Errors  as read_keyframes
    static Result<Animator> create(const Document& document,
                                   const BufferStore& buffers,
                                   const std::vector<int>& animations);

    bool empty() const { return tracks_.empty(); }
    /// True when there are animations, and not only values that were set.
    bool plays() const;

    /// Sets a property to a value at all times, in place of what animations and earlier calls say.
    void set(const SetValue& wanted, const Document& document);

    /// Says of each node and mesh of the document whether it is animated. True when that is new
    /// for any: geometry that was static may be so no more.
    bool mark(Document& document) const;

    /// Writes every animated value at a time into the document. All of them are written whatever
    /// the time is: a document may be posed again and again, in any order.
    ///
    /// Errors  65 E-CAM-*, E-NODE-ROTATION, E-LIGHT-ROTATION animated values are not valid ones
    Result<void> pose(Document& document, double time_s) const;

private:
    struct Track {
        GltfChannel channel;
        Keyframes keys;
        std::vector<double> fixed = {};  ///< the value, where it was set; then there are no keys
    };

    /// The file's value of a quaternion with single animated numbers. It is restored before every
    /// pose, because posing normalises all four numbers.
    struct Quaternion {
        AnimatedProperty property;
        std::array<double, 4> stored;
    };

    struct AnimatedCamera {
        int number;
        CameraGiven given;
    };

    void add(Track track, const Document& document);
    Result<void> apply(const Track& track, Document& document, double time_s) const;

    std::vector<Track> tracks_;
    std::vector<Quaternion> quaternions_;
    std::vector<AnimatedCamera> cameras_;
    bool has_materials_ = false;
};

/// Indices of the animations that --animation means: "all", "none", an exact name, an index.
/// Without it the first one is played where a time is given, else none.
///
/// Errors  64 E-ANIM-UNKNOWN, E-ANIM-AMBIGUOUS; both messages list the names
Result<std::vector<int>> choose_animations(const Document& document,
                                           const std::optional<std::string>& choice,
                                           bool has_time);

}  // namespace obscura::gltf
