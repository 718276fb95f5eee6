"""How a problem is put together, and what is told of wrong ones."""
import pickle

import numpy as np
import pytest

import elamin
from conftest import buckling_load, column


def test_file_dict_and_methods_are_one(root):
    import tomllib

    file = root / "problems/hencky_clamped.toml"
    by_file = elamin.Problem(file)
    by_dict = elamin.Problem(tomllib.loads(file.read_text()))
    by_path = elamin.Problem(str(file), settings={"path.steps": 50})
    by_methods = column()
    assert by_dict.tables == by_file.tables
    for p in (by_dict, by_path, by_methods):
        assert (p.x0 == by_file.x0).all() and p.dofs == by_file.dofs
        x = by_file.x0 * (1 + 1e-3)
        assert p.energy(x, 0.01) == by_file.energy(x, 0.01)
    again = elamin.Problem(tomllib.loads(by_methods.toml()))
    assert again.tables == by_methods.tables


def test_tables_as_toml_read_back(root):
    import tomllib

    files = [*(root / "tests/input/good").glob("*.toml"), *(root / "problems").glob("*.toml")]
    assert len(files) > 50
    for file in files:
        p = elamin.Problem(file)
        written = tomllib.loads(file.read_text(encoding="utf-8"))
        assert tomllib.loads(p.toml()) == p.tables, file
        assert p.tables == written or "input" in written.get("lammps", {}), file      # a LAMMPS script is more tables


def test_arrays_make_what_a_beam_makes():
    by_beam = column()
    n, d, E = 14, 1e-3, 0.96e6
    p = elamin.Problem(plane="xz")
    i = p.particles(by_beam.x0, d, name="column")
    assert (i == np.arange(n)).all()
    p.bonds(np.column_stack([i[:-1], i[1:]]), np.pi * E * d / 8, d)
    p.angles(np.column_stack([i[:-2], i[1:-1], i[2:]]), np.pi * E * d**3 / 64)
    p.group(name="bottom", particles=i[:2]).group(name="top", particles=i[-2:]).group(name="tip", particles=[n - 2])
    p.support(group="bottom").support(group="top", directions="x").load(group="tip", total_force=[0, 0, -1])
    x = by_beam.x0 * (1 + 1e-3 * np.arange(n)[:, None])
    for term, value in by_beam.terms(x, 0.01).items():
        assert p.terms(x, 0.01)[term] == pytest.approx(value, rel=1e-12, abs=1e-25)
    assert (p.groups["tip"] == [12]).all()
    p.path(method="arc_length", steps=20, to=0.02)
    first = next(s for s in p.path() if s.events)
    assert first.label == "branch:1" and first.load_factor == pytest.approx(buckling_load(), rel=1e-9)


def test_stiffnesses_may_be_of_each():
    p = elamin.Problem()
    p.particles([[0, 0, 0], [1, 0, 0], [3, 0, 0]], [1.0, 1.0, 2.0])
    p.bonds([[0, 1], [1, 2]], [1.0, 10.0], [0.5, 1.0])
    p.bonds([[0, 2]], 100.0)                              # as built
    p.angles([[0, 1, 2]], 3.0, 90.0)
    p.study(type="energy")
    assert p.terms()["bond"] == pytest.approx(1.0 * 0.25 + 10.0 * 1.0, rel=1e-15)
    assert p.terms()["angle"] == pytest.approx(3.0 * (1 - np.cos(np.pi - np.pi / 2)), rel=1e-15)
    assert (p.diameters == [1, 1, 2]).all()


def test_mistakes_of_a_file_have_their_places(tmp_path):
    file = tmp_path / "wrong.toml"
    file.write_text('[[beam]]\nname = "a"\nparticles = 3\ndiametre = 1\n[path]\nsteps = 0\n')
    with pytest.raises(elamin.InputError) as caught:
        elamin.Problem(file).check()
    mistakes = caught.value.mistakes
    assert [(m.line, m.key) for m in mistakes if m.key == "beam.a.diametre"] == [(4, "beam.a.diametre")]
    assert any(m.key == "path.steps" and m.line == 6 and m.file == str(file) for m in mistakes)
    assert str(caught.value).count("\n") == len(mistakes) - 1
    assert isinstance(caught.value, ValueError)
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again) == str(caught.value) and again.mistakes == mistakes


