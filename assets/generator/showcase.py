# assets/generator/showcase.py - the demo: a still life on a wooden board before a curved backdrop.
# SPDX-License-Identifier: Apache-2.0
"""Metres. The board's upper side is y = 0; the camera stands at +Z and looks down -Z."""
import math
import os

from generator import shapes, textures
from generator.gltf import GltfFile
from generator.noise import hash01
from generator.vectors import (add, clamp, look_at, mix, normalize, quaternion, quaternion_product,
                               scale, sub)

BOARD_RADIUS = 0.56
BOARD_THICKNESS = 0.032


def _add(gltf, name, mesh, material):
    gltf.node(name=name, mesh=gltf.mesh(name, [gltf.primitive(mesh, material)]))


def _backdrop(gltf):
    """Floor, quarter turn and wall in one sweep, wide enough to fill the picture."""
    floor, wall, bend, top = -BOARD_THICKNESS, -1.15, 0.55, 2.1
    front, half_width = 2.2, 3.2
    run = front - (wall + bend)
    arc = bend * math.pi / 2.0
    whole = run + arc + top - bend

    def point(u, v):
        s = v * whole
        if s < run:
            y, z = floor, front - s
        elif s < run + arc:
            angle = (s - run) / bend
            y, z = floor + bend * (1.0 - math.cos(angle)), wall + bend * (1.0 - math.sin(angle))
        else:
            y, z = floor + bend + (s - run - arc), wall
        return ((2.0 * u - 1.0) * half_width, y, z)

    material = gltf.material('Backdrop', color=(0.085, 0.165, 0.180), roughness=0.85)
    _add(gltf, 'Backdrop', shapes.surface(point, 2, 220), material)


def _board(gltf):
    profile = shapes.spline([
        (0.0, 0.0), (0.15, 0.0), (0.3, 0.0), (0.42, 0.0), (0.49, 0.0), (0.525, 0.0),
        (0.545, -0.001), (0.556, -0.007),
        (BOARD_RADIUS, -0.016), (0.556, -0.025), (0.545, -0.031), (0.525, -BOARD_THICKNESS),
        (0.49, -BOARD_THICKNESS)])
    mesh = shapes.lathe(lambda v: profile(1.0 - v), 160, 72)
    turn = math.radians(24.0)
    for i, (x, _, z) in enumerate(mesh.positions):  # the picture lies flat on the board
        along = x * math.cos(turn) - z * math.sin(turn)
        across = x * math.sin(turn) + z * math.cos(turn)
        mesh.uvs[i] = (0.5 + along / (2.0 * BOARD_RADIUS), 0.5 + across / (2.0 * BOARD_RADIUS))
    wood = textures.wood()
    material = gltf.material(
        'Wood', roughness=1.0,
        color_texture=gltf.texture('wood_color.png', wood['color']),
        surface_texture=gltf.texture('wood_surface.png', wood['surface']),
        normal_texture=gltf.texture('wood_normal.png', wood['normal']))
    _add(gltf, 'Board', mesh, material)


def _pedestal_and_knot(gltf):
    block = shapes.rounded_box((0.115, 0.045, 0.09), 0.006, 6, uv_per_metre=2.6)
    block.moved(turn=quaternion((0, 1, 0), 14)).standing_on(0.0).moved((0.02, 0, -0.06))
    stone = textures.terrazzo()
    material = gltf.material(
        'Terrazzo', roughness=1.0,
        color_texture=gltf.texture('terrazzo_color.png', stone['color']),
        surface_texture=gltf.texture('terrazzo_surface.png', stone['surface']))
    _add(gltf, 'Pedestal', block, material)

    def knot(t):
        a = 2.0 * math.pi * t
        reach = 0.098 + 0.042 * math.cos(3.0 * a)
        return (reach * math.cos(2.0 * a), reach * math.sin(2.0 * a), 0.060 * math.sin(3.0 * a))

    mesh = shapes.tube(knot, 0.0215, 400, 40)
    turn = quaternion_product(quaternion((0, 1, 0), -18), quaternion((0, 0, 1), 90))
    mesh.moved(turn=turn).standing_on(0.0895).moved((0.02, 0, -0.06))
    gold = gltf.material('Gold', color=(1.0, 0.71, 0.29), metallic=1.0, roughness=0.14)
    _add(gltf, 'Knot', mesh, gold)


