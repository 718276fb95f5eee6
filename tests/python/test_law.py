"""Laws of one's own: derivatives, the same numbers as elamin's own laws, equilibria, paths, stability, errors."""
import concurrent.futures
import multiprocessing
import pickle

import numpy as np
import pytest

import elamin
from conftest import buckling_load, column

EPS = np.finfo(float).eps


# A stiffening bond, U = K e² + Q e⁴ with e = r − r₀, as functions over all elements.
K, Q, R0 = 1.0, 5.0, 1.0


def parts(x):
    d = x[:, 1] - x[:, 0]
    r = np.linalg.norm(d, axis=1)
    return d / r[:, None], r, r - R0


def value(x):
    _, _, e = parts(x)
    return K * e**2 + Q * e**4


def gradient(x):
    u, _, e = parts(x)
    f = (2 * K * e + 4 * Q * e**3)[:, None] * u
    return np.stack([-f, f], axis=1)


def hessian(x):
    u, r, e = parts(x)
    slope, curve = 2 * K * e + 4 * Q * e**3, 2 * K + 12 * Q * e**2
    uu = u[:, :, None] * u[:, None, :]
    h = curve[:, None, None] * uu + (slope / r)[:, None, None] * (np.eye(3) - uu)
    return np.block([[h, -h], [-h, h]])


def chain(**law):
    """examples/own_law.cpp: three particles, a force at the end."""
    p = elamin.Problem()
    i = p.particles([[0, 0, 0], [1, 0, 0], [2, 0, 0]], 1.0)
    p.group(name="first", particles=i[:1]).group(name="last", particles=i[-1:])
    p.support(group="first").load(group="last", force=[0.8, 0, 0])
    p.law("stiffening", [[0, 1], [1, 2]], **law)
    return p


FUNCTIONS = dict(value=value, gradient=gradient, hessian=hessian, translation_invariant=True)
FORMULA = dict(formula="K*(r01 - r0)**2 + Q*(r01 - r0)**4", K=K, Q=Q, r0=R0)


@pytest.mark.parametrize("law", [FUNCTIONS, FORMULA])
def test_the_chain_of_the_cpp_example(law):
    p = chain(**law)
    m = elamin.minimise(p, load_factor=1, method="newton")
    assert m.converged and m.stable
    for e in np.linalg.norm(np.diff(m.x, axis=0), axis=1) - 1:
        assert 2 * K * e + 4 * Q * e**3 == pytest.approx(0.8, rel=1e-12)
    assert m.terms["stiffening"] == p.terms(m)["stiffening"] == pytest.approx(value(m.x[np.array([[0, 1], [1, 2]])]).sum(), rel=4 * EPS)


def test_formula_and_functions_agree():
    a, b = chain(**FUNCTIONS), chain(**FORMULA)
    x = a.x0 + 0.1 * np.random.default_rng(1).standard_normal((3, 3))
    assert a.energy(x) == pytest.approx(b.energy(x), rel=8 * EPS)
    assert np.abs(a.gradient(x) - b.gradient(x)).max() <= 16 * EPS * np.abs(b.gradient(x)).max()
    assert abs(a.hessian(x) - b.hessian(x)).max() <= 32 * EPS * abs(b.hessian(x)).max()