def test_mistakes_of_a_dict_have_their_keys():
    p = elamin.Problem({"beam": [{"name": "a", "particles": 3, "from": [0, 0, 0], "to": [2, 0, 0], "diameter": -1, "youngs_modulus": 1}],
                        "path": {"stepps": 3}})
    with pytest.raises(elamin.InputError) as caught:
        p.n
    assert "beam.a.diameter: must be a positive number, is -1" in str(caught.value).splitlines()
    assert "path.stepps: unknown key" in str(caught.value)
    assert "--set" not in str(caught.value)
    assert {m.key for m in caught.value.mistakes} >= {"beam.a.diameter", "path.stepps"}
    assert "mistakes" in repr(p)
    with pytest.raises(elamin.InputError, match="holds no structure"):
        elamin.Problem({}).n
    with pytest.raises(elamin.InputError, match="beam.thing: must be a string, a number, a list or a dict"):
        elamin.Problem({"beam": [{"thing": object()}]})
    with pytest.raises(elamin.InputError, match="nowhere/no.toml: "):
        elamin.Problem("nowhere/no.toml")
    endless = []
    endless.append(endless)
    for wrong, what in ((endless, "is nested too deeply"), (2**70, "is an integer that is too large"), ("\ud800", "is no text in UTF-8")):
        with pytest.raises(elamin.InputError, match="beam.name: .*" + what):
            elamin.Problem({"beam": [{"name": wrong}]})


def test_mutated_tables_are_read_or_refused(root):
    """Nothing but an InputError, whatever stands in a dict."""
    import copy
    import random
    import tomllib

    rng = random.Random(1)
    junk = [None, True, -1, 0, 1e300, float("nan"), float("inf"), "", "x" * 100, "\x00", [], [[]], {}, [1, 2, 3], {"a": 1},
            np.float32(1.5), np.int64(3), np.zeros((2, 3)), 2**70, b"bytes", object(), (1, 2), "all", -0.0]
    files = sorted((root / "tests/input/good").glob("*.toml"))
    tables = [tomllib.loads(f.read_text(encoding="utf-8")) for f in files]
    refused = 0
    for _ in range(300):
        node = changed = copy.deepcopy(rng.choice(tables))
        while True:
            keys = list(node) if isinstance(node, dict) else list(range(len(node)))
            key = rng.choice(keys)
            if isinstance(node[key], (dict, list)) and node[key] and rng.random() < 0.8:
                node = node[key]
                continue
            node[key] = rng.choice(junk)
            break
        try:
            elamin.Problem(changed, folder=root / "tests/input/good").n
        except elamin.InputError as error:
            refused += 1
            assert str(error) and error.mistakes
    assert 100 < refused < 300


def test_wrong_arrays_are_refused():
    def fails(match, **given):
        p = elamin.Problem()
        x = given.pop("x", np.eye(3) * 3)
        with pytest.raises(elamin.InputError, match=match):
            p.particles(x, given.pop("diameter", 1.0))
            p.bonds(given.pop("pairs", [[0, 1]]), given.pop("K", 1.0), given.pop("r0", None))
            p.angles(given.pop("triples", [[0, 1, 2]]), 1.0, given.pop("rest", 180))
            p.n

    fails(r"x must have the shape \(n, 3\)", x=np.zeros((3, 2)))
    fails("x must be finite", x=np.full((3, 3), np.inf))
    fails("diameter: must be positive", diameter=[1.0, 0.0, 1.0])
    fails("diameter: must be one number, or 3", diameter=[1.0, 1.0])
    fails("there is no particle 3", pairs=[[0, 3]])
    fails("there is no particle -1", pairs=[[0, -1]])
    fails("one particle twice", pairs=[[1, 1]])
    fails("there is no particle -1", triples=[[-1, 0, 1]])
    fails("pairs: must be integers", pairs=[[0.5, 1]])
    fails("pairs: must be integers", pairs=[[True, False]])
    fails(r"pairs: must have the shape \(m, 2\), has \(1, 3\)", pairs=[[0, 1, 2]])
    for wrong, match in (([-1], "group: particles: there is no particle -1"), ([0.5], "group: particles: must be integers"),
                         ([True, False], "group: particles: must be integers")):
        with pytest.raises(elamin.InputError, match=match):
            column().group(name="g", particles=wrong)
    fails("stiffness: must be not negative", K=-1.0)
    fails("rest_length: must be positive", r0=0.0)
    fails("one particle twice", triples=[[0, 1, 0]])
    fails("at most 180", rest=181)


