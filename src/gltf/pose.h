// gltf/pose.h - writes the values of animations at a time into a document.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/animation.h"

#include <nlohmann/json.hpp>
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
    /// In      tree: the document's JSON; what pointers into materials, lights and cameras need of
    ///         it is kept
    /// Errors  as read_keyframes
    static Result<Animator> create(const nlohmann::json& tree,
                                   const Document& document,
                                   const BufferStore& buffers,
                                   const std::vector<int>& animations);

    bool empty() const { return tracks_.empty(); }

    /// Says of each node and mesh of the document whether it is animated.
    void mark(Document& document) const;

    /// Writes every animated value at a time into the document. All of them are written whatever
    /// the time is: a document may be posed again and again, in any order.
    ///
    /// Errors  those of read_document, of materials, lights and cameras that animated values break
    Result<void> pose(Document& document, double time_s);

private:
    struct Track {
        GltfChannel channel;
        Keyframes keys;
    };

    void apply(const Track& track, Document& document, double time_s);
    Result<void> read_again(Document& document) const;

    std::vector<Track> tracks_;
    nlohmann::json tree_;  ///< only what is read again
};

/// Indices of the animations that --animation means: "all", "none", an exact name, an index.
/// Without it the first one is played where a time is given, else none.
///
/// Errors  64 E-ANIM-UNKNOWN, E-ANIM-AMBIGUOUS; both messages list the names
Result<std::vector<int>> choose_animations(const Document& document,
                                           const std::optional<std::string>& choice,
                                           bool has_time);

}  // namespace obscura
