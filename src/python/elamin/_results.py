"""What a run leaves, as pandas tables, states and figures."""
from __future__ import annotations

import json
import os
import pathlib
import tempfile
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from ._elamin import figure as _figure
from ._elamin import report_page as _report_page
from ._elamin import write_pdf as _write_pdf
from ._errors import InputError

if TYPE_CHECKING:
    import pandas as pd

Floats = NDArray[np.float64]
_WORDS = ("label", "parent", "stage", "status", "what", "zero_mode", "kind", "name", "shape", "open")
_WHOLE = ("step", "branch", "iterations", "negative", "negative_rigid", "multiplicity")
_WHOLE_OF_STATES = ("id", "first", "second", "middle", "third")
_OBSERVED = ("path.csv", "events.csv", "trajectory.csv", "sweep.csv", "curve.csv", "landscape.csv")


def read_table(file: Union[str, "os.PathLike[str]"]) -> "pd.DataFrame":
    """A CSV table of elamin: numbers to the last bit, words as strings, empty numbers as NaN.

    What is observed may be called like a column of another table, "middle" or "kind": its numbers stay what they are.
    """
    import pandas as pd

    table = pd.read_csv(file, float_precision="round_trip", keep_default_na=False, na_values={}, dtype=str)
    whole = _WHOLE if pathlib.Path(file).name in _OBSERVED else _WHOLE + _WHOLE_OF_STATES
    for column in table.columns:
        values = table[column]
        if column in _WORDS and not values.any():
            continue
        if values.isin(["true", "false"]).all() and len(values):
            table[column] = values == "true"
            continue
        try:
            table[column] = pd.Series([float(v) if v else np.nan for v in values], index=table.index, dtype=float)
        except ValueError:
            continue
        numbers = table[column]
        if column in whole and len(numbers) and (numbers == numbers.round()).all():
            table[column] = numbers.astype(int)
    return table


class Figure:
    """A figure as SVG; a notebook shows it."""

    def __init__(self, svg: str) -> None:
        self.svg = svg

    def _repr_svg_(self) -> str:
        return self.svg

    def save(self, file: Union[str, "os.PathLike[str]"]) -> None:
        """Writes it as FILE.svg, or FILE.pdf (by rsvg-convert)."""
        name = os.fspath(file)
        if name.endswith(".pdf"):
            _write_pdf(self.svg, name)
        elif name.endswith(".svg"):
            pathlib.Path(name).write_text(self.svg, encoding="utf-8")
        else:
            raise InputError(f"{name}: a figure is an SVG or a PDF; a name that ends in .svg or .pdf is needed")


class StoredState:
    """A state that a run has kept.

    Attributes:
        label: "initial", "final", "limit:1", …
        particles: table with id, kind, x, y, z, radius, energy, contact force; of bodies too.
        load_factor: NaN where it is not known.
    """

    def __init__(self, stem: pathlib.Path, label: str) -> None:
        self._stem, self.label = stem, label
        self.particles = read_table(f"{stem}.particles.csv")
        try:
            self.load_factor = float(json.loads(pathlib.Path(f"{stem}.json").read_text(encoding="utf-8"))["lambda"])
        except (OSError, KeyError, ValueError):
            self.load_factor = float("nan")

    @property
    def x(self) -> Floats:
        """Positions of the particles (n, 3) [length]."""
        particles = self.particles[self.particles["kind"] != "body"]
        return np.ascontiguousarray(particles[["x", "y", "z"]].to_numpy(dtype=float))

    def _table(self, name: str) -> "pd.DataFrame":
        import pandas as pd

        file = f"{self._stem}.{name}.csv"
        return read_table(file) if os.path.exists(file) else pd.DataFrame()

    @property
    def bonds(self) -> "pd.DataFrame":
        """first, second (ids), length, strain, tension."""
        return self._table("bonds")

    @property
    def angles(self) -> "pd.DataFrame":
        """first, middle, third (ids), turn, curvature, moment."""
        return self._table("angles")

    @property
    def modes(self) -> List[Floats]:
        """Of an event its null vectors, (n, 3) each."""
        table = self._table("modes")
        n = len(self.x)
        found: List[Floats] = []
        while f"ux{len(found) + 1}" in table.columns:
            k = len(found) + 1
            found.append(table[[f"ux{k}", f"uy{k}", f"uz{k}"]].to_numpy(dtype=float)[:n])
        return found

    def __repr__(self) -> str:
        return f"<elamin.StoredState {self.label!r} at load factor {self.load_factor:.7g}: {len(self.x)} particles>"