def _vase(gltf):
    outline = shapes.spline([
        (0.0, 0.004), (0.030, 0.003), (0.046, 0.001), (0.052, 0.004), (0.060, 0.025),
        (0.084, 0.085), (0.092, 0.140), (0.080, 0.195), (0.048, 0.243), (0.031, 0.275),
        (0.030, 0.300), (0.040, 0.322), (0.0455, 0.330), (0.044, 0.334), (0.038, 0.327),
        (0.026, 0.300), (0.026, 0.270), (0.040, 0.240)])
    mesh = shapes.lathe(outline, 128, 150).moved((-0.27, 0, -0.12))
    skin = textures.glaze()
    material = gltf.material(
        'Glazed clay', roughness=1.0, double_sided=True,
        color_texture=gltf.texture('glaze_color.png', skin['color']),
        surface_texture=gltf.texture('glaze_surface.png', skin['surface']))
    _add(gltf, 'Vase', mesh, material)


def _leaf(at, direction, size, droop):
    """A bent blade that starts at `at`, points along `direction` and hangs down by `droop`."""
    forward = normalize(direction)
    side = normalize((forward[2], 0.25, -forward[0]))

    def point(u, v):
        across = (u - 0.5) * 0.5 * size
        sag = -droop * size * v * v + 0.6 * abs(u - 0.5) ** 2 * size
        return add(add(at, scale(forward, v * size)), add(scale(side, across), (0, sag, 0)))
    return shapes.surface(point, 8, 12)


def _branch(gltf):
    foot = (-0.27, 0.10, -0.12)
    shoots = (((0.02, 0.24, 0.02), (0.00, 0.34, 0.02), (-0.06, 0.44, 0.03)),
              ((-0.015, 0.22, 0.01), (0.035, 0.31, 0.03), (0.11, 0.38, 0.05)),
              ((0.0, 0.22, -0.01), (-0.07, 0.31, 0.04), (-0.16, 0.34, 0.08)))
    wood, leaves = shapes.Mesh(), shapes.Mesh()
    for s, offsets in enumerate(shoots):
        curve_at = shapes.spline([foot] + [add(foot, o) for o in offsets])

        def curve(t, curve_at=curve_at):
            near = clamp(t, 0.01, 0.99)  # beyond its ends the curve goes on straight
            slope = scale(sub(curve_at(near + 0.01), curve_at(near - 0.01)), 50.0)
            return add(curve_at(near), scale(slope, t - near))

        wood.append(shapes.stem(curve, lambda v: 0.0042 - 0.0028 * clamp(v), 10, 40))
        for k in range(7):
            t = 0.52 + 0.08 * k
            angle = 2.4 * k + 1.9 * s
            lift = 0.35 + 0.5 * hash01(s, k, 7)
            aim = (math.cos(angle), lift, math.sin(angle))
            if k == 6:
                aim = sub(curve(1.0), curve(0.9))
            size = 0.135 * (1.0 - 0.06 * k) * (0.85 + 0.3 * hash01(s, k, 9))
            leaves.append(_leaf(curve(t), aim, size, 0.25 + 0.35 * hash01(s, k, 8)))
    bark = gltf.material('Bark', color=(0.13, 0.085, 0.05), roughness=0.8)
    blade = gltf.material('Leaf', roughness=0.5, alpha_mode='MASK', alpha_cutoff=0.5,
                          double_sided=True,
                          color_texture=gltf.texture('leaf.png', textures.leaf(), clamp=True))
    _add(gltf, 'Branch', wood, bark)
    _add(gltf, 'Leaves', leaves, blade)


