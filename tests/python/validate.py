"""Says what the Manifold library thinks of OBJ and GLB files.

Usage: validate.py FILE...    prints a JSON list, one object a file, in the order given:

    file        the path as given
    status      Manifold's verdict: "NoError" for a closed, oriented 2-manifold, else its reason
    triangles   number of triangles in the file
    components  number of connected components (shells, cavities included)
    genus       handles of all components together, from vertices, edges and triangles
    volume      enclosed volume in file units, None unless NoError
    area        surface area in file units, None unless NoError
    error       why the file could not be read, None otherwise

Vertices are joined by index alone, never by position. Of a GLB file the `EXT_mesh_manifold`
primitive counts if there is one; node transforms are not applied.
"""

import gc
import json
import struct
import sys

import manifold3d
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

COMPONENT_TYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def read_obj(path):
    """Positions (n, 3) and triangles (m, 3); polygons become fans."""
    positions, triangles = [], []
    # Millions of numbers and not one cycle: collecting garbage would take most of the time.
    gc.disable()
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            if line.startswith("v "):
                positions.extend(map(float, line.split()[1:4]))
            elif line.startswith("f "):
                corners = [int(corner.split("/", 1)[0]) for corner in line.split()[1:]]
                if min(corners) < 1:
                    raise ValueError("relative indices are not supported")
                for second, third in zip(corners[1:], corners[2:]):
                    triangles += corners[0], second, third
    return (
        np.array(positions, dtype=np.float64).reshape(-1, 3),
        np.array(triangles, dtype=np.int64).reshape(-1, 3) - 1,
    )


class Glb:
    """A binary glTF 2.0 file whose data are all in its own binary chunk."""

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        magic, version, length = struct.unpack_from("<4sII", data)
        if magic != b"glTF" or version != 2 or length != len(data):
            raise ValueError("not a GLB file of version 2 with the stated length")
        self.description, self.binary = None, b""
        at = 12
        while at < length:
            size, kind = struct.unpack_from("<I4s", data, at)
            chunk = data[at + 8 : at + 8 + size]
            if len(chunk) != size or size % 4 != 0:
                raise ValueError("a chunk is cut off or not padded")
            if kind == b"JSON":
                self.description = json.loads(chunk)
            elif kind == b"BIN\0":
                self.binary = chunk
            at += 8 + size

    def view(self, number, offset, kind, count):
        view = self.description["bufferViews"][number]
        start = view.get("byteOffset", 0) + offset
        if offset + count * np.dtype(kind).itemsize > view["byteLength"]:
            raise ValueError("an accessor reaches beyond its buffer view")
        return np.frombuffer(self.binary, dtype=kind, count=count, offset=start)

    def accessor(self, number):
        accessor = self.description["accessors"][number]
        width = WIDTHS[accessor["type"]]
        kind = np.dtype(COMPONENT_TYPES[accessor["componentType"]]).newbyteorder("<")
        count = accessor["count"] * width
        values = self.view(accessor["bufferView"], accessor.get("byteOffset", 0), kind, count)
        values = values.reshape(-1, width).copy()
        if sparse := accessor.get("sparse"):
            places, replaced = sparse["indices"], sparse["values"]
            place_kind = np.dtype(COMPONENT_TYPES[places["componentType"]]).newbyteorder("<")
            at = self.view(
                places["bufferView"], places.get("byteOffset", 0), place_kind, sparse["count"]
            )
            if not np.all(np.diff(at.astype(np.int64)) > 0):
                raise ValueError("sparse indices do not increase strictly")
            values[at] = self.view(
                replaced["bufferView"],
                replaced.get("byteOffset", 0),
                kind,
                sparse["count"] * width,
            ).reshape(-1, width)
        return values


def read_glb(path):
    """Positions and triangles of the file's only mesh; empty without one."""
    glb = Glb(path)
    meshes = glb.description.get("meshes", [])
    if not meshes:
        return np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)
    if len(meshes) > 1:
        raise ValueError("more than one mesh")
    extension = meshes[0].get("extensions", {}).get("EXT_mesh_manifold")
    primitives = [extension["manifoldPrimitive"]] if extension else meshes[0]["primitives"]
    accessors = {primitive["attributes"]["POSITION"] for primitive in primitives}
    if len(accessors) != 1:
        raise ValueError("primitives do not share their positions")
    positions = glb.accessor(accessors.pop()).astype(np.float64)
    indices = [glb.accessor(primitive["indices"]).reshape(-1, 3) for primitive in primitives]
    return positions, np.concatenate(indices).astype(np.int64)


def count_components(vertex_count, triangles):
    """Connected components of the triangles, by vertices."""
    edges = triangles[:, [0, 1, 1, 2]].reshape(-1, 2)
    joined = coo_matrix(
        (np.ones(len(edges), dtype=bool), (edges[:, 0], edges[:, 1])),
        shape=(vertex_count, vertex_count),
    )
    _, labels = connected_components(joined, directed=False)
    return len(np.unique(labels[triangles]))


def count_handles(triangles, components):
    vertices = len(np.unique(triangles))
    characteristic = vertices - len(triangles) * 3 // 2 + len(triangles)
    return components - characteristic // 2


def validate(path):
    report = dict.fromkeys(
        ["file", "status", "triangles", "components", "genus", "volume", "area", "error"]
    )
    report["file"] = path
    try:
        positions, triangles = read_glb(path) if path.endswith(".glb") else read_obj(path)
        if triangles.size and triangles.max() >= len(positions):
            raise ValueError("a triangle names a vertex that does not exist")
    except (OSError, ValueError, KeyError, IndexError, TypeError, struct.error) as error:
        report["error"] = f"{type(error).__name__}: {error}"
        report["status"] = "Unreadable"
        return report
    report["triangles"] = len(triangles)
    mesh = manifold3d.Mesh64(
        np.ascontiguousarray(positions), np.ascontiguousarray(triangles.astype(np.uint64))
    )
    manifold = manifold3d.Manifold(mesh)
    report["status"] = manifold.status().name
    if report["status"] == "NoError":
        report["components"] = count_components(len(positions), triangles)
        report["genus"] = count_handles(triangles, report["components"])
        report["volume"] = manifold.volume()
        report["area"] = manifold.surface_area()
    return report


if __name__ == "__main__":
    json.dump([validate(path) for path in sys.argv[1:]], sys.stdout)
