"""What the tests of the Python module share. ELAMIN: the program, of the same build."""
import json
import os
import pathlib
import subprocess

import numpy as np
import pytest

import elamin

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("ELAMIN", str(ROOT / "build/release/elamin"))


@pytest.fixture
def root():
    return ROOT


@pytest.fixture
def program():
    def run(*arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], check=True, capture_output=True, encoding="utf-8").stdout

    return run


@pytest.fixture
def program_energy(program, tmp_path):
    """Energies by term and forces of a problem file, as the program has them: to the last bit."""

    def energy(file, *more):
        forces = tmp_path / "forces.csv"
        found = json.loads(program("energy", file, "--json", "--forces", forces, *more))
        rows = [[float(cell) for cell in line.split(",")[1:]] for line in forces.read_text().splitlines()[1:]]
        return found["energy"], np.array(rows).reshape(-1, 3)

    return energy


def column(particles=14, **path):
    """Hencky's clamped chain under a load: it buckles at P with P (d − P/(2K)) = 4 B sin²(π/(particles − 2))."""
    p = elamin.Problem(title="column", plane="xz")
    p.beam(name="column", particles=particles, center=[0, 0, 0], axis=[0, 0, 1], diameter=1e-3, youngs_modulus=0.96e6)
    p.group(name="bottom", of="column", first=2).group(name="top", of="column", last=2).group(name="tip", of="column", ids=[particles - 1])
    p.support(group="bottom").support(group="top", directions="x").load(group="tip", total_force=[0, 0, -1])
    p.table("path", method="arc_length", steps=50, to=0.02, **path)
    return p


def torn():
    """A bond that bears 0.858 at most, pulled by 2: there is no equilibrium beyond."""
    p = elamin.Problem()
    p.particles([[0, 0, 0], [1, 0, 0]], 0.5)
    p.law("weak", [[0, 1]], formula="-exp(-(r01 - 1)**2)")
    p.group(name="first", particles=[0]).group(name="last", particles=[1])
    p.support(group="first").support(group="last", directions="yz").load(group="last", force=[2, 0, 0])
    return p.table("path", steps=10)


def buckling_load(particles=14, d=1e-3, E=0.96e6):
    K, B = np.pi * E * d / 8, np.pi * E * d**3 / 64
    mu = 4 * np.sin(np.pi / (particles - 2)) ** 2
    return K * d * (1 - np.sqrt(1 - 2 * B * mu / (K * d**2)))
