"""Energies, gradients and Hessians: against the program to the last bit, and against differences."""
import pickle

import numpy as np
import pytest

import elamin
from conftest import buckling_load, column

EPS = np.finfo(float).eps


@pytest.mark.parametrize("name", ["two_beams", "column_cylindrical", "ring_pressure", "grain_corner", "box_tips", "boxes_stacked",
                                  "plate_growing", "column_between_walls"])
@pytest.mark.parametrize("load_factor", [None, 0.37])
def test_energy_and_forces_are_the_programs(root, program_energy, name, load_factor):
    file = root / f"problems/{name}.toml"
    terms, forces = program_energy(file, *([] if load_factor is None else ["--lambda", str(load_factor)]))
    p = elamin.Problem(file)
    total = terms.pop("total")
    assert p.energy(None, load_factor) == total
    assert p.terms(None, load_factor) == terms
    if len(forces):
        assert (p.forces(None, load_factor) + 0.0 == forces).all()
    assert (p.gradient(None, load_factor) == -p.forces(None, load_factor)).all()


def shaken(p, size=1e-2, seed=1):
    return p.x0 + size * p.diameters.min() * np.random.default_rng(seed).standard_normal(p.x0.shape)


def in_plane(p, x, across):
    x = x.copy()
    x[:, across] = p.x0[:, across]
    return x


@pytest.mark.parametrize("name", ["two_beams", "sheet_indented", "grain_corner", "ring_pressure"])
def test_derivatives_are_those_of_the_energy(root, name):
    p = elamin.Problem(root / f"problems/{name}.toml")
    x = shaken(p, 1e-3)
    if "plane" in p.tables:
        x = in_plane(p, x, {"xy": 2, "xz": 1, "yz": 0}[p.tables["plane"]])
    rng = np.random.default_rng(2)
    g, H = p.gradient(x), p.hessian(x)
    u = np.zeros(3 * p.n)
    u[p.free[p.free < 3 * p.n]] = rng.standard_normal((p.free < 3 * p.n).sum())
    u /= np.abs(u).max()
    # Central differences: f‴ h² / 6 is the error of the method, ε |f| / h that of rounding. The third derivative is of the order of
    # H / diameter.
    d = p.diameters.min()
    h = 1e-4 * d
    size = np.abs(p.hessian(x)).sum(axis=1).max()
    U = u.reshape(x.shape)
    slope = (p.energy(x + h * U) - p.energy(x - h * U)) / (2 * h)
    terms = sum(abs(t) for t in p.terms(x).values())
    bound = size * np.abs(u).sum() / d * h**2 + 4 * EPS * terms / h + 4 * EPS * size * np.abs(x).max() * np.abs(u).sum()
    assert abs(slope - (g * U).sum()) <= bound
    assert bound < 1e-3 * np.abs(g * U).sum()
    curve = (p.gradient(x + h * U) - p.gradient(x - h * U)).ravel() / (2 * h)
    # Of contacts that open and close within h the Hessian has a corner: what they add is of the order of the stiffness of an overlap h.
    off = np.abs(H @ u - curve).max()
    assert off <= size * (10 * h / d if name in ("sheet_indented", "grain_corner") else 10 * (h / d) ** 2 + 1e-8)


def test_hessian_is_symmetric_and_free_is_a_part_of_it(root):
    p = elamin.Problem(root / "problems/two_beams.toml")
    x = in_plane(p, shaken(p), 1)
    H, F = p.hessian(x), p.hessian(x, free=True)
    assert H.shape == (3 * p.n, 3 * p.n) and F.shape == (p.dofs, p.dofs)
    assert abs(H - H.T).max() == 0 and abs(F - F.T).max() == 0
    assert H.has_sorted_indices and H.has_canonical_format
    assert abs(H[p.free][:, p.free] - F).max() == 0
    assert (p.gradient(x).ravel()[p.free] == p.gradient(x, free=True)).all()


def test_a_grain_that_nothing_touches_has_no_stiffness():
    p = elamin.Problem()
    p.grains(name="grains", positions=[[0, 0, 0], [5, 0, 0]], diameter=1.0, density=1.0).gravity(acceleration=[0, 0, -1.0])
    p.contact(between=["grains", "grains"], youngs_modulus=1.0, poissons_ratio=0.3)
    p.study(type="energy")
    assert abs(p.hessian()).max() == 0
    assert p.gradient()[0, 2] == pytest.approx(np.pi / 6, rel=4 * EPS)


def test_bodies_have_forces_and_torques(root, program, tmp_path):
    file = root / "problems/box_tips.toml"
    program("energy", file, "--lambda", "0.5", "--forces", tmp_path / "f.csv")
    rows = np.loadtxt(tmp_path / "f.bodies.csv", delimiter=",", skiprows=1, ndmin=2)
    p = elamin.Problem(file)
    assert (p.body_forces(None, 0.5) + 0.0 == rows[:, 1:]).all()
    bodies = p.start.bodies
    assert bodies.shape == (1, 7)
    x = np.zeros((p.n, 3))
    assert p.energy(x, 0.5, bodies=bodies) == pytest.approx(p.energy(None, 0.5), rel=1e-12, abs=1e-18)
    raised = bodies.copy()
    raised[0, 2] += 1.0
    assert p.energy(x, 0.5, bodies=raised) != p.energy(x, 0.5, bodies=bodies)


def test_positions_are_views():
    p = column()
    x = p.x0
    assert x.base is not None and not x.flags.writeable and x.flags.c_contiguous and x.shape == (14, 3)
    state = p.start
    assert np.shares_memory(state.x, state.x)


