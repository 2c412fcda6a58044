"""Distance between a mesh and the true boundary of a CSG model, both ways, by sampling.

Usage: distance.py SAMPLES MODEL.csg MESH.obj [MODEL.csg MESH.obj ...]

Knows nothing of the program under test: it reads the model's text itself, and takes each distance
to the true surfaces from closed forms or Newton's method in double precision.  A distance is
never taken for smaller than it is: it ends in a point that was found to be boundary.

Prints a JSON list with, for each pair, the largest distance from mesh to true boundary
(`mesh_to_true`) and from true boundary to mesh (`true_to_mesh`), and the samples' numbers.
"""

import json
import re
import sys

import numpy as np
from scipy.spatial import cKDTree

# ---------------------------------------------------------------- polynomials

class Surface:
    """p = 0 with p < 0 inside, in the model's coordinates; points are rows of an array."""

    def __init__(self, inverse, value, gradient):
        self.inverse, self.local_value, self.local_gradient = inverse, value, gradient

    def _local(self, x):
        return x @ self.inverse[:3, :3].T + self.inverse[:3, 3]

    def value(self, x):
        return self.local_value(self._local(x))

    def gradient(self, x):
        return self.local_gradient(self._local(x)) @ self.inverse[:3, :3]


def plane(normal, offset):
    n = np.array(normal, float)
    return (lambda x: x @ n - offset, lambda x: np.broadcast_to(n, x.shape))


def ball(r):
    return (lambda x: (x * x).sum(1) - r * r, lambda x: 2 * x)


def tube(r):
    m = np.array([1.0, 1.0, 0.0])
    return (lambda x: (x * x) @ m - r * r, lambda x: 2 * x * m)


def cone(r0, slope):
    """x² + y² = (r0 + slope·z)²"""
    def value(x):
        return x[:, 0] ** 2 + x[:, 1] ** 2 - (r0 + slope * x[:, 2]) ** 2
    def gradient(x):
        return np.stack([2 * x[:, 0], 2 * x[:, 1], -2 * slope * (r0 + slope * x[:, 2])], 1)
    return (value, gradient)


def ring(big, small):
    def value(x):
        s = (x * x).sum(1) + big**2 - small**2
        return s**2 - 4 * big**2 * (x[:, 0] ** 2 + x[:, 1] ** 2)
    def gradient(x):
        s = (x * x).sum(1) + big**2 - small**2
        flat = x * np.array([1.0, 1.0, 0.0])
        return 4 * s[:, None] * x - 8 * big**2 * flat
    return (value, gradient)


def written(text):
    """A polynomial as Python code; its gradient by complex steps, exact to rounding."""
    code = compile(text.replace("^", "**"), "polynomial", "eval")
    def at(x, y, z):
        return eval(code, {"x": x, "y": y, "z": z})
    def gradient(p):
        h = 1e-30
        c = p.T.astype(complex)
        return np.stack([at(*(c[a] + (1j * h if a == k else 0) for a in range(3))).imag / h
                         for k in range(3)], 1)
    return (lambda p: at(p[:, 0], p[:, 1], p[:, 2]), gradient)

# ---------------------------------------------------------------- models

