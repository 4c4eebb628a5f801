// surface/harmonics.h - real spherical harmonics of degrees 0 to 3.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"

namespace obscura {

/// Number of functions up to degree 3: (degree + 1)^2.
inline constexpr int max_harmonics = 16;

inline namespace OBSCURA_ISA {

/// Values of all sixteen in a direction; (l, m) is at l^2 + l + m. With the Condon-Shortley phase.
///
/// In      d: unit
/// Source  KHR_gaussian_splatting, "Calculating color from Spherical Harmonics"; Sloan, "Stupid
///         Spherical Harmonics Tricks", 2008, appendix A2, for the polynomials
template <typename F>
OBSCURA_INLINE void real_harmonics(const Vec3<F>& d, F (&y)[max_harmonics]) {
    const F xx = d.x * d.x;
    const F yy = d.y * d.y;
    const F zz = d.z * d.z;
    const F one(1.0f);
    y[0] = F(0.2820947917738781f);
    y[1] = F(-0.4886025119029199f) * d.y;
    y[2] = F(0.4886025119029199f) * d.z;
    y[3] = F(-0.4886025119029199f) * d.x;
    y[4] = F(1.092548430592079f) * d.x * d.y;
    y[5] = F(-1.092548430592079f) * d.y * d.z;
    y[6] = F(0.3153915652525200f) * (F(3.0f) * zz - one);
    y[7] = F(-1.092548430592079f) * d.x * d.z;
    y[8] = F(0.5462742152960395f) * (xx - yy);
    y[9] = F(-0.5900435899266435f) * d.y * (F(3.0f) * xx - yy);
    y[10] = F(2.890611442640554f) * d.x * d.y * d.z;
    y[11] = F(-0.4570457994644657f) * d.y * (F(5.0f) * zz - one);
    y[12] = F(0.3731763325901154f) * d.z * (F(5.0f) * zz - F(3.0f));
    y[13] = F(-0.4570457994644657f) * d.x * (F(5.0f) * zz - one);
    y[14] = F(1.445305721320277f) * d.z * (xx - yy);
    y[15] = F(-0.5900435899266435f) * d.x * (xx - F(3.0f) * yy);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