def test_particles_do_not_go_with_a_data_file(root):
    p = elamin.Problem()
    p.lammps(data="x.data")
    p.particles([[0, 0, 0]], 1.0)
    with pytest.raises(elamin.InputError, match="do not go with a .lammps. data file"):
        p.n
    with pytest.raises(elamin.InputError, match="give ids"):
        p.group(name="g", particles=[0])


def test_files_of_a_dict_are_sought_from_its_folder(tmp_path):
    (tmp_path / "grains.csv").write_text("0,0,0,1\n3,0,0,1\n")
    tables = {"grains": [{"name": "g", "file": "grains.csv"}], "study": {"type": "energy"}}
    assert elamin.Problem(tables, folder=tmp_path).n == 2
    with pytest.raises(elamin.InputError, match='there is no file "grains.csv"'):
        elamin.Problem(tables, folder=tmp_path / "..").n


def test_keys_are_changed_and_copies_are_apart():
    p = column()
    q = p.copy().set("beam.column.particles", 20).set("support.1.directions", "xz")
    assert (p.n, q.n) == (14, 20)
    q.set("group.tip.ids", [19])
    assert q.n == 20 and (q.groups["tip"] == [18]).all()
    with pytest.raises(elamin.InputError, match="path.stepps"):
        p.set("path.stepps", 3).n
    r = pickle.loads(pickle.dumps(q))
    assert r.energy(q.x0 * 1.01, 0.3) == q.energy(q.x0 * 1.01, 0.3)


def test_tables_that_cannot_be_are_not_cleared():
    p = column()
    p.clear("expect").clear("load")
    assert "load" not in p.tables
    with pytest.raises(elamin.InputError, match='clear: "laod" is no table; allowed: title, .*; did you mean "load"'):
        p.clear("laod")


def test_what_check_says_and_pictures():
    p = column()
    assert "14 particles, 13 bonds, 12 angles" in p.check()
    svg = p.picture().svg
    assert svg.startswith("<svg") or svg.startswith("<?xml")
    assert svg.rstrip().endswith("</svg>") and svg in p._repr_html_()
    assert "column" in repr(p) and "14 particles" in repr(p)
    wrong = elamin.Problem({"beam": [{"name": "<b>"}]})
    assert "<b>" not in wrong._repr_html_().replace("<pre>", "").replace("<p>", "")


def test_every_table_has_a_method():
    import json

    schema = json.loads(elamin.json_schema())["properties"]
    for table, spec in schema.items():
        if spec.get("type") not in ("array", "object"):
            continue
        assert callable(getattr(elamin.Problem, table)), table
        assert getattr(elamin.Problem, table).__doc__