# Coordinates in more than one place, kinks, steps, branches.
FORMULAS = [("r01**3 + r02*r12", 3), ("exp(-r01/2)*(1 + c012)**2 + c012*r12", 3), ("k*(z0 - 0.3)**2/2 + x0*y1", 2),
            ("sqrt(1 + r03**2)*c021 + c123 + x2", 4), ("2.5e-1*log(r01)", 2), ("k*(sqrt((x0 - 10)**2 + (z0 - 3)**2) - 9)**2/2", 1),
            ("exp(x0*z0/10)", 1), ("1/(1 + x0**2 + z0**2)", 1), ("sqrt(x0**2 + y0**2 + z0**2 + 1)", 1), ("sin(x0)*cos(z0)", 1),
            ("(x0**2 + z0**2)**2", 1), ("x0*y0*z0", 1), ("k*exp(-(x0 - 3)**2 - z0**2)", 1), ("exp(-r01)/r01", 2),
            ("k*(x1 - x0)**2*(z1 - z0)**2", 2), ("exp(-(r01 - 1)**2)*(1 - c012)**2*r12**2", 3),
            ("Max(z0, 0)**3", 1), ("Max(x0, y0, z0, 0)**2", 1), ("Min(z0, 1)**2", 1), ("k*Max(2 - r01, 0)**2.5", 2),
            ("Abs(z0)**3", 1), ("(abs(z0) - z0)**2", 1), ("abs(log(r01))", 2), ("Heaviside(z0)*z0**3", 1), ("Heaviside(z0)", 1),
            ("Piecewise((z0**2, z0 > 0), (0, True))", 1), ("Piecewise((log(z0), z0 > 0.1), (x0, True))", 1),
            ("Piecewise((z0**2, (z0 > 0) & (x0 > 0)), (x0, True))", 1), ("sqrt(Max(z0, 0) + 1)*sqrt((x0 - 1)**2)", 1)]


@pytest.mark.parametrize("formula, sites", FORMULAS)
def test_formulas_are_differentiated(formula, sites):
    rng = np.random.default_rng(3)
    x = rng.standard_normal((5, sites, 3))
    p = elamin.Problem()
    p.particles(x.reshape(-1, 3), 0.1)
    p.law("own", np.arange(5 * sites).reshape(5, sites), formula=formula, **({"k": np.arange(1.0, 6.0)} if "k*" in formula else {}))
    p.study(type="energy")
    x0 = p.x0
    H, g = p.hessian().toarray(), p.gradient().ravel()
    # Of central differences the error is f‴ h²/6 ~ h², and ε/h of rounding: 1e-8 with h = 1e-4 and functions of order one on lengths of
    # order one; near lengths of 0.1 the third derivative is 10³ times as large, of which 10 are in the largest entry.
    h = 1e-4
    for k in range(x0.size):
        e = np.zeros(x0.size)
        e[k] = h
        e = e.reshape(x0.shape)
        assert abs((p.energy(x0 + e) - p.energy(x0 - e)) / (2 * h) - g[k]) <= 1e-6 * np.abs(g).max()
        assert np.abs((p.gradient(x0 + e) - p.gradient(x0 - e)).ravel() / (2 * h) - H[k]).max() <= 1e-6 * np.abs(H).max()


def test_branches_that_are_not_taken_do_not_count():
    p = elamin.Problem()
    p.particles([[0, 0, -1.0], [3.0, 0, 4.0]], 0.1)
    p.law("own", [[0], [1]], formula="sqrt(Max(z0, 0))").study(type="energy")       # its slope is 0/0 where z0 < 0
    assert p.energy() == 2 and p.gradient()[:, 2].tolist() == [0, 0.25]
    assert p.hessian().toarray()[[2, 5], [2, 5]].tolist() == [0, -1 / 32]
    q = elamin.Problem()
    q.particles([[0, 0, -1.0]], 0.1)
    q.law("own", [[0]], formula="Piecewise((z0, z0 > 0))").study(type="energy")     # defined where z0 > 0
    assert q.energy() == np.inf and q.energy([[0, 0, 2.0]]) == 2


def test_parameters_may_have_any_name():
    p = elamin.Problem()
    p.particles([[0, 0, 2.0]], 0.1)
    names = ("t0", "_t0", "select", "numpy", "sign", "E", "I")
    p.law("own", [[0]], formula="sqrt(1 + z0**2)*Max(z0, 0)/sqrt(1 + z0**2)*" + "*".join(names), **{name: 2.0 for name in names})
    p.study(type="energy")
    assert p.energy() == pytest.approx(2.0 ** 8, rel=8 * EPS) and p.gradient()[0, 2] == pytest.approx(2.0 ** 7, rel=8 * EPS)