class Model:
    """Surfaces and a formula over their signs."""

    def __init__(self, text):
        self.surfaces = []
        self.tokens = re.findall(r'"[^"]*"|[A-Za-z_]\w*|[-+]?[\d.]+(?:e[-+]?\d+)?|[()\[\]{},;=]', text)
        self.at = 0
        self.formula = self._group("union", np.eye(4), until=None)

    def _next(self):
        self.at += 1
        return self.tokens[self.at - 1]

    def _value(self):
        token = self._next()
        if token == "[":
            values = []
            while self.tokens[self.at] != "]":
                values.append(self._value())
                if self.tokens[self.at] == ",":
                    self.at += 1
            self.at += 1
            return values
        if token in ("true", "false"):
            return token == "true"
        return token[1:-1] if token.startswith('"') else float(token)

    def _arguments(self):
        assert self._next() == "("
        named, plain = {}, []
        while self.tokens[self.at] != ")":
            if self.tokens[self.at + 1] == "=":
                name = self._next()
                self.at += 1
                named[name] = self._value()
            else:
                plain.append(self._value())
            if self.tokens[self.at] == ",":
                self.at += 1
        self.at += 1
        return named, plain

    def _group(self, kind, place, until):
        children = []
        while self.at < len(self.tokens) and self.tokens[self.at] != until:
            child = self._node(place)
            if child is not None:
                children.append(child)
        return (kind, children)

    def _node(self, place):
        name = self._next()
        if name == ";":
            return None
        named, plain = self._arguments()
        if name == "multmatrix":
            place = place @ np.array(plain[0] if plain else named["m"])
        if self.at < len(self.tokens) and self.tokens[self.at] == "{":
            self.at += 1
            kind = name if name in ("union", "difference", "intersection") else "union"
            group = self._group(kind, place, "}")
            self.at += 1
            return group
        self.at += 1  # the semicolon
        parts = shape(name, named, plain)
        inverse = np.linalg.inv(place)
        literals = []
        for value, gradient in parts:
            literals.append(("literal", len(self.surfaces)))
            self.surfaces.append(Surface(inverse, value, gradient))
        return ("intersection", literals)

    def inside(self, x):
        signs = [s.value(x) <= 0 for s in self.surfaces]
        def evaluate(node):
            kind, rest = node
            if kind == "literal":
                return signs[rest]
            values = [evaluate(child) for child in rest]
            if kind == "union":
                return np.logical_or.reduce(values)
            if kind == "intersection":
                return np.logical_and.reduce(values)
            return np.logical_and.reduce([values[0]] + [~v for v in values[1:]])
        return evaluate(self.formula)


def shape(name, named, plain):
    if name == "sphere":
        return [ball(named["r"])]
    if name == "torus":
        return [ring(named["r1"], named["r2"])]
    if name == "polynomial":
        return [written(plain[0])]
    if name == "cube":
        size = named.get("size", [1, 1, 1])
        low = [-s / 2 if named.get("center") else 0 for s in size]
        axes = np.eye(3)
        return ([plane(axes[a], low[a] + size[a]) for a in range(3)]
                + [plane(-axes[a], -low[a]) for a in range(3)])
    if name == "cylinder":
        h = named.get("h", 1)
        low = -h / 2 if named.get("center") else 0.0
        r1, r2 = named.get("r1", named.get("r", 1)), named.get("r2", named.get("r", 1))
        slope = (r2 - r1) / h
        side = tube(r1) if slope == 0 else cone(r1 - slope * low, slope)
        return [side, plane([0, 0, 1], low + h), plane([0, 0, -1], -low)]
    raise ValueError(f"unknown shape {name}")

# ---------------------------------------------------------------- the true boundary

STEPS = 30
# Around a point this near to the boundary both inside and outside are found.
NEAR = 1e-8


def is_boundary(model, x, size):
    """Whether the solid is on one side of each point and not on the other."""
    probes = np.array([[a, b, c] for a in (-1, 0, 1) for b in (-1, 0, 1) for c in (-1, 0, 1) if a or b or c], float)
    probes += np.array([0.137, -0.071, 0.043])  # along no axis or diagonal
    first = model.inside(x + NEAR * size * probes[0])
    found = np.zeros(len(x), bool)
    for probe in probes[1:]:
        found |= model.inside(x + NEAR * size * probe) != first
    return found


