"""Disparity maps as pictures with the standard library alone: reads PFM and 8-bit grey PNG, paints
maps and their errors with a palette, writes PNG."""

import math
import struct
import sys
import zlib
from array import array

BLACK = 0  # palette index of what is unknown
PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"


class Map:
    """Rows of disparities in pixels from the top; NaN = unknown."""

    def __init__(self, width, height, rows):
        self.width, self.height, self.rows = width, height, rows


def read_pfm(path):
    """Reads a one-channel PFM; inf and NaN become NaN."""
    with open(path, "rb") as file:
        if file.readline().strip() != b"Pf":
            raise ValueError(f"{path}: not a one-channel PFM")
        width, height = map(int, file.readline().split())
        scale = float(file.readline())
        values = array("f", file.read(4 * width * height))
    if (scale < 0) != (sys.byteorder == "little"):
        values.byteswap()
    if len(values) != width * height:
        raise ValueError(f"{path}: truncated")
    rows = [values[y * width:(y + 1) * width] for y in reversed(range(height))]
    rows = [[v if math.isfinite(v) else math.nan for v in row] for row in rows]
    return Map(width, height, rows)


def _paeth(left, up, up_left):
    estimate = left + up - up_left
    d_left, d_up, d_up_left = abs(estimate - left), abs(estimate - up), abs(estimate - up_left)
    if d_left <= d_up and d_left <= d_up_left:
        return left
    return up if d_up <= d_up_left else up_left


def _unfilter(kind, line, above):
    """Undoes PNG's line filters for one byte per pixel."""
    if kind == 0:
        return line
    out = bytearray(len(line))
    left = up_left = 0
    for x, value in enumerate(line):
        up = above[x]
        if kind == 1:
            value += left
        elif kind == 2:
            value += up
        elif kind == 3:
            value += (left + up) // 2
        else:
            value += _paeth(left, up, up_left)
        left = out[x] = value & 255
        up_left = up
    return out


def read_grey_png(path, scale):
    """Reads an 8-bit grey PNG whose values are scale × disparity, 0 = unknown."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:8] != PNG_SIGNATURE:
        raise ValueError(f"{path}: not a PNG")
    width, height, depth, colour, _, _, interlaced = struct.unpack(">IIBBBBB", data[16:29])
    if (depth, colour, interlaced) != (8, 0, 0):
        raise ValueError(f"{path}: not a plain 8-bit grey PNG")
    packed, at = b"", 8
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    lines = zlib.decompress(packed)
    value_of = [math.nan] + [v / scale for v in range(1, 256)]
    rows, above = [], bytearray(width)
    for y in range(height):
        start = y * (width + 1)
        above = _unfilter(lines[start], lines[start + 1:start + 1 + width], above)
        rows.append([value_of[v] for v in above])
    return Map(width, height, rows)


def _turbo(t):
    """Google's Turbo colour map, in its published polynomial approximation."""
    coefficients = [
        (0.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943),
        (0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604),
        (0.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973),
    ]
    channel = (sum(c * t**power for power, c in enumerate(cs)) for cs in coefficients)
    return bytes(max(0, min(255, round(255 * value))) for value in channel)


def _heat(t):
    """Black through red and yellow to white."""
    return bytes(max(0, min(255, round(255 * (3 * t - k)))) for k in range(3))


TURBO = [b"\0\0\0"] + [_turbo(i / 254) for i in range(255)]
HEAT = [b"\x30\x38\x48"] + [_heat(i / 254) for i in range(255)]


def paint(rows, low, high):
    """Palette indices: 1..255 for low..high and beyond, 0 for NaN."""
    gain = 254 / (high - low)
    return [
        bytes([1 + max(0, min(254, round((v - low) * gain))) if v == v else BLACK for v in row])
        for row in rows
    ]


def absolute_difference(a, b):
    """|a − b| of two maps of one size, NaN where either is unknown."""
    if (a.width, a.height) != (b.width, b.height):
        raise ValueError("maps of different sizes")
    return [[abs(p - q) for p, q in zip(*pair)] for pair in zip(a.rows, b.rows)]


def write_png(path, indices, palette):
    """Writes rows of palette indices as a PNG."""

    def chunk(kind, body):
        return (struct.pack(">I", len(body)) + kind + body +
                struct.pack(">I", zlib.crc32(kind + body)))

    header = struct.pack(">IIBBBBB", len(indices[0]), len(indices), 8, 3, 0, 0, 0)
    body = zlib.compress(b"".join(b"\0" + row for row in indices), 6)
    with open(path, "wb") as file:
        file.write(PNG_SIGNATURE + chunk(b"IHDR", header) + chunk(b"PLTE", b"".join(palette)) +
                   chunk(b"IDAT", body) + chunk(b"IEND", b""))