class Run:
    """A run's results, in its directory: one that is there, or what Problem.run gives."""

    def __init__(self, directory: Union[str, "os.PathLike[str]"], exit_status: Optional[int] = None,
                 verdicts: Sequence[Tuple[bool, str]] = (), _keep: object = None) -> None:
        self.directory = pathlib.Path(directory)
        self.exit_status = exit_status
        self.verdicts: List[Tuple[bool, str]] = list(verdicts)
        self._keep = _keep                                 # a temporary directory lives as long as this
        if not self.directory.is_dir():
            raise InputError(f"{directory}: there is no such directory")

    def __copy__(self) -> "Run":
        return Run(self.directory, self.exit_status, self.verdicts, self._keep)

    def __getstate__(self) -> Dict[str, Any]:
        if self._keep is not None:                         # another process would find nothing there
            raise InputError(f"{self.directory}: these results are temporary and gone with this process's Run; to hand a run to another "
                             "process, give it a directory: p.run(\"results\")")
        return dict(self.__dict__)

    def _table(self, name: str) -> "pd.DataFrame":
        file = self.directory / name
        if not file.exists():
            raise InputError(f"{self.directory}: this run has left no {name}")
        return read_table(file)

    @property
    def path(self) -> "pd.DataFrame":
        """A row per equilibrium: step, label, lambda, energy and its terms, residual, stable, what is observed."""
        return self._table("path.csv")

    @property
    def events(self) -> "pd.DataFrame":
        """A row per event: label, lambda, multiplicity, Morse index on both sides, what happened."""
        return self._table("events.csv")

    @property
    def contacts(self) -> "pd.DataFrame":
        """Of every labelled state each closed contact."""
        return self._table("contacts.csv")

    @property
    def trajectory(self) -> "pd.DataFrame":
        """Of a motion in time its rows."""
        return self._table("trajectory.csv")

    @property
    def modes(self) -> "pd.DataFrame":
        """Of a study of modes the eigenvalues."""
        return self._table("modes.csv")

    @property
    def sweep(self) -> "pd.DataFrame":
        """Of a sweep a row per run."""
        return self._table("sweep.csv")

    @property
    def runs(self) -> List["Run"]:
        """Of a sweep its runs."""
        found = sorted(d.parent for d in self.directory.glob("*/resolved.toml"))
        return [Run(d, _keep=self._keep) for d in found]

    @property
    def summary(self) -> Dict[str, Any]:
        """summary.json: status, message, warnings, events, final, times, version."""
        file = self.directory / "summary.json"
        if not file.exists():
            more = "; it is a sweep, whose `runs` have one each" if (self.directory / "sweep.csv").exists() else ""
            raise InputError(f"{self.directory}: there is no summary.json{more}")
        text = file.read_text(encoding="utf-8")
        found: Dict[str, Any] = json.loads(text)
        return found

    @property
    def status(self) -> str:
        """ "done", "not_converged" or "interrupted"."""
        return str(self.summary["status"])

    @property
    def message(self) -> str:
        return str(self.summary["message"])

    @property
    def labels(self) -> List[str]:
        """Of the states that it has kept."""
        names = sorted((self.directory / "states").glob("*.particles.csv"))
        return [n.name[: -len(".particles.csv")] for n in names]

    def state(self, label: str) -> StoredState:
        """The state of a label: "initial", "final", "limit:1", …"""
        stem = self.directory / "states" / str(label).replace(":", "-")
        if not pathlib.Path(f"{stem}.particles.csv").exists():
            raise InputError(f"{self.directory}: there is no state {label!r}; there are {', '.join(self.labels)}")
        return StoredState(stem, label)

    def plot(self, x: str = "", y: str = "", shapes: Sequence[str] = (), diagram: bool = True) -> Figure:
        """A figure of it, as `elamin plot` makes it.

        Args:
            x, y: columns; by default the load factor and what is observed first.
            shapes: labels of states to draw below the diagram, a list or with commas between them.
            diagram: False: the states alone.
        """
        labels = shapes.split(",") if isinstance(shapes, str) else list(shapes)
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "figure.svg")
            _figure(str(self.directory), x, y, labels, diagram, file)
            return Figure(pathlib.Path(file).read_text(encoding="utf-8"))

    def report(self, file: Union[str, "os.PathLike[str]", None] = None) -> pathlib.Path:
        """Writes one HTML page of it (by default report.html into its directory), to look at in a browser, and says where."""
        path = pathlib.Path(file) if file is not None else self.directory / "report.html"
        path.write_text(_report_page([str(self.directory)]), encoding="utf-8")
        return path

    def _repr_html_(self) -> str:
        try:
            picture = self.plot().svg
        except InputError:
            picture = ""
        return f"<p>{_escaped(repr(self))}</p>{picture}"

    def __repr__(self) -> str:
        try:
            return f"<elamin.Run {str(self.directory)!r}: {self.status}, {self.message}>"
        except (OSError, KeyError, ValueError):
            return f"<elamin.Run {str(self.directory)!r}>"


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