def common_points(surfaces, start):
    """Points on all of up to three surfaces, near the starts: least steps of Newton's method, then
    steps along the surfaces towards the start."""
    x = start.copy()
    k = len(surfaces)
    with np.errstate(all="ignore"):
        for step in range(STEPS):
            values = np.stack([s.value(x) for s in surfaces], 1)
            rows = np.stack([s.gradient(x) for s in surfaces], 1)
            inverse = np.linalg.pinv(rows, rcond=1e-9)
            move = -np.einsum("nij,nj->ni", inverse, values)
            if step < STEPS - 6:
                # Towards the foot of the start: the part of the way that stays on the surfaces.
                back = start - x
                move += back - np.einsum("nij,njk,nk->ni", inverse, rows, back)
            x = x + np.where(np.isfinite(move), move, 0.0)
        residual = np.stack([np.abs(s.value(x)) / (np.linalg.norm(s.gradient(x), axis=1) + 1e-300)
                             for s in surfaces], 1).max(1)
    return x, residual


def distance_to_boundary(model, x, limit, size):
    """Distances to the nearest boundary point found; exact enough below the limit."""
    best = np.full(len(x), np.inf)
    with np.errstate(all="ignore"):
        near = np.stack([np.abs(s.value(x)) / (np.linalg.norm(s.gradient(x), axis=1) + 1e-300)
                         for s in model.surfaces], 1)
    order = np.argsort(near, axis=1)[:, :4]

    def attempt(chosen, which):
        groups = {}
        for row, key in zip(which, map(tuple, np.sort(chosen, axis=1))):
            groups.setdefault(key, []).append(row)
        for key, rows in groups.items():
            rows = np.array(rows)
            foot, residual = common_points([model.surfaces[i] for i in key], x[rows])
            distance = np.linalg.norm(foot - x[rows], axis=1)
            good = (residual < 1e-10 * size) & (distance < best[rows]) & (distance < 50 * limit)
            if good.any():
                real = is_boundary(model, foot[good], size)
                best[rows[good][real]] = distance[good][real] + 2 * NEAR * size

    everything = np.arange(len(x))
    attempt(order[:, :1], everything)
    width = order.shape[1]
    combinations = [[1], [2], [0, 1], [0, 2], [1, 2], [0, 1, 2], [3], [0, 3], [1, 3]]
    for columns in combinations:
        if max(columns) >= width:
            continue
        far = np.flatnonzero(best > 0.25 * limit)
        if len(far):
            attempt(order[far][:, columns], far)
    return best


