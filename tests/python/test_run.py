"""Runs and what they leave: the files of the program, as tables."""
import json
import pathlib

import numpy as np
import pytest

import elamin
from conftest import buckling_load, column, torn


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return column().run(tmp_path_factory.mktemp("here") / "run")


def test_tables_have_the_bits_of_the_files(run, program, tmp_path):
    file = tmp_path / "column.toml"
    file.write_text(column().toml())
    program(file, "-o", tmp_path / "run", "--quiet")
    there = elamin.Run(tmp_path / "run")
    for name in ("path.csv", "events.csv", "contacts.csv", "states/branch-1.data"):
        assert (run.directory / name).read_bytes() == (there.directory / name).read_bytes(), name
    lines = (run.directory / "path.csv").read_text().splitlines()
    columns = lines[0].split(",")
    assert list(run.path.columns) == columns and len(run.path) == len(lines) - 1
    cells = [line.split(",") for line in lines[1:]]
    for k, column_name in enumerate(columns):
        values = run.path[column_name]
        for cell, v in zip((c[k] for c in cells), values):
            if isinstance(v, str):
                assert v == cell
            elif isinstance(v, (bool, np.bool_)):
                assert cell == ("true" if v else "false")
            else:
                assert v == float(cell) if cell else np.isnan(v)
    assert run.path["step"].dtype == int and run.path["stable"].dtype == bool and run.path["lambda"].dtype == float
    assert run.status == "done" and run.exit_status == 0 and run.summary == json.loads((run.directory / "summary.json").read_text())


def test_states(run):
    event = run.state("branch:1")
    assert event.load_factor == pytest.approx(buckling_load(), rel=1e-9) == run.events["lambda"][0]
    assert event.x.shape == (14, 3) and len(event.bonds) == 13 and len(event.angles) == 12
    [mode] = event.modes
    assert mode.shape == (14, 3) and np.abs(mode[:, 0]).max() > 0.1
    p = column()
    steps = {s.label: s for s in p.path() if s.label}
    assert (steps["branch:1"].x == event.x).all()
    assert p.energy(event) == pytest.approx(steps["branch:1"].energy, rel=1e-12)
    assert run.state("initial").load_factor == 0 and "branch-1" in run.labels
    with pytest.raises(elamin.InputError, match="there is no state 'limit:7'; there are"):
        run.state("limit:7")


def test_figures_and_pages(run, tmp_path):
    figure = run.plot(y="energy", shapes=["initial", "branch:1"])
    assert "energy" in figure.svg and figure._repr_svg_() == figure.svg
    figure.save(tmp_path / "figure.svg")
    assert (tmp_path / "figure.svg").read_text() == figure.svg
    with pytest.raises(elamin.InputError, match="svg or .pdf"):
        figure.save(tmp_path / "figure.png")
    with pytest.raises(elamin.InputError, match="enrgy"):
        run.plot(y="enrgy")
    page = run.report()
    assert page == run.directory / "report.html" and "<html" in page.read_text()[:300]
    assert "svg" in run._repr_html_() and "done" in repr(run)


def test_temporary_results_live_as_long_as_the_run():
    run = column().run()
    folder = run.directory
    assert folder.exists() and len(run.path) > 50
    del run
    assert not folder.exists()


