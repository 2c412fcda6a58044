"""Says what trimesh measures of mesh files.

Usage: mesh_properties.py FILE...    prints a JSON list, one object a file, in the order given:
area, volume, centroid (3), inertia (3 by 3, about the centroid, density 1) and solids, the number of
parts that hang together. Instances are put in their places; equal positions are joined.
"""

import json
import sys

import trimesh


def measure(path):
    mesh = trimesh.load_scene(path).to_mesh()
    mesh.merge_vertices(merge_norm=True, merge_tex=True)
    return {
        "area": float(mesh.area),
        "volume": float(mesh.volume),
        "centroid": mesh.center_mass.tolist(),
        "inertia": mesh.moment_inertia.tolist(),
        "solids": int(mesh.body_count),
    }


if __name__ == "__main__":
    json.dump([measure(path) for path in sys.argv[1:]], sys.stdout)
