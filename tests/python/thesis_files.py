"""Writes the byte files of the thesis' Appendix A from its text, independently of csg2brep.

usage: python3 thesis_files.py FOLDER

Everything is assembled with `struct`: `i` int, `f` float, `d` double, `B` char, big-endian unless the
file's name says little.
"""
import struct
import sys
from math import comb
from pathlib import Path

FOLDER = Path(sys.argv[1])

IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]


def moved(scale, x, y, z):
    return [scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0, x, y, z, 1]


def leaf(order, material, kind, matrix, extra=b""):
    return struct.pack(order + "Bii", 1, material, kind) + extra + struct.pack(order + "16f", *matrix)


def operator(code, left, right):
    return struct.pack("BB", 0, code) + left + right


def polynomial(order, degree, coefficients):
    assert len(coefficients) == comb(degree + 3, 3)
    return struct.pack(f"{order}i{len(coefficients)}f", degree, *coefficients)


def bored_ball(order):
    """A ball of radius 2 at (1, 0, 0) without a unit block at its centre: volume 32/3 pi - 1."""
    ball = leaf(order, 7, 1, moved(2, 1, 0, 0))
    block = leaf(order, 9, 0, moved(1, 0.5, -0.5, -0.5))
    return operator(2, ball, block)


def everything(order):
    """All eight types, joined by all three operators."""
    torus = leaf(order, 2, 5, moved(1, 10, 0, 0), struct.pack(order + "f", 0.25))
    # x^2 - 4xy + 3z^2 - 5 is the thesis' own example; x^2 + y^2 + z^2 - 1 is bounded.
    ball = polynomial(order, 2, [1, 0, 0, 0, 1, 0, 0, 1, 0, -1])
    poly = leaf(order, 3, 6, moved(1, 20, 0, 0), ball)
    cylinder = leaf(order, 4, 2, moved(1, 30, 0, 0))
    cone = leaf(order, 5, 4, moved(1, 40, 0, 0))
    helicoid = leaf(order, 6, 7, moved(1, 50, 0, 0))
    half_ball = operator(1, leaf(order, 1, 1, moved(1, 60, 0, 0)), leaf(order, 1, 3, IDENTITY))
    bored = bored_ball(order)
    tree = operator(0, torus, operator(0, poly, operator(0, cylinder, operator(0, cone, helicoid))))
    return operator(0, operator(0, half_ball, bored), tree)


CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (1, 1, 1)]


def one_sector(order, copies=1):
    """The half-space x - 1/2 <= 0 in one simplex, degree 1: its values at the corners."""
    out = struct.pack(order + "i", 1) + struct.pack(order + "Bi", 1, 5) + struct.pack(order + "i", copies)
    for _ in range(copies):
        out += struct.pack(order + "12d", *[c for corner in CORNERS for c in corner])
        out += struct.pack(order + "iii4d", 5, 3, 1, -0.5, 0.5, 0.5, 0.5)
    return out


def tetrahedron_faces(order):
    """The surface of the simplex with corners 0, x, y, z: area 3/2 + sqrt(3)/2."""
    o, x, y, z = (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)
    out = b"A"
    for a, b, c in [(o, y, x), (o, x, z), (o, z, y), (x, y, z)]:
        out += struct.pack(order + "i9d", 1, *a, *b, *c)
    return out


def subdivision(order):
    """One simplex of volume 1/6: its near child is full, the far one a front that x + y = ... cuts in
    half: the half-space with values -1 -1 1 1 at the corners. Volume 1/12 + 1/24 = 1/8."""
    out = b"S" + struct.pack(order + "i", 1)
    out += struct.pack(order + "12d", *[c for corner in CORNERS for c in corner])
    out += struct.pack(order + "i", 2) + struct.pack(order + "i", 0) + struct.pack(order + "i", 3)
    return out + struct.pack(order + "Biii4d", 1, 0, 1, 1, -1, -1, 1, 1)


def wireframe(order):
    out = struct.pack(order + "ii", 4, 0)
    out += struct.pack(order + "12f", 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1)
    out += struct.pack(order + "i", 4)
    for face in [(0, 1, 2), (0, 2, 3), (0, 3, 1), (2, 1, 3)]:
        out += struct.pack(order + "i3i", 3, *face)
    return out


for name, order in [("", ">"), ("_little", "<")]:
    files = {
        f"bored{name}.CSG": bored_ball(order),
        f"everything{name}.CSG": everything(order),
        f"sector{name}.cspg": one_sector(order),
        f"tetrahedron{name}.apl": tetrahedron_faces(order),
        f"halves{name}.sub": subdivision(order),
        f"tetrahedron{name}.wfr": wireframe(order),
    }
    for file, content in files.items():
        (FOLDER / file).write_bytes(content)

# A block alone: its type, 0, is the same in either byte order.
for name, order in [("", ">"), ("_little", "<")]:
    (FOLDER / f"block{name}.CSG").write_bytes(leaf(order, 2, 0, moved(3, 1, 2, -1)))

# What is wrong, each with the byte at which it is.
ball = leaf(">", 1, 1, IDENTITY)
wrong = {
    "type.CSG": leaf(">", 1, 42, IDENTITY),
    "operator.CSG": operator(9, ball, ball),
    "truncated.CSG": everything(">")[:100],
    "trailing.CSG": ball + b"xyz",
    "nan.CSG": leaf(">", 1, 1, [float("nan")] + IDENTITY[1:]),
    "degree.CSG": leaf(">", 1, 6, IDENTITY, struct.pack(">i", 2**31 - 1)),
    "singular.CSG": leaf(">", 1, 1, [0] * 16),
    "tube.CSG": leaf(">", 1, 5, IDENTITY, struct.pack(">f", -1)),
    "primitives.cspg": struct.pack(">i", 2**31 - 1) + one_sector(">")[4:],
    "sectors.cspg": one_sector(">")[:9] + struct.pack(">i", 2**30) + one_sector(">")[13:],
    "name.cspg": one_sector(">")[:5] + struct.pack(">i", 6) + one_sector(">")[9:],
    "nan.cspg": one_sector(">")[:-8] + struct.pack(">d", float("nan")),
    "infinite.apl": tetrahedron_faces(">")[:-8] + struct.pack(">d", float("inf")),
    "short.apl": tetrahedron_faces(">")[:-3],
    "node.sub": subdivision(">")[:101] + struct.pack(">i", 7),
    "letter.sub": b"X" + subdivision(">")[1:],
    "open.apl": tetrahedron_faces(">")[:-76],
}
for file, content in wrong.items():
    (FOLDER / f"wrong_{file}").write_bytes(content)
