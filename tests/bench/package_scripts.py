"""LAMMPS input scripts for the protocols of the eight studies of LAMMPSStructures (github.com/adguerra/LAMMPSStructures).

`write(study, folder)` writes `in.STUDY` and the files that it includes, in the manner of that package: a particle, bond or angle a line, a type for
each structure, grains glued to what is nearest by LAMMPS's own variables and computes. Nothing of the package is used; where it draws grains at
random the places are those of problems/studies. Positions as everywhere in metres.
"""
import csv
import random
from math import cos, hypot, pi, sin, sqrt
from pathlib import Path

STUDIES = Path(__file__).resolve().parent.parent.parent / "problems" / "studies"


def of_csv(name):
    with open(STUDIES / name) as file:
        return [tuple(map(float, (row["x"], row["y"], row["z"]))) for row in csv.DictReader(file)]


class Script:
    """The lines of a script and of the files beside it; ids, types and coefficients count up as LAMMPS counts them."""

    shaken = 0.0                                       # particles stand at random by up to so many diameters off their places

    def __init__(self, box):
        self.random = random.Random(1)
        self.files, self.main = {}, []
        self.particles = self.types = self.bond_types = self.angle_types = self.grains = self.moves = self.walls = 0
        x, y, z = (length / 2 for length in box)
        self.add("units si", "atom_style hybrid angle sphere", "comm_modify vel yes", f"region station block {-x} {x} {-y} {y} {-z} {z}",
                 "create_box 100 station bond/types 1000 extra/bond/per/atom 100 angle/types 100 extra/angle/per/atom 100",
                 "change_box all boundary f f f", "pair_style hybrid/overlay granular lj/cut 0",
                 "pair_coeff * * granular hertz/material 0 0 0 tangential linear_nohistory 0 0", "pair_coeff * * lj/cut 0 0 0",
                 "special_bonds lj/coul 0 1 1", "bond_style harmonic", "angle_style cosine", "bond_coeff * 0 0", "angle_coeff * 0",
                 "fix motion all nve/sphere", "neigh_modify page 500000 one 50000")

    def add(self, *lines):
        self.main.extend(lines)

    def include(self, name, lines):
        self.files[name] = lines
        self.add(f"include {name}")

    def place(self, name, points, diameter, density):
        """A type of particles; gives the type and the id of its first one."""
        self.types += 1
        first, off = self.particles + 1, lambda c: c + self.shaken * diameter * self.random.uniform(-1, 1)
        self.particles += len(points)
        self.include(f"{name}.txt", [f"create_atoms {self.types} single {off(x)!r} {off(y)!r} {off(z)!r}" for x, y, z in points])
        self.add(f"set type {self.types} diameter {diameter!r}", f"set type {self.types} density {density!r}")
        return self.types, first

    def grain(self, points, diameter, density):
        self.grains += 1
        return self.place(f"grains_{self.grains}", points, diameter, density)

    def elastic(self, bonds, K, rest, angles, B):
        self.bond_types += 1
        self.angle_types += 1
        self.add(f"bond_coeff {self.bond_types} {K!r} {rest!r}")
        self.include(f"bonds_{self.bond_types}.txt", [f"create_bonds single/bond {self.bond_types} {i} {j}" for i, j in bonds])
        self.add(f"angle_coeff {self.angle_types} {B!r}")
        self.include(f"angles_{self.angle_types}.txt", [f"create_bonds single/angle {self.angle_types} {i} {j} {k}" for i, j, k in angles])

    def square_section(self, thickness, modulus, rest):
        return modulus * thickness**2 / (2 * rest), modulus * thickness**4 / (12 * rest)

    def beam(self, count, x, length, thickness, modulus, density):
        rest = length / (count - 1)
        kind, a = self.place(f"beam_{self.types + 1}", [(x, 0.0, -length / 2 + length * i / (count - 1)) for i in range(count)], thickness, density)
        K, B = self.square_section(thickness, modulus, rest)
        self.elastic([(a + i, a + i + 1) for i in range(count - 1)], K, rest, [(a + i, a + i + 1, a + i + 2) for i in range(count - 2)], B)
        return kind, a

    def loop(self, count, height, radius, thickness, modulus, density):
        rest = 2 * radius * sin(pi / count)
        points = [(radius * cos(2 * pi * i / count), radius * sin(2 * pi * i / count), height) for i in range(count)]
        kind, a = self.place(f"beam_{self.types}", points, thickness, density)
        K, B = self.square_section(thickness, modulus, rest)
        at = lambda i: a + i % count
        self.elastic([(at(i), at(i + 1)) for i in range(-1, count - 1)], K, rest, [(at(i), at(i + 1), at(i + 2)) for i in range(-2, count - 2)], B)
        return kind

    def sheet(self, points, spacing, thickness, modulus, density):
        """Bonds between neighbours, angles along rows; the package's bending stiffness, E t³/72 (the derivation has E t³/(8√3))."""
        kind, a = self.place("sheet_1", points, spacing, density)
        near, angles = neighbours(points, 1.05 * spacing), []
        bonds = [(i, j) for i in range(len(points)) for j in near[i] if j > i]
        far = lambda i, k: sqrt(sum((p - q) ** 2 for p, q in zip(points[i], points[k]))) > 1.9 * spacing
        for j in range(len(points)):
            angles += [(i, j, k) for i in near[j] for k in near[j] if i < j < k and far(i, k)]
        numbered = lambda lists: [tuple(a + i for i in items) for items in sorted(lists)]
        self.elastic(numbered(bonds), sqrt(3) / 4 * modulus * thickness, spacing, numbered(angles), modulus * thickness**3 / 72)
        return kind, a

    def hertz(self, one, other, modulus, words="0 0.5 tangential linear_nohistory 0 0"):
        self.add(f"pair_coeff {one} {other} granular hertz/material {modulus} {words}")

    def wall(self, region, modulus, kind=None):
        self.walls += 1
        n, group = self.walls, "all"
        if kind is not None:
            group = f"walled_{n}"
            self.add(f"group {group} type {kind}")
        if region is not None: self.add(f"region wall_{n} {region}")
        self.add(f"fix wall_{n} {group} wall/gran/region granular hertz/material {modulus} 0.25 0.25 tangential linear_nohistory 0 0 "
                 f"region {'station' if region is None else f'wall_{n}'}")
        return n

    def no_wall(self, n, grouped=True):
        self.add(f"unfix wall_{n}", f"region wall_{n} delete", *([f"group walled_{n} delete"] if grouped else []))

    def move(self, what, velocity):
        self.moves += 1
        self.add(f"group moved_{self.moves} {what}", f"fix move_{self.moves} moved_{self.moves} move linear 0 0 {velocity!r}")

    def push(self, name, what, direction):
        self.add(f"group {name} {what}", f"fix {name} {name} gravity 1e-05 vector {direction}")

    def glue(self, name, grains, to, stiffness, bonds):
        """Each grain to the particles of type `to` that are nearest to it, at the distance that they have."""
        lines = [f"group target type {to}"]
        for grain in grains:
            lines += [f"group grain id {grain}",
                      "variable distance atom sqrt((xcm(grain,x)-x)^2+(xcm(grain,y)-y)^2+(xcm(grain,z)-z)^2)",
                      "variable cx equal xcm(grain,x)", "variable cy equal xcm(grain,y)", "variable cz equal xcm(grain,z)"]
            among = "target"
            for n in range(1, bonds + 1):
                self.bond_types += 1
                lines += [f"compute nearest {among} reduce min v_distance", "thermo_style custom step c_nearest", "run 0", "thermo_style custom step atoms time",
                          "variable least equal c_nearest", "variable reach equal ${least}*1.0000001",
                          f"bond_coeff {self.bond_types} {stiffness} ${{least}}", f"create_bonds many grain {among} {self.bond_types} 0 ${{reach}}"]
                if n < bonds:
                    lines += [f"region ball_{n} sphere ${{cx}} ${{cy}} ${{cz}} ${{reach}}", f"group taken_{n} region ball_{n}",
                              f"group left_{n} subtract all taken_{n}"]
                    among = f"left_{n}"
                lines.append("uncompute nearest")
            for n in range(bonds - 1, 0, -1): lines += [f"group left_{n} delete", f"group taken_{n} delete", f"region ball_{n} delete"]
            lines.append("group grain delete")
        self.include(f"{name}.txt", lines + ["group target delete"])

    def output(self):
        self.add("compute bending all pe/atom angle", "compute stretching all pe/atom bond",
                 "dump frames all custom 1 out*.dump id type radius x y z fx fy fz c_bending c_stretching", "dump_modify frames pad 11")

    def run(self, steps, timestep=None, frames=20):
        if timestep is not None: self.add(f"timestep {timestep!r}")
        self.add(f"dump_modify frames every {steps // frames}", f"run {steps}")

    def write(self, name, folder):
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        for file, lines in {**self.files, f"in.{name}": self.main}.items():
            (folder / file).write_text("\n".join(lines) + "\n")
        return folder / f"in.{name}"


