"""Two clamped beams of different thickness are pressed together side by side, over many gaps, in several processes.

    PYTHONPATH=build/release/python python3 examples/python/two_beam_threshold.py

The thin one buckles first, towards the thick one, which buckles towards it. They touch, and then one pushes the other back until the
pair loses its stability. Over a narrow gap the thin one wins: it drives the thick one back until that is straight again. Over a wide
gap the thick one has bent so far by then that it drives the thin one. (Beams of few particles, so that this runs in seconds;
problems/two_beams_winner.toml has finer ones.)
Units: metre, newton; the load factor is the shortening in millimetres.
"""
import concurrent.futures
import os

import numpy as np

import elamin

L, E = 95e-3, 0.96e6                                     # length between the clamps, Young's modulus
PARTICLES = {"thin": 21, "thick": 15}                    # on this length: diameters of 4.5 and 6.3 mm


def two_beams(gap, contact=True):
    """The problem for a gap between the surfaces [m]."""
    d = {name: L / n for name, n in PARTICLES.items()}
    p = elamin.Problem(title=f"two beams, gap {gap * 1e3:.2f} mm", plane="xz")
    for name, x, push in (("thin", gap, -1e-8), ("thick", -(d["thin"] + d["thick"]) / 2, 1e-8)):
        p.beam(name=name, section="square", particles=PARTICLES[name] + 4, center=[x, 0, 0], axis=[0, 0, 1], diameter=d[name],
               youngs_modulus=E)
        p.group(name=name + "_bottom", of=name, first=2).group(name=name + "_top", of=name, last=2)
        p.group(name=name + "_middle", of=name, middle=1)
        p.support(group=name + "_bottom", displacement=[0, 0, 0.5e-3]).support(group=name + "_top", displacement=[0, 0, -0.5e-3])
        # Too small to matter, but it decides that each buckles towards the other.
        p.load(group=name + "_middle", force=[push, 0, 0], constant=True)
    if contact:
        p.contact(between=["thin", "thick"], youngs_modulus=1e6, poissons_ratio=0.5)
    return p


def deflections(p, x):
    """Of the middles of the thin and the thick one [m]."""
    middle = [p.groups["thin_middle"][0], p.groups["thick_middle"][0]]
    return x[middle, 0] - p.x0[middle, 0]


def outcome(gap):
    """Where they touch and where the pair loses its stability [mm], and who wins."""
    p = two_beams(gap)
    touch, then = np.nan, None
    for step in p.path(steps=30, to=3.0, when_unstable="stop"):
        for event in step.events:
            if event.kind == "contact" and np.isnan(touch):
                touch, then = event.load_factor, deflections(p, step.x)
            elif event.kind in ("limit", "branch") and then is not None:
                pushed = np.abs(deflections(p, step.x)) < np.abs(then)
                return touch, event.load_factor, "thin" if pushed[1] else "thick"
    return touch, np.nan, "nobody"


def main():
    gaps = np.array([6.0, 7.0, 8.0, 9.0, 10.0]) * 1e-3
    with concurrent.futures.ProcessPoolExecutor(min(4, os.cpu_count() or 1)) as pool:
        found = list(pool.map(outcome, gaps))
    print("gap [mm]  they touch at [mm]  unstable at [mm]  who wins")
    for gap, (touch, lost, winner) in zip(gaps, found):
        print(f"{gap * 1e3:8.2f}  {touch:18.9f}  {lost:16.9f}  {winner}")
    touches = [touch for touch, _, _ in found]
    assert touches == sorted(touches)
    assert [winner for _, _, winner in found] == ["thin"] * 3 + ["thick"] * 2

    # Where they touch, each of them is bent as it would be alone: the two deflections add up to the gap.
    alone = two_beams(gaps[1], contact=False)
    for step in alone.path(steps=30, to=touches[1]):
        pass
    thin, thick = deflections(alone, step.x)
    assert abs(thick - thin - gaps[1]) <= 1e-8 * gaps[1], (thick - thin, gaps[1])

    lo, hi = 8e-3, 9e-3                                  # the threshold, by halving
    while hi - lo > 0.3e-3:
        middle = (lo + hi) / 2
        lo, hi = (middle, hi) if outcome(middle)[2] == "thin" else (lo, middle)
    print(f"the thick one wins from a gap between {lo * 1e3:.2f} and {hi * 1e3:.2f} mm on")


if __name__ == "__main__":
    main()
