#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the hard cases of surfaces and solids into surfaces/: points (.pcd), meshes (.off) and cases.json.

Answers are found here, in rational numbers and by the definition: distances as the least over all features that may be
nearest, insides by rays in random directions that meet no edge. Nothing of pcl_bsh is used.
"""
import collections
import itertools
import json
import math
import pathlib
import random
from fractions import Fraction

FOLDER = pathlib.Path(__file__).resolve().parent / "surfaces"
IDENTITY = [1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0, 0]


# Rational geometry -------------------------------------------------------------------------------------------------

def sub(p, q):
    return (p[0] - q[0], p[1] - q[1], p[2] - q[2])


def dot(p, q):
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def cross(p, q):
    return (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])


def along(p, s, v):
    return (p[0] + s * v[0], p[1] + s * v[1], p[2] + s * v[2])


def squared(v):
    return dot(v, v)


def exact(p):
    return tuple(Fraction(x) for x in p)


def posed(pose, p):
    rows = [[Fraction(x) for x in pose[4 * i:4 * i + 4]] for i in range(3)]
    return tuple(dot(row[:3], p) + row[3] for row in rows)


def to_segment(p, a, b):
    way = sub(b, a)
    whole = squared(way)
    share = min(max(dot(sub(p, a), way) / whole, Fraction(0)), Fraction(1)) if whole else Fraction(0)
    return squared(sub(p, along(a, share, way)))


def point_triangle(p, t):
    least = min(to_segment(p, t[i], t[(i + 1) % 3]) for i in range(3))
    u, v, w = sub(t[1], t[0]), sub(t[2], t[0]), sub(p, t[0])
    a, b, c, d, e = dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w)
    whole = a * c - b * b
    if whole:
        s, r = (c * d - b * e) / whole, (a * e - b * d) / whole
        if s >= 0 and r >= 0 and s + r <= 1:
            least = min(least, squared(sub(sub(w, along((0, 0, 0), s, u)), along((0, 0, 0), r, v))))
    return least


def pierces(a, b, t):
    way, u, v, w = sub(a, b), sub(t[1], t[0]), sub(t[2], t[0]), sub(a, t[0])
    whole = dot(way, cross(u, v))
    if not whole:
        return False
    q, s, r = dot(w, cross(u, v)) / whole, dot(way, cross(w, v)) / whole, dot(way, cross(u, w)) / whole
    return 0 <= q <= 1 and s >= 0 and r >= 0 and s + r <= 1


def segment_segment(a, b, c, d):
    u, v, w = sub(b, a), sub(d, c), sub(a, c)
    least = min(to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b))
    aa, ab, bb, au, bv = dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w)
    whole = aa * bb - ab * ab
    if whole:
        s, r = (ab * bv - bb * au) / whole, (aa * bv - ab * au) / whole
        if 0 < s < 1 and 0 < r < 1:
            least = min(least, squared(sub(along(w, s, u), along((0, 0, 0), r, v))))
    return least


def triangle_triangle(x, y):
    edges = [(0, 1), (1, 2), (2, 0)]
    if any(pierces(x[i], x[j], y) or pierces(y[i], y[j], x) for i, j in edges):
        return Fraction(0)
    least = min(min(point_triangle(p, y) for p in x), min(point_triangle(p, x) for p in y))
    return min(least, min(segment_segment(x[i], x[j], y[k], y[l]) for i, j in edges for k, l in edges))


def winding(p, triangles, rng):
    """None on the surface."""
    across = []
    for t in triangles:
        normal = cross(sub(t[1], t[0]), sub(t[2], t[0]))
        if dot(normal, sub(t[0], p)):
            across.append((t, normal))
        elif point_triangle(p, t) == 0:
            return None
    while True:
        way = tuple(Fraction(rng.randint(-10**6, 10**6)) for _ in range(3))
        turns, generic = 0, True
        for t, normal in across:
            w = [sub(c, p) for c in t]
            sides = [dot(way, cross(w[i], w[(i + 1) % 3])) for i in range(3)]
            if 0 in sides:
                generic = False
                break
            if not (all(s > 0 for s in sides) or all(s < 0 for s in sides)):
                continue
            if dot(normal, w[0]) * dot(normal, way) > 0:
                turns += 1 if dot(normal, way) > 0 else -1
        if generic:
            return turns


def open_edges(triangles):
    left = collections.Counter()
    for t in triangles:
        for i in range(3):
            a, b = t[i], t[(i + 1) % 3]
            if a != b:
                left[(a, b)] += 1
                left[(b, a)] -= 1
    return sum(count for count in left.values() if count > 0), left


def root(value):
    """The double nearest to the root of a fraction."""
    if value == 0:
        return 0.0
    shift = 4 * max(0, 300 + value.denominator.bit_length() - value.numerator.bit_length())
    scaled = (value.numerator << (2 * shift)) // value.denominator
    return float(Fraction(math.isqrt(scaled), 1 << shift))


# Meshes ------------------------------------------------------------------------------------------------------------

class Mesh:
    def __init__(self):
        self.vertices, self.faces = [], []

    def add(self, vertices, faces, scale=1.0, shift=(0.0, 0.0, 0.0), flip=False):
        first = len(self.vertices)
        self.vertices += [tuple(x * scale + s for x, s in zip(v, shift)) for v in vertices]
        self.faces += [tuple(first + i for i in (reversed(f) if flip else f)) for f in faces]
        return self

    def corners(self, pose):
        """Triangles as the pose has them; of more corners, fans from the first."""
        at = [posed(pose, exact(v)) for v in self.vertices]
        return [(at[f[0]], at[f[i]], at[f[i + 1]]) for f in self.faces for i in range(1, len(f) - 1)]

    def soup(self):
        made = Mesh()
        for f in self.faces:
            made.add([self.vertices[i] for i in f], [tuple(range(len(f)))])
        return made

    def write(self, name):
        lines = ["OFF", f"{len(self.vertices)} {len(self.faces)} 0"]
        lines += [" ".join(repr(float(x)) for x in v) for v in self.vertices]
        lines += [" ".join(map(str, (len(f), *f))) for f in self.faces]
        (FOLDER / name).write_text("\n".join(lines) + "\n")


CUBE_VERTICES = [(float(i & 1), float(i >> 1 & 1), float(i >> 2 & 1)) for i in range(8)]
CUBE_FACES = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6),
              (0, 6, 2), (1, 3, 7), (1, 7, 5)]
TRIANGLE = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)]


def cube(scale=1.0, shift=(0.0, 0.0, 0.0), flip=False):
    return Mesh().add(CUBE_VERTICES, CUBE_FACES, scale, shift, flip)


def soup_of(*triangles):
    made = Mesh()
    for t in triangles:
        made.add(list(t), [(0, 1, 2)])
    return made


def write_points(name, points):
    header = ["# .PCD v0.7", "VERSION 0.7", "FIELDS x y z", "SIZE 8 8 8", "TYPE F F F", "COUNT 1 1 1",
              f"WIDTH {len(points)}", "HEIGHT 1", "VIEWPOINT 0 0 0 1 0 0 0", f"POINTS {len(points)}", "DATA ascii"]
    (FOLDER / name).write_text("\n".join(header + [" ".join(repr(float(x)) for x in p) for p in points]) + "\n")


# Cases -------------------------------------------------------------------------------------------------------------

CASES = []


def case(name, mesh, clearance, points=None, other=None, pose=None, solid=False):
    """Points, or another mesh, against a mesh at the pose T_input_mesh."""
    key = name.split(",")[0].lower() + "_" + str(len(CASES))
    pose = [float(x) for x in pose or IDENTITY]
    told = {"name": name, "mesh": key + "_mesh.off", "clearance": clearance}
    mesh.write(told["mesh"])
    if pose != IDENTITY:
        told["pose"] = pose
    surface = mesh.corners(pose)
    if points is not None:
        told["points"] = key + "_points.pcd"
        write_points(told["points"], points)
        inputs = [exact(p) for p in points]
        distance = point_triangle
    else:
        told["other"] = key + "_other.off"
        other.write(told["other"])
        inputs = other.corners(IDENTITY)
        distance = triangle_triangle
    reach = Fraction(clearance) ** 2
    squares = [[distance(p, t) for t in surface] for p in inputs]
    told["colliding"] = [i for i, row in enumerate(squares) if min(row) <= reach]
    told["colliding_of_mesh"] = [j for j in range(len(surface)) if min(row[j] for row in squares) <= reach]
    told["smallest_distance"] = root(min(min(row) for row in squares))
    if solid:
        rng = random.Random(7)
        edges, _ = open_edges(surface)
        assert edges == 0, name
        labels = []
        for p in inputs:
            of_corners = [winding(c, surface, rng) for c in (p if points is None else [p])]
            inside = any(n for n in of_corners)
            labels.append(1 if inside else 2 if None in of_corners else 0)
        told["labels"] = labels
    CASES.append(told)


def opened(name, mesh):
    key = name.split(",")[0].lower() + "_" + str(len(CASES))
    mesh.write(key + "_mesh.off")
    count, left = open_edges(mesh.corners(IDENTITY))
    assert count > 0
    first = next((i, t[k], t[(k + 1) % 3]) for i, t in enumerate(mesh.corners(IDENTITY)) for k in range(3)
                 if left[(t[k], t[(k + 1) % 3])] > 0)
    CASES.append({"name": name, "mesh": key + "_mesh.off", "open_edges": count, "first_open_triangle": first[0],
                  "first_open_edge": [[float(x) for x in first[1]], [float(x) for x in first[2]]]})


def touching():
    flat = soup_of(TRIANGLE)
    below, above = math.nextafter, lambda x: math.nextafter(x, math.inf)
    case("S1, at a vertex", flat, 0.078125, [(-0.046875, -0.0625, 0.0), (-0.046875, -0.0625, 2.0 ** -60)])
    case("S2, at an edge", flat, 0.25, [(0.5, -0.25, 0.0), (0.5, above(-0.25), 0.0), (0.5, below(-0.25, -1), 0.0)])
    case("S3, at a face", flat, 0.5, [(0.25, 0.25, 0.5), (0.25, 0.25, above(0.5)), (0.25, 0.25, -0.5)])
    case("S3, at a slanted face", soup_of([(1.0, 0, 0), (0, 1.0, 0), (0, 0, 1.0)]), math.sqrt(1 / 3),
         [(0.0, 0.0, 0.0), (2 / 3, 2 / 3, 2 / 3)])
    case("S4, on the triangle", flat, 0.0, [(0, 0, 0), (0.5, 0.5, 0), (0.25, 0.125, 0), (0.5, above(0.5), 0),
                                            (0.1, 0.2, 0), (0.1, 0.2, 5e-324)])
    rng = random.Random(4)
    lattice = lambda: tuple(rng.randint(-4, 4) / 8 for _ in range(3))
    case("S5, ties on a lattice", soup_of(*[[lattice() for _ in range(3)] for _ in range(12)]), 0.375,
         [(x / 8, y / 8, z / 8) for x in range(-6, 7, 2) for y in range(-6, 7, 3) for z in range(-6, 7, 3)])
    case("S5, ties of triangles on a lattice", soup_of(*[[lattice() for _ in range(3)] for _ in range(8)]), 0.25,
         other=soup_of(*[[lattice() for _ in range(3)] for _ in range(8)]))


def degenerate():
    point, end, middle = (1.0, 2.0, 3.0), (2.0, 2.0, 3.0), (1.5, 2.0, 3.0)
    beside = [(1.0, 2.0, 3.5), (0.625, 1.5, 3.0), (1.25, 2.0, 2.5), (2.3, 2.4, 3.0), (2.5, 2.0, 3.0)]
    case("S6, a point", soup_of([point, point, point]), 0.5, beside)
    case("S6, a segment", soup_of([point, end, point]), 0.5, beside)
    case("S6, corners on one line", soup_of([point, end, middle]), 0.5, beside)
    case("S6, segments that cross", soup_of([(0, 0, 0), (1.0, 1.0, 1.0), (0, 0, 0)]), 0.0,
         other=soup_of([(1.0, 0, 0), (0, 1.0, 1.0), (1.0, 0, 0)], [(1.0, 0, 1e-300), (0, 1.0, 1.0), (0, 1.0, 1.0)]))
    case("S7, a needle", soup_of([(0.0, 0, 0), (1000.0, 0.1, 0.3), (0.0, 1e-9, 0)]), 0.01,
         [(500.0, 0.05, 0.16), (500.0, 0.05, 0.1600000000000001), (0.0, 0.0, 0.01), (-0.01, 0, 0), (250.0, 0.035, 0.075)])
    last = math.nextafter(1.0, 2.0)
    case("S7, a sliver of one last place", soup_of([(0.0, 1.0, 0.0), (64.0, 1.0, 0.0), (31.0, last, 0.0)]), 0.25,
         [(31.0, 1.25, 0.0), (31.0, math.nextafter(1.25, 2.0), 0.0), (31.0, math.nextafter(1.25, 2) + 2.0 ** -52, 0.0),
          (30.0, 1.25 + 2.0 ** -52, 0.0), (8.0, 1.25, 0.0)])


def far():
    utm = (513449.75, 5402650.25, 300.125)
    small = [tuple(1e-5 * x + s for x, s in zip(v, utm)) for v in CUBE_VERTICES]
    mesh = Mesh().add(small, CUBE_FACES)
    points = [tuple(s + 1e-5 * q for s, q in zip(utm, p)) for p in itertools.product((-0.5, 0.0, 0.5, 1.0, 1.7), repeat=3)]
    case("S8, 10 um edges at UTM coordinates", mesh, 4e-6, points, solid=True)
    turn = [0.8, -0.6, 0.0, 513449.75, 0.6, 0.8, 0.0, 5402650.25, 0.0, 0.0, 1.0, 300.125]
    case("S8, turned there by a pose", cube(0.1), 0.01,
         [tuple(s + 0.05 * q for s, q in zip(utm, p)) for p in itertools.product((-1, 0, 0.6, 1, 2.2), repeat=3)],
         pose=turn, solid=True)
    sides = 600
    fan = Mesh()
    fan.add([(0.0, 0.0, 1.0), (0.0, 0.0, 0.0)] + [(math.cos(2 * math.pi * i / sides), math.sin(2 * math.pi * i / sides), 0.0)
                                                  for i in range(sides)],
            [f for i in range(sides) for f in ((0, 2 + i, 2 + (i + 1) % sides), (1, 2 + (i + 1) % sides, 2 + i))])
    case("S9, a fan of many sides", fan, 2.0 ** -10,
         [(0.0, 0.0, 1.0), (0.0, 0.0, 1.0 + 2.0 ** -10), (0, 0, 0.5), (0, 0, 0), (0, 0, -2.0 ** -10), (1.0, 0, 0),
          (0.5, 0.0, 0.5), (0.5, 0.0, math.nextafter(0.5, 1)), (0.999, 0, 2.0 ** -12)], solid=True)


def two_triangles():
    flat = soup_of(TRIANGLE)
    at = lambda *corners: soup_of(corners)
    case("S10, crossing", flat, 0.0, other=at((0.2, 0.2, -1.0), (0.3, 0.2, 1.0), (0.2, 0.3, 1.0)))
    case("S10, a vertex in the face", flat, 0.0, other=at((0.25, 0.25, 0.0), (1.0, 1.0, 1.0), (0, 1.0, 1.0)))
    case("S10, a vertex just above the face", flat, 0.0, other=at((0.25, 0.25, 5e-324), (1.0, 1.0, 1.0), (0, 1.0, 1.0)))
    case("S10, edges that touch", flat, 0.0, other=at((0.5, -1.0, 0.0), (0.5, 1.0, 0.0), (0.5, -1.0, 1.0)))
    case("S10, edges at the clearance", flat, 0.375, other=at((0.5, -1.0, 0.375), (0.5, 0.25, 0.375), (0.5, 0, 9.0)))
    case("S10, in one plane, one in the other", flat, 0.0, other=at((0.1, 0.1, 0), (0.3, 0.1, 0), (0.1, 0.3, 0)))
    case("S10, in one plane, a common corner", flat, 0.0, other=at((1.0, 0, 0), (2.0, 0, 0), (2.0, 1.0, 0)))
    case("S10, in one plane, apart by the clearance", flat, 0.5, other=at((1.5, 0, 0), (2.0, 0, 0), (2.0, 1.0, 0)))
    case("S10, parallel at the clearance", flat, 0.125, other=soup_of([(x, y, 0.125) for x, y, _ in TRIANGLE]))
    case("S10, the same", flat, 0.0, other=flat)


def solids():
    grid = list(itertools.product((-0.25, 0.0, 0.25, 0.5, 1.0, 1.25), repeat=3))
    fine = list(itertools.product((-0.5, 0.0, 0.125, 0.25, 0.5, 1.0, 1.5), repeat=3))
    case("S20, a cube", cube(), 0.0, grid, solid=True)
    case("S20, of the float before its corner", cube(math.nextafter(1.0, 0)), 0.0, grid, solid=True)
    case("S21, corners that are one by coordinates alone", cube().soup(), 0.0, grid, solid=True)
    minus = cube().soup()
    minus.vertices = [tuple(-0.0 if x == 0.0 and i % 2 else x for x in v) for i, v in enumerate(minus.vertices)]
    case("S21, of -0 and 0", minus, 0.0, grid, solid=True)
    doubled = cube()
    doubled.add([(0.25, 0.25, 0.25), (0.75, 0.25, 0.25), (0.25, 0.75, 0.25)], [(0, 1, 2), (2, 1, 0)])
    doubled.add([(1.5, 0.0, 0.0), (2.0, 0.0, 0.0), (1.5, 1.0, 0.0)], [(0, 1, 2), (2, 1, 0)])
    case("S22, faces doubled in opposite directions", doubled, 0.0, fine + [(1.6, 0.1, 0.0), (1.6, 0.1, 0.1)], solid=True)
    case("S22, each face twice", cube().add(CUBE_VERTICES, CUBE_FACES), 0.0, grid, solid=True)
    case("S22, all faces doubled in opposite directions", cube().add(CUBE_VERTICES, CUBE_FACES, flip=True), 0.0, grid,
         solid=True)
    case("S23, a flipped shell", cube(flip=True), 0.0, grid, solid=True)
    inner = (0.25, 0.25, 0.25)
    case("S24, nested shells", cube().add(CUBE_VERTICES, CUBE_FACES, 0.5, inner), 0.0, fine, solid=True)
    case("S24, a hollow", cube().add(CUBE_VERTICES, CUBE_FACES, 0.5, inner, True), 0.0, fine, solid=True)
    case("S25, shells that overlap", cube().add(CUBE_VERTICES, CUBE_FACES, 1.0, (0.5, 0.5, 0.5)), 0.0, fine, solid=True)
    case("S25, shells that share a face", cube().add(CUBE_VERTICES, CUBE_FACES, 1.0, (1.0, 0.0, 0.0)), 0.0, fine,
         solid=True)
    rng = random.Random(25)
    crossing = Mesh()
    for _ in range(6):
        crossing.add([tuple(rng.randint(0, 4) / 4 for _ in range(3)) for _ in range(4)],
                     [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
    case("S25, tetrahedra that cross on a lattice", crossing, 0.0, list(itertools.product((0, 0.25, 0.375, 0.5, 0.75, 1.0),
                                                                                      repeat=3)), solid=True)
    case("S26, a body wholly inside", cube(), 0.0, other=cube(0.25, (0.375, 0.375, 0.375)), solid=True)
    case("S26, a body in the hollow", cube().add(CUBE_VERTICES, CUBE_FACES, 0.5, inner, True), 0.0,
         other=cube(0.25, (0.375, 0.375, 0.375)), solid=True)
    case("S26, a body inside that touches", cube(), 0.0, other=cube(0.5, (0.5, 0.25, 0.25)), solid=True)
    case("S27, a turned cube", cube(), 0.0625, grid, pose=[0.6, -0.8, 0, 0.1, 0.8, 0.6, 0, -0.3, 0, 0, 1.0, 1e-17],
         solid=True)
    opened("S30, a cube without a triangle", Mesh().add(CUBE_VERTICES, CUBE_FACES[:7] + CUBE_FACES[8:]))
    opened("S30, a face the wrong way round", Mesh().add(CUBE_VERTICES, CUBE_FACES[:4] + [CUBE_FACES[4][::-1]] +
                                                        CUBE_FACES[5:]))
    apart = cube().soup()
    apart.vertices[3] = tuple(math.nextafter(x, 2.0) for x in apart.vertices[3])
    opened("S30, corners apart by the last place", apart)


def main():
    FOLDER.mkdir(exist_ok=True)
    for old in FOLDER.iterdir():
        old.unlink()
    for make in (touching, degenerate, far, two_triangles, solids):
        make()
    about = ("For each case: which records of the input (points, or triangles of `other`) have a distance <= clearance from "
             "the closed triangles of `mesh`, moved by the pose T_input_mesh (three rows of four numbers), which triangles "
             "of the mesh do from the input, and the smallest distance, in exact arithmetic on the numbers in the files. "
             "labels: 0 outside, 1 inside, 2 on the surface of what the mesh encloses (winding number other than 0); of a "
             "triangle, inside where a corner is, else on the surface where a corner is. open_edges: it does not close.")
    rows = ",\n".join("    " + json.dumps(c, separators=(",", ":")) for c in CASES)
    (FOLDER / "cases.json").write_text('{\n  "about": ' + json.dumps(about) + ',\n  "cases": [\n' + rows + "\n  ]\n}\n")
    print(f"{len(CASES)} cases")


if __name__ == "__main__":
    main()