def test_a_formula_by_complex_steps():
    """f′ = Im f(x + ih)/h has no rounding but that of f: the radial derivative of a formula."""
    p = elamin.Problem()
    p.particles([[0, 0, 0], [0, 0, 1.3]], 0.1)
    p.law("own", [[0, 1]], formula="exp(-r01)*sin(3*r01) + 1/r01")
    p.study(type="energy")

    def f(r):
        return np.exp(-r) * np.sin(3 * r) + 1 / r

    assert p.gradient()[1, 2] == pytest.approx(np.imag(f(1.3 + 1e-30j)) / 1e-30, rel=16 * EPS)


def own_column(particles=14):
    """The column of conftest with bonds and angles by formulas."""
    d, E = 1e-3, 0.96e6
    p = elamin.Problem(plane="xz")
    i = p.particles(column(particles).x0, d)
    p.law("stretch", np.column_stack([i[:-1], i[1:]]), formula="K*(r01 - d)**2", K=np.pi * E * d / 8, d=d)
    p.law("bend", np.column_stack([i[:-2], i[1:-1], i[2:]]), formula="B*(1 + c012)", B=np.pi * E * d**3 / 64)
    p.group(name="bottom", particles=i[:2]).group(name="top", particles=i[-2:]).group(name="tip", particles=[particles - 2])
    p.support(group="bottom").support(group="top", directions="x").load(group="tip", total_force=[0, 0, -1])
    p.table("path", method="arc_length", steps=50, to=0.02)
    return p


def test_a_column_of_own_laws_buckles_as_one_of_elamins():
    own, there = list(own_column().path()), list(column().path())
    first = [next(s for s in steps if s.events) for steps in (own, there)]
    assert first[0].label == first[1].label == "branch:1"
    assert first[0].load_factor == pytest.approx(buckling_load(), rel=1e-9)
    assert [s.negative for s in own][-1] == [s.negative for s in there][-1] == 1
    assert own[-1].energy == pytest.approx(there[-1].energy, rel=1e-10)
    assert own[-1].terms["stretch"] == pytest.approx(there[-1].terms["bond"], rel=1e-8)


def test_a_run_has_them_too(tmp_path):
    p = own_column()
    run = p.run(tmp_path / "run")
    assert run.status == "done"
    assert run.events["lambda"][0] == pytest.approx(buckling_load(), rel=1e-9)
    steps = list(p.path())
    assert [s.energy for s in steps] == list(run.path["energy"])
    for term in ("stretch", "bend"):
        assert [s.terms[term] for s in steps] == [s.row[term] for s in steps] == list(run.path[term])
    assert run.plot(y="bend").svg


def test_a_sweep_has_their_columns(tmp_path):
    run = own_column().sweep(key="path.to", values=[0.005, 0.01]).run(tmp_path / "sweep")
    assert list(run.sweep["stretch"]) == [r.path["stretch"].iloc[-1] for r in run.runs]
    assert list(run.sweep["negative_rigid"]) == [0, 0]


def test_a_foundation_of_own_springs():
    """A column on springs across, of k a particle, has the modes of the column with k more stiffness: the anchored law."""
    p = column(20)
    k = 0.4
    q = p.copy().law("springs", np.arange(20)[:, None], formula="k*x0**2/2", k=k)
    a, b = p.modes(None, 6, 0.0), q.modes(None, 6, 0.0)
    for one, two in zip(a, b):                            # those along the column do not feel the springs
        assert two.eigenvalue - one.eigenvalue == pytest.approx(k * (one.shape[:, 0] ** 2).sum(), rel=1e-9, abs=1e-9 * k)
    assert sum((m.shape[:, 0] ** 2).sum() > 0.5 for m in a) == 5
    alone = elamin.Problem()
    alone.particles([[0, 0, 0]], 1.0, name="one")
    alone.law("well", [[0]], formula="(x0 - 1)**2 + y0**2 + 2*(z0 + 3)**2").load(group="one", force=[1, 0, 0])
    m = elamin.minimise(alone, load_factor=1)
    assert m.converged and np.abs(m.x - [1.5, 0, -3]).max() <= 1e-12


