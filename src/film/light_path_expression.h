// film/light_path_expression.h - light path expressions: from their text to a syntax tree.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "surface/scatter_event.h"

#include <string>
#include <string_view>
#include <vector>

namespace obscura {

inline constexpr size_t max_expression_length = 4096;  ///< bytes
inline constexpr int max_repetition_count = 64;        ///< n and m of {n,m}
inline constexpr int max_expression_nesting = 64;      ///< parentheses within parentheses
inline constexpr size_t max_shown_expression = 80;     ///< bytes of it that an error shows

/// The light that a path ends with.
struct LightEvent {
    char kind;          ///< L a punctual light, O an emitting surface, B the background
    std::string group;  ///< its label: the light group, "" for none
};

/// Labels that an event may have. Without members it accepts all.
struct LabelPattern {
    std::vector<std::string> globs;  ///< "*" stands for any characters, also none
    bool negated = true;             ///< accepts all labels but these
};

/// In EventPattern::modes: lights, which have no mode, are accepted.
inline constexpr char no_mode = '-';

/// Events by type, mode and label: <R[GS]'coat'>, or what D is short for.
struct EventPattern {
    std::string types;  ///< letters of "RTVLOB"
    std::string modes;  ///< letters of "DGS", and no_mode
    LabelPattern labels;
};

/// The events that one position of a path may have: what one of the members accepts, or, negated,
/// what none accepts.
struct EventSet {
    std::vector<EventPattern> members;
    bool negated = false;
};

bool matches(const EventSet& events, const ScatterEvent& scattering);
bool matches(const EventSet& events, const LightEvent& light);

/// A part of an expression with the parts that it is made of.
///
/// To add an operator: a kind here, the parser in light_path_expression.cpp, both passes of
/// path_order.cpp, and Nfa::add in path_automaton.cpp.
struct PathNode {
    enum class Kind { camera, event, sequence, choice, repetition };

    static constexpr int unbounded = -1;

    Kind kind = Kind::camera;
    size_t column = 1;                  ///< where it begins in the text, in bytes, from 1
    std::vector<size_t> children = {};  ///< indices of nodes; a repetition has one
    int min_count = 1;                  ///< of a repetition
    int max_count = 1;                  ///< of a repetition; or unbounded
    EventSet events = {};               ///< of an event
};

/// An expression that was checked: each path that it accepts begins with C, ends with a light and
/// has neither of them elsewhere.
struct LightPathExpression {
    std::string text;             ///< as it was written, for messages
    std::vector<PathNode> nodes;  ///< children before parents: the last is the whole expression
};

/// Parses a light path expression: which paths from the camera to a light belong to a layer.
///
///   C               the camera, with which all paths begin
///   <RG'coat'>      a scattering: type R, T or V, mode D, G or S, label of the lobe. Each may be
///                   ".", a set [GS] or a negated set [^S]; what is left out at the end is anything
///   <L'key'>        a light: L punctual, O an emitting surface, B the background, with the label
///                   of its group; <L.'key'> is the same
///   R  D  L  .      short for <R>, <.D> and <L>; "." is any event, scattering or light
///   [LO]  [^S]      one of these events, or any event but these; members may be <...>
///   XY  X|Y  (X)    in sequence, one of both, grouped; "|" binds least
///   X* X+ X?        any number of times, at least once, at most once
///   X{n} {n,m} {n,} as often as that
///
/// A set of labels is ['coat' 'sheen'] or [^'coat']; in a label "*" is any characters. White space
/// counts in labels only.
///
/// As in OSL, a light has a label but no mode, so that [^S] and <.[^S]> accept lights while D and
/// <.D> do not. Unlike in OSL, "|" binds less than a sequence, as in other regular expressions; ?
/// exists; [^RS] means neither R nor S; sets do not hold sequences; a label stands in <...> only,
/// and there is one; there is no straight mode "s"; C.* is refused, C.*[LOB] is meant.
///
/// Errors  64 E-LPE with the column and what is accepted there; where: how it begins. Also when
///         it is longer than max_expression_length, repeats more than max_repetition_count times,
///         nests deeper than max_expression_nesting; when a path that it accepts does not begin
///         with C or end with a light; when no path fits
/// Source  Heckbert, "Adaptive Radiosity Textures for Bidirectional Ray Tracing", SIGGRAPH 1990;
///         Open Shading Language, "OSL Light Path Expressions"
Result<LightPathExpression> parse_light_path_expression(std::string_view text);

}  // namespace obscura
