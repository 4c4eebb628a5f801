#!/usr/bin/env python3
# tools/make_albedo_table.py - computes how much light a lobe reflects, as tables of src/surface.
# SPDX-License-Identifier: Apache-2.0
"""Usage: python3 tools/make_albedo_table.py ggx > src/surface/albedo_table.cpp
       python3 tools/make_albedo_table.py charlie > src/surface/sheen_table.cpp

For a view angle and a roughness, the share of a white sky that the specular lobe of surface/bsdf.h
sends back is f0 * A + B (Schlick's Fresnel is linear in f0). A and B are means over a regular grid of
visible normals (Dupuy and Benyoub, 2023), for which BRDF * cosine / density is Fresnel * G1(wi).
The same for the Charlie lobe of surface/sheen.h with a white colour: an integral over directions, finer
towards the horizon, where narrow fibres shine.
"""
import math
import sys

COSINES, ROUGHNESSES, GRID = 32, 32, 96
MIN_ALPHA = 1e-3
MIN_SHEEN_ALPHA = 0.005


def g1(cosine, alpha):
    return 2 * cosine / (cosine + math.sqrt(alpha**2 + (1 - alpha**2) * cosine**2))


def entry(cosine, roughness):
    alpha = max(roughness**2, MIN_ALPHA)
    wo = (math.sqrt(1 - cosine**2), 0.0, cosine)
    length = math.hypot(wo[0] * alpha, wo[2])
    stretched = (wo[0] * alpha / length, 0.0, wo[2] / length)
    sum_a = sum_b = 0.0
    for i in range(GRID):
        turn = 2 * math.pi * (i + 0.5) / GRID
        for j in range(GRID):
            z = (1 - (j + 0.5) / GRID) * (1 + stretched[2]) - stretched[2]
            radius = math.sqrt(max(0.0, 1 - z * z))
            hx = (radius * math.cos(turn) + stretched[0]) * alpha
            hy = radius * math.sin(turn) * alpha
            hz = z + stretched[2]
            n = math.sqrt(hx * hx + hy * hy + hz * hz)
            hx, hy, hz = hx / n, hy / n, hz / n
            d = wo[0] * hx + wo[2] * hz
            wi_z = 2 * d * hz - wo[2]
            if wi_z <= 0:
                continue
            weight = (1 - min(max(d, 0.0), 1.0)) ** 5
            shadowing = g1(wi_z, alpha)
            sum_a += (1 - weight) * shadowing
            sum_b += weight * shadowing
    return sum_a / GRID**2, sum_b / GRID**2


def charlie_lambda(cosine, alpha):
    t = (1 - alpha) ** 2
    a, b, c, d, e = (
        low + (high - low) * t
        for low, high in (
            (21.5473, 25.3245),
            (3.82987, 3.32435),
            (0.19823, 0.16801),
            (-1.97760, -1.27393),
            (-4.32054, -4.85967),
        )
    )

    def fit(x):
        return a / (1 + b * max(x, 1e-6) ** c) + d * x + e

    return math.exp(fit(cosine) if cosine < 0.5 else 2 * fit(0.5) - fit(1 - cosine))


def sheen_entry(cosine, roughness):
    alpha = max(roughness**2, MIN_SHEEN_ALPHA)
    sine = math.sqrt(1 - cosine**2)
    lambda_o = charlie_lambda(cosine, alpha)
    total = 0.0
    for i in range(GRID):
        cos_i = ((i + 0.5) / GRID) ** 2
        width = ((i + 1) / GRID) ** 2 - (i / GRID) ** 2
        sin_i = math.sqrt(1 - cos_i**2)
        visibility = 1 / (4 * cosine * cos_i * (1 + lambda_o + charlie_lambda(cos_i, alpha)))
        for j in range(GRID):
            turn = math.pi * (j + 0.5) / GRID
            hx = sine + sin_i * math.cos(turn)
            hy = sin_i * math.sin(turn)
            hz = cosine + cos_i
            sine2 = (hx * hx + hy * hy) / max(hx * hx + hy * hy + hz * hz, 1e-30)
            density = (2 + 1 / alpha) * sine2 ** (0.5 / alpha) / (2 * math.pi)
            total += density * visibility * cos_i * width * 2 * math.pi / GRID
    return total


def rows(values):
    for i in range(0, len(values), 8):
        print("    " + " ".join(f"{v:.6f}f," for v in values[i : i + 8]))


def places():
    for r in range(ROUGHNESSES):
        for c in range(COSINES):
            yield max((c / (COSINES - 1)) ** 2, 1e-4), r / (ROUGHNESSES - 1)


def ggx_tables():
    table = [entry(*place) for place in places()]
    return {f"specular_albedo_{n}": [row[i] for row in table] for i, n in enumerate(("scale", "bias"))}


def charlie_tables():
    return {"sheen_albedo_table": [sheen_entry(*place) for place in places()]}


def main():
    file, tables = {
        "ggx": ("albedo_table.cpp", ggx_tables),
        "charlie": ("sheen_table.cpp", charlie_tables),
    }[sys.argv[1]]
    print(f"// surface/{file} - written by tools/make_albedo_table.py; do not edit.")
    print("// SPDX-License-Identifier: Apache-2.0")
    print('#include "surface/albedo_table.h"\n\nnamespace obscura {\n')
    print("// clang-format off")
    for name, values in tables().items():
        print(f"const float {name}[albedo_cosines * albedo_roughnesses] = {{")
        rows(values)
        print("};\n")
    print("// clang-format on\n\n}  // namespace obscura")


main()