def test_what_nothing_holds_is_still_refused():
    p = elamin.Problem()
    p.particles([[0, 0, 0], [1, 0, 0]], 1.0, name="pair")
    p.law("own", [[0, 1]], formula="(r01 - 1)**2").load(group="pair", force=[1, 0, 0])
    with pytest.raises(elamin.InputError, match="support"):
        p.n


def test_particles_on_bodies():
    """A spring between a particle that a body carries and a fixed one turns the body as elamin's own bond does."""
    def problem():
        p = elamin.Problem()
        p.beam(name="b", particles=3, from_=[0.8, 0, 0], to=[2.8, 0, 0], diameter=1.0, bond_stiffness=2.0, angle_stiffness=0.5)
        p.body(name="cube", shape="cube", edge=1.0, rounding_diameter=0.1, density=1.0, position=[0, 0, 0])
        p.group(name="end", of="b", first=1).group(name="far", of="b", last=1)
        p.glue(group="end", body="cube").support(group="far", directions="xyz").load(group="cube", force=[0.1, 0.3, 0.0])
        return p.study(type="energy")

    plain, own = problem(), problem()
    own.set("beam.b.bond_stiffness", 1.0).law("half", [[0, 1], [1, 2]], formula="K*(r01 - 1)**2", K=1.0)
    x = plain.x0 + np.array([[0, 0, 0], [0.1, 0.2, -0.1], [0.2, 0, 0.1]])
    assert own.energy(x) == pytest.approx(plain.energy(x), rel=1e-14)
    assert np.abs(own.gradient(x, free=True) - plain.gradient(x, free=True)).max() <= 1e-13
    assert abs(own.hessian(x, free=True) - plain.hessian(x, free=True)).max() <= 1e-12


class Broken(Exception):
    pass


def test_errors_in_functions_come_through(tmp_path):
    calls = []

    def breaks(x):
        calls.append(1)
        if len(calls) > 20:
            raise Broken("enough")
        return value(x)

    law = dict(FUNCTIONS, value=breaks)
    p = chain(**law).table("path", steps=5)
    with pytest.raises(Broken, match="enough"):
        for _ in range(30):
            p.energy(p.start)
    for work in (lambda: list(p.path()), lambda: p.run(tmp_path / "run"), lambda: elamin.minimise(p, p.start, load_factor=1),
                 lambda: p.modes(p.start, 2)):
        with pytest.raises(Broken, match="enough"):
            calls.clear()
            calls.extend([1] * 18)
            work()