def test_arrays_of_a_wrong_shape_are_refused(root):
    p = column()
    with pytest.raises(elamin.InputError, match=r"x: must have the shape \(14, 3\), has \(3, 14\)"):
        p.energy(np.zeros((3, 14)))
    with pytest.raises(elamin.InputError, match="finite"):
        p.energy(np.full((14, 3), np.nan))
    with pytest.raises(elamin.InputError, match="64 particles"):
        p.energy(elamin.Problem(root / "problems/two_beams.toml").start)


def test_states_keep_all_digits():
    p = column()
    step = list(p.path())[-1]
    state = pickle.loads(pickle.dumps(step.state))
    assert p.energy(state) == step.energy == p.energy(step)
    assert (state.low == step.state.low).all() and np.abs(state.low).max() > 0
    assert (p.forces(step) == step.forces).all()
    moved = state.at_load_factor(0)
    assert moved.load_factor == 0 and state.load_factor == step.load_factor


def test_minimise_finds_what_the_path_has():
    p = column(20)
    p.path(to=0.004)
    last = list(p.path())[-1]
    assert last.load_factor < buckling_load(20)
    for method in ("newton", "auto", "ipopt", "nlopt:LD_LBFGS", "fire"):
        m = elamin.minimise(p, p.x0, method=method, load_factor=0.002)
        assert m.converged and m.stable and m.residual <= 1e-10, (method, m.message)
        assert m.load_factor == 0.002
        assert p.energy(m) == m.energy
        assert m.terms == p.terms(m)
    m = elamin.minimise(p, last)
    assert np.abs(m.x - last.x).max() <= 1e-12 * np.abs(last.x).max()
    few = elamin.minimise(p, last.x, load_factor=0.5, max_iterations=1)
    assert not few.converged and few.message
    with pytest.raises(elamin.InputError, match='method: must be "auto", "newton".*is "newtn"; did you mean "newton"'):
        elamin.minimise(p, method="newtn")


def test_what_has_not_converged_is_not_stable():
    p = elamin.Problem(plane="xz")
    p.beam(name="b", particles=12, from_=[0, 0, 0], to=[11, 0, 0], diameter=1.0, youngs_modulus=1.0)
    p.group(name="clamp", of="b", first=2).group(name="tip", of="b", last=1)
    p.support(group="clamp").load(group="tip", force=[0, 0, -1e-2])
    for x0 in (None, p.x0):
        few, enough = (elamin.minimise(p, x0, load_factor=1, max_iterations=most) for most in (2, None))
        assert enough.converged and enough.stable
        assert not few.converged and not few.stable and not few.stability.stable


def test_load_factors_and_threads_that_cannot_be_are_refused(tmp_path):
    p = column()
    for wrong in (np.nan, np.inf, -np.inf):
        for work in (lambda: elamin.minimise(p, load_factor=wrong), lambda: elamin.minimise(p, p.x0, load_factor=wrong),
                     lambda: p.energy(p.x0, wrong), lambda: p.energy(None, wrong), lambda: p.start.at_load_factor(wrong)):
            with pytest.raises(elamin.InputError, match="load_factor: must be a finite number, is -?(nan|inf)"):
                work()
    for wrong in (0, -1):
        with pytest.raises(elamin.InputError, match=f"set_threads: must be an integer of at least 1, is {wrong}"):
            elamin.set_threads(wrong)
    with pytest.raises(elamin.InputError, match="threads: must be an integer of at least 0, is -1"):
        p.run(tmp_path / "run", threads=-1)


def test_poses_of_bodies_that_cannot_be_are_refused():
    p = elamin.Problem()
    p.body(name="cube", shape="cube", edge=1.0, rounding_diameter=0.1, density=1.0, position=[0, 0, 0]).study(type="energy")
    for wrong in ([0, 0, 0, 0, 0, 0, 0], [np.nan, 0, 0, 1, 0, 0, 0], [0, 0, 0, np.inf, 0, 0, 0]):
        with pytest.raises(elamin.InputError, match="body 0 has numbers that are not finite, or a quaternion of length 0"):
            p.energy(np.empty((0, 3)), bodies=[wrong])


def test_minimise_goes_to_the_load_in_steps():
    p = elamin.Problem(plane="xz")
    p.beam(name="b", particles=10, from_=[0, 0, 0], to=[9, 0, 0], diameter=1.0, youngs_modulus=1.0)
    p.group(name="left", of="b", first=2).group(name="right", of="b", last=2)
    p.support(group="left").support(group="right", displacement=[-6, 0, 1])
    m = elamin.minimise(p, load_factor=1)
    assert m.converged and m.stable
    assert np.abs(m.x[-1] - [3, 0, 1]).max() <= 1e-15


def test_modes_are_eigenvectors_of_the_hessian():
    from scipy.linalg import eigh

    p = column(20)
    m = elamin.minimise(p, load_factor=0.001)
    values = eigh(p.hessian(m, free=True).toarray(), eigvals_only=True)
    modes = p.modes(m, 4)
    assert np.allclose([mode.eigenvalue for mode in modes], values[:4], rtol=1e-8)
    for mode in modes:
        v = mode.shape.ravel()[p.free]
        assert np.linalg.norm(v) == pytest.approx(1, rel=1e-12)
        assert np.linalg.norm(p.hessian(m, free=True) @ v - mode.eigenvalue * v) <= 1e-8 * values[-1]
    assert p.stability(m).stable and p.stability(m).negative == 0
    with pytest.raises(elamin.InputError, match="k: must be an integer from 1 to"):
        p.modes(m, 1000)
