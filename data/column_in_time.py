#!/usr/bin/env python3
"""Dynamic buckling of a column against the speed of its compression, beside the static value; a table and a figure.

Reads problems/column_in_time/, which
    ./elamin problems/column_in_time.toml
leaves behind. The dynamic buckling strain is the end shortening over N d, N = 40 free particles, where the deflection of
the middle grows fastest with the shortening: statically that is the branch point. Writes data/column_in_time.svg. Exit status 1
if the slowest motion is farther than 2 % from the closed form.
"""
import csv
import json
import sys
from math import log10, pi, sin, sqrt
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
N, DIAMETER = 40, 1e-3


def exact(c=1 / 16):
    """End shortening over N d at which 2K(d − a)a = 4B sin²(π/(N + 2)); c = B/(2 K d²)."""
    q = 4 * c * sin(pi / (N + 2)) ** 2
    return (N + 1) / N * 2 * q / (1 + sqrt(1 - 4 * q))


def buckling_strain(file):
    with open(file, newline="") as rows:
        points = [(-float(r["shortening"]), float(r["deflection"])) for r in csv.DictReader(rows)]
    step = max(1, len(points) // 400)                  # a quarter of a per cent of the motion
    growth = [(points[k + step][1] - points[k][1], k) for k in range(len(points) - step)]
    k = max(growth)[1]
    return (points[k][0] + points[k + step][0]) / 2 / (N * DIAMETER)


def main():
    folder = ROOT / "problems" / "column_in_time"
    if not (folder / "sweep.csv").exists():
        sys.exit(f"{folder} is not there: run  ./elamin problems/column_in_time.toml")
    static = exact()
    print(f"static {static:.7f}\n{'speed [m/s]':>12} {'strain':>10} {'/ static':>9} {'steps':>9} {'seconds':>8}")
    points = []
    for run in sorted(p for p in folder.iterdir() if (p / "trajectory.csv").exists()):
        summary = json.loads((run / "summary.json").read_text())
        final = summary["final"]
        speed = -final["shortening"] / final["time"]
        strain = buckling_strain(run / "trajectory.csv")
        points.append((speed, strain))
        print(f"{speed:12.3g} {strain:10.7f} {strain / static:9.3f} {final['step']:9} {summary['times']['total']:8.2f}")
    points.sort()
    draw(points, static)
    return 0 if abs(points[0][1] / static - 1) < 0.02 else 1


def draw(points, static):
    """420 × 300, speed logarithmic, strain over the static one logarithmic."""
    x = lambda v: 60 + 340 * (log10(v) + 6.2) / 4.5
    y = lambda r: 250 - 220 * log10(r / 0.9) / log10(8 / 0.9)
    parts = ['<svg xmlns="http://www.w3.org/2000/svg" width="420" height="300" font-family="sans-serif" font-size="11">',
             '<rect width="420" height="300" fill="white"/>']
    for e in range(-6, -1):
        parts.append(f'<line x1="{x(10**e):.1f}" y1="30" x2="{x(10**e):.1f}" y2="250" stroke="#ddd"/>'
                     f'<text x="{x(10**e):.1f}" y="266" text-anchor="middle">10<tspan dy="-4" font-size="8">{e}</tspan></text>')
    for r in (1, 1.5, 2, 3, 5, 8):
        parts.append(f'<line x1="60" y1="{y(r):.1f}" x2="400" y2="{y(r):.1f}" stroke="{"#1f4e9c" if r == 1 else "#ddd"}" '
                     f'stroke-width="{2 if r == 1 else 1}"/><text x="54" y="{y(r) + 4:.1f}" text-anchor="end">{r}</text>')
    line = " ".join(f"{x(v):.1f},{y(s / static):.1f}" for v, s in points)
    parts.append(f'<polyline points="{line}" fill="none" stroke="#c0392b"/>')
    parts += [f'<circle cx="{x(v):.1f}" cy="{y(s / static):.1f}" r="3" fill="#c0392b"/>' for v, s in points]
    parts.append('<text x="230" y="288" text-anchor="middle">speed of compression [m/s]</text>'
                 '<text x="60" y="20">strain where the column gives way / static buckling strain</text>'
                 f'<text x="398" y="{y(1) - 5:.1f}" text-anchor="end" fill="#1f4e9c">static path</text></svg>')
    (ROOT / "data" / "column_in_time.svg").write_text("\n".join(parts) + "\n")


if __name__ == "__main__":
    sys.exit(main())
