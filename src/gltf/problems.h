// gltf/problems.h - collects an asset's faults, then refuses it or warns.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"

#include <set>
#include <string>
#include <vector>

namespace obscura::gltf {

/// Counts of what a leniently loaded scene lacks.
struct Degraded {
    size_t textures = 0;    ///< images that could not be read
    size_t primitives = 0;  ///< of meshes, and shapes, that are not drawn at all
    size_t triangles = 0;   ///< left out of primitives that are drawn; points and lines too
};

/// What a scene loses when loading continues.
enum class Loss { nothing, texture, primitive, triangle };

struct Remedy {
    Loss loss = Loss::nothing;
    std::string text;  ///< what is done: "the primitive is not drawn"
    size_t count = 1;
};

/// The problems of one asset, in the order in which they are added, which is the same for any
/// number of threads. Readers add what they find and go on, as if loading were lenient; settle()
/// then refuses the asset or warns.
///
/// Some problems stop lenient loading too: limits, policies and memory (33, 77), input and output
/// (74), and accessors whose structure is broken (E-ACC-* but a count of 0).
class Problems {
public:
    explicit Problems(bool lenient = false) : lenient_(lenient) {}

    bool lenient() const { return lenient_; }

    /// Adds a problem. The same one found again, in another use of a mesh, is not counted again.
    void add(const Error& error, const Remedy& remedy);
    /// Counts the losses that an earlier scene of the asset reported.
    void count(Loss loss, size_t count);

    /// Ends the collection and begins a new one. Of more than 100 problems the others are counted.
    ///
    /// In      end: the error that ended loading; nullptr: it completed
    /// Out     strict: the first problem with all others in Error::also, `end` last.
    ///         Lenient: a warning for each, and what is lost; the first that stops lenient loading
    Result<Degraded> settle(const Error* end, Log& log);

private:
    struct Problem {
        Error error;
        std::string remedy;
        bool final = false;
    };

    void add_final(const Error& error);
    Result<void> refuse() const;
    void warn(Log& log) const;

    bool lenient_;
    std::vector<Problem> list_;
    std::set<std::string> known_;
    Degraded lost_;
};

}  // namespace obscura::gltf
