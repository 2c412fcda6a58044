"""Looks for triangles that pass through each other in OBJ files.

Usage: self_intersections.py FILE...    prints a JSON list, one object a file, in the order given:

    file       the path as given
    contacts   pairs of triangles that share more than their common corners and edges, decided
               in exact arithmetic by CGAL (through libigl)
    crossings  how many of them cannot be pulled apart by a move of `allowed`
    depth      the longest such move that any pair needs, in file units
    allowed    2^-40 of the file's coordinates: what rounding of positions may do
    where      a corner of the pair that is deepest in each other, None without contacts

Solids that touch have contacts of depth zero, also face to face; a face that folds over itself
has two layers that look the same way. The least move that separates two triangles is
along a normal of either or across an edge of each; of triangles in one plane, across an edge
within that plane; of triangles no wider than `allowed`, across their longest edge. A move along
any axis at all is an upper bound.
"""

import json
import sys

import igl.copyleft.cgal
import numpy as np
from validate import read_obj


def normalized(vectors):
    """Unit vectors; zero where there is no direction."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)


def move_along(axes, first, second):
    """Least move of `second` along each axis (n, k, 3) that separates triangles (n, 3, 3)."""
    a = np.einsum("nkx,ncx->nkc", axes, first)
    b = np.einsum("nkx,ncx->nkc", axes, second)
    move = np.minimum(a.max(2) - b.min(2), b.max(2) - a.min(2))
    move[np.linalg.norm(axes, axis=2) < 0.5] = np.inf
    return np.maximum(move.min(axis=1), 0.0)


def depths(first, second, allowed):
    edges = [np.roll(t, -1, axis=1) - t for t in (first, second)]
    normals = [np.cross(e[:, 0], e[:, 1]) for e in edges]
    units = [normalized(n) for n in normals]
    across = np.cross(edges[0][:, :, None, :], edges[1][:, None, :, :]).reshape(len(first), 9, 3)
    # Of almost parallel edges the product is noise.
    lengths = [np.linalg.norm(e, axis=2) for e in edges]
    scale = (lengths[0][:, :, None] * lengths[1][:, None, :]).reshape(len(first), 9, 1)
    across = np.where(np.linalg.norm(across, axis=2, keepdims=True) > 1e-9 * scale, across, 0.0)
    longest = [e[np.arange(len(e)), n.argmax(1)] for e, n in zip(edges, lengths)]
    beside = [np.cross(e[:, None], np.eye(3)[None]) for e in longest]
    axes = [np.stack(units, axis=1), normalized(across), *map(normalized, beside)]
    depth = move_along(np.concatenate(axes, axis=1), first, second)
    # In one plane the normals separate nothing that overlaps.
    height = np.abs(np.einsum("ncx,nx->nc", second - first[:, :1], units[0])).max(axis=1)
    flat = height <= allowed
    for normal, length in zip(normals, lengths):
        flat &= np.linalg.norm(normal, axis=1) > allowed * length.max(axis=1)
    within = np.concatenate([normalized(np.cross(units[0][:, None], e)) for e in edges], axis=1)
    back_to_back = np.einsum("nx,nx->n", *normals) < 0
    return np.where(flat, np.where(back_to_back, 0.0, move_along(within, first, second)), depth)


def inspect(path):
    positions, triangles = read_obj(path)
    report = {"file": path, "contacts": 0, "crossings": 0, "depth": 0.0, "where": None}
    report["allowed"] = float(2.0**-40 * np.abs(positions).max(initial=0.0))
    if not len(triangles):
        return report
    pairs = igl.copyleft.cgal.remesh_self_intersections(positions, triangles, detect_only=True)[2]
    report["contacts"] = len(pairs)
    if len(pairs):
        corners = positions[triangles]
        found = depths(corners[pairs[:, 0]], corners[pairs[:, 1]], report["allowed"])
        report["crossings"] = int((found > report["allowed"]).sum())
        report["depth"] = float(found.max())
        report["where"] = corners[pairs[found.argmax(), 0], 0].tolist()
    return report


if __name__ == "__main__":
    json.dump([inspect(path) for path in sys.argv[1:]], sys.stdout)
