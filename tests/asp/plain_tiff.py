"""Grey float TIFF files, uncompressed, as lists of rows."""

import array
import struct

ENTRY = struct.Struct("<HHII")  # tag, type, count, value
SHORT, LONG = 3, 4


def write_tiff(path, rows):
    width, height = len(rows[0]), len(rows)
    pixels = b"".join(array.array("f", row).tobytes() for row in rows)
    entries = [(256, LONG, 1, width), (257, LONG, 1, height), (258, SHORT, 1, 32),
               (259, SHORT, 1, 1), (262, SHORT, 1, 1), (273, LONG, 1, 8), (277, SHORT, 1, 1),
               (278, LONG, 1, height), (279, LONG, 1, len(pixels)), (339, SHORT, 1, 3)]
    with open(path, "wb") as file:
        file.write(b"II*\0" + struct.pack("<I", 8 + len(pixels)) + pixels)
        file.write(struct.pack("<H", len(entries)))
        for entry in entries:
            file.write(ENTRY.pack(*entry))
        file.write(struct.pack("<I", 0))


def read_tiff(path):
    with open(path, "rb") as file:
        data = file.read()
    assert data[:4] == b"II*\0", "expected a little-endian TIFF"
    start, = struct.unpack_from("<I", data, 4)
    count, = struct.unpack_from("<H", data, start)
    tags = {}
    for k in range(count):
        tag, kind, number, value = ENTRY.unpack_from(data, start + 2 + k * ENTRY.size)
        if number == 1:
            tags[tag] = [value & 0xFFFF if kind == SHORT else value]
        else:
            tags[tag] = list(struct.unpack_from(f"<{number}{'H' if kind == SHORT else 'I'}", data,
                                                value))
    assert tags[258] == [32] and tags[259] == [1] and tags[339] == [3], "expected plain floats"
    values = array.array("f")
    for offset, size in zip(tags[273], tags[279]):
        values.frombytes(data[offset:offset + size])
    width, = tags[256]
    return [values[k:k + width] for k in range(0, len(values), width)]
