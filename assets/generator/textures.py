# assets/generator/textures.py - procedural pictures: wood, terrazzo, knurl, glaze, leaf, chequer.
# SPDX-License-Identifier: Apache-2.0
"""Every function returns PNG bytes, or a dictionary of them: 'color' in sRGB, 'surface' with
roughness in green and metalness in blue, 'normal' in tangent space with green up."""
import math

from generator.noise import fractal_noise, hash01, value_noise
from generator.pictures import png, srgb8, unorm8
from generator.vectors import clamp, mix, normalize, smoothstep

_SRGB = [srgb8(i / 4095.0) for i in range(4096)]


def _code(linear):
    return _SRGB[int(clamp(linear) * 4095.0 + 0.5)]


def color_png(pixels):
    """Rows of linear (r, g, b) or (r, g, b, alpha)."""
    channels = len(pixels[0][0])
    rows = []
    for row in pixels:
        out = bytearray()
        for pixel in row:
            out += bytes(map(_code, pixel[:3]))
            if channels == 4:
                out.append(unorm8(pixel[3]))
        rows.append(bytes(out))
    return png(rows, channels)


def surface_png(roughness, metallic=0.0):
    """Rows of roughness; one metalness for all."""
    blue = unorm8(metallic)
    return png([bytes(b for r in row for b in (255, unorm8(r), blue)) for row in roughness], 3)


def normal_png(height, strength):
    """The normals of rows of heights that tile; strength is in texels per unit of height."""
    rows, count = [], len(height)
    for y, row in enumerate(height):
        above, below = height[y - 1], height[(y + 1) % count]
        out = bytearray()
        for x in range(len(row)):
            slope_x = (row[(x + 1) % len(row)] - row[x - 1]) * 0.5 * strength
            slope_y = (above[x] - below[x]) * 0.5 * strength
            normal = normalize((-slope_x, -slope_y, 1.0))
            out += bytes(unorm8(0.5 + 0.5 * c) for c in normal)
        rows.append(bytes(out))
    return png(rows, 3)


_OAK = ((0.40, 0.215, 0.095), (0.155, 0.066, 0.026))  # early wood, late wood
_WALNUT = ((0.29, 0.135, 0.056), (0.10, 0.04, 0.016))


def wood(size=1024, staves=8):
    """Boards of walnut and oak side by side along x, each with its own grain along y."""
    warp = fractal_noise(size, size, 4, 2, 4, 11)
    fibre = fractal_noise(size, size, 256, 4, 2, 23)
    pores = value_noise(size, size, 512, 24, 31)
    color, rough, height = [], [], []
    for y in range(size):
        color_row, rough_row, height_row = [], [], []
        for x in range(size):
            stave = x * staves // size
            across = x * staves / size - stave
            pick = hash01(stave, 5)
            ring = (3.0 * across + 1.3 * pick + 5.0 * warp[y][(x + int(pick * size)) % size]
                    + 0.12 * fibre[y][x])
            ring -= math.floor(ring)
            late = smoothstep(0.25, 0.95, ring) * (1.0 - smoothstep(0.95, 1.0, ring))
            dark = clamp(0.55 * late + 0.35 * fibre[y][x] - 0.1)
            pore = smoothstep(0.72, 0.9, pores[y][x]) * (0.3 + 0.7 * late)
            tone = mix(*(_OAK if pick < 0.45 else _WALNUT), dark)
            gap = 1.0 - smoothstep(0.0, 0.018, min(across, 1.0 - across))
            shade = (1.0 - 0.35 * pore) * (1.0 - 0.75 * gap)
            color_row.append(tuple(c * shade for c in tone))
            rough_row.append(0.34 + 0.18 * dark + 0.2 * pore + 0.3 * gap)
            height_row.append(-0.25 * dark - 0.5 * pore - 2.0 * gap)
        color.append(color_row)
        rough.append(rough_row[::2] if y % 2 == 0 else None)
        height.append(height_row[::2] if y % 2 == 0 else None)
    return {'color': color_png(color), 'surface': surface_png(rough[::2]),
            'normal': normal_png(height[::2], 0.5)}


_CHIPS = ((0.62, 0.58, 0.52), (0.16, 0.15, 0.15), (0.46, 0.20, 0.13), (0.30, 0.36, 0.34),
          (0.80, 0.76, 0.70), (0.50, 0.36, 0.18))


def terrazzo(size=512, cells=26):
    """Stone chips (one to a cell, by distance to jittered points) in pale cement; tiles."""
    warp_x = fractal_noise(size, size, 16, 16, 3, 41)
    warp_y = fractal_noise(size, size, 16, 16, 3, 47)
    grain = value_noise(size, size, 128, 128, 53)
    points = {(i, j): (hash01(i, j, 1), hash01(i, j, 2), hash01(i, j, 3), hash01(i, j, 4))
              for i in range(cells) for j in range(cells)}
    color, rough = [], []
    for y in range(size):
        row, rough_row = [], []
        for x in range(size):
            px = x * cells / size + 0.9 * warp_x[y][x]
            py = y * cells / size + 0.9 * warp_y[y][x]
            ci, cj = math.floor(px), math.floor(py)
            nearest, second, chip = 9.0, 9.0, None
            for i in (ci - 1, ci, ci + 1):
                for j in (cj - 1, cj, cj + 1):
                    point = points[i % cells, j % cells]
                    distance = (i + point[0] - px) ** 2 + (j + point[1] - py) ** 2
                    if distance < nearest:
                        nearest, second, chip = distance, nearest, point
                    elif distance < second:
                        second = distance
            border = math.sqrt(second) - math.sqrt(nearest)
            inside = smoothstep(0.10, 0.16, border) if chip[2] > 0.25 else 0.0
            stone = _CHIPS[int(chip[3] * len(_CHIPS))]
            cement = 0.70 + 0.10 * (grain[y][x] - 0.5)
            row.append(mix((cement, cement * 0.96, cement * 0.89), stone, inside))
            rough_row.append(0.32 - 0.16 * inside)
        color.append(row)
        rough.append(rough_row)
    return {'color': color_png(color), 'surface': surface_png(rough)}


