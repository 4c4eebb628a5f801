// math/lanes.h - one value type for one path (float, double) or for 4, 8 or 16 at once (Lanes).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>
#include <xsimd/xsimd.hpp>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

/// Name of the inline namespace that separates the code of one instruction set from that of others.
/// The build sets it for the stages; everything else is compiled once, as baseline.
#ifndef OBSCURA_ISA
#define OBSCURA_ISA isa_baseline
#endif

/// Numeric helpers are always inlined: a call per operation would cost more than the operation.
#define OBSCURA_INLINE inline __attribute__((always_inline))

namespace obscura {
inline namespace OBSCURA_ISA {

namespace xs = xsimd;

using BatchF = xs::batch<float>;
using BatchI = xs::batch<int32_t>;
using BatchU = xs::batch<uint32_t>;

inline constexpr int lane_count = static_cast<int>(BatchF::size);

// clang-format off

/// One boolean per lane.
struct Mask {
    xs::batch_bool<float> v;
    Mask() = default;
    OBSCURA_INLINE Mask(xs::batch_bool<float> b) : v(b) {}  // NOLINT(google-explicit-constructor)
#if defined(__AVX512F__)  // xsimd 8 would go through memory, here and in operator!
    OBSCURA_INLINE explicit Mask(bool b) : v(static_cast<__mmask16>(b ? 0xFFFF : 0)) {}
#else
    OBSCURA_INLINE explicit Mask(bool b) : v(b) {}
#endif
#if XSIMD_VERSION_MAJOR >= 9
    template <typename T> OBSCURA_INLINE static Mask from(xs::batch_bool<T> b) {
        return {xs::batch_bool_cast<float>(b)};
    }
    template <typename T> OBSCURA_INLINE xs::batch_bool<T> as() const {
        return xs::batch_bool_cast<T>(v);
    }
#elif defined(__AVX512F__)
    template <typename T> OBSCURA_INLINE static Mask from(xs::batch_bool<T> b) {
        return {xs::batch_bool<float>(b.data)};
    }
    template <typename T> OBSCURA_INLINE xs::batch_bool<T> as() const {
        return xs::batch_bool<T>(v.data);
    }
#elif defined(__AVX__)
    template <typename T> OBSCURA_INLINE static Mask from(xs::batch_bool<T> b) {
        return {xs::batch_bool<float>(_mm256_castsi256_ps(b.data))};
    }
    template <typename T> OBSCURA_INLINE xs::batch_bool<T> as() const {
        return xs::batch_bool<T>(_mm256_castps_si256(v.data));
    }
#elif defined(__x86_64__)
    template <typename T> OBSCURA_INLINE static Mask from(xs::batch_bool<T> b) {
        return {xs::batch_bool<float>(_mm_castsi128_ps(b.data))};
    }
    template <typename T> OBSCURA_INLINE xs::batch_bool<T> as() const {
        return xs::batch_bool<T>(_mm_castps_si128(v.data));
    }
#else
    template <typename T> OBSCURA_INLINE static Mask from(xs::batch_bool<T> b) {
        return {xs::batch_bool<float>(b.data)};
    }
    template <typename T> OBSCURA_INLINE xs::batch_bool<T> as() const {
        return xs::batch_bool<T>(v.data);
    }
#endif
};

OBSCURA_INLINE Mask operator&(Mask a, Mask b) { return a.v & b.v; }
OBSCURA_INLINE Mask operator|(Mask a, Mask b) { return a.v | b.v; }
#if defined(__AVX512F__)
OBSCURA_INLINE Mask operator!(Mask a) {
    return xs::batch_bool<float>(static_cast<__mmask16>(~static_cast<__mmask16>(a.v.data)));
}
#else
OBSCURA_INLINE Mask operator!(Mask a) { return ~a.v; }
#endif

/// Bit i is lane i.
OBSCURA_INLINE uint32_t mask_bits(Mask m) {
#if defined(__AVX512F__)
    return static_cast<uint32_t>(m.v.data);
#elif defined(__AVX__)
    return static_cast<uint32_t>(_mm256_movemask_ps(m.v));
#elif defined(__x86_64__)
    return static_cast<uint32_t>(_mm_movemask_ps(m.v));
#else
    bool lanes[BatchF::size];
    m.v.store_unaligned(lanes);
    uint32_t bits = 0;
    for (uint32_t i = 0; i < BatchF::size; ++i) bits |= static_cast<uint32_t>(lanes[i]) << i;
    return bits;
#endif
}
OBSCURA_INLINE bool any(Mask m) { return mask_bits(m) != 0; }
OBSCURA_INLINE bool none(Mask m) { return mask_bits(m) == 0; }
OBSCURA_INLINE bool all(Mask m) { return mask_bits(m) == (1U << lane_count) - 1U; }
OBSCURA_INLINE int count(Mask m) { return __builtin_popcount(mask_bits(m)); }

/// 4, 8 or 16 floats.
struct Lanes {
    BatchF v;
    Lanes() = default;
    OBSCURA_INLINE Lanes(BatchF b) : v(b) {}  // NOLINT(google-explicit-constructor)
    OBSCURA_INLINE Lanes(float f) : v(f) {}   // NOLINT(google-explicit-constructor)
};
/// 4, 8 or 16 signed integers.
struct LanesI {
    BatchI v;
    LanesI() = default;
    OBSCURA_INLINE LanesI(BatchI b) : v(b) {}   // NOLINT(google-explicit-constructor)
    OBSCURA_INLINE LanesI(int32_t i) : v(i) {}  // NOLINT(google-explicit-constructor)
};
/// 4, 8 or 16 unsigned integers.
struct LanesU {
    BatchU v;
    LanesU() = default;
    OBSCURA_INLINE LanesU(BatchU b) : v(b) {}    // NOLINT(google-explicit-constructor)
    OBSCURA_INLINE LanesU(uint32_t u) : v(u) {}  // NOLINT(google-explicit-constructor)
};

OBSCURA_INLINE Lanes operator+(Lanes a, Lanes b) { return a.v + b.v; }
OBSCURA_INLINE Lanes operator-(Lanes a, Lanes b) { return a.v - b.v; }
OBSCURA_INLINE Lanes operator*(Lanes a, Lanes b) { return a.v * b.v; }
OBSCURA_INLINE Lanes operator/(Lanes a, Lanes b) { return a.v / b.v; }
OBSCURA_INLINE Lanes operator-(Lanes a) { return BatchF(-0.0f) - a.v; }  // keeps the sign of zero
OBSCURA_INLINE Mask operator<(Lanes a, Lanes b) { return a.v < b.v; }
OBSCURA_INLINE Mask operator<=(Lanes a, Lanes b) { return a.v <= b.v; }
OBSCURA_INLINE Mask operator>(Lanes a, Lanes b) { return a.v > b.v; }
OBSCURA_INLINE Mask operator>=(Lanes a, Lanes b) { return a.v >= b.v; }
OBSCURA_INLINE Mask operator==(Lanes a, Lanes b) { return a.v == b.v; }
OBSCURA_INLINE Mask operator!=(Lanes a, Lanes b) {  // NaN differs from all
    return !Mask(a.v == b.v);
}

OBSCURA_INLINE LanesI operator+(LanesI a, LanesI b) { return a.v + b.v; }
OBSCURA_INLINE LanesI operator-(LanesI a, LanesI b) { return a.v - b.v; }
OBSCURA_INLINE LanesI operator*(LanesI a, LanesI b) { return a.v * b.v; }
OBSCURA_INLINE LanesI operator&(LanesI a, LanesI b) { return a.v & b.v; }
OBSCURA_INLINE LanesI operator|(LanesI a, LanesI b) { return a.v | b.v; }
OBSCURA_INLINE Mask operator<(LanesI a, LanesI b) { return Mask::from(a.v < b.v); }
OBSCURA_INLINE Mask operator>(LanesI a, LanesI b) { return Mask::from(a.v > b.v); }
OBSCURA_INLINE Mask operator<=(LanesI a, LanesI b) { return Mask::from(a.v <= b.v); }
OBSCURA_INLINE Mask operator>=(LanesI a, LanesI b) { return Mask::from(a.v >= b.v); }
OBSCURA_INLINE Mask operator==(LanesI a, LanesI b) { return Mask::from(a.v == b.v); }
OBSCURA_INLINE Mask operator!=(LanesI a, LanesI b) { return !(a == b); }

OBSCURA_INLINE LanesU operator+(LanesU a, LanesU b) { return a.v + b.v; }
OBSCURA_INLINE LanesU operator-(LanesU a, LanesU b) { return a.v - b.v; }
OBSCURA_INLINE LanesU operator*(LanesU a, LanesU b) { return a.v * b.v; }
OBSCURA_INLINE LanesU operator&(LanesU a, LanesU b) { return a.v & b.v; }
OBSCURA_INLINE LanesU operator|(LanesU a, LanesU b) { return a.v | b.v; }
OBSCURA_INLINE LanesU operator^(LanesU a, LanesU b) { return a.v ^ b.v; }
OBSCURA_INLINE LanesU operator>>(LanesU a, int s) { return a.v >> s; }
OBSCURA_INLINE LanesU operator<<(LanesU a, int s) { return a.v << s; }
OBSCURA_INLINE Mask operator==(LanesU a, LanesU b) { return Mask::from(a.v == b.v); }
OBSCURA_INLINE Mask operator!=(LanesU a, LanesU b) { return !(a == b); }
OBSCURA_INLINE Mask operator<(LanesU a, LanesU b) { return Mask::from(a.v < b.v); }

OBSCURA_INLINE Lanes select(Mask m, Lanes a, Lanes b) { return xs::select(m.v, a.v, b.v); }
OBSCURA_INLINE LanesI select(Mask m, LanesI a, LanesI b) {
    return xs::select(m.as<int32_t>(), a.v, b.v);
}
OBSCURA_INLINE LanesU select(Mask m, LanesU a, LanesU b) {
    return xs::select(m.as<uint32_t>(), a.v, b.v);
}

OBSCURA_INLINE Lanes sqrt(Lanes a) { return xs::sqrt(a.v); }
#if defined(__AVX512F__)  // a third of the time of sqrt and division; one step of Newton's, 2 ulp
OBSCURA_INLINE Lanes inverse_sqrt(Lanes a) {
    const BatchF y = _mm512_rsqrt14_ps(a.v);
    return y * (BatchF(1.5f) - BatchF(0.5f) * a.v * y * y);
}
#else
OBSCURA_INLINE Lanes inverse_sqrt(Lanes a) { return BatchF(1.0f) / xs::sqrt(a.v); }
#endif
OBSCURA_INLINE Lanes abs(Lanes a) { return xs::abs(a.v); }
OBSCURA_INLINE Lanes min(Lanes a, Lanes b) { return xs::min(a.v, b.v); }
OBSCURA_INLINE Lanes max(Lanes a, Lanes b) { return xs::max(a.v, b.v); }
OBSCURA_INLINE Lanes floor(Lanes a) { return xs::floor(a.v); }
OBSCURA_INLINE Lanes exp(Lanes a) { return xs::exp(a.v); }
OBSCURA_INLINE Lanes log(Lanes a) { return xs::log(a.v); }
OBSCURA_INLINE Lanes log2(Lanes a) { return xs::log2(a.v); }
OBSCURA_INLINE Lanes acos(Lanes a) { return xs::acos(a.v); }
OBSCURA_INLINE Lanes atan2(Lanes y, Lanes x) { return xs::atan2(y.v, x.v); }
OBSCURA_INLINE LanesI min(LanesI a, LanesI b) { return xs::min(a.v, b.v); }
OBSCURA_INLINE LanesI max(LanesI a, LanesI b) { return xs::max(a.v, b.v); }

/// The same bits as another type; since xsimd 10 the target is named by its element type.
#if XSIMD_VERSION_MAJOR >= 10
template <typename To, typename From> OBSCURA_INLINE To same_bits(From v) {
    return xs::bitwise_cast<typename To::value_type>(v);
}
#else
template <typename To, typename From> OBSCURA_INLINE To same_bits(From v) {
    return xs::bitwise_cast<To>(v);
}
#endif

/// Rounds towards zero.
OBSCURA_INLINE LanesI to_int(Lanes a) { return xs::to_int(a.v); }
OBSCURA_INLINE LanesI as_int(LanesU a) { return same_bits<BatchI>(a.v); }
OBSCURA_INLINE LanesU as_uint(LanesI a) { return same_bits<BatchU>(a.v); }
OBSCURA_INLINE LanesI float_bits(Lanes a) { return same_bits<BatchI>(a.v); }
OBSCURA_INLINE Lanes bits_float(LanesI a) { return same_bits<BatchF>(a.v); }

// Scalars: the same names, so that a formula reads the same for one path and for sixteen.
OBSCURA_INLINE bool any(bool m) { return m; }
OBSCURA_INLINE bool all(bool m) { return m; }
OBSCURA_INLINE bool none(bool m) { return !m; }
OBSCURA_INLINE int count(bool m) { return m ? 1 : 0; }
template <typename T> OBSCURA_INLINE T select(bool m, T a, T b) { return m ? a : b; }
OBSCURA_INLINE float sqrt(float a) { return __builtin_sqrtf(a); }
OBSCURA_INLINE double sqrt(double a) { return __builtin_sqrt(a); }
OBSCURA_INLINE float inverse_sqrt(float a) { return 1.0f / sqrt(a); }
OBSCURA_INLINE double inverse_sqrt(double a) { return 1.0 / sqrt(a); }
OBSCURA_INLINE float abs(float a) { return __builtin_fabsf(a); }
OBSCURA_INLINE double abs(double a) { return __builtin_fabs(a); }
OBSCURA_INLINE float min(float a, float b) { return a < b ? a : b; }
OBSCURA_INLINE double min(double a, double b) { return a < b ? a : b; }
OBSCURA_INLINE int32_t min(int32_t a, int32_t b) { return a < b ? a : b; }
OBSCURA_INLINE float max(float a, float b) { return a > b ? a : b; }
OBSCURA_INLINE double max(double a, double b) { return a > b ? a : b; }
OBSCURA_INLINE int32_t max(int32_t a, int32_t b) { return a > b ? a : b; }
OBSCURA_INLINE float floor(float a) { return __builtin_floorf(a); }
OBSCURA_INLINE double floor(double a) { return __builtin_floor(a); }
OBSCURA_INLINE float sin(float a) { return __builtin_sinf(a); }
OBSCURA_INLINE double sin(double a) { return __builtin_sin(a); }
OBSCURA_INLINE float cos(float a) { return __builtin_cosf(a); }
OBSCURA_INLINE double cos(double a) { return __builtin_cos(a); }
OBSCURA_INLINE float exp(float a) { return __builtin_expf(a); }
OBSCURA_INLINE double exp(double a) { return __builtin_exp(a); }
OBSCURA_INLINE float log(float a) { return __builtin_logf(a); }
OBSCURA_INLINE double log(double a) { return __builtin_log(a); }
OBSCURA_INLINE float log2(float a) { return __builtin_log2f(a); }
OBSCURA_INLINE double log2(double a) { return __builtin_log2(a); }
OBSCURA_INLINE float acos(float a) { return __builtin_acosf(a); }
OBSCURA_INLINE double acos(double a) { return __builtin_acos(a); }
OBSCURA_INLINE float atan2(float y, float x) { return __builtin_atan2f(y, x); }
OBSCURA_INLINE double atan2(double y, double x) { return __builtin_atan2(y, x); }
OBSCURA_INLINE int32_t to_int(float a) { return static_cast<int32_t>(a); }
OBSCURA_INLINE int32_t to_int(double a) { return static_cast<int32_t>(a); }
OBSCURA_INLINE int32_t as_int(uint32_t a) { return static_cast<int32_t>(a); }
OBSCURA_INLINE int32_t first_lane(int32_t a) { return a; }
OBSCURA_INLINE uint32_t as_uint(int32_t a) { return static_cast<uint32_t>(a); }
OBSCURA_INLINE int32_t float_bits(float a) { return __builtin_bit_cast(int32_t, a); }
OBSCURA_INLINE float bits_float(int32_t a) { return __builtin_bit_cast(float, a); }

// clang-format on

/// The integer and boolean types of a value type, and gathers with them.
template <typename F>
struct LaneTypes {  // float and double
    using Int = int32_t;
    using Uint = uint32_t;
    using Bool = bool;
    static constexpr int size = 1;
    static OBSCURA_INLINE F gather(const float* base, Int i) { return static_cast<F>(base[i]); }
    static OBSCURA_INLINE Int gather(const int32_t* base, Int i) { return base[i]; }
    static OBSCURA_INLINE Uint gather(const uint32_t* base, Int i) { return base[i]; }
    static OBSCURA_INLINE F from_int(Int i) { return static_cast<F>(i); }
};

template <>
struct LaneTypes<Lanes> {
    using Int = LanesI;
    using Uint = LanesU;
    using Bool = Mask;
    static constexpr int size = lane_count;
#if defined(__AVX512F__)  // xsimd 8 would extract the indices one by one
    static OBSCURA_INLINE Lanes gather(const float* base, LanesI i) {
        return BatchF(_mm512_i32gather_ps(i.v, base, 4));
    }
    static OBSCURA_INLINE LanesI gather(const int32_t* base, LanesI i) {
        return BatchI(_mm512_i32gather_epi32(i.v, base, 4));
    }
    static OBSCURA_INLINE LanesU gather(const uint32_t* base, LanesI i) {
        return as_uint(gather(reinterpret_cast<const int32_t*>(base), i));
    }
#elif defined(__AVX2__)
    static OBSCURA_INLINE Lanes gather(const float* base, LanesI i) {
        return BatchF(_mm256_i32gather_ps(base, i.v, 4));
    }
    static OBSCURA_INLINE LanesI gather(const int32_t* base, LanesI i) {
        return BatchI(_mm256_i32gather_epi32(base, i.v, 4));
    }
    static OBSCURA_INLINE LanesU gather(const uint32_t* base, LanesI i) {
        return as_uint(gather(reinterpret_cast<const int32_t*>(base), i));
    }
#else
    static OBSCURA_INLINE Lanes gather(const float* base, LanesI i) {
        return BatchF::gather(base, i.v);
    }
    static OBSCURA_INLINE LanesI gather(const int32_t* base, LanesI i) {
        return BatchI::gather(base, i.v);
    }
    static OBSCURA_INLINE LanesU gather(const uint32_t* base, LanesI i) {
        return as_uint(gather(reinterpret_cast<const int32_t*>(base), i));
    }
#endif
    static OBSCURA_INLINE Lanes from_int(LanesI i) {
        return xs::to_float(i.v);
    }
};

// clang-format off
OBSCURA_INLINE Lanes load(const float* p) { return BatchF::load_unaligned(p); }
OBSCURA_INLINE LanesI load(const int32_t* p) { return BatchI::load_unaligned(p); }
OBSCURA_INLINE LanesU load(const uint32_t* p) {
    return as_uint(load(reinterpret_cast<const int32_t*>(p)));
}
OBSCURA_INLINE int32_t first_lane(LanesI a) {
#if defined(__AVX512F__)
    return _mm512_cvtsi512_si32(a.v);
#elif defined(__AVX2__)
    return _mm256_cvtsi256_si32(a.v);
#else
    return a.v.get(0);
#endif
}
OBSCURA_INLINE void store(float* p, Lanes a) { a.v.store_unaligned(p); }
OBSCURA_INLINE void store(int32_t* p, LanesI a) { a.v.store_unaligned(p); }
OBSCURA_INLINE void store(uint32_t* p, LanesU a) {
    store(reinterpret_cast<int32_t*>(p), as_int(a));
}
// clang-format on

/// 0, 1, 2, ... in the lanes.
OBSCURA_INLINE LanesI lane_numbers() {
    alignas(64) static constexpr int32_t numbers[16] = {
        0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    return load(numbers);
}

/// Stream compaction: moves the lanes of a mask to the front, in order; the rest is unspecified.
class Packer {
public:
#if defined(__AVX512F__)
    OBSCURA_INLINE explicit Packer(Mask m) : mask_(static_cast<__mmask16>(mask_bits(m))) {}
    OBSCURA_INLINE Lanes operator()(Lanes a) const {
        return BatchF(_mm512_maskz_compress_ps(mask_, a.v));
    }

private:
    __mmask16 mask_;
#elif defined(__AVX2__)
    OBSCURA_INLINE explicit Packer(Mask m) {
        const uint64_t bytes = _pdep_u64(mask_bits(m), 0x0101010101010101ULL) * 0xFFULL;
        const uint64_t order = _pext_u64(0x0706050403020100ULL, bytes);
        order_ = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(order)));
    }
    OBSCURA_INLINE Lanes operator()(Lanes a) const {
        return BatchF(_mm256_permutevar8x32_ps(a.v, order_));
    }

private:
    __m256i order_;
#else
    OBSCURA_INLINE explicit Packer(Mask m) : bits_(mask_bits(m)) {}
    OBSCURA_INLINE Lanes operator()(Lanes a) const {
        float in[lane_count];
        float out[lane_count] = {};
        store(in, a);
        int next = 0;
        for (int i = 0; i < lane_count; ++i) {
            if ((bits_ >> i & 1U) != 0) out[next++] = in[i];
        }
        return load(out);
    }

private:
    uint32_t bits_;
#endif
};

template <typename F>
using IntOf = typename LaneTypes<F>::Int;
template <typename F>
using UintOf = typename LaneTypes<F>::Uint;
template <typename F>
using MaskOf = typename LaneTypes<F>::Bool;

/// Reads base[i] for every lane. Indices of idle lanes must be in range too.
template <typename F, typename T, typename I>
OBSCURA_INLINE auto gather(const T* base, const I& i) {
    return LaneTypes<F>::gather(base, i);
}

/// Exact for |i| <= 2^24.
template <typename F>
OBSCURA_INLINE F from_int(const IntOf<F>& i) {
    return LaneTypes<F>::from_int(i);
}

/// 2^(exponent - 127): the float with this biased exponent, exponent in [1, 254].
template <typename F>
OBSCURA_INLINE F power_of_two(const IntOf<F>& biased_exponent) {
    if constexpr (std::is_same_v<F, double>) {
        return static_cast<double>(bits_float(biased_exponent << 23));
    } else {
        return bits_float(as_int(as_uint(biased_exponent) << 23));
    }
}

template <typename F>
OBSCURA_INLINE F clamp(const F& a, const F& low, const F& high) {
    return min(max(a, low), high);
}

template <typename F>
OBSCURA_INLINE F square(const F& a) {
    return a * a;
}

template <typename F>
OBSCURA_INLINE F lerp(const F& a, const F& b, const F& t) {
    return a + (b - a) * t;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