def boundary_samples(model, low, high, count, rng):
    """Where random lines through the box cross the boundary."""
    found, size = [], np.linalg.norm(high - low)
    total = 0
    while total < count:
        lines = min(4000, max(100, count // 2))
        direction = rng.normal(size=(lines, 3))
        direction /= np.linalg.norm(direction, axis=1)[:, None]
        through = low + (high - low) * rng.random((lines, 3))
        steps = np.linspace(-1, 1, 257) * size * 1.01
        before = model.inside(through + steps[0] * direction)
        hits = []
        for a, b in zip(steps[:-1], steps[1:]):
            after = model.inside(through + b * direction)
            rows = np.flatnonzero(after != before)
            if len(rows):
                hits.append((rows, np.full(len(rows), a), np.full(len(rows), b), before[rows]))
            before = after
        rows, a, b, at_a = (np.concatenate(column) for column in zip(*hits))
        for _ in range(60):
            m = (a + b) / 2
            same = model.inside(through[rows] + m[:, None] * direction[rows]) == at_a
            a, b = np.where(same, m, a), np.where(same, b, m)
        found.append(through[rows] + b[:, None] * direction[rows])
        total += len(rows)
    return np.concatenate(found)[:count]

# ---------------------------------------------------------------- the mesh

def read_obj(path):
    vertices, facets = [], []
    with open(path) as file:
        for line in file:
            if line.startswith("v "):
                vertices.append([float(t) for t in line.split()[1:4]])
            elif line.startswith("f "):
                facets.append([int(t.split("/")[0]) - 1 for t in line.split()[1:4]])
    return np.array(vertices), np.array(facets)


def distance_to_triangles(p, a, b, c):
    """Point by point; after Ericson, Real-Time Collision Detection, 5.1.5, by clamping."""
    def to_segment(p, a, b):
        d = b - a
        t = np.clip(((p - a) * d).sum(1) / np.maximum((d * d).sum(1), 1e-300), 0, 1)
        return np.linalg.norm(p - a - t[:, None] * d, axis=1)
    n = np.cross(b - a, c - a)
    area = np.maximum((n * n).sum(1), 1e-300)
    w = (np.cross(b - a, p - a) * n).sum(1) / area
    v = (np.cross(p - a, c - a) * n).sum(1) / area
    inside = (v >= 0) & (w >= 0) & (v + w <= 1)
    flat = np.abs(((p - a) * n).sum(1)) / np.sqrt(area)
    edges = np.minimum(np.minimum(to_segment(p, a, b), to_segment(p, b, c)), to_segment(p, c, a))
    return np.where(inside, flat, edges)


def distance_to_mesh(p, vertices, facets):
    a, b, c = (vertices[facets[:, k]] for k in range(3))
    middle = (a + b + c) / 3
    reach = max(np.linalg.norm(q - middle, axis=1).max() for q in (a, b, c))
    tree = cKDTree(middle)
    best = np.full(len(p), np.inf)
    k = min(24, len(facets))
    gaps, nearest = tree.query(p, k=k)
    for column in range(k):
        f = nearest[:, column] if k > 1 else nearest
        best = np.minimum(best, distance_to_triangles(p, a[f], b[f], c[f]))
    # Triangles farther than that could still be nearer where they are large.
    farthest = gaps[:, -1] if k > 1 else gaps
    for row in np.flatnonzero(farthest < best + reach):
        f = np.array(tree.query_ball_point(p[row], best[row] + reach))
        if len(f) > k:
            at = np.broadcast_to(p[row], (len(f), 3))
            best[row] = min(best[row], distance_to_triangles(at, a[f], b[f], c[f]).min())
    return best


def mesh_samples(vertices, facets, count, rng):
    a, b, c = (vertices[facets[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    # Half by area, half by number: creases have small triangles.
    chosen = np.concatenate([rng.choice(len(facets), count // 2, p=area / area.sum()),
                             rng.integers(len(facets), size=count - count // 2)])
    u, v = rng.random(count), rng.random(count)
    flip = u + v > 1
    u, v = np.where(flip, 1 - u, u), np.where(flip, 1 - v, v)
    # A quarter on edges, where creases are.
    v[: count // 4] = 0
    return a[chosen] + u[:, None] * (b - a)[chosen] + v[:, None] * (c - a)[chosen]


def measure(model_path, mesh_path, count):
    rng = np.random.default_rng(7)
    with open(model_path) as file:
        model = Model(file.read())
    vertices, facets = read_obj(mesh_path)
    low, high = vertices.min(0), vertices.max(0)
    size = np.linalg.norm(high - low)
    on_mesh = mesh_samples(vertices, facets, count, rng)
    to_true = distance_to_boundary(model, on_mesh, 1e-2 * size, size)
    on_true = boundary_samples(model, low - 0.01 * size, high + 0.01 * size, count, rng)
    to_mesh = distance_to_mesh(on_true, vertices, facets)
    worst = on_mesh[np.argmax(to_true)]
    return {
        "samples": count,
        "mesh_to_true": float(to_true.max()),
        "worst_on_mesh": worst.tolist(),
        "true_to_mesh": float(to_mesh.max()),
        "worst_on_true": on_true[np.argmax(to_mesh)].tolist(),
    }


if __name__ == "__main__":
    count, pairs = int(sys.argv[1]), sys.argv[2:]
    results = [measure(a, b, count) for a, b in zip(pairs[::2], pairs[1::2])]
    json.dump(results, sys.stdout)
