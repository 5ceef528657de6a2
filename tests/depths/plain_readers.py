"""Plain readers of what the program writes. They share no code with it. Standard library only."""

import array
import struct
import zlib
from pathlib import Path

PLY_TYPES = {"float": "f", "uchar": "B", "int": "i"}


def read_ply(path):
    """(points, faces, comments): a dict per point, by the names of the properties; a list per
    face."""
    data = Path(path).read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    lines = data[:end].decode("ascii").split("\n")
    assert lines[0] == "ply" and lines[1] == "format binary_little_endian 1.0", lines[:2]
    elements = []
    comments = []
    for line in lines[2:-2]:
        words = line.split()
        if words[0] == "comment":
            comments.append(line[len("comment "):])
        elif words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        else:
            assert words[0] == "property", line
            elements[-1][2].append(words[1:])
    points, faces = [], []
    for name, count, properties in elements:
        if name == "vertex":
            names = [words[1] for words in properties]
            layout = struct.Struct("<" + "".join(PLY_TYPES[words[0]] for words in properties))
            for values in layout.iter_unpack(data[end:end + count * layout.size]):
                points.append(dict(zip(names, values)))
            end += count * layout.size
        else:
            assert name == "face" and properties == [["list", "uchar", "int", "vertex_indices"]]
            for _ in range(count):
                corners = data[end]
                faces.append(struct.unpack_from(f"<{corners}i", data, end + 1))
                end += 1 + 4 * corners
    assert end == len(data), "bytes after the last element"
    return points, faces, comments


def read_pfm(path):
    """Rows from the top, of floats; unknown is inf."""
    with open(path, "rb") as file:
        assert file.readline() == b"Pf\n"
        width, height = map(int, file.readline().split())
        assert float(file.readline()) < 0  # little-endian
        values = array.array("f", file.read())
    assert len(values) == width * height
    return [values[y * width:(y + 1) * width] for y in reversed(range(height))]


def read_npy(path):
    """Rows of floats; unknown is nan."""
    data = Path(path).read_bytes()
    assert data[:8] == b"\x93NUMPY\x01\x00"
    header_bytes = struct.unpack_from("<H", data, 8)[0]
    header = eval(data[10:10 + header_bytes].decode("ascii"), {})  # a literal, as NumPy says
    assert header["descr"] == "<f4" and not header["fortran_order"]
    height, width = header["shape"]
    values = array.array("f", data[10 + header_bytes:])
    return [values[y * width:(y + 1) * width] for y in range(height)]


def read_png(path):
    """Rows of tuples of channels."""
    data = Path(path).read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed, header = 8, b"", None
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        at += 12 + size
    width, height, bits, colour, _, _, interlaced = header
    assert interlaced == 0
    channels = {0: 1, 2: 3, 6: 4}[colour]
    pixel = channels * bits // 8
    raw = zlib.decompress(packed)
    rows, before = [], bytearray(width * pixel)
    for y in range(height):
        kind = raw[y * (width * pixel + 1)]
        row = bytearray(raw[y * (width * pixel + 1) + 1:(y + 1) * (width * pixel + 1)])
        for i in range(len(row)):
            left = row[i - pixel] if i >= pixel else 0
            up_left = before[i - pixel] if i >= pixel else 0
            if kind == 1:
                row[i] = row[i] + left & 255
            elif kind == 2:
                row[i] = row[i] + before[i] & 255
            elif kind == 3:
                row[i] = row[i] + (left + before[i]) // 2 & 255
            elif kind == 4:
                p = left + before[i] - up_left
                nearest = min((abs(p - left), 0, left), (abs(p - before[i]), 1, before[i]),
                              (abs(p - up_left), 2, up_left))
                row[i] = row[i] + nearest[2] & 255
        values = struct.unpack(f">{width * channels}{'B' if bits == 8 else 'H'}", row)
        rows.append([values[i:i + channels] for i in range(0, len(values), channels)])
        before = row
    return rows