def test_directories_of_others_are_safe(tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine/thesis.tex").write_text("all of it")
    with pytest.raises(elamin.InputError, match="is not empty and not the results of a run"):
        column().run(tmp_path / "mine")
    p = elamin.Problem(plane="xz")
    p.particles([[0, 0, 0], [1, 0, 0], [2, 0, 0]], 1.0, name="all_of_it")
    p.bonds([[0, 1], [1, 2]], 1.0).angles([[0, 1, 2]], 1.0).group(name="first", ids=[1, 2]).support(group="first")
    p.path(steps=2)
    with pytest.raises(elamin.InputError, match="is not empty and not the results of a run"):
        p.run(tmp_path / "mine")
    assert sorted(f.name for f in (tmp_path / "mine").iterdir()) == ["thesis.tex"]
    run = p.run(tmp_path / "own")
    assert (tmp_path / "own/particles.data").exists()
    assert "no_shape" not in (run.report()).read_text() or run.summary["status"] == "done"
    again = p.run(tmp_path / "own")
    assert again.status == "done" and (tmp_path / "own/particles.data").exists()
    column().run(tmp_path / "own")
    assert not (tmp_path / "own/particles.data").exists()
    assert pathlib.Path(tmp_path / "own/path.csv").exists()


def test_expectations(tmp_path):
    p = column()
    for value in (buckling_load(), 1.0):
        p.expect(observable="lambda", at="branch:1", value=value, rtol=1e-9)
    run = p.run(tmp_path / "run")
    assert [met for met, _ in run.verdicts] == [True, False]
    assert "expected" in run.verdicts[1][1] or "1" in run.verdicts[1][1]


def test_a_run_that_does_not_converge_warns(tmp_path):
    p = torn()
    with pytest.warns(elamin.NotConverged, match="the run ended"):
        run = p.run(tmp_path / "run")
    assert run.exit_status == 2 and run.status == "not_converged"


def test_sweeps_of_a_problem(tmp_path):
    p = column()
    p.clear("group").group(name="bottom", of="column", first=2).group(name="top", of="column", last=2)
    p.group(name="tip", of="column", last=2)
    p.clear("load").load(group="tip", total_force=[0, 0, -1])
    p.sweep(key="beam.column.particles", values=[14, 16])
    run = p.run(tmp_path / "run")
    assert list(run.sweep["beam.column.particles"]) == [14, 16]
    assert len(run.runs) == 2 and run.runs[0].events["lambda"][0] == run.sweep["branch:1"][0]


def test_modes_and_motions(tmp_path, root):
    p = column().study(type="modes").table("modes", count=3).clear("path").clear("load")
    run = p.run(tmp_path / "modes")
    assert len(run.modes) == 3
    swing = elamin.Problem(root / "problems/grain_bounces.toml").run(tmp_path / "motion")
    assert "time" in swing.trajectory.columns


def test_progress_is_told(capfd):
    column().run(progress=True)
    out = capfd.readouterr().out
    assert "branch:1" in out and "written:" in out
    column().run()
    assert capfd.readouterr().out == ""


@pytest.mark.parametrize("name", ["middle", "first", "second", "id", "kind", "name", "open"])
def test_what_is_observed_keeps_its_numbers_whatever_it_is_called(name):
    p = column()
    p.observe(name=name, group="tip", quantity="displacement.z").path(steps=3)
    rows = [step.row[name] for step in p.path()]
    run = p.run()
    assert list(run.path[name]) == rows and run.path[name].dtype == float
    assert any(v != round(v) for v in rows)
    assert run.state("initial").bonds["first"].dtype == int


def test_where_a_curve_ends_in_a_sweep_is_no_integer(root):
    p = elamin.Problem(root / "problems/truss_curve.toml").clear("expect")
    p.set("curve.to", 74.25).set("curve.stops", [74.5]).set("curve.steps", 2)
    p.sweep(key="path.steps", values=[50, 60])
    assert list(p.run().sweep["second"]) == pytest.approx([74.25, 74.25], rel=1e-12)


def test_temporary_results_are_not_handed_to_other_processes(tmp_path):
    import copy
    import pickle

    run = column().run()
    assert copy.copy(run).directory == run.directory
    with pytest.raises(elamin.InputError, match="give it a directory"):
        pickle.dumps(run)
    kept = pickle.loads(pickle.dumps(column().run(tmp_path / "run")))
    assert kept.status == "done" and kept.directory == tmp_path / "run"


def test_what_a_directory_has_no_summary_of_is_told(tmp_path):
    p = column().clear("load").study(type="energy")
    p.sweep(key="beam.column.youngs_modulus", values=[1e6, 2e6])
    run = p.run(tmp_path / "sweep")
    with pytest.raises(elamin.InputError, match="it is a sweep, whose `runs` have one each"):
        run.status
    assert "sweep" in repr(run) and [r.status for r in run.runs] == ["done", "done"]


def test_shapes_may_be_one_word(run):
    assert run.plot(shapes="initial").svg == run.plot(shapes=["initial"]).svg
    assert run.plot(shapes="initial,branch:1").svg == run.plot(shapes=["initial", "branch:1"]).svg
