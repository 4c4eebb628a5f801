# assets/generator/sky.py - a clear daylight sky with its sun, as a latitude-longitude picture.
# SPDX-License-Identifier: Apache-2.0
"""The model of Preetham, Shirley and Smits, "A Practical Analytic Model for Daylight", SIGGRAPH
1999: chromaticity and luminance over the sky dome follow Perez' five-parameter function, with
parameters linear in turbidity. The sun is a disk whose colour and power are set beside it.

Mapping: u = atan2(z, x) / 2pi + 0.5, v = acos(y) / pi. Values are linear Rec.709, scaled such that
a white horizontal plane gets the irradiance SKY_IRRADIANCE from the dome.
"""
import math
import os

from generator.pictures import radiance_hdr
from generator.vectors import clamp, dot, normalize, scale, smoothstep

WIDTH, HEIGHT = 512, 256
TURBIDITY = 3.0
SUN = normalize((-0.62, 0.62, 0.52))
# Wider than the real 0.27, so that shadow edges are soft; the power is the same.
SUN_RADIUS_DEG = 1.2
SUN_IRRADIANCE = (3.3, 2.9, 2.35)  # on a plane that faces the sun
SKY_IRRADIANCE = 1.1  # luminance, on a horizontal plane
GROUND_ALBEDO = (0.30, 0.28, 0.25)

# Rows: A to E of the Perez function as (slope, offset) in turbidity (the paper's appendix A.2).
_PEREZ = {
    'Y': ((0.1787, -1.4630), (-0.3554, 0.4275), (-0.0227, 5.3251), (0.1206, -2.5771),
          (-0.0670, 0.3703)),
    'x': ((-0.0193, -0.2592), (-0.0665, 0.0008), (-0.0004, 0.2125), (-0.0641, -0.8989),
          (-0.0033, 0.0452)),
    'y': ((-0.0167, -0.2608), (-0.0950, 0.0092), (-0.0079, 0.2102), (-0.0441, -1.6537),
          (-0.0109, 0.0529)),
}
# Zenith chromaticity: rows are T^2, T, 1; columns the powers 3 to 0 of the sun's zenith angle.
_ZENITH = {
    'x': ((0.00166, -0.00375, 0.00209, 0.0), (-0.02903, 0.06377, -0.03202, 0.00394),
          (0.11693, -0.21196, 0.06052, 0.25886)),
    'y': ((0.00275, -0.00610, 0.00317, 0.0), (-0.04214, 0.08970, -0.04153, 0.00516),
          (0.15346, -0.26756, 0.06670, 0.26688)),
}


def _perez(kind, cos_theta, gamma):
    a, b, c, d, e = (slope * TURBIDITY + offset for slope, offset in _PEREZ[kind])
    return ((1.0 + a * math.exp(b / max(cos_theta, 0.01))) *
            (1.0 + c * math.exp(d * gamma) + e * math.cos(gamma) ** 2))


def _zenith(kind, sun_angle):
    powers = (sun_angle ** 3, sun_angle ** 2, sun_angle, 1.0)
    turbidity = (TURBIDITY ** 2, TURBIDITY, 1.0)
    return sum(t * sum(p * c for p, c in zip(powers, row))
               for t, row in zip(turbidity, _ZENITH[kind]))


def _rgb(x, y, luminance):
    """Linear Rec.709 of CIE xyY, without negative components."""
    cx, cz = x / y * luminance, (1.0 - x - y) / y * luminance
    return tuple(max(c, 0.0) for c in (
        3.2404542 * cx - 1.5371385 * luminance - 0.4985314 * cz,
        -0.9692660 * cx + 1.8760108 * luminance + 0.0415560 * cz,
        0.0556434 * cx - 0.2040259 * luminance + 1.0572252 * cz))


def dome(direction):
    """Relative radiance of the sky in a direction with y > 0, without the sun."""
    gamma = math.acos(clamp(dot(direction, SUN), -1.0, 1.0))
    sun_angle = math.acos(SUN[1])
    value = {kind: _perez(kind, direction[1], gamma) / _perez(kind, 1.0, sun_angle)
             for kind in 'Yxy'}
    return _rgb(value['x'] * _zenith('x', sun_angle), value['y'] * _zenith('y', sun_angle),
                value['Y'])


def _direction(u, v):
    phi, theta = (u - 0.5) * 2.0 * math.pi, v * math.pi
    return (math.cos(phi) * math.sin(theta), math.cos(theta), math.sin(phi) * math.sin(theta))


def _irradiance_of_dome():
    """RGB on a horizontal plane, by the midpoint rule."""
    total = [0.0, 0.0, 0.0]
    for j in range(64):
        theta = (j + 0.5) / 64 * math.pi / 2
        weight = math.cos(theta) * math.sin(theta) * (math.pi / 2 / 64) * (2 * math.pi / 128)
        for i in range(128):
            radiance = dome(_direction((i + 0.5) / 128, theta / math.pi))
            total = [t + weight * c for t, c in zip(total, radiance)]
    return total


def _sun_share(u, v, sun_cos):
    """Part of a pixel that the sun's disk covers, from 8 by 8 points."""
    hits = 0
    for j in range(8):
        for i in range(8):
            point = _direction(u + (i - 3.5) / 8 / WIDTH, v + (j - 3.5) / 8 / HEIGHT)
            hits += dot(point, SUN) >= sun_cos
    return hits / 64.0


def sky_rows():
    """Rows of linear RGB tuples, from the zenith down."""
    dome_rgb = _irradiance_of_dome()
    luminance = 0.2126 * dome_rgb[0] + 0.7152 * dome_rgb[1] + 0.0722 * dome_rgb[2]
    exposure = SKY_IRRADIANCE / luminance
    received = [e * exposure + s * SUN[1] for e, s in zip(dome_rgb, SUN_IRRADIANCE)]
    ground = tuple(a * e / math.pi for a, e in zip(GROUND_ALBEDO, received))
    sun_cos = math.cos(math.radians(SUN_RADIUS_DEG))
    near_cos = math.cos(math.radians(SUN_RADIUS_DEG + 1.5))
    sun_radiance = scale(SUN_IRRADIANCE, 1.0 / (2.0 * math.pi * (1.0 - sun_cos)))
    rows = []
    for j in range(HEIGHT):
        v = (j + 0.5) / HEIGHT
        row = []
        for i in range(WIDTH):
            u = (i + 0.5) / WIDTH
            direction = _direction(u, v)
            above = (direction[0], max(direction[1], 0.004), direction[2])
            haze = smoothstep(-0.06, 0.01, direction[1])  # the ground fades into the horizon
            pixel = tuple(g + (c * exposure - g) * haze for g, c in zip(ground, dome(above)))
            if dot(direction, SUN) > near_cos:
                share = _sun_share(u, v, sun_cos)
                pixel = tuple(p + s * share for p, s in zip(pixel, sun_radiance))
            row.append(pixel)
        rows.append(row)
    return rows


def write_sky(folder):
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, 'sky.hdr'), 'wb') as out:
        out.write(radiance_hdr(sky_rows()))