def _knob(gltf):
    """A turned steel knob with a knurled grip, on its side like a dropped part."""
    body = shapes.lathe(shapes.spline([
        (0.0, 0.0), (0.02, 0.0), (0.044, 0.0), (0.048, 0.003), (0.048, 0.010), (0.046, 0.0125),
        (0.0455, 0.0127)]), 96, 40)
    cap = shapes.lathe(shapes.spline([
        (0.0455, 0.0463), (0.046, 0.0465), (0.046, 0.0505), (0.043, 0.0535), (0.036, 0.0538),
        (0.034, 0.0525), (0.02, 0.0515), (0.0, 0.0515)]), 96, 40)
    grip = shapes.lathe(lambda v: (0.0475, 0.0127 + 0.0336 * v), 128, 2)
    place = ((0.245, 0.0, 0.075), quaternion((0, 1, 0), 30))
    for part in (body, cap, grip):
        part.moved(*place)
    steel = gltf.material('Steel', color=(0.60, 0.58, 0.56), metallic=1.0, roughness=0.22)
    knurled = gltf.material(
        'Knurled steel', color=(0.60, 0.58, 0.56), metallic=1.0, roughness=0.28,
        normal_texture=gltf.texture('knurl_normal.png', textures.knurl_normal()),
        uv_scale=(44, 5))
    gltf.node(name='Knob', mesh=gltf.mesh('Knob', [
        gltf.primitive(body.append(cap), steel), gltf.primitive(grip, knurled)]))


def _gem_facets():
    """A round brilliant of radius 1. The kites' middle points are placed so that they are flat."""
    def ring(radius, y, count, shift):
        return [(radius * math.cos(2 * math.pi * (k + shift) / count), y,
                 radius * math.sin(2 * math.pi * (k + shift) / count)) for k in range(count)]

    flat = math.cos(math.pi / 8)
    girdle_top, girdle_low = ring(1.0, 0.03, 16, 0.0), ring(1.0, -0.03, 16, 0.0)
    table = ring(0.55, 0.34, 8, 0.5)
    crown = ring(0.78, 0.34 - (0.78 * flat - 0.55) / 0.45 * 0.31, 8, 0.0)
    pavilion = ring(0.30, -0.86 + 0.30 * flat * 0.83, 8, 0.5)
    culet = (0.0, -0.86, 0.0)
    polygons = [table]
    for k in range(8):
        j = 2 * k
        following, before = (k + 1) % 8, (k - 1) % 8
        polygons += [[table[before], crown[k], table[k]],
                     [table[k], crown[k], girdle_top[j + 1], crown[following]],
                     [crown[k], girdle_top[j - 1], girdle_top[j]],
                     [crown[k], girdle_top[j], girdle_top[j + 1]],
                     [culet, pavilion[before], girdle_low[j], pavilion[k]],
                     [pavilion[k], girdle_low[j], girdle_low[j + 1]],
                     [pavilion[k], girdle_low[j + 1], girdle_low[(j + 2) % 16]]]
    for j in range(16):
        n = (j + 1) % 16
        polygons.append([girdle_top[j], girdle_top[n], girdle_low[n], girdle_low[j]])
    return shapes.outward(polygons)


def _gems(gltf):
    stones = (('Ruby', (0.62, 0.02, 0.06), 0.046, (0.115, 0.0, 0.215), 30),
              ('Emerald', (0.02, 0.42, 0.16), 0.030, (0.030, 0.0, 0.275), 160))
    for name, color, radius, at, yaw in stones:
        mesh = shapes.facets([[scale(p, radius) for p in polygon] for polygon in _gem_facets()])
        # It lies on its pavilion: the line from the culet to the girdle is level.
        lie = quaternion((0, 0, 1), math.degrees(math.atan2(0.83, 1.0)))
        mesh.moved(turn=quaternion_product(quaternion((0, 1, 0), yaw), lie))
        mesh.standing_on(0.0).moved(at)
        _add(gltf, name, mesh, gltf.material(name, color=color, metallic=0.9, roughness=0.04))


