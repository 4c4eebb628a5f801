// gltf/pose.h - writes the values of animations at a time into a document.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/animation.h"
#include "gltf/parse/light_camera_rows.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

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

    /// Says of each node and mesh of the document whether it is animated.
    void mark(Document& document) const;

    /// Writes every animated value at a time into the document. All of them are written whatever
    /// the time is: a document may be posed again and again, in any order.
    ///
    /// Errors  65 E-CAM-*, E-NODE-ROTATION, E-LIGHT-ROTATION of cameras and quaternions that
    /// animated
    ///         values break
    Result<void> pose(Document& document, double time_s) const;

private:
    struct Track {
        GltfChannel channel;
        Keyframes keys;
    };

    /// A quaternion of which single numbers are animated: how the file has it. It is set back
    /// before every pose, for a pose brings all four numbers to length 1.
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

}  // namespace obscura
