# assets/generator/vectors.py - vectors and quaternions as plain tuples.
# SPDX-License-Identifier: Apache-2.0
import math


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def normalize(a):
    size = length(a)
    return scale(a, 1.0 / size) if size > 0.0 else (0.0, 1.0, 0.0)


def mix(a, b, t):
    """Linear interpolation of numbers or of tuples."""
    if isinstance(a, tuple):
        return tuple(x + (y - x) * t for x, y in zip(a, b))
    return a + (b - a) * t


def clamp(x, low=0.0, high=1.0):
    return low if x < low else high if x > high else x


def smoothstep(low, high, x):
    t = clamp((x - low) / (high - low))
    return t * t * (3.0 - 2.0 * t)


def quaternion(axis, degrees):
    """Rotation about an axis, as glTF writes it: x, y, z, w."""
    half = math.radians(degrees) / 2.0
    x, y, z = scale(normalize(axis), math.sin(half))
    return (x, y, z, math.cos(half))


def quaternion_product(a, b):
    """The rotation that does b first, then a."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz)


def rotate(q, v):
    axis = q[:3]
    t = scale(cross(axis, v), 2.0)
    return add(add(v, scale(t, q[3])), cross(axis, t))


def look_at(eye, target):
    """Quaternion of a camera (it looks down -Z, +Y up) at eye that sees target in its middle."""
    back = normalize(sub(eye, target))
    yaw = math.degrees(math.atan2(back[0], back[2]))
    pitch = math.degrees(math.asin(-back[1]))
    return quaternion_product(quaternion((0, 1, 0), yaw), quaternion((1, 0, 0), pitch))
