"""Paths one point at a time: the same points as a run, leaving early, Ctrl-C, threads and processes."""
import concurrent.futures
import multiprocessing
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
import warnings

import numpy as np
import pytest

import elamin
from conftest import buckling_load, column, torn


def test_points_are_those_of_a_run(root, program, tmp_path):
    file = root / "problems/hencky_clamped.toml"
    program(file, "-o", tmp_path / "run", "--quiet")
    table = elamin.Run(tmp_path / "run").path
    path = elamin.Problem(file).path()
    steps = list(path)
    assert path.status == "done" and path.message == elamin.Run(tmp_path / "run").message
    assert [s.load_factor for s in steps] == list(table["lambda"])
    assert [s.energy for s in steps] == list(table["energy"])
    assert [s.label for s in steps] == list(table["label"])
    assert [s.stable for s in steps] == list(table["stable"])
    assert [s.number for s in steps] == list(table["step"])
    events = [e for s in steps for e in s.events]
    assert [e.label for e in events] == list(elamin.Run(tmp_path / "run").events["label"])
    assert events[0].kind == "branch" and events[0].multiplicity == 1 and events[0].negative_after == 1
    assert events[0].load_factor == pytest.approx(buckling_load(), rel=1e-9)
    for step in steps:
        assert step.x.shape == (14, 3) and not step.x.flags.writeable and step.x.base is step
        assert step.row["lambda"] == step.load_factor
    [mode] = next(s for s in steps if s.events).modes
    assert mode.shape == (14, 3) and np.linalg.norm(mode) == pytest.approx(1, rel=1e-12)


def test_stages_and_observables(root):
    p = elamin.Problem(root / "problems/two_beams.toml").clear("expect")
    p.path(to=0.3)
    last = list(p.path())[-1]
    middle = p.groups["thin_middle"]
    assert last.row["thin_x"] == pytest.approx((last.x - p.x0)[middle, 0].mean(), abs=1e-15)


def test_x_outlives_its_step():
    xs = [step.x for step in column().path()]
    assert len({x.ctypes.data for x in xs}) == len(xs)
    assert np.abs(xs[-1] - xs[0]).max() > 0


def test_leaving_the_loop_ends_the_work():
    before = threading.active_count()
    threads = len(os.listdir("/proc/self/task"))
    for _ in range(5):
        for step in column(40).path():
            if step.number == 2:
                break
    p = column(40).path()
    next(p)
    p.close()
    with pytest.raises(StopIteration):
        next(p)
    assert threading.active_count() == before
    assert len(os.listdir("/proc/self/task")) <= threads + 8          # no worker is left (OpenMP keeps a few of its own)


def test_a_path_that_ends_early_warns():
    path = torn().path()
    with pytest.warns(elamin.NotConverged, match="the path ended"):
        steps = list(path)
    assert path.status == "not_converged" and path.message
    assert 2 * steps[-1].load_factor == pytest.approx(np.sqrt(2 / np.e), rel=1e-9)        # the limit point


def test_wrong_input_is_raised_by_the_loop():
    with pytest.raises(elamin.InputError, match="path.steps"):
        for _ in column().path(steps=-1):
            pass


PREPARE = """
    import sys, os, signal, threading, time
    sys.path.insert(0, {folder!r})
    import elamin
    from conftest import column
    p = column(120, when_unstable="follow")
    p.path(steps=1000000, to=1.0, points=20000000)
    p.n
    def press():
        time.sleep(1)
        os.kill(os.getpid(), signal.SIGINT)
    threading.Thread(target=press, daemon=True).start()
    began = time.time()
    try:
        {work}
        print("ended by itself")
    except KeyboardInterrupt:
        print("interrupted", time.time() - began < 20)
"""


@pytest.mark.parametrize("work", ["p.run({where!r})", "for s in p.path(): pass", "p.law('own', [[0]], *[lambda x: time.sleep(60)] * 3)",
                                  "elamin.minimise(p, p.x0 + 1e-4 * __import__('numpy').random.default_rng(1).standard_normal(p.x0.shape), "
                                  "method='fire', load_factor=1.0, tolerance=1e-300, max_iterations=1000000)"])