def test_bonds_and_angles_join_structures_too():
    def beams(first):
        p = elamin.Problem()
        if first:
            p.particles([[0, 0, 5], [1, 0, 5]], 1.0)
        for k in range(2):
            p.beam(name=f"b{k}", section="square", particles=4, center=[0, 3.0 * k, 0], axis=[1, 0, 0], diameter=1.0, youngs_modulus=1.0)
        p.study(type="energy")
        return p

    for first in (False, True):
        p = beams(first)
        n = 2 if first else 0
        before = p.terms()
        p.bonds([[n, n + 4], [n + 1, n + 5]], [2.0, 3.0], [1.0, 2.0]).bonds([[n + 2, n + 6]], 7.0)      # as built
        p.angles([[n, n + 4, n + 5]], 3.0, 180.0)
        after = p.terms()
        assert p.n == 8 + n
        assert after["bond"] - before["bond"] == pytest.approx(2 * 2.0**2 + 3 * 1.0, rel=1e-12)
        assert after["angle"] - before["angle"] == pytest.approx(3.0, rel=1e-12)      # B (1 + cos θ) of a right angle
        if first:                                         # one of each, and among the first ones
            p.bonds([[0, 1], [1, 2]], 1.0, [0.5, 4.0])
            r = np.linalg.norm(p.x0[2] - p.x0[1])
            assert p.terms()["bond"] - after["bond"] == pytest.approx(0.25 + (r - 4) ** 2, rel=1e-12)
        with pytest.raises(elamin.InputError, match="no id of a particle"):
            beams(first).bonds([[0, 8 + n]], 1.0, 1.0).n
        with pytest.raises(elamin.InputError, match="bonds: pairs: there is no particle -1"):
            beams(first).bonds([[-1, 1]], 1.0, 1.0)


def test_copies_of_all_kinds_are_apart():
    import copy

    for copied in (copy.copy, copy.deepcopy, elamin.Problem.copy):
        p = elamin.Problem()
        p.particles([[0, 0, 0], [1, 0, 0]], 1.0)
        p.bonds([[0, 1]], 1.0).study(type="energy")
        q = copied(p)
        q.particles([[5, 0, 2]], 1.0)
        q.bonds([[1, 2]], 1.0, 1.0).law("own", [[2]], formula="z0**2")
        assert (q.n, p.copy().n, pickle.loads(pickle.dumps(p)).n) == (3, 2, 2)
        assert "own" in q.terms() and "own" not in p.terms()
        p.law("own", [[0]], formula="z0**2")


def test_weights_and_motions_need_densities(tmp_path):
    def grains(density):
        p = elamin.Problem()
        p.particles([[0, 0, 0]], 1.0, density=2.0, name="heavy")
        p.particles([[3, 0, 0]], 1.0, density=density, name="other")
        return p

    def energy_of(group, density):
        p = grains(density).gravity(group=group, acceleration=[0, 0, -1]).study(type="energy")
        return p.gradient()[:, 2]

    sphere = np.pi / 6
    assert list(energy_of("all", 3.0)) == pytest.approx([2 * sphere, 3 * sphere], rel=1e-15)
    assert list(energy_of("heavy", None)) == pytest.approx([2 * sphere, 0], rel=1e-15)
    for group in ("all", "other"):
        with pytest.raises(elamin.InputError, match="particles: density: is missing of particle 1; gravity.1 needs it"):
            energy_of(group, None)
    p = grains(None).gravity(group="other", acceleration=[0, 0, -1]).support(group="all").table("path", steps=1)
    with pytest.raises(elamin.InputError, match="density: is missing of particle 1"):
        p.run(tmp_path / "run")
    assert not (tmp_path / "run").exists()
    with pytest.raises(elamin.InputError, match="density: is missing of particle 1; dynamics needs it"):
        grains(None).dynamics(timestep=0.1, steps=1).n


def test_arrays_that_are_no_real_numbers_are_refused():
    p = column()
    for wrong in ("abc", [[1, 2, 3], [1]], p.x0 + 1j, np.full((14, 3), "x")):
        with pytest.raises(elamin.InputError, match="x: must be an array of real numbers"):
            p.energy(wrong)
        with pytest.raises(elamin.InputError, match="particles: x: must be an array of real numbers"):
            elamin.Problem().particles(wrong, 1.0)
    for width in (0, -3, np.nan):
        with pytest.raises(elamin.InputError, match="width: must be a number of points above 6"):
            p.picture(width=width)
