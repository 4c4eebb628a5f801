// light/light_tree.h - chooses one of many lights by power, distance and orientation.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/record_words.h"
#include "math/gather4.h"
#include "math/vec.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace obscura {

/// What is known of one light, or of all lights of a subtree: an upper bound of where they are and
/// where they shine. 32-bit words only.
///
/// Source  Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree
///         Splitting", HPG 2018, section 4.1: two cones, of normals and of emission around them
struct LightBounds {
    float centre[3] = {0, 0, 0};
    float radius = 0;           ///< of a sphere around the lights
    float axis[3] = {0, 0, 1};  ///< unit; of the cone that holds all normals
    /// Sum of the intensities along the normals, in candela; only ratios count
    float intensity = 0;
    float cos_normals = -1, sin_normals = 0;  ///< half angle of that cone; -1, 0: all directions
    float cos_emission = 0;  ///< angle from a normal beyond which a light emits nothing
    /// 1: some light also emits to the back. In a tree's right child: plus 2 * the leaf with which
    /// its lights begin.
    int32_t sides = 0;
};

/// An inner node of the tree.
struct LightTreeNode {
    LightBounds left, right;
};

static_assert(sizeof(LightBounds) == 12 * 4, "read as 32-bit words: no padding");

/// One light while the tree is built.
struct BoundedLight {
    LightBounds bounds;
    int32_t light = 0;  ///< number, see LightView
    Vec3f low, high;    ///< box around the light
};

/// A tree as raw pointers. Leaves are single lights and are numbered from left to right. Nodes are
/// in depth-first order, so that an inner left child follows its parent, and an inner right child
/// comes as many nodes later as the left child has lights.
struct LightTreeView {
    const LightTreeNode* nodes = nullptr;  ///< null: lights are chosen by the table alone
    const int32_t* light_of_leaf = nullptr;
    const int32_t* leaf_of_light = nullptr;  ///< by number of light; -1: it is not in the tree
    int32_t leaves = 0;
    /// The random numbers with which the table chooses the tree, in units of four.
    int32_t first_random = 0, randoms = 0;
    float share = 0;  ///< probability of that
};

/// Owns the arrays of LightTreeView.
struct LightTree {
    std::vector<LightTreeNode> nodes;
    std::vector<int32_t> light_of_leaf;
    std::vector<int32_t> leaf_of_light;
};

/// Builds the tree; the same lights give the same tree.
///
/// In      lights: at least two, with intensities above 0; light_count: above all their numbers
/// Source  Conty Estevez and Kulla 2018, section 4.3: the surface area orientation heuristic
LightTree build_light_tree(std::span<const BoundedLight> lights, size_t light_count);