def test_wrong_laws_are_refused():
    def fails(match, elements=((0, 1),), kind=elamin.InputError, **law):
        with pytest.raises(kind, match=match):
            p = elamin.Problem()
            p.particles([[0, 0, 0], [1, 0, 0]], 1.0)
            p.law("own", elements, **law).study(type="energy")
            p.energy()

    fails("give value, gradient and hessian, or a formula", value=value)
    fails("r02; allowed: x0, y0, z0", formula="r01 + r02")
    for formula in ("r01 +* 2", "(", "", "Piecewise(z0)", "r01(3)", "0 < z0 < 1"):
        fails("cannot be read", formula=formula)
    for formula in ("r01, 2", "r01 > 2", "1/0", "sqrt(-1)*r01", "exp", "True"):
        fails("is no real number; it must be an energy", formula=formula)
    fails("sympy has no derivative of the formula 'z0%2'; allowed are", formula="z0%2")
    fails("law own: k: must be one number, or 1 of them; has the shape .2,.", formula="k*r01", k=[1, 2])
    fails("law own: k: must be one number, or 1 of them; is 'stiff'", formula="k*r01", k="stiff")
    fails("is a variable of the formula", formula="r01", r01=3.0)
    fails("particle number 7; the problem has 2", elements=[[0, 7]], formula="r01")
    functions = dict(value=value, gradient=gradient, hessian=hessian)
    for law in ({"formula": "r01"}, functions):
        for wrong in (-1, -100000000, 2**32 + 1):
            fails(f"law own: elements: there is no particle {wrong}; particles count from 0", elements=[[wrong, 1]], **law)
        fails("law own: elements: must be integers", elements=[[0.5, 1]], **law)
        fails("law own: elements: must be an array of integers", elements=[[0, 1], [1]], **law)
    fails("particle twice", elements=[[1, 1]], formula="r01")
    fails("must have the shape", elements=[0, 1], formula="r01")
    fails("its value has 3 numbers for 1 elements", kind=ValueError, value=lambda x: np.zeros(3), gradient=gradient, hessian=hessian)
    fails("its gradient has 3 numbers for 1 elements of 2 sites; 6 are wanted", kind=ValueError, value=value,
          gradient=lambda x: np.zeros(3), hessian=hessian)
    for name in ("bond", "lambda", "stable", "multiplicity"):
        fails_by_name("there is a column of this name already", name)
    for name in ("", "a,b", "1", 'x"'):
        fails_by_name("its name must be of letters", name)
    p = elamin.Problem()
    p.particles([[0, 0, 0], [1, 0, 0]], 1.0)
    with pytest.raises(elamin.InputError, match="law own: there is a law of this name already; give it another name"):
        p.law("own", [[0, 1]], formula="r01").law("own", [[0, 1]], formula="r01**2")
    p = elamin.Problem()
    p.particles([[0, 0, 0], [1, 0, 0]], 1.0, name="pair")
    p.law("own", [[0, 1]], formula="r01").study(type="energy").observe(name="own", group="pair", quantity="position.x")
    with pytest.raises(elamin.InputError, match='observe.own.name: "own" is the name of a law'):
        p.n


def fails_by_name(match, name):
    with pytest.raises(elamin.InputError, match=match):
        elamin.Problem().law(name, [[0, 1]], formula="r01")


def test_check_law_tells_right_from_wrong():
    x = np.random.default_rng(5).standard_normal((4, 2, 3))
    assert max(elamin.check_law(value, gradient, hessian, x)) < 1e-7
    assert elamin.check_law(value, lambda x: 2 * gradient(x), hessian, x)[0] > 0.5
    assert elamin.check_law(value, gradient, lambda x: 2 * hessian(x), x)[1] > 0.5
    with pytest.raises(elamin.InputError, match=r"the Hessian must have the shape \(4, 6, 6\), has \(4, 3, 6\)"):
        elamin.check_law(value, gradient, lambda x: hessian(x)[:, :3], x)
    with pytest.raises(elamin.InputError, match=r"the gradient must have the shape \(4, 2, 3\), has \(4,\)"):
        elamin.check_law(value, value, hessian, x)
    with pytest.raises(elamin.InputError, match=r"the value must have the shape \(4,\), has \(4, 2, 3\)"):
        elamin.check_law(gradient, gradient, hessian, x)
    with pytest.raises(elamin.InputError, match=r"x must have the shape \(m, sites, 3\), has \(2, 3\)"):
        elamin.check_law(value, gradient, hessian, x[0])


def test_what_moves_in_time_is_refused(tmp_path):
    p = chain(**FORMULA)
    p.copy().check()
    q = chain(**FORMULA)
    q._arrays.density[:] = 1.0
    q.study(type="dynamics").dynamics(timestep=1e-6, steps=2)
    with pytest.raises(elamin.InputError, match="not felt by what moves in time"):
        q.run(tmp_path / "run")