def knurl_normal(size=128):
    """One period of a diamond knurl: four-sided pyramids with worn tops."""
    def wave(t):
        return abs(2.0 * (t - math.floor(t)) - 1.0)

    height = [[min(wave((x + y) / size), 0.86) * 0.5 + min(wave((x - y) / size), 0.86) * 0.5
               for x in range(size)] for y in range(size)]
    return normal_png(height, 0.42 * size)


def glaze(size=512):
    """A vase's skin: dark blue glaze that ran down over raw clay, with speckles."""
    edge = fractal_noise(size, 8, 11, 1, 2, 61)[0]
    cloud = fractal_noise(size, size, 6, 6, 5, 67)
    specks = value_noise(size, size, 170, 170, 71)
    color, rough = [], []
    for y in range(size):
        v = y / size
        row, rough_row = [], []
        for x in range(size):
            drip = 0.36 + 0.30 * math.sqrt(edge[x])  # the root rounds the lower tips
            coat = 1.0 - smoothstep(drip - 0.012, drip + 0.004, v)
            rim = coat * smoothstep(drip - 0.07, drip - 0.012, v)
            blue = mix((0.015, 0.055, 0.145), (0.04, 0.20, 0.30), cloud[y][x])
            blue = mix(blue, (0.20, 0.42, 0.46), 0.75 * rim)
            clay = mix((0.52, 0.40, 0.29), (0.66, 0.55, 0.43), cloud[y][x])
            speck = smoothstep(0.80, 0.88, specks[y][x])
            clay = mix(clay, (0.14, 0.09, 0.06), 0.8 * speck)
            row.append(mix(clay, blue, coat))
            rough_row.append(mix(0.78, 0.13, coat))
        color.append(row)
        rough.append(rough_row)
    return {'color': color_png(color), 'surface': surface_png(rough)}


def leaf(width=256, height=512):
    """A leaf from its stalk (below) to its tip, clear outside, with veins; the colour goes on
    under the clear part so that filtering finds no fringe."""
    cloud = fractal_noise(width, height, 4, 8, 4, 83)
    pixels = []
    for y in range(height):
        t = 1.0 - (y + 0.5) / height  # 0 at the stalk
        body = 0.43 * math.sin(math.pi * clamp((t - 0.10) / 0.89) ** 0.78) ** 0.85
        teeth = 1.0 + 0.05 * abs(math.sin(34.0 * t))
        half = max(body * teeth, 0.018 if t < 0.2 else 0.0)
        row = []
        for x in range(width):
            side = (x + 0.5) / width - 0.5
            offset = abs(side)
            vein = 1.0 - smoothstep(0.004, 0.012, offset)
            branch = (t - 0.55 * offset) * 11.0
            branch = abs(branch - math.floor(branch) - 0.5) * 2.0
            vein = max(vein, 0.7 * (1.0 - smoothstep(0.0, 0.12, 1.0 - branch)))
            tone = mix((0.05, 0.15, 0.03), (0.14, 0.29, 0.06), cloud[y][x])
            tone = mix(tone, (0.33, 0.44, 0.14), 0.6 * vein)
            tone = mix(tone, (0.42, 0.30, 0.06), smoothstep(0.75, 1.0, offset / max(half, 0.05)))
            alpha = clamp(0.5 + (half - offset) * width / 3.0)
            row.append((*tone, alpha))
        pixels.append(row)
    return color_png(pixels)


def chequer(size=256, fields=8, first=(0.75, 0.75, 0.72), second=(0.08, 0.09, 0.10)):
    field = size // fields
    return color_png([[first if (x // field + y // field) % 2 else second for x in range(size)]
                      for y in range(size)])


def alpha_probe(size=256):
    """Alpha as it is met in practice: a disk that fades outwards, hard-edged stripes and dots.

    Clear texels are magenta: OPAQUE shows it, and a filter that lets it bleed betrays itself.
    """
    pixels = []
    for y in range(size):
        row = []
        for x in range(size):
            u, v = (x + 0.5) / size, (y + 0.5) / size
            if v < 0.5:
                alpha = clamp(1.25 - 4.0 * math.hypot(u - 0.5, v - 0.25))
            elif u < 0.5:
                alpha = 1.0 if int(u * 32) % 2 == 0 else 0.0
            else:
                alpha = 1.0 if math.hypot(u * 12 % 1 - 0.5, v * 12 % 1 - 0.5) < 0.36 else 0.0
            hue = mix((0.85, 0.32, 0.06), (0.05, 0.40, 0.62), v)
            row.append((*(hue if alpha > 0.0 else (1.0, 0.0, 1.0)), alpha))
        pixels.append(row)
    return color_png(pixels)
