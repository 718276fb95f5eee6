"""The diagram of a clamped column: it is loaded until it buckles and bends on, and both sides of the branch point are drawn.

    PYTHONPATH=build/release/python python3 examples/python/column_diagram.py [figure.svg]

A chain of links buckles where the force P in them satisfies P a = 4 B sin²(π/(N + 2)), a = d − P/(2K) the length of a link, N the number
of free particles. Units: metre, newton.
"""
import sys

import numpy as np

import elamin

N, d, E = 20, 1e-3, 0.96e6                              # free particles, diameter, Young's modulus

p = elamin.Problem(title="Clamped column", plane="xz")
p.beam(name="column", section="cylinder", particles=N + 4, center=[0, 0, 0], axis=[0, 0, 1], diameter=d, youngs_modulus=E)
p.group(name="bottom", of="column", first=2)
p.group(name="top", of="column", last=2)
p.group(name="middle", of="column", middle=2)
p.support(group="bottom")
p.support(group="top", directions="x")                   # it may come down
p.load(group="top", total_force=[0, 0, -1])              # the load factor is the load, in newtons
p.observe(name="deflection", group="middle", quantity="position.x")
p.path(method="arc_length", steps=60, to=0.006, branches=1)

# Closed forms: the chain's buckling load, and Euler's for clamped ends, E I (2π/L)².
K, B = np.pi * E * d / 8, np.pi * E * d**3 / 64
mu = 4 * np.sin(np.pi / (N + 2)) ** 2
buckling = K * d * (1 - np.sqrt(1 - 2 * B * mu / (K * d**2)))
euler = B * d * (2 * np.pi / ((N + 2) * d)) ** 2

run = p.run()
load = run.events.set_index("label").loc["branch:1", "lambda"]
print(f"buckling load {load:.10g} N, the chain's closed form {buckling:.10g} N, Euler's {euler:.7g} N")
assert abs(load - buckling) <= 1e-9 * buckling
assert abs(load - euler) <= 0.02 * euler

# Behind the branch point the straight column is unstable and the bent ones are stable; these mirror each other.
path = run.path
straight = path[path["branch"] == 0]
bent = [path[path["branch"] == b] for b in sorted(set(path["branch"]) - {0})]
beyond = straight["lambda"] > load * (1 + 1e-9)
assert beyond.any() and not straight[beyond]["stable"].any()
assert len(bent) == 2
for branch in bent:
    assert branch["stable"].all()
    print(f"branch {branch['branch'].iloc[0]}: deflection {branch['deflection'].iloc[-1]:+.6f} m at {branch['lambda'].iloc[-1]:.5f} N")
ends = [b["deflection"].iloc[-1] for b in bent]
assert ends[0] * ends[1] < 0

figure = run.plot(y="deflection", shapes=["initial", "branch:1"])
if len(sys.argv) > 1:
    figure.save(sys.argv[1])
    print("written:", sys.argv[1])
