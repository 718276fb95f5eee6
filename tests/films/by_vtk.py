#!/usr/bin/python3
"""Runs problems with frames and opens what ParaView would by VTK's own reader (Debian package python3-vtk9). Its numbers are held against the
data and CSV files of the same states, to the last bit:

    tests/films/by_vtk.py PROGRAM"""
import csv
import math
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

ROOT = pathlib.Path(__file__).resolve().parents[2]
PARTICLE, BOND, ANGLE, CONTACT, WALL, BODY = range(6)
SHAPES = {PARTICLE: 1, BOND: 3, ANGLE: 4, CONTACT: 1, WALL: 7, BODY: 7}     # VTK's numbers
failures = 0


def same(what, found, expected):
    """Equal to the last bit; -0 is 0."""
    global failures
    if list(found) == list(expected):
        return
    failures += 1
    print(f"FAIL  {what}: {str(found)[:200]} instead of {str(expected)[:200]}")


def rows(file):
    return list(csv.DictReader(open(file, newline=""))) if file.exists() else []


def number(text):
    return float(text) if text else 0.0


def numbers(row, *columns):
    return tuple(number(row[c]) for c in columns)


class Grid:
    def __init__(self, file):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(file))
        reader.Update()
        if reader.GetErrorCode():
            sys.exit(f"{file}: VTK cannot read it")
        self.grid = reader.GetOutput()
        self.points, self.cells, self.whole = self.grid.GetPointData(), self.grid.GetCellData(), self.grid.GetFieldData()
        self.kinds = [int(k) for k in self.column(self.cells, "kind")]

    @staticmethod
    def column(data, name):
        array = data.GetArray(name)
        values = [array.GetTuple(k) for k in range(array.GetNumberOfTuples())]
        return [v[0] for v in values] if array.GetNumberOfComponents() == 1 else values

    def of(self, kind, *names):
        columns = [self.column(self.cells, n) for n in names]
        return [tuple(c[k] for c in columns) for k, found in enumerate(self.kinds) if found == kind]

    def corners(self, kind):
        """Points of each cell of a kind."""
        all = []
        for k, found in enumerate(self.kinds):
            if found == kind:
                ids = self.grid.GetCell(k).GetPointIds()
                all.append([ids.GetId(i) for i in range(ids.GetNumberOfIds())])
        return all


def atoms(file):
    """id: (diameter, x, y, z) of a data file of style hybrid sphere angle."""
    lines = file.read_text().split("\n")
    begin = next((k for k, line in enumerate(lines) if line.startswith("Atoms # hybrid")), None)
    if begin is None:
        return {}
    all = {}
    for line in lines[begin + 2:]:
        if not line.strip():
            return all
        id, type, x, y, z, diameter, density, molecule = line.split()
        all[int(id)] = (float(diameter), float(x), float(y), float(z))


def check_frame(name, stem, vtu, label, load_factor, contacts, modes):
    """stem: of the files of the state."""
    g = Grid(vtu)
    same(f"{name}: load factor", Grid.column(g.whole, "load_factor"), [load_factor])
    same(f"{name}: label", [g.whole.GetAbstractArray("label").GetValue(0)], [label])
    for kind, cell in enumerate(g.kinds):
        if g.grid.GetCellType(kind) != SHAPES[cell]:
            sys.exit(f"{name}: a cell of another shape")
    for data in (g.points, g.cells):
        for k in range(data.GetNumberOfArrays()):
            array = data.GetArray(k)
            if not all(math.isfinite(v) for t in range(array.GetNumberOfTuples()) for v in array.GetTuple(t)):
                sys.exit(f"{name}: {array.GetName()} is not finite somewhere")
    there = atoms(pathlib.Path(f"{stem}.data"))
    particles = rows(pathlib.Path(f"{stem}.particles.csv"))
    singles = [p for p in particles if p["kind"] == "particle"]
    ids, radius, energy, force = (Grid.column(g.points, c) for c in ("id", "radius", "energy", "contact_force"))
    same(f"{name}: particles", g.of(PARTICLE, "first"), [(int(p["id"]),) for p in singles])
    for points, p in zip(g.corners(PARTICLE), singles):
        k = points[0]
        diameter, *x = there[int(p["id"])]
        same(f"{name}: particle {p['id']}", (*g.grid.GetPoint(k), radius[k], energy[k], *force[k]), (*x, diameter / 2, *numbers(p, "energy", "fx", "fy", "fz")))
        same(f"{name}: id", [ids[k]], [int(p["id"])])
    if "N11" in particles[0]:
        resultants = [Grid.column(g.points, c) for c in ("N", "M")]
        for points, p in zip(g.corners(PARTICLE), singles):
            same(f"{name}: N and M of particle {p['id']}", tuple(v for r in resultants for v in r[points[0]]),
                 tuple(number(p[c] or "0") for c in ("N11", "N22", "N12", "M11", "M22", "M12")))
    where = {ids[c[0]]: c[0] for c in g.corners(PARTICLE)}
    bonds = rows(pathlib.Path(f"{stem}.bonds.csv"))
    same(f"{name}: bonds", g.of(BOND, "first", "second", "tension", "strain"), [numbers(b, "first", "second", "tension", "strain") for b in bonds])
    same(f"{name}: ends of bonds", g.corners(BOND), [[where[int(b["first"])], where[int(b["second"])]] for b in bonds])
    angles = rows(pathlib.Path(f"{stem}.angles.csv"))
    same(f"{name}: angles", g.of(ANGLE, "first", "second", "curvature", "moment", "moment_vector"),
         [(*numbers(a, "first", "third", "curvature", "moment"), numbers(a, "mx", "my", "mz")) for a in angles])
    same(f"{name}: points of angles", g.corners(ANGLE), [[where[int(a[c])] for c in ("first", "middle", "third")] for a in angles])
    walls = rows(pathlib.Path(f"{stem}.walls.csv"))
    number_of = {w["name"]: -1 - k for k, w in enumerate(walls)}
    same(f"{name}: contacts", g.of(CONTACT, "first", "second", "gap", "force"),
         [(int(c["first"]), number_of[c["second"]] if c["second"] in number_of else int(c["second"]), number(c["gap"]), numbers(c, "fx", "fy", "fz")) for c in contacts])
    same(f"{name}: points of contact", [g.grid.GetPoint(p[0]) for p in g.corners(CONTACT)], [numbers(c, "x", "y", "z") for c in contacts])
    same(f"{name}: walls", sorted({w for w, in g.of(WALL, "first")}), sorted(number_of.values()))
    bodies = {int(p["id"]) for p in particles if p["kind"] == "body"}
    same(f"{name}: bodies", sorted({b for b, in g.of(BODY, "first")}), sorted(bodies))
    count = (len(modes[0]) - 1) // 3 if modes else 0
    for m in range(1, count + 1):
        u = Grid.column(g.points, f"mode_{m}")
        same(f"{name}: null vector {m}", [u[where[int(r["id"])]] for r in modes], [numbers(r, f"ux{m}", f"uy{m}", f"uz{m}") for r in modes])
    return g


