"""Says what lib3mf, the 3MF Consortium's reader, and plyfile find in our files.

Usage: mesh_files.py FILE...    prints a JSON list, one object a file, in the order given:

    vertices, triangles    counts
    warnings               lib3mf's, read in strict mode
    manifold               lib3mf: the mesh is a closed, oriented manifold
    unit                   lib3mf's number of the model's unit (1 mm, 3 inch)
    materials              number of base materials; in PLY of colours
    objects                names of lib3mf's mesh objects, each a solid
    built                  number of its build items
    volume                 of the triangles as read, in file units
"""

import json
import sys

import numpy as np


def volume(positions, triangles):
    a, b, c = (positions[triangles[:, corner]] for corner in range(3))
    return float(np.sum(np.cross(a, b) * c)) / 6.0


def threemf(path):
    import lib3mf

    wrapper = lib3mf.get_wrapper()
    model = wrapper.CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(path)
    positions, triangles, manifold, materials, objects = [], [], True, 0, []
    meshes = model.GetMeshObjects()
    while meshes.MoveNext():
        mesh = meshes.GetCurrentMeshObject()
        manifold = manifold and mesh.IsManifoldAndOriented()
        objects.append(mesh.GetName())
        first = len(positions)
        positions += [list(vertex.Coordinates) for vertex in mesh.GetVertices()]
        triangles += [[first + at for at in t.Indices] for t in mesh.GetTriangleIndices()]
    groups = model.GetBaseMaterialGroups()
    while groups.MoveNext():
        materials += groups.GetCurrentBaseMaterialGroup().GetCount()
    return {
        "vertices": len(positions),
        "triangles": len(triangles),
        "warnings": reader.GetWarningCount(),
        "manifold": bool(manifold),
        "unit": int(model.GetUnit()),
        "materials": materials,
        "objects": objects,
        "built": model.GetBuildItems().Count(),
        "volume": volume(
            np.array(positions, dtype=float).reshape(-1, 3),
            np.array(triangles, dtype=int).reshape(-1, 3),
        ),
    }


def ply(path):
    from plyfile import PlyData

    data = PlyData.read(path)
    vertex, face = data["vertex"], data["face"]
    positions = np.stack([vertex["x"], vertex["y"], vertex["z"]], axis=1)
    triangles = np.array(list(face["vertex_indices"]), dtype=int).reshape(-1, 3)
    colours = set(zip(*(face[name].tolist() for name in ("red", "green", "blue", "alpha"))))
    return {
        "vertices": len(positions),
        "triangles": len(triangles),
        "materials": len(colours),
        "volume": volume(positions, triangles),
    }


if __name__ == "__main__":
    reports = [threemf(path) if path.endswith(".3mf") else ply(path) for path in sys.argv[1:]]
    json.dump(reports, sys.stdout)
