"""manifold3d for the comparison: solids from tessellated primitives by mesh Booleans.

Reads lines `SOLID SEGMENTS PATH`; builds the solid with that many segments a circle, one thread,
and answers `MILLISECONDS VERTICES TRIANGLES`. PATH gets the mesh: positions as 64-bit numbers,
then triangles as 32-bit indices; `-` writes none. `none` is the answer to a solid that mesh
Booleans have no primitives for.
"""

import math
import sys
import time

import manifold3d
import numpy
from manifold3d import CrossSection, Manifold, OpType


def sphere(n):
    return Manifold.sphere(1.0, n)


def demo(n):
    body = Manifold.cube((2, 2, 2), True) ^ Manifold.sphere(1.35, n)
    bore = Manifold.cylinder(4, 0.6, 0.6, n, True)
    bores = [bore, bore.rotate((90, 0, 0)), bore.rotate((0, 90, 0))]
    return Manifold.batch_boolean([body, *bores], OpType.Subtract)


def torus_and_sphere(n):
    # The tube's circle has a radius of 0.3 and the ring's largest 1.3.
    tube = CrossSection.circle(0.3, max(3, round(n * math.sqrt(0.3 / 1.3)))).translate((1, 0))
    return tube.revolve(n) + Manifold.sphere(0.6, max(3, round(n * math.sqrt(0.6 / 1.3))))


def grid(n):
    places = [-1.5, -0.5, 0.5, 1.5]
    ball = Manifold.sphere(0.4, n)
    parts = [ball.translate((x, y, z)) for x in places for y in places for z in places]
    return Manifold.batch_boolean(parts, OpType.Add)


def ring(n):
    angles = [2 * math.pi * i / 128 for i in range(128)]
    ball = Manifold.sphere(0.3, n)
    parts = [ball.translate((4 * math.cos(a), 4 * math.sin(a), 0)) for a in angles]
    return Manifold.batch_boolean(parts, OpType.Add)


def plate(n):
    places = [-4.2 + 1.2 * i for i in range(8)]
    hole = Manifold.cylinder(2, 0.4, 0.4, n, True)
    holes = [hole.translate((x, y, 0)) for x in places for y in places]
    body = Manifold.cube((10, 10, 1), True)
    return Manifold.batch_boolean([body, *holes], OpType.Subtract)


SOLIDS = {"S1": sphere, "S2": demo, "S3": torus_and_sphere, "S4": grid, "S5": ring, "S6": plate}


def main():
    for line in sys.stdin:
        solid, segments, path = line.split(maxsplit=2)
        build = SOLIDS.get(solid)
        if build is None:
            print("none", flush=True)
            continue
        start = time.perf_counter()
        mesh = build(int(segments)).to_mesh64()
        milliseconds = (time.perf_counter() - start) * 1e3
        positions = numpy.ascontiguousarray(mesh.vert_properties[:, :3], dtype="<f8")
        triangles = numpy.ascontiguousarray(mesh.tri_verts, dtype="<u4")
        if path.strip() != "-":
            with open(path.strip(), "wb") as file:
                file.write(positions.tobytes())
                file.write(triangles.tobytes())
        print(milliseconds, len(positions), len(triangles), flush=True)


if __name__ == "__main__":
    assert manifold3d
    main()
