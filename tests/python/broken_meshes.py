"""Writes good and deliberately broken meshes in every format, and what other programs say of them.

Usage: broken_meshes.py FOLDER    prints a JSON list, one object a file:

    file                path of the file
    case                what was done to the mesh
    open, crowded, one_way   edges of one, of three or more, of two equally directed triangles (numpy)
    pinched             vertices that libigl does not find manifold and whose triangles are more
                        than one fan
    degenerate, duplicate, out_of_range, not_finite   as they were made
    boundary            open edges by libigl
    manifold            Manifold's verdict on the same arrays
    watertight, volume, area, components   by trimesh, None where it cannot say

Counts are those of the triangle arrays, which are the same in all formats; STL, and GLB without
EXT_mesh_manifold, have equal positions joined.
"""

import io
import json
import pathlib
import struct
import sys
import zipfile

import igl
import manifold3d
import numpy as np
import trimesh


def box(at=(0, 0, 0)):
    mesh = trimesh.creation.box(extents=(2, 2, 2))
    return mesh.vertices + np.array(at), mesh.faces.astype(np.int64)


def together(*meshes):
    positions, triangles, count = [], [], 0
    for vertices, faces in meshes:
        positions.append(vertices)
        triangles.append(faces + count)
        count += len(vertices)
    return np.concatenate(positions), np.concatenate(triangles)


