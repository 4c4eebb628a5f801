// crosscheck/segment_rounding.cpp - rounding bounds of Embree's test of a curve segment.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/segment_rounding.h"

#include "crosscheck/truth.h"

#include <algorithm>
#include <cmath>

namespace obscura::crosscheck {

namespace {

/// Bound of so many roundings, relative to the sizes of the rounded numbers.
constexpr double roundings(double count) {
    return count * 0.5 * ulp_of_one;
}

double square_of(double x) {
    return x * x;
}

}  // namespace

SegmentRounding::SegmentRounding(const Segment<double>& segment, const TrueRay& ray)
    : radius_from_(segment.radius_from), radius_to_(segment.radius_to) {
    const Vec3d& d = ray.direction;
    const Vec3d p = segment.to - segment.from;
    direction2_ = dot(d, d);
    start_ = dot((segment.from + segment.to) * 0.5 - ray.origin, d) / direction2_;
    const Vec3d near = ray.origin + d * start_;
    const Vec3d o = near - segment.from;
    const double l = dot(p, p);
    const double dr = radius_to_ - radius_from_;
    const double r0_dr = radius_from_ * dr;
    const double r0_l = square_of(radius_from_) * l;
    length_m_ = std::sqrt(l);
    cone_ = l - dr * dr;
    cone_size_ = l + dr * dr;
    const double o_p = dot(o, p);
    const double o_p_size = dot(abs(o), abs(p));
    const double o_d_size = dot(abs(o), abs(d));
    place_ = o_p + r0_dr;
    place_size_ = o_p_size + std::abs(r0_dr);
    speed_ = dot(d, p);
    speed_size_ = dot(abs(d), abs(p));
    const Vec3d from_cap = near - segment.to;
    cap_near_ = dot(from_cap, from_cap);
    cap_along_ = dot(abs(from_cap), abs(d));
    cap_on_way_ = dot(from_cap, d);

    // Scalar products 3, g 4, place 4; each with its factor's, the product and the differences.
    a_ = {cone_ * direction2_ - speed_ * speed_,
          roundings(9) * (cone_size_ * direction2_ + square_of(speed_size_))};
    b_ = {cone_ * dot(o, d) - speed_ * place_,
          roundings(9) * (cone_size_ * o_d_size + speed_size_ * place_size_)};
    c_ = {cone_ * dot(o, o) - o_p * o_p - r0_l - 2 * r0_dr * o_p,
          roundings(11) * (cone_size_ * dot(o, o) + square_of(o_p_size) + r0_l +
                           2 * std::abs(r0_dr) * o_p_size)};
    const RoundedNumber a{std::abs(a_.value), a_.error};
    const RoundedNumber b{std::abs(b_.value), b_.error};
    const RoundedNumber c{std::abs(c_.value), c_.error};
    discriminant_ = {square_of(b_.value) - a_.value * c_.value,
                     (2 * b.value + b.error) * b.error + a.value * c.error + c.value * a.error +
                         a.error * c.error +
                         roundings(2) * (square_of(b.value) + a.value * c.value)};
}

bool SegmentRounding::is_chance() const {
    const double room = roundings(4) * cone_size_;
    if (cone_ < -room) return false;  // one sphere holds the other, and there is no cone
    return cone_ <= room || std::abs(a_.value) <= a_.error ||
           std::abs(discriminant_.value) <= discriminant_.error;
}

double SegmentRounding::cone_error(double t) const {
    const double along = std::abs(t - start_);
    // Two in the discriminant; its root, sum, reciprocal (5 by Newton's step) and product are 30.
    const double products = square_of(b_.value) + std::abs(a_.value * c_.value);
    const double solving = roundings(32) * products / std::max(std::abs(a_.value), a_.error);
    return a_.error * along * along + 2 * b_.error * along + c_.error + solving;
}

double SegmentRounding::cap_m() const {
    // Half the chord is at most the radius.
    const double radius2 = square_of(radius_to_);
    const double along2 = square_of(cap_along_) / direction2_;
    const double off = roundings(22) * along2 + roundings(9) * cap_near_ + roundings(44) * radius2;
    return off / (2 * std::max(radius_to_, 1e-3 * length_m_));
}

double SegmentRounding::surface_m(double t) const {
    if (cone_ <= 0) return cap_m();
    // F rises by 2 sqrt(g l) times the radius a metre; a cone's point is not taken for thinner than
    // a thousandth of its length.
    const double thin = std::max(std::min(radius_from_, radius_to_), 0.5e-3 * length_m_);
    const double slope = 2 * std::sqrt(cone_) * length_m_ * thin;
    return std::max(cap_m(), cone_error(t) / slope);
}

bool SegmentRounding::is_on_first_cap(double t) const {
    return cone_ > 0 && place_ + (t - start_) * speed_ < 0;
}

bool SegmentRounding::is_at_seam(double t) const {
    const double steepness = std::abs(a_.value);
    if (cone_ <= 0 || steepness <= a_.error) return false;  // no cone, or no position on it
    const double along = t - start_;
    const double error = cone_error(t);
    const double root = std::sqrt(std::max(discriminant_.value, 0.0));
    const double moved_on_cone = std::min(error / root, std::sqrt(error / steepness));
    const double cap_error = 2 * radius_to_ * cap_m();
    const double cap_root = std::abs(cap_on_way_ + along * direction2_);
    const double moved_on_cap = std::min(cap_error / cap_root, std::sqrt(cap_error / direction2_));
    const double moved = std::max(moved_on_cone, moved_on_cap);
    const double room = roundings(5) * (place_size_ + std::abs(along) * speed_size_) +
                        roundings(4) * cone_size_ + std::abs(speed_) * moved;
    const double place = place_ + along * speed_;
    return std::abs(place) <= room || std::abs(place - cone_) <= room;
}

}  // namespace obscura::crosscheck