def test_ctrl_c(tmp_path, work):
    if "law" in work:
        work += "; p.energy()"
    text = textwrap.dedent(PREPARE).format(folder=os.path.dirname(__file__), work=work.format(where=str(tmp_path / "run")))
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, encoding="utf-8", timeout=120)
    assert done.stdout.strip().splitlines()[-1] == "interrupted True", done.stdout + done.stderr
    if "run" in work:
        assert elamin.Run(tmp_path / "run").status == "interrupted"


def test_the_lock_is_released_while_solving(tmp_path):
    p = column(60)
    p.path(steps=200)
    p.n
    ticks, stop = [], threading.Event()

    def tick():
        while not stop.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    began = time.perf_counter()
    p.run(tmp_path / "run")
    ended = time.perf_counter()
    stop.set()
    thread.join()
    inside = [t for t in ticks if began < t < ended]
    assert ended - began > 0.05 and len(inside) > 5


def final_energy(particles):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return [s.energy for s in column(particles).path()]


SIZES = [10, 12, 14, 16, 18, 20]


def test_sweeps_over_threads_and_processes_have_the_same_bits():
    alone = [final_energy(n) for n in SIZES]
    column(30).energy()                                              # OpenMP is at work already
    with concurrent.futures.ThreadPoolExecutor(3) as pool:
        assert list(pool.map(final_energy, SIZES)) == alone
    for method in ("fork", "spawn"):
        with concurrent.futures.ProcessPoolExecutor(2, mp_context=multiprocessing.get_context(method)) as pool:
            assert list(pool.map(final_energy, SIZES)) == alone


def test_a_forked_process_works_where_threads_were():
    text = textwrap.dedent("""
        import os, sys
        sys.path.insert(0, {folder!r})
        import numpy as np
        import elamin
        elamin.set_threads(2)
        p = elamin.Problem()
        p.sheet(name="s", shape="rectangle", size=[100, 100], spacing=1.0, youngs_modulus=1.0)
        p.study(type="energy")
        x = p.x0 * 1.01
        e = p.energy(x), p.gradient(x).sum(), p.hessian(x).sum()
        child = os.fork()
        if child == 0:
            os._exit(0 if e == (p.energy(x), p.gradient(x).sum(), p.hessian(x).sum()) else 3)
        print(os.waitpid(child, 0)[1], len(p.x0))
    """).format(folder=os.path.dirname(__file__))
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, encoding="utf-8", timeout=60,
                          env={**os.environ, "OMP_NUM_THREADS": "2"})
    assert done.stdout.split()[0] == "0", done.stdout + done.stderr


def test_one_problem_in_several_threads():
    p = column(40)
    x = p.x0 * 1.001
    expected = p.energy(x), p.gradient(x).tobytes(), p.hessian(x).data.tobytes()

    def look(_):
        return p.energy(x), p.gradient(x).tobytes(), p.hessian(x).data.tobytes()

    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        assert all(found == expected for found in pool.map(look, range(50)))


def test_a_path_left_open_does_not_hang_the_end():
    text = textwrap.dedent("""
        import sys
        sys.path.insert(0, {folder!r})
        from conftest import column
        path = column(40).path()
        next(path)
    """).format(folder=os.path.dirname(__file__))
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, encoding="utf-8", timeout=60)
    assert done.returncode == 0 and done.stderr == ""


def test_a_path_that_several_threads_ask_gives_each_step_once():
    alone = [s.number for s in column().path()]
    for _ in range(3):
        path, found = column().path(), []

        def ask():
            for step in path:
                found.append(step.number)

        threads = [threading.Thread(target=ask, daemon=True) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(30)
        assert not any(thread.is_alive() for thread in threads)
        assert sorted(found) == alone


def test_a_path_that_is_closed_before_it_begins_has_no_steps():
    path = column().path()
    path.close()
    assert list(path) == []
