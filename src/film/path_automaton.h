// film/path_automaton.h - one automaton that follows paths for many light path expressions.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/light_path_expression.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace obscura {

inline constexpr size_t max_path_expressions = 64;    ///< one bit each
inline constexpr size_t max_automaton_states = 4096;  ///< before equal ones become one
/// Events and branches of all expressions, with their repetitions written out.
inline constexpr size_t max_automaton_parts = 8192;

/// The events that paths of a scene can have. Automata know them by their indices.
struct EventAlphabet {
    std::vector<ScatterEvent> scatterings;
    std::vector<LightEvent> lights;
};

/// The minimal deterministic automaton of a list of expressions: a path's state after each
/// scattering tells all that the expressions need to know about it. States of equal futures are
/// one; they are numbered in the order in which short paths reach them.
class PathAutomaton {
public:
    /// Errors  64 E-LPE when there are more than max_path_expressions, max_automaton_parts or
    ///         max_automaton_states; where: the expression, if it is one
    /// Source  Aho, Sethi, Ullman, "Compilers", 1986, section 3.9 (sets of positions as states);
    ///         Moore, "Gedanken-experiments on sequential machines", 1956 (equal states)
    static Result<PathAutomaton> compile(std::span<const LightPathExpression> expressions,
                                         const EventAlphabet& alphabet);

    int state_count() const { return static_cast<int>(settled_.size()); }

    /// The state of a path that has left the camera.
    uint16_t start() const { return 0; }

    /// In      scattering: index into EventAlphabet::scatterings
    uint16_t after_scattering(uint16_t state, size_t scattering) const {
        return next_[state * scattering_count_ + scattering];
    }

    /// The expressions that accept a path which ends with a light in this state: bit i is the one
    /// of index i.
    ///
    /// In      light: index into EventAlphabet::lights
    uint64_t accepted(uint16_t state, size_t light) const {
        return accepted_[state * light_count_ + light];
    }

    /// True when no expression accepts the path any more, wherever it goes.
    bool is_dead(uint16_t state) const { return dead_[state] != 0; }

    /// True when every scattering leads back to this state: the path needs not be followed on.
    bool is_settled(uint16_t state) const { return settled_[state] != 0; }

private:
    PathAutomaton() = default;

    size_t scattering_count_ = 0;
    size_t light_count_ = 0;
    std::vector<uint16_t> next_;      ///< by state, then scattering
    std::vector<uint64_t> accepted_;  ///< by state, then light
    std::vector<uint8_t> settled_;    ///< by state
    std::vector<uint8_t> dead_;       ///< by state
};

}  // namespace obscura
