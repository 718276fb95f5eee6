"""Particles, bonds and angles from arrays: they go into the problem as a LAMMPS data file."""
from __future__ import annotations

from typing import Any, Dict, List, Optional, Tuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import InputError

Floats = NDArray[np.float64]


def numbers_of_particles(array: ArrayLike, name: str) -> NDArray[np.int64]:
    """Integers from 0, of any shape."""
    try:
        a = np.asarray(array)
    except ValueError:
        raise InputError(f"{name}: must be an array of integers, numbers of particles from 0; its rows are not of one length") from None
    if a.size == 0:
        return np.empty(a.shape, dtype=np.int64)
    if not np.issubdtype(a.dtype, np.integer):
        raise InputError(f"{name}: must be integers, numbers of particles from 0; is of {a.dtype}")
    for wrong in (a.min(), a.max()):
        if not 0 <= int(wrong) < 2**31:
            raise InputError(f"{name}: there is no particle {wrong}; particles count from 0")
    return a.astype(np.int64)


def real_numbers(array: ArrayLike, name: str) -> Floats:
    """An array of its own of real numbers, of any shape."""
    try:
        if np.iscomplexobj(array):
            raise TypeError
        return np.array(array, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{name}: must be an array of real numbers") from None


def _rows(array: ArrayLike, width: int, name: str) -> NDArray[np.int64]:
    a = numbers_of_particles(array, name)
    if a.size == 0:
        return np.empty((0, width), dtype=np.int64)
    if a.ndim != 2 or a.shape[1] != width:
        raise InputError(f"{name}: must have the shape (m, {width}), has {a.shape}")
    return a


def one_or_each(value: ArrayLike, count: int, name: str) -> Floats:
    """A number for each, from one or from as many."""
    try:
        a = real_numbers(value, name)
    except InputError:
        raise InputError(f"{name}: must be one number, or {count} of them; is {value!r}") from None
    if a.ndim > 1 or (a.ndim == 1 and a.shape[0] != count):
        raise InputError(f"{name}: must be one number, or {count} of them; has the shape {a.shape}")
    return np.broadcast_to(a, (count,))


def _each(value: ArrayLike, count: int, name: str, least: float, strict: bool) -> Floats:
    a = one_or_each(value, count, name)
    wrong = ~np.isfinite(a) | (a <= least if strict else a < least)
    if wrong.any():
        raise InputError(f"{name}: must be {'positive' if strict else 'not negative'} and finite, is {a[wrong][0]}")
    return a


class Arrays:
    """What p.particles, p.bonds and p.angles have been given."""

    def __init__(self) -> None:
        self.x: Floats = np.empty((0, 3))
        self.diameter: Floats = np.empty(0)
        self.density: Floats = np.empty(0)
        self.type: NDArray[np.int64] = np.empty(0, dtype=np.int64)
        self.bonds: List[Tuple[NDArray[np.int64], Floats, Optional[Floats]]] = []
        self.angles: List[Tuple[NDArray[np.int64], Floats, Floats]] = []

    def copy(self) -> "Arrays":
        other = Arrays()
        other.x, other.diameter, other.density, other.type = self.x, self.diameter, self.density, self.type
        other.bonds, other.angles = list(self.bonds), list(self.angles)
        return other

    def __bool__(self) -> bool:
        return bool(len(self.x) or self.bonds or self.angles)

    def add_particles(self, x: ArrayLike, diameter: ArrayLike, density: Optional[ArrayLike]) -> NDArray[np.int64]:
        x = real_numbers(x, "particles: x")
        if x.ndim != 2 or x.shape[1] != 3 or len(x) == 0:
            raise InputError(f"particles: x must have the shape (n, 3), has {x.shape}")
        if not np.isfinite(x).all():
            raise InputError("particles: x must be finite")
        n = len(x)
        first = len(self.x)
        self.diameter = np.concatenate([self.diameter, _each(diameter, n, "particles: diameter", 0, True)])
        self.density = np.concatenate([self.density, np.zeros(n) if density is None else _each(density, n, "particles: density", 0, True)])
        self.type = np.concatenate([self.type, np.full(n, 1 + self.type.max(initial=0))])
        self.x = np.concatenate([self.x, x])
        return np.arange(first, first + n)

    def add_bonds(self, pairs: ArrayLike, stiffness: ArrayLike, rest_length: Optional[ArrayLike]) -> None:
        p = _rows(pairs, 2, "bonds: pairs")
        K = _each(stiffness, len(p), "bonds: stiffness", 0, False)
        r0 = None if rest_length is None else _each(rest_length, len(p), "bonds: rest_length", 0, True)
        self.bonds.append((p, K, r0))

    def add_angles(self, triples: ArrayLike, stiffness: ArrayLike, rest: ArrayLike) -> None:
        t = _rows(triples, 3, "angles: triples")
        B = _each(stiffness, len(t), "angles: stiffness", 0, False)
        theta = _each(rest, len(t), "angles: rest", 0, False)
        if (theta > 180).any():
            raise InputError(f"angles: rest must be at most 180 degrees, is {theta.max()}")
        self.angles.append((t, B, theta))

    def _check(self, rows: NDArray[np.int64], name: str) -> None:
        if not len(rows):
            return
        n = len(self.x)
        if rows.max() >= n:
            raise InputError(f"{name}: there is no particle {rows.max()}; p.particles has given {n}, which count from 0")
        s = np.sort(rows, axis=1)
        same = (s[:, 1:] == s[:, :-1]).any(axis=1)
        if same.any():
            raise InputError(f"{name}: {tuple(rows[same][0])} has one particle twice")

    def split(self) -> Tuple["Arrays", List[Dict[str, Any]], List[Dict[str, Any]]]:
        """These without the bonds and angles that particles of structures have, and such as tables [[bonds]] and [[angles]], one a kind."""
        n = len(self.x)
        inner = self.copy()
        inner.bonds, inner.angles = [], []
        bonds: List[Dict[str, Any]] = []
        angles: List[Dict[str, Any]] = []
        for pairs, K, r0 in self.bonds:
            own = (pairs < n).all(axis=1)
            inner.bonds.append((pairs[own], K[own], None if r0 is None else r0[own]))
            kinds, kind = self._kinds([np.column_stack([K, np.zeros(len(K)) if r0 is None else r0])[~own]])
            for k, (stiffness, length) in enumerate(kinds):
                bonds.append({"pairs": (pairs[~own][kind == k] + 1).tolist(), "bond_stiffness": stiffness,
                              "rest_length": None if r0 is None else length})
        for triples, B, rest in self.angles:
            own = (triples < n).all(axis=1)
            inner.angles.append((triples[own], B[own], rest[own]))
            kinds, kind = self._kinds([np.column_stack([B, rest])[~own]])
            for k, (stiffness, degrees) in enumerate(kinds):
                angles.append({"triples": (triples[~own][kind == k] + 1).tolist(), "angle_stiffness": stiffness, "rest": degrees})
        return inner, bonds, angles

    def text(self) -> str:
        """The LAMMPS data file (atom style hybrid sphere angle); ids are the numbers from 0, and one."""
        pairs = np.concatenate([b[0] for b in self.bonds]) if self.bonds else np.empty((0, 2), dtype=np.int64)
        self._check(pairs, "bonds")
        triples = np.concatenate([a[0] for a in self.angles]) if self.angles else np.empty((0, 3), dtype=np.int64)
        self._check(triples, "angles")
        n = len(self.x)
        if n == 0:
            raise InputError("bonds, angles: are between particles of p.particles, which has not been called")
        out = ["particles, bonds and angles from Python\n"]
        bond_kinds, bond_kind = self._kinds([np.column_stack([K, self._lengths(p) if r is None else r]) for p, K, r in self.bonds])
        angle_kinds, angle_kind = self._kinds([np.column_stack([B, t]) for _, B, t in self.angles])
        out.append(f"{n} atoms\n{len(pairs)} bonds\n{len(triples)} angles")
        out.append(f"{self.type.max()} atom types\n{len(bond_kinds)} bond types\n{len(angle_kinds)} angle types\n")
        lo, hi = (self.x - self.diameter[:, None]).min(axis=0), (self.x + self.diameter[:, None]).max(axis=0)
        out += [f"{lo[c]:.17g} {hi[c]:.17g} {'xyz'[c]}lo {'xyz'[c]}hi" for c in range(3)]
        if len(bond_kinds):
            out.append("\nBond Coeffs # harmonic\n")
            out += [f"{k + 1} {K:.17g} {r:.17g}" for k, (K, r) in enumerate(bond_kinds)]
        if len(angle_kinds):
            straight = bool((angle_kinds[:, 1] == 180).all())
            out.append(f"\nAngle Coeffs # {'cosine' if straight else 'cosine/shift'}\n")
            out += [f"{k + 1} {B:.17g}" if straight else f"{k + 1} {2 * B:.17g} {t:.17g}" for k, (B, t) in enumerate(angle_kinds)]
        out.append("\nAtoms # hybrid sphere angle\n")
        density = np.where(self.density > 0, self.density, 1.0)
        out += [f"{i + 1} {self.type[i]} {p[0]:.17g} {p[1]:.17g} {p[2]:.17g} {self.diameter[i]:.17g} {density[i]:.17g} {self.type[i]}"
                for i, p in enumerate(self.x)]
        if len(pairs):
            out.append("\nBonds\n")
            out += [f"{k + 1} {bond_kind[k] + 1} {i + 1} {j + 1}" for k, (i, j) in enumerate(pairs)]
        if len(triples):
            out.append("\nAngles\n")
            out += [f"{k + 1} {angle_kind[k] + 1} {a + 1} {b + 1} {c + 1}" for k, (a, b, c) in enumerate(triples)]
        return "\n".join(out) + "\n"

    def _lengths(self, pairs: NDArray[np.int64]) -> Floats:
        self._check(pairs, "bonds")
        lengths: Floats = np.linalg.norm(self.x[pairs[:, 1]] - self.x[pairs[:, 0]], axis=1)
        return lengths

    @staticmethod
    def _kinds(rows: List[Floats]) -> Tuple[Floats, NDArray[np.int64]]:
        if not rows or not sum(len(r) for r in rows):
            return np.empty((0, 2)), np.empty(0, dtype=np.int64)
        kinds, kind = np.unique(np.concatenate(rows), axis=0, return_inverse=True)
        return kinds, kind.ravel()
