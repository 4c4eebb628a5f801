# assets/generator/noise.py - repeatable random numbers and tileable noise pictures.
# SPDX-License-Identifier: Apache-2.0


def hash01(*words):
    """A number in [0, 1) that depends on the integers given and on nothing else."""
    h = 0x9E3779B9
    for word in words:
        h = ((h ^ (word & 0xFFFFFFFF)) * 0x85EBCA6B) & 0xFFFFFFFF
        h ^= h >> 13
        h = (h * 0xC2B2AE35) & 0xFFFFFFFF
        h ^= h >> 16
    return h / 4294967296.0


def _fade(t):
    return t * t * t * (t * (6.0 * t - 15.0) + 10.0)


def value_noise(width, height, cells_x, cells_y, seed):
    """Rows of floats in [0, 1): smooth noise with cells_x by cells_y cells that tiles."""
    lattice = [[hash01(x, y, seed) for x in range(cells_x)] for y in range(cells_y)]
    columns = []
    for x in range(width):
        position = x * cells_x / width
        cell = int(position)
        columns.append((cell, (cell + 1) % cells_x, _fade(position - cell)))
    rows = []
    for y in range(height):
        position = y * cells_y / height
        cell = int(position)
        t = _fade(position - cell)
        low, high = lattice[cell], lattice[(cell + 1) % cells_y]
        line = [a + (b - a) * t for a, b in zip(low, high)]
        rows.append([line[a] + (line[b] - line[a]) * s for a, b, s in columns])
    return rows


def fractal_noise(width, height, cells_x, cells_y, octaves, seed):
    """Rows of floats in [0, 1): octaves of value_noise, each twice as fine and half as strong."""
    total = [[0.0] * width for _ in range(height)]
    weight = 0.5
    for octave in range(octaves):
        layer = value_noise(width, height, cells_x << octave, cells_y << octave, seed + octave)
        for row, extra in zip(total, layer):
            row[:] = [a + weight * b for a, b in zip(row, extra)]
        weight *= 0.5
    norm = 1.0 / (1.0 - 0.5 ** octaves)
    return [[a * norm for a in row] for row in total]