inline namespace OBSCURA_ISA {

/// Where light is to arrive.
template <typename F>
struct LitPoint {
    Vec3<F> position;
    /// Unit: light from behind it is not seen. Zero: light is seen from all sides.
    Vec3<F> normal;
};

/// LightBounds in registers.
template <typename F>
struct LightBoundsValues {
    Vec3<F> centre, axis;
    F radius, intensity, cos_normals, sin_normals, cos_emission;
    IntOf<F> sides;
};

/// In      index: of a node, in range for idle lanes too
template <typename F, size_t child>
OBSCURA_INLINE LightBoundsValues<F> read_light_bounds(const LightTreeNode* nodes,
                                                      const IntOf<F>& index) {
    static_assert(offsetof(LightBounds, radius) == 12 && offsetof(LightBounds, axis) == 16 &&
                  offsetof(LightBounds, intensity) == 28 &&
                  offsetof(LightBounds, cos_normals) == 32 && offsetof(LightBounds, sides) == 44);
    const auto* words = member_words<float>(nodes, child * sizeof(LightBounds));
    const IntOf<F> first = index * IntOf<F>(words_per_record<LightTreeNode>);
    const Four<F> place = gather4<F>(words, first);
    const Four<F> axis = gather4<F>(words + 4, first);
    const Four<F> angles = gather4<F>(words + 8, first);
    return {{place.x, place.y, place.z},
            {axis.x, axis.y, axis.z},
            place.w,
            axis.w,
            angles.x,
            angles.y,
            angles.z,
            float_bits(angles.w)};
}

/// cos(max(a - b, 0)) for angles in [0, pi].
template <typename F>
OBSCURA_INLINE F cos_of_difference(const F& cos_a, const F& sin_a, const F& cos_b, const F& sin_b) {
    return select(cos_a >= cos_b, F(1.0f), cos_a * cos_b + sin_a * sin_b);
}

/// What rounding may add to a cosine that bounds others.
inline constexpr float light_cosine_slack = 1e-3f;

/// The least that orientation leaves of a light's importance, unless it leaves nothing: what glossy
/// surfaces reflect at grazing angles does not fall with the cosine.
inline constexpr float min_light_cosine = 0.1f;

/// Within this fraction of their radius, distance to the centre of lights does not count. Between
/// 0.35 and 0.7 of it the noise of many lamps over a floor is least.
inline constexpr float nearest_light_distance = 0.5f;

/// An estimate of the irradiance that lights may bring to a point. 0 only where none of them
/// brings any.
///
/// Source  Conty Estevez and Kulla 2018, section 4.2: cosines bounded over the sphere that holds
///         the lights
template <typename F>
OBSCURA_INLINE F light_importance(const LightBoundsValues<F>& lights, const LitPoint<F>& at) {
    const F one(1.0f);
    const F zero(0.0f);
    const F slack(light_cosine_slack);
    const Vec3<F> to_point = at.position - lights.centre;
    const F squared = max(dot(to_point, to_point), F(1e-24f));
    const F inverse = inverse_sqrt(squared);
    const F sin_size = min(lights.radius * inverse, one);
    const F cos_size = sqrt(one - sin_size * sin_size);
    const auto inside = sin_size >= one;
    const auto sine = [&](const F& cosine) { return sqrt(max(one - cosine * cosine, zero)); };

    F cos_axis = dot(lights.axis, to_point) * inverse;
    const auto both = (lights.sides & IntOf<F>(1)) != IntOf<F>(0);
    cos_axis = clamp(select(both, abs(cos_axis), cos_axis), F(-1.0f), one);
    const F sin_axis = sine(cos_axis);
    const F cos_past =
        cos_of_difference(cos_axis, sin_axis, lights.cos_normals, lights.sin_normals);
    const F sin_past = max(sin_axis * lights.cos_normals - cos_axis * lights.sin_normals, zero);
    F emitted = cos_of_difference(cos_past, sin_past, cos_size, sin_size);
    emitted = select(inside, one, emitted);
    const auto shines = emitted > lights.cos_emission - slack;

    const F cos_normal = clamp(F(-dot(at.normal, to_point) * inverse), F(-1.0f), one);
    F received = cos_of_difference(cos_normal, sine(cos_normal), cos_size, sin_size);
    // From inside the sphere, the part of it that is above the surface tells most.
    const F above = F(0.5f) - F(0.5f) * dot(at.normal, to_point) / max(lights.radius, F(1e-12f));
    received = select(inside, clamp(above, zero, one), received);
    const auto open = dot(at.normal, at.normal) <= zero;
    received = select(open, one, received);

    const F lowest(min_light_cosine);
    const F cosines = max(emitted, lowest) * max(received, lowest);
    const F nearest = F(nearest_light_distance) * lights.radius;
    const F importance = lights.intensity * cosines / max(squared, nearest * nearest);
    return select(shines & (received > -slack), max(importance, F(1e-36f)), zero);
}

/// The part of the tree that a descent has reached.
template <typename F>
struct LightTreePlace {
    IntOf<F> node = IntOf<F>(0);  ///< of the lights [first, end), if they are more than one
    IntOf<F> first = IntOf<F>(0);
    IntOf<F> end;
    IntOf<F> randoms;  ///< how many random numbers lead there
};

/// A node's choice between its children.
template <typename F>
struct LightTreeFork {
    IntOf<F> of_left, of_right;  ///< random numbers; both 0: no light brings anything
    IntOf<F> middle;             ///< first leaf of the right child
};

/// In      goes: elsewhere the result means nothing
template <typename F>
OBSCURA_INLINE LightTreeFork<F> light_tree_fork(const LightTreeView& tree,
                                                const LightTreePlace<F>& place,
                                                const LitPoint<F>& at,
                                                const MaskOf<F>& goes) {
    using I = IntOf<F>;
    const I node = select(goes, place.node, I(0));
    const LightBoundsValues<F> l = read_light_bounds<F, 0>(tree.nodes, node);
    const LightBoundsValues<F> r = read_light_bounds<F, 1>(tree.nodes, node);
    const F left = light_importance(l, at);
    const F right = light_importance(r, at);
    const F both = left + right;
    const F share = left / max(both, F(1e-37f));
    const I middle = as_int(as_uint(r.sides) >> 1);
    // A child that brings light has a number for each of its lights, however little that is beside
    // the other's, which may be hidden. Rounding may make a large number one more than it is.
    const I least = select(left > F(0.0f), I(middle - place.first), I(0));
    const I rest = select(right > F(0.0f), I(place.end - middle), I(0));
    const I shared = to_int(from_int<F>(place.randoms) * share);
    const I of_left = select(right > F(0.0f),
                             max(min(shared, I(place.randoms - rest)), least),
                             select(left > F(0.0f), place.randoms, I(0)));
    const I of_right = select(both > F(0.0f), I(place.randoms - of_left), I(0));
    return {of_left, of_right, middle};
}

/// Goes on to a child where `goes`.
template <typename F>
OBSCURA_INLINE void enter_child(const MaskOf<F>& goes,
                                const MaskOf<F>& left,
                                const LightTreeFork<F>& fork,
                                LightTreePlace<F>& place) {
    const IntOf<F> step = select(left, IntOf<F>(1), IntOf<F>(fork.middle - place.first));
    const IntOf<F> randoms = select(left, fork.of_left, fork.of_right);
    place.node = select(goes, IntOf<F>(place.node + step), place.node);
    place.end = select(goes & left, fork.middle, place.end);
    place.first = select(goes & (!left), fork.middle, place.first);
    place.randoms = select(goes, randoms, place.randoms);
}

/// The probability of the tree's choice: it is the number of random numbers that lead there, so
/// that rounding on the way down has no part in it.
template <typename F>
OBSCURA_INLINE F light_tree_probability(const LightTreeView& tree, const LightTreePlace<F>& place) {
    return from_int<F>(place.randoms) * F(1.0f / static_cast<float>(tree.randoms));
}

/// A light that the tree has chosen.
template <typename F>
struct LightTreeDraw {
    IntOf<F> light;  ///< number, see LightView
    F probability;   ///< of the choice by the tree; 0: no light brings anything
    F place;  ///< in [0, 1): what the choice has left of the random number, as CdfDraw::place
};

/// Chooses a light. Lights stand in the order of their leaves, as in a CDF: a child has a part of
/// its parent's random numbers in proportion to its importance, so that numbers that are stratified
/// stay so within every subtree and on every light.
///
/// In      random: a number of those with which the table chooses the tree; active: elsewhere the
///         light is any of the tree's
template <typename F>
OBSCURA_INLINE LightTreeDraw<F> draw_from_light_tree(const LightTreeView& tree,
                                                     const LitPoint<F>& at,
                                                     const UintOf<F>& random,
                                                     const MaskOf<F>& active) {
    using I = IntOf<F>;
    LightTreePlace<F> place;
    place.end = select(active, I(tree.leaves), I(1));
    place.randoms = I(tree.randoms);
    I number = as_int(random >> 2) - I(tree.first_random);  // among those of the place
    while (true) {
        const auto goes = place.end - place.first > I(1);
        if (none(goes)) break;
        const LightTreeFork<F> fork = light_tree_fork<F>(tree, place, at, goes);
        const auto left = number < fork.of_left;
        number = select(goes & (!left), I(number - fork.of_left), number);
        enter_child<F>(goes, left, fork, place);
    }
    const F within = (from_int<F>(number) + F(0.5f)) / from_int<F>(max(place.randoms, I(1)));
    return {gather<F>(tree.light_of_leaf, place.first),
            light_tree_probability(tree, place),
            min(within, F(0x1.fffffep-1f))};
}

/// Probability with which draw_from_light_tree chooses the light of a leaf.
template <typename F>
OBSCURA_INLINE F light_tree_probability(const LightTreeView& tree,
                                        const LitPoint<F>& at,
                                        const IntOf<F>& leaf,
                                        const MaskOf<F>& active) {
    using I = IntOf<F>;
    LightTreePlace<F> place;
    place.end = select(active, I(tree.leaves), I(1));
    place.randoms = I(tree.randoms);
    while (true) {
        const auto goes = place.end - place.first > I(1);
        if (none(goes)) break;
        const LightTreeFork<F> fork = light_tree_fork<F>(tree, place, at, goes);
        enter_child<F>(goes, leaf < fork.middle, fork, place);
    }
    return light_tree_probability(tree, place);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