def _bowl(gltf):
    """A ribbed bowl coloured by its vertices, with three glazed balls in it."""
    outline = shapes.spline([
        (0.0, 0.003), (0.020, 0.002), (0.034, 0.0), (0.037, 0.004), (0.050, 0.020), (0.078, 0.050),
        (0.088, 0.068), (0.087, 0.0705), (0.084, 0.068), (0.072, 0.050), (0.045, 0.024),
        (0.020, 0.012), (0.0, 0.010)])

    def ribs(u, v):
        swell = math.sin(math.pi * v) ** 2
        return 1.0 + 0.035 * swell * math.cos(2.0 * math.pi * (16.0 * u + 0.8 * v))

    def color(u, v):
        tone = mix((0.72, 0.30, 0.18), (0.90, 0.78, 0.58), clamp(1.6 * abs(v - 0.55)))
        shade = 0.85 + 0.15 * math.cos(2.0 * math.pi * (16.0 * u + 0.8 * v))
        return tuple(c * shade for c in tone) + (1.0,)

    mesh = shapes.lathe(outline, 192, 90, color=color, ribs=ribs).moved((-0.135, 0, 0.185))
    _add(gltf, 'Bowl', mesh, gltf.material('Bowl', roughness=0.38))
    balls = (((-0.158, 0.048, 0.195), 0.030, (0.80, 0.40, 0.03)),
             ((-0.106, 0.047, 0.202), 0.028, (0.75, 0.70, 0.62)),
             ((-0.132, 0.049, 0.152), 0.029, (0.07, 0.30, 0.33)))
    for k, (at, radius, tone) in enumerate(balls):
        ball = shapes.sphere(radius, 64, 32).moved(at)
        _add(gltf, 'Ball %d' % (k + 1), ball,
             gltf.material('Ball %d' % (k + 1), color=tone, roughness=0.08 + 0.12 * k))


def _lights(gltf):
    """A glowing hoop behind the knot, a lantern, and a soft accent from the right."""
    hoop = shapes.torus(0.235, 0.0055, 200, 20).moved((0.02, 0.2405, -0.20),
                                                      quaternion((0, 1, 0), 8))
    _add(gltf, 'Hoop', hoop, gltf.material('Hoop', color=(0, 0, 0),
                                           emission=(8.0, 2.7, 0.8)))
    foot = shapes.lathe(shapes.spline([
        (0.0, 0.001), (0.02, 0.0), (0.034, 0.0), (0.037, 0.003), (0.034, 0.008), (0.012, 0.014),
        (0.007, 0.030), (0.010, 0.046), (0.024, 0.056), (0.0265, 0.063), (0.025, 0.064),
        (0.022, 0.060)]), 80, 90)
    at = (0.345, 0.0, -0.095)
    brass = gltf.material('Brass', color=(0.86, 0.62, 0.33), metallic=1.0, roughness=0.25,
                          double_sided=True)
    _add(gltf, 'Lantern foot', foot.moved(at), brass)
    globe = shapes.sphere(0.046, 64, 32).moved(add(at, (0.0, 0.099, 0.0)))
    _add(gltf, 'Lantern', globe, gltf.material('Lantern', color=(0, 0, 0),
                                               emission=(6.0, 4.4, 2.8)))
    eye = (0.95, 0.85, 0.55)
    accent = gltf.light(type='spot', name='Accent', color=[1.0, 0.86, 0.70], intensity=1.1,
                        spot={'innerConeAngle': 0.2, 'outerConeAngle': 0.6})
    gltf.node(name='Accent', translation=eye, rotation=look_at(eye, (0.0, 0.08, 0.0)),
              extensions=accent)


def write_showcase(folder):
    gltf = GltfFile('Obscura authors, CC0-1.0')
    _backdrop(gltf)
    _board(gltf)
    _pedestal_and_knot(gltf)
    _vase(gltf)
    _branch(gltf)
    _knob(gltf)
    _gems(gltf)
    _bowl(gltf)
    _lights(gltf)
    eye = (0.16, 0.44, 1.27)
    camera = gltf.perspective_camera('Camera', math.radians(35.0))
    gltf.node(name='Camera', camera=camera, translation=eye,
              rotation=look_at(eye, (0.0, 0.205, 0.0)))
    gltf.write_gltf(os.path.join(folder, 'showcase'), 'showcase')
