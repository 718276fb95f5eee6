"""The types: of the package, and as its users see them."""
import pathlib
import subprocess

import elamin

PACKAGE = pathlib.Path(elamin.__file__).parent
HERE = pathlib.Path(__file__).parent
MYPY = ["/usr/bin/mypy" if pathlib.Path("/usr/bin/mypy").exists() else "mypy", "--config-file", str(HERE / "mypy.ini")]


def mypy(*files, cwd):
    return subprocess.run([*MYPY, *map(str, files)], capture_output=True, encoding="utf-8", cwd=cwd)


def test_the_package_is_typed(tmp_path):
    assert (PACKAGE / "py.typed").exists() and (PACKAGE / "_elamin.pyi").exists()
    right = tmp_path / "right.py"
    right.write_text(
        "import elamin\n"
        "import numpy as np\n"
        "p = elamin.Problem('x.toml', settings={'path.steps': 3}).beam(name='b', particles=4, from_=[0, 0, 0], section='square')\n"
        "e: float = p.energy(p.x0, 0.5)\n"
        "for step in p.path(steps=4):\n"
        "    factor: float = step.load_factor\n"
        "    label: str = step.events[0].label\n"
        "m = elamin.minimise(p, np.zeros((3, 3)), method='newton')\n"
        "ok: bool = m.converged\n"
        "run = p.run(progress=True)\n"
        "name: str = run.state('final').label\n")
    wrong = tmp_path / "wrong.py"
    wrong.write_text("import elamin\n"
                     "p = elamin.Problem('x.toml')\n"
                     "p.beam(name=3)\n"
                     "p.beam(section='round')\n"
                     "p.beam(particels=3)\n"
                     "e: str = p.energy()\n"
                     "p.nonsense()\n"
                     "next(p.path()).events[0].lable\n")
    done = mypy(PACKAGE, right, wrong, cwd=PACKAGE.parent)
    found = [line for line in done.stdout.splitlines() if ": error: " in line]
    assert {int(line.split("wrong.py:")[1].split(":")[0]) for line in found if "wrong.py" in line} == {3, 4, 5, 6, 7, 8}, done.stdout
    assert all("wrong.py" in line for line in found), done.stdout


def test_the_stub_has_what_the_module_has():
    from elamin import _elamin

    stub = (PACKAGE / "_elamin.pyi").read_text()
    for name, thing in vars(_elamin).items():
        if name.startswith("_"):
            continue
        assert f"class {name}" in stub or f"def {name}(" in stub or f"{name}: " in stub, name
        if isinstance(thing, type):
            for member in vars(thing):
                if not member.startswith("_"):
                    assert f"def {member}(" in stub or f"    {member}: " in stub, f"{name}.{member}"