def energies(p):
    return [s.energy for s in p.path(steps=4)]


def test_laws_go_into_processes():
    for law in (FUNCTIONS, FORMULA):
        p = chain(**law)
        assert pickle.loads(pickle.dumps(p)).energy(p.x0 * 1.1) == p.energy(p.x0 * 1.1)
        here = energies(p)
        with concurrent.futures.ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("fork")) as pool:
            assert pool.submit(energies, p).result() == here
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            assert list(pool.map(energies, [p, chain(**law)])) == [here, here]


def test_small_strains_keep_their_digits():
    """Of a translation-invariant law x is relative to the first site: far from the origin a stretch is known by the low words."""
    p = elamin.Problem()
    p.particles([[1e6, 0, 0], [1e6 + 1, 0, 0]], 1.0)
    p.group(name="first", particles=[0]).group(name="last", particles=[1])
    p.support(group="first").support(group="last", directions="yz").load(group="last", force=[2e-11, 0, 0])
    p.law("own", [[0, 1]], formula="(r01 - 1)**2")
    m = elamin.minimise(p, load_factor=1)
    stretch = (m.x - p.x0)[1, 0] + m.state.low[1, 0]
    assert (m.x - p.x0)[1, 0] != stretch and stretch == pytest.approx(1e-11, rel=1e-4)     # of lengths of order one: ε/1e-11


def one_law(**given):
    p = elamin.Problem()
    p.particles(np.random.default_rng(1).standard_normal((12, 3)) * 3, 0.1)
    return p.law(given.pop("name", "own"), given.pop("elements", [[0, 1]]), **given).study(type="energy")


def test_laws_that_cannot_be_are_refused():
    for given, match in ((dict(formula="k*r01", k=np.nan), "law own: k: must be numbers, is nan"),
                         (dict(formula="r01!"), "has factorial; allowed are the functions sqrt"),
                         (dict(value=value, gradient=gradient, hessian=hessian, translation_invarient=True),
                          "translation_invarient: parameters are of a formula")):
        with pytest.raises(elamin.InputError, match=match):
            one_law(**given).energy()
    p = one_law(name="second", formula="r01")
    assert p.energy() > 0
    p.table("study", type="path").table("path", method="arc_length")
    p.curve(of="limit:1", second="path.to", from_=1.0, to=2.0)
    with pytest.raises(elamin.InputError, match='the law "second": there is a column of this name already'):
        p.n


def test_names_that_mean_two_angles_mean_none():
    every = [list(range(12))]
    with pytest.raises(elamin.InputError, match="the formula has c0111"):       # at site 1, or at site 11
        one_law(elements=every, formula="c0111")
    p = one_law(elements=every, formula="c0211 + r1011 + 0*r111")
    a, b, c = p.x0[[0, 2, 11]]
    cosine = (a - b) @ (c - b) / np.linalg.norm(a - b) / np.linalg.norm(c - b)
    assert p.energy() == pytest.approx(cosine + np.linalg.norm(p.x0[10] - p.x0[11]), rel=1e-14)


def test_a_formula_may_be_of_sympy():
    sympy = pytest.importorskip("sympy")
    r, k = sympy.symbols("r01 k")
    assert one_law(formula=k * r**2, k=3.0).energy() == pytest.approx(one_law(formula="k*r01**2", k=3.0).energy(), rel=1e-15)


def test_check_law_says_what_it_cannot_look_at():
    for x, step, match in ((np.full((1, 2, 3), np.nan), None, "x must be finite"), (np.zeros((0, 2, 3)), None, "must have the shape"),
                           (np.ones((1, 2, 3)), 0.0, "step must be a positive number, is 0")):
        with pytest.raises(elamin.InputError, match=match):
            elamin.check_law(value, gradient, hessian, x, step)
