# assets/generator/shapes.py - triangle meshes: parametric surfaces, tubes, boxes and facets.
# SPDX-License-Identifier: Apache-2.0
import math

from generator.vectors import add, clamp, cross, dot, normalize, rotate, scale, sub


class Mesh:
    """Vertices with unit normals; triangles are counter-clockwise seen from outside."""

    def __init__(self):
        self.positions, self.normals, self.uvs, self.colors, self.indices = [], [], [], [], []

    def vertex(self, position, normal, uv=None, color=None):
        self.positions.append(position)
        self.normals.append(normal)
        if uv is not None:
            self.uvs.append(uv)
        if color is not None:
            self.colors.append(color)
        return len(self.positions) - 1

    def triangle(self, a, b, c):
        """Leaves out triangles without area, as they arise at the poles of a sphere."""
        p, q, r = (self.positions[i] for i in (a, b, c))
        if p != q and q != r and r != p:
            self.indices += (a, b, c)

    def append(self, other):
        first = len(self.positions)
        for kind in ('positions', 'normals', 'uvs', 'colors'):
            getattr(self, kind).extend(getattr(other, kind))
        self.indices += [first + i for i in other.indices]
        return self

    def moved(self, offset=(0, 0, 0), turn=(0, 0, 0, 1)):
        """Rotates, then translates."""
        self.positions = [add(rotate(turn, p), offset) for p in self.positions]
        self.normals = [rotate(turn, n) for n in self.normals]
        return self

    def standing_on(self, height):
        """Shifts the mesh so that its lowest vertex has this height."""
        return self.moved((0, height - min(p[1] for p in self.positions), 0))


def surface(point, columns, rows, color=None):
    """A mesh of point(u, v) for u, v in [0, 1]; outside is cross(dP/du, dP/dv).

    The texture's lower edge lies along v = 0. color(u, v), if given, returns linear RGBA.
    """
    step = 1e-4
    mesh = Mesh()
    for j in range(rows + 1):
        v = j / rows
        inner_v = clamp(v, 10 * step, 1 - 10 * step)
        for i in range(columns + 1):
            u = i / columns
            along_u = sub(point(u + step, inner_v), point(u - step, inner_v))
            along_v = sub(point(u, inner_v + step), point(u, inner_v - step))
            position = tuple(round(x, 7) + 0.0 for x in point(u, v))
            mesh.vertex(position, normalize(cross(along_u, along_v)), (u, 1.0 - v),
                        color(u, v) if color else None)
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            b, c, d = a + 1, a + columns + 2, a + columns + 1
            mesh.triangle(a, b, c)
            mesh.triangle(a, c, d)
    return mesh


def spline(points):
    """A function of t in [0, 1] through the points (tuples of any size), smooth (Catmull-Rom)."""
    last = len(points) - 1

    def at(t):
        position = clamp(t) * last
        i = min(int(position), last - 1)
        s = position - i
        p0, p1, p2, p3 = (points[min(max(k, 0), last)] for k in range(i - 1, i + 3))
        return tuple(b + 0.5 * s * (c - a + s * (2 * a - 5 * b + 4 * c - d
                                                 + s * (3 * (b - c) + d - a)))
                     for a, b, c, d in zip(p0, p1, p2, p3))
    return at


def lathe(profile, columns, rows, color=None, ribs=None):
    """Turns profile(v) = (radius, height) about the Y axis; going upwards it faces outwards.

    ribs(u, v), if given, multiplies the radius.
    """
    def point(u, v):
        radius, height = profile(clamp(v))
        radius = max(radius, 0.0) * (ribs(u, clamp(v)) if ribs else 1.0)
        angle = 2.0 * math.pi * u
        return (radius * math.cos(angle), height, -radius * math.sin(angle))
    return surface(point, columns, rows, color)


def sphere(radius, columns, rows):
    def profile(v):
        return (radius * math.sin(math.pi * v), -radius * math.cos(math.pi * v))
    mesh = lathe(profile, columns, rows)
    mesh.normals = [normalize(p) for p in mesh.positions]
    return mesh


