"""Files made for the attack: meshes as text, GeoTIFFs, and any file with some bytes changed."""

import math
import struct
from itertools import product


def quad(a, b, c, d):
    return [(a, b, c), (a, c, d)]


def stl(facets):
    text = "".join(
        "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {x} {y} {z}\n" for x, y, z in facet) + "endloop\nendfacet\n" for facet in facets
    )
    return f"solid x\n{text}endsolid x\n".encode()


def plane(half, fall, z=0.0):
    """A square that falls towards y."""
    return quad(*[(x * half, y * half, z - fall * y * half) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


def box(half):
    """A closed box around (0, 0, 0)."""
    facets = []
    for axis, side in product(range(3), (-half, half)):
        corners = ((-half, -half), (half, -half), (half, half), (-half, half))
        facets += quad(*[(*at[:axis], side, *at[axis:]) for at in corners])
    return facets


def teeth(half, width, height):
    """Folds across x."""
    facets = []
    for k in range(int(2 * half / width)):
        west, low, high = k * width - half, height * (k % 2), height * ((k + 1) % 2)
        facets += quad((west, -half, low), (west + width, -half, high), (west + width, half, high), (west, half, low))
    return facets


MESHES = {
    "slope": plane(20.0, 0.7),
    "box": box(3.0),
    "plates": plane(20.0, 0.0) + plane(20.0, 0.0, 4.0),
    "teeth": teeth(20.0, 0.3, 3.0),
    "needle": quad((-20.0, -1e-3, 10.0), (20.0, -1e-3, -10.0), (20.0, 1e-3, -10.0), (-20.0, 1e-3, 10.0)),
}


def spoilt(data, chance, first=0):
    data = bytearray(data)
    for _ in range(chance.randint(1, 6)):
        data[chance.randrange(first, len(data))] = chance.randrange(256)
    return bytes(data[: chance.randrange(1, len(data))]) if chance.random() < 0.3 else bytes(data)


def geotiff(columns, heights, cell):
    """The plainest GeoTIFF there is: one strip of doubles, values at points, -9999 where there is none."""
    rows, strip = len(heights) // columns, struct.pack(f"<{len(heights)}d", *heights)
    short, long, text, double = 3, 4, 2, 12
    # tag, kind, count, and the value itself or the bytes that stand behind the tags
    tags = [
        (256, short, 1, columns), (257, short, 1, rows), (258, short, 1, 64), (259, short, 1, 1), (262, short, 1, 1), (273, long, 1, strip),
        (277, short, 1, 1), (278, short, 1, rows), (279, long, 1, len(strip)), (339, short, 1, 3), (33550, double, 3, struct.pack("<3d", cell, cell, 0)),
        (33922, double, 6, struct.pack("<6d", 0, 0, 0, 100, 200, 0)), (42113, text, 6, b"-9999\0"),
    ]
    at, behind, table = 8 + 2 + 12 * len(tags) + 4, b"", b""
    for tag, kind, count, value in tags:
        if isinstance(value, bytes):
            value, behind = at + len(behind), behind + value + bytes(-len(value) % 8)
        table += struct.pack("<HHII", tag, kind, count, value)
    return struct.pack("<2sHIH", b"II", 42, 8, len(tags)) + table + bytes(4) + behind


# what is no slope: columns, heights, size of a cell
NO_SLOPES = {
    "1e300": (2, [1e300, 5, 5, 5], 1.0), "nan": (2, [math.nan] * 4, 1.0), "all without data": (2, [-9999.0] * 4, 1.0),
    "one cell": (1, [5.0], 1.0), "one row": (4, [5.0] * 4, 1.0), "cell 1e-300": (2, [5.0] * 4, 1e-300),
    "cell 1e300": (2, [5.0] * 4, 1e300), "cell 0": (2, [5.0] * 4, 0.0), "cell nan": (2, [5.0] * 4, math.nan),
}
