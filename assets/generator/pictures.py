# assets/generator/pictures.py - writes PNG and Radiance HDR files.
# SPDX-License-Identifier: Apache-2.0
import math
import struct
import zlib


def png(rows, channels):
    """PNG bytes of rows of bytes with 1, 3 or 4 channels of 8 bits.

    Each row is stored as the difference to its left or upper neighbour, whichever choice makes
    the whole file smaller.
    """
    width, height = len(rows[0]) // channels, len(rows)
    color_type = {1: 0, 3: 2, 4: 6}[channels]
    left, up = bytearray(), bytearray()
    above = bytes(len(rows[0]))
    for row in rows:
        left.append(1)
        left += row[:channels]
        left += bytes((a - b) & 255 for a, b in zip(row[channels:], row))
        up.append(2)
        up += bytes((a - b) & 255 for a, b in zip(row, above))
        above = row
    streams = [zlib.compress(bytes(s), 9) for s in (left, up)]

    def chunk(kind, data):
        body = kind + data
        return struct.pack('>I', len(data)) + body + struct.pack('>I', zlib.crc32(body))

    header = struct.pack('>IIBBBBB', width, height, 8, color_type, 0, 0, 0)
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', header) +
            chunk(b'IDAT', min(streams, key=len)) + chunk(b'IEND', b''))


def srgb8(linear):
    """The 8-bit sRGB code of a linear value in [0, 1] (IEC 61966-2-1)."""
    x = min(max(linear, 0.0), 1.0)
    encoded = 12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055
    return int(encoded * 255.0 + 0.5)


def unorm8(value):
    return int(min(max(value, 0.0), 1.0) * 255.0 + 0.5)


def _rgbe(pixel):
    largest = max(pixel)
    if largest < 1e-32:
        return (0, 0, 0, 0)
    mantissa, exponent = math.frexp(largest)
    factor = mantissa * 256.0 / largest
    return tuple(min(int(c * factor), 255) for c in pixel) + (exponent + 128,)


def _run_length(data):
    """One channel of a row in Radiance's encoding: 128 + n repeats a byte, n copies n bytes."""
    out = bytearray()
    start = 0
    while start < len(data):
        run = 1
        while run < 127 and start + run < len(data) and data[start + run] == data[start]:
            run += 1
        if run >= 4:
            out += bytes((128 + run, data[start]))
            start += run
            continue
        end = start + run
        while end < len(data) and end - start < 128 and len(set(data[end:end + 4])) > 1:
            end += 1
        end = min(end, start + 128)
        out.append(end - start)
        out += data[start:end]
        start = end
    return out


def radiance_hdr(rows):
    """Radiance RGBE bytes of rows of (r, g, b) tuples, run-length encoded; 8 <= width < 32768."""
    width, height = len(rows[0]), len(rows)
    out = bytearray(b'#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n')
    out += b'-Y %d +X %d\n' % (height, width)
    for row in rows:
        pixels = [_rgbe(pixel) for pixel in row]
        out += bytes((2, 2, width >> 8, width & 255))
        for channel in range(4):
            out += _run_length(bytes(pixel[channel] for pixel in pixels))
    return bytes(out)