def joined(positions, triangles):
    """Vertices of equal position as one, in the order of their first."""
    _, first, inverse = np.unique(positions, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(np.argsort(first))
    return positions[np.sort(first)], order[inverse.reshape(-1)][triangles]


def cases():
    ring = trimesh.creation.torus(major_radius=3, minor_radius=1)
    torus = np.array(ring.vertices), np.array(ring.faces, dtype=np.int64)
    yield "cube", *box(), {}
    yield "torus", *torus, {}
    yield "two", *together(box(), box((5, 0, 0))), {}
    yield "cavity", *together(*[(3 * box()[0], box()[1]), (box()[0], box()[1][:, ::-1])]), {}
    vertices, faces = torus
    yield "hole", vertices, np.delete(faces, [5, 600], axis=0), {}
    turned = faces.copy()
    turned[7] = turned[7, ::-1]
    yield "turned", vertices, turned, {}
    fin = np.vstack([vertices, [[9.0, 9.0, 9.0]]])
    yield "fin", fin, np.vstack([faces, [[faces[3][0], faces[3][1], len(vertices)]]]), {}
    yield "corner", *joined(*together(box(), box((2, 2, 2)))), {}
    yield "edge", *joined(*together(box(), box((2, 2, 0)))), {}
    yield "repeated", vertices, np.vstack([faces, faces[[11, 11]]]), {"duplicate": 2}
    a, b, _ = faces[0]
    yield "degenerate", vertices, np.vstack([faces, [[a, a, b], [b, b, b]]]), {"degenerate": 2}
    missing = faces.copy()
    missing[9][1] = len(vertices) + 5
    yield "missing", vertices, missing, {"out_of_range": 1}
    strange = vertices.copy()
    strange[4] = [np.nan, 0, 0]
    strange[8] = [0, np.inf, 0]
    yield "strange", strange, faces, {"not_finite": 2}


def judge(positions, triangles, known):
    report = {"degenerate": 0, "duplicate": 0, "out_of_range": 0, "not_finite": 0} | known
    whole = triangles[(triangles < len(positions)).all(axis=1)]
    a, b, c = whole.T
    whole = whole[(a != b) & (b != c) & (c != a)]
    directed = np.concatenate([whole[:, [0, 1]], whole[:, [1, 2]], whole[:, [2, 0]]])
    edges, inverse, uses = np.unique(
        np.sort(directed, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    forward = np.bincount(inverse.reshape(-1), directed[:, 0] < directed[:, 1], len(edges))
    report["open"] = int((uses == 1).sum())
    report["crowded"] = int((uses > 2).sum())
    report["one_way"] = int(((uses == 2) & (forward != 1)).sum())
    report["boundary"] = len(igl.boundary_facets(whole)[0])
    report["pinched"] = int((~igl.is_vertex_manifold(whole)[np.unique(whole)]).sum())
    report["components"] = int(igl.facet_components(whole)[0])

    report["manifold"] = report["watertight"] = report["volume"] = report["area"] = None
    if report["out_of_range"] == 0:
        mesh = manifold3d.Mesh64(
            np.ascontiguousarray(positions, dtype=np.float64),
            np.ascontiguousarray(triangles, dtype=np.uint64),
        )
        report["manifold"] = manifold3d.Manifold(mesh).status().name
        if not report["not_finite"]:
            mesh = trimesh.Trimesh(positions, whole, process=False)
            report["watertight"] = bool(mesh.is_watertight and mesh.is_winding_consistent)
            report["volume"], report["area"] = float(mesh.volume), float(mesh.area)
    return report


def obj(positions, triangles):
    lines = ["# broken on purpose", "o part", "g first"]
    lines += ["v %r %r %r" % tuple(map(float, p)) for p in positions]
    lines += ["f %d//1 %d//1 %d//1" % tuple(t + 1) for t in triangles]
    return "\n".join(lines).encode()


def stl_corners(positions, triangles):
    return positions[triangles]


def stl_binary(positions, triangles):
    out = [b"\0" * 80, struct.pack("<I", len(triangles))]
    for corners in stl_corners(positions, triangles):
        out.append(struct.pack("<12fH", 0, 0, 0, *corners.reshape(-1), 0))
    return b"".join(out)


def stl_text(positions, triangles):
    lines = ["solid part of two words"]
    for corners in stl_corners(positions, triangles):
        lines += ["  facet normal 0 0 0", "    outer loop"]
        lines += ["      vertex %r %r %r" % tuple(map(float, corner)) for corner in corners]
        lines += ["    endloop", "  endfacet"]
    return "\n".join(lines + ["endsolid part of two words", ""]).encode()


def threemf(positions, triangles):
    text = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        '<model unit="inch" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">',
        '<resources><object id="7" type="model"><mesh><vertices>',
    ]
    text += ['<vertex x="%r" y="%r" z="%r"/>' % tuple(map(float, p)) for p in positions]
    text += ["</vertices><triangles>"]
    text += ['<triangle v1="%d" v2="%d" v3="%d"/>' % tuple(t) for t in triangles]
    text += ['</triangles></mesh></object></resources><build><item objectid="7"']
    text += [' transform="0 1 0 -1 0 0 0 0 1 10 20 30"/></build></model>']
    relations = (
        '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
        '<Relationship Id="r" Target="/3D/3dmodel.model" '
        'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
    )
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("_rels/.rels", relations)
        archive.writestr("3D/3dmodel.model", "\n".join(text))
    return out.getvalue()


def ply(encoding):
    def write(positions, triangles):
        header = f"ply\nformat {encoding} 1.0\ncomment broken on purpose\n"
        header += f"element vertex {len(positions)}\n"
        header += "".join(f"property double {axis}\n" for axis in "xyz") + "property uchar red\n"
        header += f"element face {len(triangles)}\nproperty list uchar int vertex_indices\n"
        out = [(header + "end_header\n").encode()]
        if encoding == "ascii":
            lines = ["%r %r %r 7" % tuple(map(float, p)) for p in positions]
            lines += ["3 %d %d %d" % tuple(t) for t in triangles]
            return out[0] + "\n".join(lines + [""]).encode()
        order = "<" if encoding == "binary_little_endian" else ">"
        out += [struct.pack(order + "3dB", *p, 7) for p in positions]
        out += [struct.pack(order + "B3i", 3, *t) for t in triangles]
        return b"".join(out)

    return write


def glb(positions, triangles):
    """Without the extension, every triangle with vertices of its own."""
    if (triangles >= len(positions)).any():
        data = [positions.astype("<f4").tobytes(), triangles.astype("<u4").tobytes()]
        counts = [len(positions), triangles.size]
    else:
        data = [positions[triangles].astype("<f4").tobytes()]
        data += [np.arange(triangles.size, dtype="<u4").tobytes()]
        counts = [triangles.size, triangles.size]
    description = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"children": [1], "scale": [1, -1, 1]}, {"mesh": 0, "translation": [1, 2, 3]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": counts[0], "type": "VEC3"},
            {"bufferView": 1, "componentType": 5125, "count": counts[1], "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": len(data[0])},
            {"buffer": 0, "byteOffset": len(data[0]), "byteLength": len(data[1])},
        ],
        "buffers": [{"byteLength": len(data[0]) + len(data[1])}],
    }
    text = json.dumps(description).encode()
    text += b" " * (-len(text) % 4)
    binary = b"".join(data)
    length = 12 + 8 + len(text) + 8 + len(binary)
    return b"".join(
        [struct.pack("<4sII", b"glTF", 2, length), struct.pack("<I4s", len(text), b"JSON"), text]
        + [struct.pack("<I4s", len(binary), b"BIN\0"), binary]
    )


WRITERS = {
    "obj": obj,
    "binary.stl": stl_binary,
    "text.stl": stl_text,
    "3mf": threemf,
    "text.ply": ply("ascii"),
    "little.ply": ply("binary_little_endian"),
    "big.ply": ply("binary_big_endian"),
    "glb": glb,
}
SOUPS = ("binary.stl", "text.stl", "glb")


def main(folder):
    reports = []
    for case, positions, triangles, known in cases():
        # 32-bit numbers, so that all formats hold the same positions.
        positions = positions.astype(np.float32).astype(np.float64)
        for name, write in WRITERS.items():
            report_of = positions, triangles, known
            if "stl" in name and "out_of_range" in known:
                continue
            if name == "glb" and "out_of_range" in known:
                report_of = positions, triangles, known
            path = pathlib.Path(folder) / f"{case}.{name}"
            path.write_bytes(write(positions, triangles))
            reports.append({"file": str(path), "case": case} | judge(*report_of))
    json.dump(reports, sys.stdout)


if __name__ == "__main__":
    main(sys.argv[1])