def tube(curve, radius, columns, rows):
    """A closed tube about curve(t), t in [0, 1], in the curve's Frenet frame."""
    step = 1e-3

    def point(u, v):
        middle, after, before = curve(u), curve(u + step), curve(u - step)
        tangent = normalize(sub(after, before))
        bend = sub(add(after, before), scale(middle, 2.0))
        second = normalize(cross(tangent, bend))
        first = cross(second, tangent)
        angle = -2.0 * math.pi * v
        side = add(scale(first, math.cos(angle)), scale(second, math.sin(angle)))
        return add(middle, scale(side, radius))
    return surface(point, columns, rows)


def torus(major, minor, columns, rows):
    """A ring about the Z axis."""
    return tube(lambda t: (major * math.cos(2 * math.pi * t), major * math.sin(2 * math.pi * t),
                           0.0), minor, columns, rows)


def stem(curve, radius, columns, rows):
    """An open tube about curve(t) whose radius is radius(t)."""
    step = 1e-3

    def point(u, v):
        tangent = normalize(sub(curve(v + step), curve(v - step)))
        first = normalize(cross(tangent, (0.3, 0.1, 1.0)))
        second = cross(tangent, first)
        angle = 2.0 * math.pi * u
        side = add(scale(first, math.cos(angle)), scale(second, math.sin(angle)))
        return add(curve(v), scale(side, radius(v)))
    return surface(point, columns, rows)


def rounded_box(half, edge, segments, uv_per_metre=1.0):
    """A box of half sizes `half` whose edges have the radius `edge`; each side has planar UVs."""
    steps = [-1.0 + edge / min(half) * k / segments for k in range(segments + 1)]
    ticks = steps + [-x for x in reversed(steps)]
    box = Mesh()
    for axis in range(3):
        for sign in (-1.0, 1.0):
            side = Mesh()
            a, b = (axis + 1) % 3, (axis + 2) % 3
            for q in ticks:
                for p in ticks:
                    cube = [0.0, 0.0, 0.0]
                    cube[axis] = sign * half[axis]
                    for k, t in ((a, p), (b, q)):
                        reach = half[k] - (1.0 - abs(t)) * min(half)
                        cube[k] = math.copysign(reach, t)
                    inner = [clamp(cube[k], edge - half[k], half[k] - edge) for k in range(3)]
                    normal = normalize(sub(cube, inner))
                    side.vertex(add(inner, scale(normal, edge)), normal,
                                (cube[a] * sign * uv_per_metre, -cube[b] * uv_per_metre))
            count = len(ticks)
            for j in range(count - 1):
                for i in range(count - 1):
                    v = j * count + i
                    quad = (v, v + 1, v + count + 1, v + count)
                    w = quad if sign > 0 else quad[::-1]
                    side.triangle(w[0], w[1], w[2])
                    side.triangle(w[0], w[2], w[3])
            box.append(side)
    return box


def facets(polygons):
    """Flat polygons, each a list of points counter-clockwise from outside; no UVs."""
    mesh = Mesh()
    for polygon in polygons:
        normal = normalize(cross(sub(polygon[1], polygon[0]), sub(polygon[2], polygon[0])))
        first = [mesh.vertex(p, normal) for p in polygon][0]
        for k in range(1, len(polygon) - 1):
            mesh.triangle(first, first + k, first + k + 1)
    return mesh


def quad(a, b, c, d):
    """A flat rectangle, counter-clockwise from outside; a is the texture's lower left corner."""
    mesh = Mesh()
    normal = normalize(cross(sub(b, a), sub(d, a)))
    for point, uv in zip((a, b, c, d), ((0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0))):
        mesh.vertex(point, normal, uv)
    mesh.triangle(0, 1, 2)
    mesh.triangle(0, 2, 3)
    return mesh


def outward(polygons):
    """Turns each polygon of a convex body about the origin so that it faces outwards."""
    turned = []
    for polygon in polygons:
        normal = cross(sub(polygon[1], polygon[0]), sub(polygon[2], polygon[0]))
        turned.append(polygon if dot(normal, polygon[0]) > 0 else polygon[::-1])
    return turned