def made(program, problem, scratch, *settings):
    run = scratch / pathlib.Path(problem).stem
    done = subprocess.run([program, str(ROOT / problem), "-o", str(run), "--quiet", *(f"--set={s}" for s in settings)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode not in (0, 2):
        sys.exit(f"{problem}: {done.stdout}")
    return run


def check_motion(program, problem, scratch):
    run = made(program, problem, scratch, 'dynamics.film=["pvd"]')
    time = {r["step"]: number(r["time"]) for r in rows(run / "trajectory.csv")}
    frames = xml.parse(run / "trajectory.pvd").getroot().findall("Collection/DataSet")
    for frame in frames:
        g = Grid(run / frame.get("file"))
        step = pathlib.Path(frame.get("file")).stem
        same(f"{problem} step {step}: time", [float(frame.get("timestep")), *Grid.column(g.whole, "time")], [time[step], time[step]])
        there = rows(run / "frames" / f"{step}.csv")
        points = [c[0] for c in g.corners(PARTICLE)]
        columns = [Grid.column(g.points, c) for c in ("id", "velocity", "force")]
        same(f"{problem} step {step}", [(g.grid.GetPoint(k), *(c[k] for c in columns)) for k in points],
             [(numbers(r, "x", "y", "z"), number(r["id"]), numbers(r, "vx", "vy", "vz"), numbers(r, "fx", "fy", "fz")) for r in there])
    same(f"{problem}: files", sorted(f.stem for f in (run / "frames").glob("*.vtu")), sorted(f.stem for f in (run / "frames").glob("*.csv")))
    print(f"{problem}: {len(frames)} frames")


def check_run(program, problem, scratch, *settings):
    run = made(program, problem, scratch, *settings)
    path = rows(run / "path.csv")
    contacts = rows(run / "contacts.csv")
    seen = set()
    frames = xml.parse(run / "path.pvd").getroot().findall("Collection/DataSet")
    for frame in frames:
        step = int(frame.get("timestep"))
        row = next(r for r in path if int(r["step"]) == step)
        label = row["label"]
        stem = run / "states" / label.replace(":", "-") if label else run / "frames" / str(step)
        its = [c for c in contacts if c["label"] == label] if label else rows(pathlib.Path(f"{stem}.contacts.csv"))
        g = check_frame(f"{problem} step {step}", stem, run / frame.get("file"), label, float(row["lambda"]), its, rows(pathlib.Path(f"{stem}.modes.csv")))
        seen |= set(g.kinds)
    same(f"{problem}: files", sorted(f.name for f in (run / "frames").glob("*.vtu")), sorted(pathlib.Path(f.get("file")).name for f in frames))
    same(f"{problem}: states with a label", [r["label"] for r in path if r["label"]],
         [r["label"] for r in path if r["label"] and any(f.get("timestep") == r["step"] for f in frames)])
    print(f"{problem}: {len(frames)} frames")
    return seen


with tempfile.TemporaryDirectory() as scratch:
    seen = set()
    for problem, *settings in (("problems/two_beams.toml", "path.frames=20"), ("problems/beam_in_tube.toml", "path.frames=4"),
                               ("problems/box_tips.toml", "path.every=7"), ("problems/cubes_jammed.toml", "path.every=1"), ("problems/truss_tall.toml", "path.frames=30"),
                               ("problems/sheet_indented.toml", "path.frames=3")):
        seen |= check_run(sys.argv[1], problem, pathlib.Path(scratch), *settings)
    check_motion(sys.argv[1], "problems/column_swings.toml", pathlib.Path(scratch))
    same("kinds of cells", sorted(seen), list(range(6)))
sys.exit(failures > 0)
