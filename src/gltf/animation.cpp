// gltf/animation.cpp - reads keyframes and interpolates between them.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/animation.h"

#include "gltf/parse/trs.h"

#include <algorithm>
#include <cmath>

namespace obscura::gltf {

namespace {

/// The keys around a time, and how far it is from the first to the second.
struct KeySpan {
    size_t before = 0;
    size_t after = 0;
    double fraction = 0;
    double seconds = 0;  ///< between the two
};

/// Files store times as floats: a frame's time, n / fps, must meet the key that was written for it,
/// though that may have been rounded up. So keys are found by the time as a float.
KeySpan find_span(const std::vector<float>& times, double time_s) {
    const auto later = std::upper_bound(times.begin(), times.end(), static_cast<float>(time_s));
    const auto after = static_cast<size_t>(later - times.begin());
    if (after == 0) return {0, 0, 0, 0};
    if (after == times.size()) return {after - 1, after - 1, 0, 0};
    const double begin = times[after - 1];
    const double seconds = double{times[after]} - begin;
    return {after - 1, after, std::clamp((time_s - begin) / seconds, 0.0, 1.0), seconds};
}

/// Values in one key: of CUBICSPLINE tangent, value, tangent.
size_t values_per_key(const Keyframes& keys) {
    return keys.kind.interpolation == Interpolation::cubic_spline ? 3 : 1;
}

std::span<const float> value_of(const Keyframes& keys, size_t key, size_t element) {
    const size_t at = (key * values_per_key(keys) + element) * keys.kind.width;
    return std::span(keys.values).subspan(at, keys.kind.width);
}

std::array<double, 4> quaternion_of(std::span<const float> value) {
    std::array<double, 4> out = {value[0], value[1], value[2], value[3]};
    normalize_quaternion(out);
    return out;
}

/// glTF 2.0, appendix C.5: a cubic through two values with the tangents there.
double cubic(const std::array<double, 2>& values,
             const std::array<double, 2>& tangents,
             const KeySpan& at) {
    const double t = at.fraction;
    const double t2 = t * t;
    const double t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * values[0] + at.seconds * (t3 - 2 * t2 + t) * tangents[0] +
           (-2 * t3 + 3 * t2) * values[1] + at.seconds * (t3 - t2) * tangents[1];
}

std::vector<double> sample_cubic(const Keyframes& keys, const KeySpan& at) {
    const std::span<const float> from = value_of(keys, at.before, 1);
    const std::span<const float> leave = value_of(keys, at.before, 2);
    const std::span<const float> arrive = value_of(keys, at.after, 0);
    const std::span<const float> to = value_of(keys, at.after, 1);
    std::vector<double> out(from.size());
    for (size_t i = 0; i < out.size(); ++i) {
        out[i] = at.before == at.after ? double{from[i]}
                                       : cubic({from[i], to[i]}, {leave[i], arrive[i]}, at);
    }
    if (!keys.kind.quaternion) return out;
    std::array<double, 4> unit = {out[0], out[1], out[2], out[3]};
    if (!normalize_quaternion(unit)) unit = quaternion_of(from);
    return {unit.begin(), unit.end()};
}

tl::unexpected<Error> bad_keys(const Document& document,
                               int accessor,
                               const char* id,
                               std::string message) {
    return fail(ExitCode::bad_data,
                id,
                document.at("accessors", static_cast<size_t>(accessor)),
                std::move(message));
}

Result<std::vector<float>> read_times(const Document& document,
                                      const BufferStore& buffers,
                                      int accessor) {
    Result<std::vector<float>> times = read_floats(document, buffers, accessor, {});
    if (!times) return times;
    if (times->empty()) {
        return bad_keys(document, accessor, "E-ANIM-TIMES", "there are no keyframes");
    }
    for (size_t i = 0; i < times->size(); ++i) {
        const float time = (*times)[i];
        if (std::isfinite(time) && (i == 0 || time >= (*times)[i - 1])) continue;
        return bad_keys(document,
                        accessor,
                        "E-ANIM-TIMES",
                        "keyframe time " + std::to_string(i) +
                            " is not finite or before the one in front of it; times must rise");
    }
    return times;
}

}  // namespace

std::array<double, 4> slerp(const std::array<double, 4>& a,
                            const std::array<double, 4>& b,
                            double fraction) {
    double dot = 0;
    for (size_t i = 0; i < 4; ++i)
        dot += a[i] * b[i];
    const double sign = dot < 0 ? -1 : 1;
    double apart = 0;
    double together = 0;
    for (size_t i = 0; i < 4; ++i) {
        apart += (a[i] - sign * b[i]) * (a[i] - sign * b[i]);
        together += (a[i] + sign * b[i]) * (a[i] + sign * b[i]);
    }
    // Kahan: exact for small angles too, where the arc cosine is not.
    const double angle = 2 * std::atan2(std::sqrt(apart), std::sqrt(together));
    constexpr double straight = 1e-6;  // chord and arc agree to the last bit
    const bool curved = angle > straight;
    const double from = curved ? std::sin((1 - fraction) * angle) / std::sin(angle) : 1 - fraction;
    const double to = curved ? std::sin(fraction * angle) / std::sin(angle) : fraction;
    std::array<double, 4> out = {};
    for (size_t i = 0; i < 4; ++i)
        out[i] = from * a[i] + to * sign * b[i];
    normalize_quaternion(out);
    return out;
}

std::vector<double> sample(const Keyframes& keys, double time_s) {
    const KeySpan at = find_span(keys.times, time_s);
    if (keys.kind.interpolation == Interpolation::cubic_spline) return sample_cubic(keys, at);
    const bool steps = keys.kind.interpolation == Interpolation::step;
    const std::span<const float> from = value_of(keys, at.before, 0);
    const std::span<const float> to = value_of(keys, steps ? at.before : at.after, 0);
    if (keys.kind.quaternion) {
        const auto turned = slerp(quaternion_of(from), quaternion_of(to), at.fraction);
        return {turned.begin(), turned.end()};
    }
    std::vector<double> out(from.size());
    for (size_t i = 0; i < out.size(); ++i)
        out[i] = (1 - at.fraction) * double{from[i]} + at.fraction * double{to[i]};
    return out;
}

Result<Keyframes> read_keyframes(const Document& document,
                                 const BufferStore& buffers,
                                 const GltfAnimationSampler& sampler,
                                 const KeyframeKind& kind) {
    Keyframes out;
    out.kind = kind;
    Result<std::vector<float>> times = read_times(document, buffers, sampler.input);
    if (!times) return fail(std::move(times.error()));
    out.times = std::move(*times);
    Result<std::vector<float>> values = read_floats(document, buffers, sampler.output, {});
    if (!values) return fail(std::move(values.error()));
    out.values = std::move(*values);
    const auto is_finite = [](float value) { return std::isfinite(value); };
    if (!std::all_of(out.values.begin(), out.values.end(), is_finite)) {
        return bad_keys(document, sampler.output, "E-ANIM-VALUE", "a value is not finite");
    }
    const size_t middle = values_per_key(out) / 2;  // tangents may be 0
    for (size_t key = 0; key < out.times.size() && kind.quaternion; ++key) {
        const std::span<const float> value = value_of(out, key, middle);
        std::array<double, 4> unit = {value[0], value[1], value[2], value[3]};
        if (normalize_quaternion(unit)) continue;
        return bad_keys(document,
                        sampler.output,
                        "E-ANIM-VALUE",
                        "the quaternion of keyframe " + std::to_string(key) + " has no length");
    }
    return out;
}

Result<double> animation_end(const Document& document,
                             const BufferStore& buffers,
                             const GltfAnimation& animation) {
    double end = 0;
    for (const GltfAnimationSampler& sampler : animation.samplers) {
        const Result<std::vector<float>> times = read_times(document, buffers, sampler.input);
        if (!times) return fail(times.error());
        end = std::max(end, double{times->back()});
    }
    return end;
}

}  // namespace obscura::gltf
