"""A bundle of 26 beams at random places is pressed together along its length; many of them, and statistics of which way the beams buckle.

    PYTHONPATH=build/release/python python3 examples/python/bundle.py [bundles]

All is built with numpy: places, particles, bonds, angles, a seeded imperfection. (The geometry of the "mushroom" of LAMMPSStructures, with
coarse beams, so that a bundle takes seconds.) Units: metre, newton.
"""
import concurrent.futures
import os
import sys

import numpy as np

import elamin

BEAMS, PARTICLES, d, E = 26, 16, 2e-3, 0.96e6            # two particles at each end are held
LENGTH = (PARTICLES - 4) * d                             # between the clamps
RADIUS = 12e-3                                           # of the bundle's circle
SHORTER = 0.08 * LENGTH


def places(rng):
    """Axes of the beams (26, 2) in a circle, no two nearer than 1.15 diameters."""
    found = []
    while len(found) < BEAMS:
        at = rng.uniform(-RADIUS, RADIUS, 2)
        if np.hypot(*at) <= RADIUS and all(np.hypot(*(at - other)) > 1.15 * d for other in found):
            found.append(at)
    return np.array(found)


def bundle(seed):
    """The problem of one bundle, and the numbers of its particles (26, 16)."""
    rng = np.random.default_rng(seed)
    z = (np.arange(PARTICLES) - (PARTICLES - 1) / 2) * d
    x = np.zeros((BEAMS, PARTICLES, 3))
    x[:, :, :2] = places(rng)[:, None, :]
    x[:, :, 2] = z
    angle = rng.uniform(0, 2 * np.pi, BEAMS)             # of each beam's imperfection: a hundredth of a diameter
    wave = np.where(np.abs(z) < LENGTH / 2, np.cos(np.pi * z / LENGTH) ** 2, 0) * 0.01 * d
    x[:, :, 0] += np.cos(angle)[:, None] * wave
    x[:, :, 1] += np.sin(angle)[:, None] * wave

    p = elamin.Problem(title=f"bundle {seed}")
    i = p.particles(x.reshape(-1, 3), d, name="bundle").reshape(BEAMS, PARTICLES)
    # Square section: K = E t²/(2 r₀), B = E t⁴/(12 r₀).
    p.bonds(np.column_stack([i[:, :-1].ravel(), i[:, 1:].ravel()]), E * d / 2, d)
    p.angles(np.column_stack([i[:, :-2].ravel(), i[:, 1:-1].ravel(), i[:, 2:].ravel()]), E * d**3 / 12)
    p.contact(between=["bundle", "bundle"], youngs_modulus=E, poissons_ratio=0.5)
    for name, ends, way in (("bottom", i[:, :2], 0.5), ("top", i[:, -2:], -0.5)):
        p.group(name=name, particles=ends).support(group=name, displacement=[0, 0, way * SHORTER])
    p.path(steps=12, locate=[])
    return p, i


def buckled(seed):
    """Deflections of the beams' middles (26, 2) [m], and how many contacts are closed at the end."""
    p, i = bundle(seed)
    p.observe(name="contacts", group="bundle", quantity="contacts")
    for step in p.path():
        pass
    middle = i[:, PARTICLES // 2]
    return (step.x[middle] - p.x0[middle])[:, :2], step.row["contacts"], step.stable


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 2
    with concurrent.futures.ProcessPoolExecutor(min(count, os.cpu_count() or 1)) as pool:
        found = list(pool.map(buckled, range(count)))
    for seed, (moved, contacts, stable) in enumerate(found):
        size = np.hypot(*moved.T)
        way = moved / size[:, None]
        order = np.hypot(*way.mean(axis=0))
        print(f"bundle {seed}: {contacts:.0f} contacts, deflections {size.min() * 1e3:.2f} to {size.max() * 1e3:.2f} mm, "
              f"order {order:.2f} (1: all the same way, 0.17: at random)")
        assert stable and size.min() > d / 2


if __name__ == "__main__":
    main()
