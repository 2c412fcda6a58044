"""What OpenCASCADE finds in STEP files, as JSON: one report a file, in the order of the arguments.

A report has `file`, `solids` and `loose` (faces in no solid); each solid has `valid` (BRepCheck), `volume`,
`area`, `surfaces` (how many faces are on which kind of surface) and `edges` (how many edges are on which
kind of curve). `--quick` measures volumes less exactly. With `--reference` the arguments are names of solids below, which OpenCASCADE builds by
its own Booleans.
"""

import json
import math
import os
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial

from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.BRepAlgoAPI import BRepAlgoAPI_Common, BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeBox,
    BRepPrimAPI_MakeCone,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakeSphere,
    BRepPrimAPI_MakeTorus,
)
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_RetDone
from OCP.STEPControl import STEPControl_Reader
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_SOLID
from OCP.TopExp import TopExp, TopExp_Explorer
from OCP.TopoDS import TopoDS
from OCP.collections import IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher as ShapeMap


def parts(shape, kind):
    found = ShapeMap()
    TopExp.MapShapes_s(shape, kind, found)
    return [found.FindKey(at) for at in range(1, found.Extent() + 1)]


def count(names):
    return {name: names.count(name) for name in sorted(set(names))}


def describe(solid, error=1e-9):
    volume, area = GProp_GProps(), GProp_GProps()
    BRepGProp.VolumeProperties_s(solid, volume, error)
    BRepGProp.SurfaceProperties_s(solid, area, error)
    surfaces = [BRepAdaptor_Surface(TopoDS.Face(face)).GetType() for face in parts(solid, TopAbs_FACE)]
    edges = [BRepAdaptor_Curve(TopoDS.Edge(edge)).GetType() for edge in parts(solid, TopAbs_EDGE)]
    return {
        "valid": BRepCheck_Analyzer(solid).IsValid(),
        "volume": volume.Mass(),
        "area": area.Mass(),
        "surfaces": count([kind.name.removeprefix("GeomAbs_").lower() for kind in surfaces]),
        "edges": count([kind.name.removeprefix("GeomAbs_").lower() for kind in edges]),
    }


def read(path, error=1e-9):
    reader = STEPControl_Reader()
    if reader.ReadFile(path) != IFSelect_RetDone:
        return {"file": path, "solids": [], "loose": 0, "error": "unreadable"}
    reader.TransferRoots()
    shape = reader.OneShape()
    loose = TopExp_Explorer(shape, TopAbs_FACE, TopAbs_SOLID).More()
    return {
        "file": path,
        "solids": [describe(solid, error) for solid in parts(shape, TopAbs_SOLID)],
        "loose": int(loose),
        "error": None,
    }


def axes(x, y, z, direction):
    return gp_Ax2(gp_Pnt(x, y, z), gp_Dir(*direction))


def box(x, y, z, dx, dy, dz):
    return BRepPrimAPI_MakeBox(gp_Pnt(x, y, z), dx, dy, dz).Shape()


def cylinder(x, y, z, direction, radius, height):
    return BRepPrimAPI_MakeCylinder(axes(x, y, z, direction), radius, height).Shape()


def ball(x, y, z, radius):
    return BRepPrimAPI_MakeSphere(gp_Pnt(x, y, z), radius).Shape()


def cone(x, y, z, r0, r1, height):
    return BRepPrimAPI_MakeCone(axes(x, y, z, (0, 0, 1)), r0, r1, height).Shape()


def torus(ring, tube):
    return BRepPrimAPI_MakeTorus(axes(0, 0, 0, (0, 0, 1)), ring, tube).Shape()


def fuse(a, b):
    return BRepAlgoAPI_Fuse(a, b).Shape()


def cut(a, b):
    return BRepAlgoAPI_Cut(a, b).Shape()


def common(a, b):
    return BRepAlgoAPI_Common(a, b).Shape()


Z, X = (0, 0, 1), (1, 0, 0)
TILTED = (0, math.sin(0.9), math.cos(0.9))
REFERENCE = {
    "two_balls": lambda: fuse(ball(0, 0, 0, 10), ball(9, 3, 2, 8)),
    "cross_drilled": lambda: cut(cylinder(0, 0, -10, Z, 6, 20), cylinder(-10, 0, 0, X, 3, 20)),
    "tilted_pipes": lambda: fuse(
        cylinder(0, 0, -10, Z, 5, 20),
        cylinder(0, -10 * TILTED[1], -10 * TILTED[2], TILTED, 4, 20),
    ),
    "ball_in_box": lambda: common(ball(0, 0, 0, 10), box(-7, -8, -6, 15, 16, 11)),
    "drilled_ball": lambda: cut(ball(0, 0, 0, 10), cylinder(3, 2, -20, Z, 4, 40)),
    "cone_in_box": lambda: cut(cone(0, 0, -8, 9, 3, 16), box(2, -20, -3, 30, 40, 6)),
    "torus_and_ball": lambda: fuse(torus(10, 3), ball(9, 2, 1, 4)),
    "cut_torus": lambda: cut(torus(10, 3), box(-20, -20, 1, 40, 40, 10)),
    "torus_and_pipe": lambda: cut(torus(10, 4), cylinder(9, 1, -20, Z, 2, 40)),
    "cone_and_pipe": lambda: fuse(cone(0, 0, -8, 9, 3, 16), cylinder(-20, 1, -1, X, 3, 40)),
    "pocket": lambda: cut(box(-10, -10, -5, 20, 20, 10), ball(2, 1, 5, 6)),
    "steps": lambda: fuse(box(-10, -10, -5, 20, 20, 10), box(-5, -4, 0, 30, 6, 9)),
}


def main(arguments):
    if arguments[:1] == ["--reference"]:
        return [describe(REFERENCE[name]()) for name in arguments[1:]]
    if arguments[:1] == ["--quick"]:
        # The largest ones first, so that no process is left alone with them.
        paths = sorted(arguments[1:], key=os.path.getsize, reverse=True)
        with ProcessPoolExecutor() as processes:
            reports = processes.map(partial(read, error=1e-5), paths)
            found = dict(zip(paths, reports))
        return [found[path] for path in arguments[1:]]
    return [read(path) for path in arguments]


if __name__ == "__main__":
    json.dump(main(sys.argv[1:]), sys.stdout)
