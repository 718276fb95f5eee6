#!/usr/bin/env python3
"""Buckling strain of clamped columns: elamin beside the closed form, Euler, COMSOL and dynamic LAMMPS runs.

Reads problems/buckling_strain_{cylindrical,square}/sweep.csv, which
    ./elamin problems/buckling_strain_cylindrical.toml
    ./elamin problems/buckling_strain_square.toml
leave behind, and data/published/. Prints a table and writes data/buckling_strain.svg. Exit status 1 if elamin differs
from the closed form by more than 1e-9.
"""
import csv
import sys
from math import log10, pi, sin, sqrt
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# B/(2 K d²), and the aspect ratio of the published file for each particle of the column.
SECTIONS = {"cylindrical": (1 / 16, 2), "square": (1 / 12, 1)}


def exact(N, c):
    """End shortening over N d at which 2K(d − a)a = 4B sin²(π/(N + 2)); N + 1 bonds are compressed."""
    q = 4 * c * sin(pi / (N + 2)) ** 2
    return (N + 1) / N * 2 * q / (1 + sqrt(1 - 4 * q))


def euler(N, c):
    """4π² EI/(EA L²) with L = N d and EI/(EA d²) = c."""
    return 4 * pi**2 * c / N**2


def read_sweep(section):
    file = ROOT / "problems" / f"buckling_strain_{section}" / "sweep.csv"
    if not file.exists():
        sys.exit(f"{file} is not there: run  ./elamin problems/buckling_strain_{section}.toml")
    with open(file, newline="") as rows:
        free = [(int(row["beam.column.particles"]) - 4, row["branch:1"]) for row in csv.DictReader(rows)]
    return {N: float(load) / N for N, load in free}


def read_published(section, per_particle):
    with open(ROOT / "data" / "published" / f"buckling_strain_{section}.csv", newline="") as rows:
        points = [(r["series"], float(r["aspect_ratio_as_plotted"]) / per_particle, float(r["critical_buckling_strain"]))
                  for r in csv.DictReader(rows)]
    return {name: {round(N): strain for series, N, strain in points if series == name} for name in ("LAMMPS", "COMSOL")}


def table(section, c, sweep, published):
    print(f"\n{section}\n  N  elamin               closed form          Euler, L = N d  COMSOL     LAMMPS, dynamic  LAMMPS/exact")
    for N, strain in sweep.items():
        comsol, lammps = (published[name].get(N) for name in ("COMSOL", "LAMMPS"))
        text = lambda number: f"{number:.7f}" if number else " " * 9
        print(f" {N:2}  {strain:.17f}  {exact(N, c):.17f}  {euler(N, c):.7f}       {text(comsol)}  {text(lammps)}        "
              f"{lammps / exact(N, c):.3f}")
    difference = max(abs(strain / exact(N, c) - 1) for N, strain in sweep.items())
    print(f"largest difference between elamin and the closed form, {len(sweep)} columns: {difference:.1e}")
    return difference


def panel(section, c, sweep, published, left):
    """One diagram, 340 × 300, both axes logarithmic."""
    x = lambda N: left + 340 * log10(N / 9) / log10(90 / 9)
    y = lambda s: 340 - 300 * log10(s / 3e-4) / log10(4e-2 / 3e-4)
    out = [f'<rect x="{left}" y="40" width="340" height="300" fill="none" stroke="#888"/>',
           f'<text x="{left + 170}" y="28" text-anchor="middle" font-weight="bold">{section} columns: strain at buckling</text>',
           f'<text x="{left + 170}" y="380" text-anchor="middle">free length over diameter, N</text>']
    for N in (10, 20, 40, 80):
        out += [f'<path d="M{x(N):.1f} 340v-300" stroke="#e4e4e4"/><text x="{x(N):.1f}" y="358" text-anchor="middle">{N}</text>']
    for s in (5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2):
        out += [f'<path d="M{left} {y(s):.1f}h340" stroke="#e4e4e4"/><text x="{left - 6}" y="{y(s) + 4:.1f}" text-anchor="end">{100 * s:g} %</text>']
    line = lambda f: "M" + "L".join(f"{x(n / 4):.1f} {y(f(n / 4, c)):.1f}" for n in range(40, 321, 8))
    out += [f'<path d="{line(euler)}" fill="none" stroke="#777" stroke-dasharray="6 4"/>',
            f'<path d="{line(exact)}" fill="none" stroke="#111" stroke-width="1.5"/>']
    marks = [("#c43c28", published["LAMMPS"], square), ("#2563a8", published["COMSOL"], triangle), ("#111", sweep, circle)]
    return out + [shape(x(N), y(s), color) for color, points, shape in marks for N, s in points.items()]


def circle(x, y, color):
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.6" fill="#fff" stroke="{color}" stroke-width="1.3"/>'


def square(x, y, color):
    return f'<rect x="{x - 2.6:.1f}" y="{y - 2.6:.1f}" width="5.2" height="5.2" fill="{color}"/>'


def triangle(x, y, color):
    return f'<path d="M{x:.1f} {y - 4.2:.1f}l4.2 7h-8.4z" fill="{color}"/>'


def legend():
    entries = [(40, '<path d="M40 404h22" stroke="#111" stroke-width="1.5"/>' + circle(51, 404, "#111"),
                "elamin on the closed form"),
               (250, '<path d="M250 404h22" stroke="#777" stroke-dasharray="6 4"/>', "Euler, L = N d"),
               (384, triangle(398, 405, "#2563a8"), "COMSOL, continuum"),
               (544, square(558, 404, "#c43c28"), "LAMMPS, dynamic simulations")]
    return [mark + f'<text x="{x + 28}" y="408">{text}</text>' for x, mark, text in entries]


def main():
    out, worst = [], 0
    for left, (section, (c, per_particle)) in zip((60, 460), SECTIONS.items()):
        sweep, published = read_sweep(section), read_published(section, per_particle)
        worst = max(worst, table(section, c, sweep, published))
        out += panel(section, c, sweep, published, left)
    style = 'xmlns="http://www.w3.org/2000/svg" width="820" height="425" font-family="sans-serif" font-size="12"'
    title = "<title>Strain at which clamped columns buckle</title>"
    body = "\n".join([f"<svg {style}>", title, '<rect width="820" height="425" fill="#fff"/>', *out, *legend(), "</svg>\n"])
    (ROOT / "data" / "buckling_strain.svg").write_text(body)
    return worst > 1e-9


if __name__ == "__main__":
    sys.exit(main())