def neighbours(points, reach):
    """Of each point the others within `reach`, in order."""
    cells = {}
    cell = lambda p: tuple(int(c // reach) for c in p)
    for i, p in enumerate(points): cells.setdefault(cell(p), []).append(i)
    near = []
    for i, p in enumerate(points):
        a, b, c = cell(p)
        around = [j for u in (-1, 0, 1) for v in (-1, 0, 1) for w in (-1, 0, 1) for j in cells.get((a + u, b + v, c + w), [])]
        near.append(sorted(j for j in around if j != i and sum((s - t) ** 2 for s, t in zip(p, points[j])) < reach**2))
    return near


def lattice(spacing, inside, x=0.0):
    """A triangular lattice in the plane z = 0, of the points (relative to `x`) that are inside."""
    n = 200
    rows = ((i * sqrt(3) / 2 * spacing, (j - (i % 2) / 2) * spacing) for i in range(-n, n) for j in range(-n, n))
    return [(x + u, v, 0.0) for u, v in rows if inside(u, v)]


def grain_beam():
    s = Script((0.1, 0.03, 0.1))
    s.add("timestep 1e-07")
    beam, _ = s.beam(50, 0.0, 0.095, 0.003, 1e5, 0.01)
    left, first = s.grain([(-0.009, 0.0, 0.0075), (-0.009, 0.0, -0.0075)], 0.015, 0.01)
    right, _ = s.grain([(0.009, 0.0, 0.0075), (0.009, 0.0, -0.0075)], 0.015, 0.01)
    s.glue("connect_1", [first, first + 1], beam, 1, 2)
    s.glue("connect_2", [first + 2, first + 3], beam, 1, 2)
    s.move("id 1", 0.01)
    s.move("id 50", -0.01)
    s.push("pushed", "id 25", "1 0 0")
    s.hertz(left, left, 100000)
    s.hertz(right, right, 100000)
    s.add("fix drag all viscous 1e-06")
    s.output()
    s.run(10000000)
    return s


def cylindrical_sheet():
    s = Script((0.5, 0.5, 0.2))
    radius, spacing = 0.02, 0.004
    around = round(2 * pi * radius / (spacing * sqrt(3)))
    step = 2 * pi / around
    distance = 2 * radius * sin(step / 2) / sqrt(3)
    points = [(-0.075 + ring * distance / 2, radius * sin(step * (i + ring % 2 / 2)), radius * cos(step * (i + ring % 2 / 2)))
              for ring in range(round(2 * 0.15 / distance)) for i in range(around)]
    sheet, _ = s.sheet(points, distance, 0.002, 2e4, 0.5)
    s.add(f"set type {sheet} diameter 0.004", f"set type {sheet} density 0.5", f"group shell type {sheet}", "fix drag shell viscous 1e-05")
    above, _ = s.grain(of_csv("pinching_above.csv"), 0.01, 0.01)
    below, _ = s.grain(of_csv("pinching_below.csv"), 0.01, 0.01)
    s.hertz(sheet, "*", 1000)
    s.move(f"type {above}", -0.02)
    s.move(f"type {below}", 0.02)
    s.output()
    s.run(500000, 1e-6)
    return s


def mushroom():
    s = Script((0.05, 0.01, 0.1))
    s.wall(None, 10000)
    s.hertz("*", "*", 10000)
    for n in range(10):
        beam, _ = s.beam(150, -0.0225 + 0.005 * n, 0.095, 0.002, 0.96e6, 0.5)
        s.hertz(beam, beam, 0)
    ends = lambda *offsets: "id " + " ".join(str(150 * n + i) for n in range(10) for i in offsets)
    s.move(ends(1, 2), 0.019)
    s.move(ends(149, 150), -0.019)
    s.push("to_right", "type 1 4 6 8 9 10", "1 0 0")
    s.push("to_left", "type 2 3 5 7", "-1 0 0")
    s.add("fix drag all viscous 2e-07")
    s.output()
    s.run(10000000, 1e-7)
    return s


def confined_d_cone():
    s = Script((0.15, 0.15, 0.07))
    t, rim = 0.127e-3, 36e-3
    spacing, offset = 10 * t, t
    for n in range(15):
        part = (n - 7) / 7                            # −1 … 1 over the lip
        s.wall(f"cylinder z 0 0 {rim + part * 0.75 * spacing!r} -0.035 {-spacing / 2 - spacing * part**2!r} open 1 open 2", 10000)
    points = lattice(spacing, lambda x, y: hypot(x, y) < 55e-3, offset)
    sheet, a = s.sheet(points, spacing, t, 5e5, 2e-2)
    s.move("id " + " ".join(str(a + i) for i, (x, y, _) in enumerate(points) if hypot(x - offset, y) < 13e-3), -0.0216)
    s.add("fix drag all viscous 1e-09")
    s.output()
    s.run(2000000, 5e-7)
    return s


def column_with_loops():
    s = Script((0.4, 0.4, 0.4))
    modulus, nu = 1000000, 0.35
    rolling = 4 * modulus / (2 * (2 - nu) * (1 + nu))
    rough = f"0.4 {nu} tangential mindlin NULL 1 0.5 rolling sds {rolling!r} 1 0.5 twisting marshall damping tsuji"
    grains, _ = s.grain(of_csv("settling_grains.csv"), 0.013, 0.01)
    s.add(f"fix station all wall/gran/region granular hertz/material {modulus} {rough} region station")
    tube = s.wall("cylinder z 0 0 0.0385 -0.2 0.2", modulus, grains)
    s.hertz(grains, grains, modulus, rough)
    s.add("fix weight all gravity 9.8 vector 0 0 -1", f"group slow type {grains}", "fix drag slow viscous 1e-06")
    s.output()
    s.run(100000, 5e-7)
    s.add("unfix drag")
    s.run(900000, 5e-7)
    s.no_wall(tube)
    for n in range(11):
        loop = s.loop(180, -0.2 + 0.0143 * (n + 1), 0.03925, 0.0015, 1e4, 0.01)
        s.hertz(grains, loop, modulus, rough)
    tube = s.wall("cylinder z 0 0 0.04 -0.2 0.2", modulus)
    s.add("fix drag all viscous 1e-09")
    s.run(300000, 5e-7)
    s.no_wall(tube, grouped=False)
    s.run(2000000, 5e-7)
    return s


def jammed(grains, diameter, walls):
    """The first half of the studies of grains on and in a sheet: grains of `grains` (a CSV) push each other apart between three walls."""
    s = Script((0.5, 0.5, 0.2))
    kind, _ = s.grain(of_csv(grains), diameter, 0.01)
    numbers = [s.wall(wall, 1000, kind) for wall in walls]
    s.hertz(kind, kind, 1000)
    s.add(f"group slow type {kind}", "fix drag slow viscous 0.001")
    s.output()
    s.run(50000, 1e-5)
    for n in numbers: s.no_wall(n)
    s.add("unfix drag")
    return s, kind


def with_sheet(s, inside):
    points = lattice(0.004, inside)
    sheet, a = s.sheet(points, 0.004, 0.002, 1e4, 0.5)
    s.add(f"group mesh type {sheet}", "fix drag mesh viscous 1e-05")
    return sheet, {a + i: point for i, point in enumerate(points)}


SQUARE = ["block -0.25 0.25 -0.25 0.25 -0.002 0.1", "block -0.25 0.25 -0.25 0.25 -0.1 0.002", "block -0.053 0.053 -0.053 0.053 -0.1 0.1"]
ROUND = ["cylinder z 0 0 0.5 -0.002 0.2", "cylinder z 0 0 0.5 -0.2 0.002", "cylinder z 0 0 0.159 -0.2 0.2"]


def on_square(x, y):
    return abs(x) < 0.053 and abs(y) < 0.053


def on_top_cohesive():
    s, grains = jammed("cohesive_grains.csv", 0.03, SQUARE)
    sheet, _ = with_sheet(s, on_square)
    s.add(f"pair_coeff {grains} {grains} lj/cut 1e-07 {0.03 / 2**(1 / 6)!r} 0.075",
          f"pair_coeff {grains} {sheet} lj/cut 1e-07 {(0.015 + 1.05 * 0.002) / 2**(1 / 6)!r} 0.075")
    s.hertz(grains, sheet, 1000)
    s.run(500000, 1e-6)
    return s


def on_top_glued():
    s, grains = jammed("glued_grains.csv", 0.025, SQUARE)
    count = s.particles
    sheet, _ = with_sheet(s, on_square)
    s.glue("connect_1", range(1, count + 1), sheet, 1, 3)
    s.run(500000, 1e-6)
    return s


def middle_glued():
    s, grains = jammed("jammed_grains.csv", 0.03, ROUND)
    count = s.particles
    sheet, points = with_sheet(s, lambda x, y: hypot(x, y) < 0.159)
    s.add("timestep 1e-06")
    s.move("id " + " ".join(str(i) for i, (x, y, _) in points.items() if hypot(x, y) > 0.159 - 0.4 * 0.03), 0)
    s.glue("connect_1", range(1, count + 1), sheet, 1, 3)
    s.push("pushed", "id 1 2", "0 0 -1")
    s.run(500000)
    return s


ALL = [grain_beam, cylindrical_sheet, mushroom, confined_d_cone, column_with_loops, on_top_cohesive, on_top_glued, middle_glued]


def write(study, folder, shaken=0.0):
    Script.shaken = shaken
    return next(make for make in ALL if make.__name__ == study)().write(study, folder)
