#!/usr/bin/env python3
"""The crooked column of problems/column_measured.data under P = P_c/2 and P_c, with 30 digits: what column_measured.toml and column_random.toml expect.

Statics alone: the force on the column is (H, −P) along the line between its hinges. From the lower one a link of rest length l_i along t_i has the
length l_i + (force·t_i)/(2K), and joint i turns by asin(M_i/B), M_i the moment of the force about it. Two unknowns, the direction of the first link and
H, make the last joint's link end above the upper hinge's place and its moment there zero.
"""
from pathlib import Path

from mpmath import asin, atan2, cos, findroot, hypot, mp, mpf, pi, sin

mp.dps = 30
B, K = mpf(1), mpf(1000)
lines = (Path(__file__).resolve().parent.parent / "problems/column_measured.data").read_text().split("\n")
start = next(i for i, line in enumerate(lines) if line.startswith("Atoms"))
atoms = sorted((line.split() for line in lines[start + 2:start + 23]), key=lambda w: int(w[0]))
X = [(mpf(w[2]), mpf(w[4])) for w in atoms]
n = len(X) - 1
P_c = 4 * B * sin(pi / (2 * n)) ** 2
link = [(b[0] - a[0], b[1] - a[1]) for a, b in zip(X, X[1:])]
length, slope = [hypot(*d) for d in link], [atan2(d[0], d[1]) for d in link]             # from the z axis towards x


def shape(angle, H, P):
    """Positions of the chain whose first link has this angle, and the moment of the force in its last point."""
    x, z = X[0]
    points = [(x, z)]
    for i in range(n):
        if i:
            moment = P * (x - X[0][0]) + H * (z - X[0][1])
            angle += slope[i] - slope[i - 1] - asin(moment / B)
        stretched = length[i] + (H * sin(angle) - P * cos(angle)) / (2 * K)
        x, z = x + stretched * sin(angle), z + stretched * cos(angle)
        points.append((x, z))
    return points, P * (x - X[0][0]) + H * (z - X[0][1])


def equilibrium(factor):
    P = factor * P_c
    angle, H = slope[0], -P * (X[n][0] - X[0][0]) / (X[n][1] - X[0][1])
    for k in range(1, 11):                                                              # as the load grows

        def residual(a, h, p=P * k / 10):
            points, moment = shape(a, h, p)
            return points[n][0] - X[n][0], moment

        angle, H = findroot(residual, (angle, H))
    return shape(angle, H, P)[0]


for factor in (mpf(1) / 2, mpf(1)):
    points = equilibrium(factor)
    print(f"P/P_c = {mp.nstr(factor, 3)}: deflection {mp.nstr(points[n // 2][0] - X[n // 2][0], 20)}, "
          f"shortening {mp.nstr(points[n][1] - X[n][1], 20)}")
