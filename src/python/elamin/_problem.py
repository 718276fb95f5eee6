"""A problem: from a file, a dict, or put together; its energy, equilibria, paths and runs."""
from __future__ import annotations

import atexit
import os
import pathlib
import tempfile
import threading
import warnings
import weakref
from typing import TYPE_CHECKING, Any, Dict, Iterator, List, Mapping, NamedTuple, Optional, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _elamin
from ._elamin import Document, Law, Minimum, Mode, PathIterator, Stability, State, Step, System
from ._errors import InputError, NotConverged
from ._law import Function, from_formula, from_functions
from ._particles import Arrays, numbers_of_particles, real_numbers
from ._results import Figure, Run, StoredState, _escaped
from ._tables import MANY, Tables

if TYPE_CHECKING:
    from scipy.sparse import csr_matrix

Floats = NDArray[np.float64]
Where = Union[ArrayLike, State, Step, Minimum, StoredState, None]
PathLike = Union[str, "os.PathLike[str]"]


class Event(NamedTuple):
    """Something that happens on a path: "limit:1", "branch:1", "contact:1", "jump:1", or an [[event]]."""

    label: str
    kind: str
    load_factor: float
    multiplicity: int
    negative_before: int
    negative_after: int
    what: str


def _events(step: Step) -> Tuple[Event, ...]:
    if not step.is_event:
        return ()
    kind = step.label.split(":")[0]
    return (Event(step.label, kind, step.load_factor, step.multiplicity, step.negative_before, step.negative_after, step.what),)


def _repr(step: Step) -> str:
    label = f" {step.label}" if step.label else ""
    stable = "stable" if step.stable else "unstable"
    return f"<elamin.Step {step.number}{label}: load factor {step.load_factor:.10g}, energy {step.energy:.7g}, {stable}>"


setattr(Step, "events", property(_events, doc="What happens here: at most one Event."))
setattr(Step, "__repr__", _repr)


class Path:
    """The equilibria of a path, found one by one as the loop asks for them.

    Leaving the loop stops the work. A path that ends before its end warns (NotConverged).

    Attributes:
        status: behind its end "done", "not_converged" or "interrupted", else "".
        message: how it ended, in a sentence.
        notes: what is to be known of it, in sentences.
    """

    _all: "weakref.WeakSet[Path]" = weakref.WeakSet()

    def __init__(self, problem: "Problem") -> None:
        self._problem = problem
        self._iterator: Optional[PathIterator] = None
        self._starting = threading.Lock()
        self._closed = False
        Path._all.add(self)

    def __iter__(self) -> Iterator[Step]:
        return self

    def __next__(self) -> Step:
        with self._starting:
            if self._iterator is None:
                if self._closed:
                    raise StopIteration
                self._iterator = PathIterator(self._problem._system())
        try:
            return self._iterator.next()
        except StopIteration:
            if self.status == "not_converged":
                warnings.warn(f"the path ended: {self.message}", NotConverged, stacklevel=2)
            raise

    @property
    def status(self) -> str:
        return self._iterator.status if self._iterator else ""

    @property
    def message(self) -> str:
        return self._iterator.message if self._iterator else ""

    @property
    def notes(self) -> List[str]:
        return list(self._iterator.notes) if self._iterator else []

    def close(self) -> None:
        """Stops the work."""
        self._closed = True
        if self._iterator is not None:
            self._iterator.close()


@atexit.register
def _close_paths() -> None:
    for path in list(Path._all):
        path.close()


class _LawSource(NamedTuple):
    """What a law is made of, so that it can be copied into another process."""

    name: str
    elements: Any
    value: Optional[Function]
    gradient: Optional[Function]
    hessian: Optional[Function]
    formula: Optional[str]
    translation_invariant: bool
    parameters: Dict[str, Any]

    def law(self) -> Law:
        if self.formula is not None:
            return from_formula(self.name, self.elements, self.formula, self.parameters)
        if self.value is None or self.gradient is None or self.hessian is None:
            raise InputError(f"law {self.name}: give value, gradient and hessian, or a formula")
        return from_functions(self.name, self.elements, self.value, self.gradient, self.hessian, self.translation_invariant)


class Problem(Tables):
    """A problem of elamin: structures, how they are held and loaded, and what is asked.

    Args:
        source: a problem file (TOML), or its tables as a dict; without it an empty one, to which methods add tables.
        folder: of files that a dict's tables name; by default the working directory.
        settings: keys to change, as {"path.steps": 50}; like --set of the program.
        title, plane: what stands before the first table.

    Each method of a table's name (beam, sheet, support, …) adds one, its keys as keywords; `from` is `from_`. Wrong input raises InputError
    with all mistakes when the problem is first used.
    """

    def __init__(self, source: Union[PathLike, Mapping[str, Any], None] = None, *, folder: Optional[PathLike] = None,
                 settings: Optional[Mapping[str, object]] = None, title: Optional[str] = None, plane: Optional[str] = None) -> None:
        name = os.path.join(os.fspath(folder), "problem") if folder is not None else "problem"
        if source is None:
            self._document = Document({}, name)
        elif isinstance(source, Mapping):
            self._document = Document(dict(source), name)
        else:
            self._document = Document.read(os.fspath(source))
        self._arrays = Arrays()
        self._laws: List[_LawSource] = []
        self._folder: Optional["tempfile.TemporaryDirectory[str]"] = None
        self._built: Optional[System] = None
        self._made: List[Law] = []
        if title is not None or plane is not None:
            self._document.update("", {"title": title, "plane": plane})
        for key, value in (settings or {}).items():
            self.set(key, value)

    # ---- tables

    def table(self, name: str, /, **keys: object) -> "Problem":
        """Adds a table of that name, or to a single one ([path], [solver], …) these keys."""
        values = {key[:-1] if key.endswith("_") else key: value for key, value in keys.items()}
        if name in MANY:
            self._document.append(name, values)
        else:
            self._document.update(name, values)
        self._built = None
        return self

    def set(self, key: str, value: object) -> "Problem":
        """Changes one key, named as --set of the program has it: "path.steps", "beam.column.particles", "support.2.displacement"."""
        self._document.set(key, value)
        self._built = None
        return self

    def clear(self, name: str) -> "Problem":
        """Takes all tables of that name away, as "expect"."""
        self._document.erase(name)
        self._built = None
        return self

    def particles(self, x: ArrayLike, diameter: ArrayLike, *, density: Optional[ArrayLike] = None,
                  name: Optional[str] = None) -> NDArray[np.int64]:
        """Adds particles.

        Args:
            x: their centres (n, 3) [length].
            diameter: of all, or of each [length].
            density: [mass/length³]; gravity and dynamics need it.
            name: of a group of them.

        Returns:
            Their numbers, from 0, for bonds, angles, laws and groups. They come before the particles of all structures.
        """
        numbers = self._arrays.add_particles(x, diameter, density)
        self._built = None
        if name is not None:
            self.group(name=name, ids=[int(i) + 1 for i in numbers])
        return numbers

    def _ids(self, particles: ArrayLike) -> List[int]:
        if self._document.has("lammps"):
            raise InputError("group: particles of a [lammps] data file have its ids; give ids")
        return [int(i) + 1 for i in numbers_of_particles(particles, "group: particles").ravel()]

    def bonds(self, pairs: ArrayLike, stiffness: ArrayLike, rest_length: Optional[ArrayLike] = None) -> "Problem":
        """Adds bonds, U = K (r − r₀)².

        Args:
            pairs: numbers of particles (m, 2), from 0: first those that `particles` has given, then those of beams, loops, sheets and
                grains, as in `x`.
            stiffness: K, of all or of each [energy/length²].
            rest_length: r₀, of all or of each [length]; by default their distance as built.
        """
        self._arrays.add_bonds(pairs, stiffness, rest_length)
        self._built = None
        return self

    def angles(self, triples: ArrayLike, stiffness: ArrayLike, rest: ArrayLike = 180.0) -> "Problem":
        """Adds angles, U = B (1 − cos(θ − θ₀)).

        Args:
            triples: numbers of particles (m, 3), the middle one second, as of `bonds`.
            stiffness: B, of all or of each [energy].
            rest: θ₀, of all or of each [degrees]; 180 is straight.
        """
        self._arrays.add_angles(triples, stiffness, rest)
        self._built = None
        return self

    def law(self, name: str, elements: ArrayLike, value: Optional[Function] = None, gradient: Optional[Function] = None,
            hessian: Optional[Function] = None, *, formula: Optional[str] = None, translation_invariant: bool = False,
            **parameters: ArrayLike) -> "Problem":
        """Adds a law of your own to the energy, as a term of that name.

        Args:
            elements: numbers of particles (m, sites), from 0; 1 to 12 sites (of particles glued to a body 4 at most).
            value: U of all elements, from positions x (m, sites, 3) to (m,) [energy]; infinite where it is not defined.
            gradient: ∂U/∂x, (m, sites, 3) [force].
            hessian: ∂²U/∂x∂x, (m, 3·sites, 3·sites) [force/length].
            formula: instead of the functions, U in the distances r01, r02, … of the sites, cosines c012 of the angle at site 1, coordinates
                x0, y0, … and parameters. sympy differentiates it; Max, Min, Abs, Heaviside and Piecewise branch by branch.
            translation_invariant: of functions: U is the same where an element is moved as a whole. x is then relative to the element's
                first site, which keeps all digits of small distances. (Of a formula that is known.)
            parameters: of the formula, a number or one for each element.
        """
        if any(law.name == name for law in self._laws):
            raise InputError(f"law {name}: there is a law of this name already; give it another name")
        if formula is None and parameters:
            raise InputError(f"law {name}: {', '.join(parameters)}: parameters are of a formula; functions have none")
        at = numbers_of_particles(elements, f"law {name}: elements")
        source = _LawSource(name, at, value, gradient, hessian, formula, translation_invariant, dict(parameters))
        law = source.law()
        self._laws.append(source)
        self._made.append(law)
        self._built = None
        return self

    def copy(self) -> "Problem":
        """The same, to be changed by itself."""
        other = Problem.__new__(Problem)
        other._document, other._arrays = self._document.copy(), self._arrays.copy()
        other._laws, other._made = list(self._laws), list(self._made)
        other._folder, other._built = None, None
        return other

    __copy__ = copy                                        # copy.copy: nothing of what is changed later is shared

    def __getstate__(self) -> Dict[str, Any]:
        return {"tables": self._document.tables(), "name": self._document.name, "arrays": self._arrays, "laws": self._laws}

    def __setstate__(self, state: Dict[str, Any]) -> None:
        self._document, self._arrays, self._laws = Document(state["tables"], state["name"]), state["arrays"], state["laws"]
        self._made = [source.law() for source in self._laws]
        self._folder, self._built = None, None

    @property
    def tables(self) -> Dict[str, Any]:
        """The tables as a dict, without particles, bonds and angles from arrays."""
        return self._document.tables()

    def toml(self) -> str:
        """The tables as a problem file, without particles, bonds and angles from arrays."""
        return self._document.toml()

    # ---- what has been built

    def _with_data(self, folder: str) -> Document:
        """The document, with a data file in the folder where there are particles from arrays."""
        if not self._arrays:
            return self._document
        if self._document.has("lammps"):
            raise InputError("particles: do not go with a [lammps] data file; take one of them")
        document = self._document.copy()
        arrays = self._arrays
        if any(document.has(structure) for structure in ("beam", "loop", "sheet", "grains")):
            arrays, bonds, angles = arrays.split()
            for table in bonds:
                document.append("bonds", table)
            for table in angles:
                document.append("angles", table)
        if len(arrays.x) or arrays is self._arrays:
            file = os.path.join(folder, "particles.data")
            pathlib.Path(file).write_text(arrays.text(), encoding="utf-8")
            document.update("lammps", {"data": os.path.abspath(file)})
        return document

    def _system(self) -> System:
        if self._built is None:
            if self._arrays and self._folder is None:
                self._folder = tempfile.TemporaryDirectory(prefix="elamin-")
            built = System(self._with_data(self._folder.name if self._folder else ""), self._made)
            self._check_density(built)
            self._built = built
        return self._built

    def _check_density(self, system: System) -> None:
        """Particles from arrays that have a weight, or move in time, have a density."""
        without = np.flatnonzero(self._arrays.density == 0)
        if not len(without):
            return
        if system.in_time:
            raise InputError(f"particles: density: is missing of particle {without[0]}; dynamics needs it")
        for k, gravity in enumerate(self._document.tables().get("gravity", []), 1):
            heavy = np.intersect1d(system.groups[gravity.get("group", "all")], without)
            if len(heavy):
                raise InputError(f"particles: density: is missing of particle {heavy[0]}; gravity.{k} needs it")

    def _state(self, x: Where, load_factor: Optional[float], bodies: Optional[ArrayLike]) -> State:
        system = self._system()
        if x is None:
            return system.start(load_factor)
        if isinstance(x, (Step, Minimum)):
            x = x.state
        if isinstance(x, State):
            return x if load_factor is None else x.at_load_factor(load_factor)
        if isinstance(x, StoredState):
            load_factor = x.load_factor if load_factor is None and np.isfinite(x.load_factor) else load_factor
            x = x.x
        return system.state(real_numbers(x, "x"), None if bodies is None else real_numbers(bodies, "bodies"),
                            system.load_factor if load_factor is None else load_factor)

    def check(self) -> str:
        """Reads and builds it, and says what was understood, as `elamin check` does. Raises InputError with all mistakes."""
        return self._system().describe()

    @property
    def n(self) -> int:
        """How many particles there are."""
        return self._system().particles

    @property
    def dofs(self) -> int:
        """How many coordinates are free."""
        return self._system().dofs

    @property
    def free(self) -> NDArray[np.int32]:
        """Of each free coordinate its place in x.ravel() (dofs,); behind the particles three places and three turns a body."""
        return self._system().free

    @property
    def x0(self) -> Floats:
        """Where the study starts: positions (n, 3) [length], read-only."""
        return self._system().start(None).x

    @property
    def start(self) -> State:
        """The state that the study starts from."""
        return self._system().start(None)

    @property
    def load_factor(self) -> float:
        """Where the study starts: of a path its `from`, else 1."""
        return self._system().load_factor

    @property
    def diameters(self) -> Floats:
        """Of the particles (n,) [length]."""
        return self._system().diameters

    @property
    def groups(self) -> Dict[str, NDArray[np.int32]]:
        """Of each group the numbers of its particles, from 0."""
        return self._system().groups

    # ---- energy

    def energy(self, x: Where = None, load_factor: Optional[float] = None, *, bodies: Optional[ArrayLike] = None) -> float:
        """The energy of all laws and loads [energy]; infinite where a law is not defined.

        Args:
            x: positions (n, 3) [length], or a state, a step of a path, a minimum; by default where the study starts. Held particles are
                where x has them.
            load_factor: by default that of the state, or p.load_factor.
            bodies: of rigid bodies position and quaternion w, x, y, z (b, 7); by default where they start.
        """
        return self._system().energy(self._state(x, load_factor, bodies))

    def terms(self, x: Where = None, load_factor: Optional[float] = None, *, bodies: Optional[ArrayLike] = None) -> Dict[str, float]:
        """The energy by its terms: bond, angle, contact, wall, cohesion, body, external, and laws of your own [energy]."""
        return self._system().terms(self._state(x, load_factor, bodies))

    def gradient(self, x: Where = None, load_factor: Optional[float] = None, *, free: bool = False,
                 bodies: Optional[ArrayLike] = None) -> Floats:
        """∂E/∂x [force]: (n, 3) of all particles, held or not, as minus the forces of `elamin energy --forces`; with free=True over the
        free coordinates, (dofs,), of bodies too."""
        return self._system().gradient(self._state(x, load_factor, bodies), free)

    def forces(self, x: Where = None, load_factor: Optional[float] = None, *, bodies: Optional[ArrayLike] = None) -> Floats:
        """−∂E/∂x of all particles (n, 3), loads included, held or not [force]."""
        return self._system().forces(self._state(x, load_factor, bodies))

    def body_forces(self, x: Where = None, load_factor: Optional[float] = None, *, bodies: Optional[ArrayLike] = None) -> Floats:
        """Force and torque on each rigid body (b, 6) [force, force·length]."""
        return self._system().body_forces(self._state(x, load_factor, bodies))

    def hessian(self, x: Where = None, load_factor: Optional[float] = None, *, free: bool = False,
                bodies: Optional[ArrayLike] = None) -> "csr_matrix":
        """∂²E/∂x∂x, both triangles of the symmetric matrix, sparse [force/length].

        Rows and columns as in x.ravel(), (3n, 3n): H @ u.ravel() is the change of the gradient with x + u. (Behind the particles of a
        problem with rigid bodies six rows a body; in a plane the rows across it are empty.) With free=True over the free coordinates,
        (dofs, dofs).
        """
        from scipy.sparse import csr_matrix

        data, indices, indptr, rows = self._system().hessian(self._state(x, load_factor, bodies), free)
        return csr_matrix((data, indices, indptr), shape=(rows, rows))

    def stability(self, x: Where = None, load_factor: Optional[float] = None, *, bodies: Optional[ArrayLike] = None) -> Stability:
        """How many eigenvalues of the Hessian over the free coordinates are negative or zero, and which motions the zero ones are."""
        return self._system().stability(self._state(x, load_factor, bodies))

    def modes(self, x: Where = None, k: int = 6, load_factor: Optional[float] = None, *, bodies: Optional[ArrayLike] = None) -> List[Mode]:
        """The k lowest eigenmodes of the Hessian over the free coordinates at x, which is to be an equilibrium."""
        return self._system().modes(self._state(x, load_factor, bodies), k)

    def minimise(self, x0: Where = None, method: Optional[str] = None, load_factor: Optional[float] = None, *,
                 tolerance: Optional[float] = None, max_iterations: Optional[int] = None, bodies: Optional[ArrayLike] = None) -> Minimum:
        """See elamin.minimise."""
        system = self._system()
        if x0 is None:
            return system.minimise(None, system.load_factor if load_factor is None else load_factor, method, tolerance, max_iterations)
        state = self._state(x0, load_factor, bodies)
        return system.minimise(state, state.load_factor, method, tolerance, max_iterations)

    # ---- paths and runs

    def _path(self, keys: Dict[str, object]) -> Path:
        given = {key: value for key, value in keys.items() if value is not None}
        if given:
            self.table("path", **given)
        return Path(self)

    def run(self, directory: Optional[PathLike] = None, *, progress: bool = False, force: bool = False, report: bool = False,
            threads: int = 0) -> Run:
        """Runs the study, or all of a [[sweep]], as the program does, and writes the results.

        Args:
            directory: of the results; by default a temporary one, which is gone with the Run.
            progress: says how far it is.
            force: write to a directory that holds something else than results, too.
            report: keep states for the page of Run.report.
            threads: to use; 0: as many as set_threads, or else OpenMP (OMP_NUM_THREADS, all cores), has it.

        A run that ends before its end warns (NotConverged); what was reached is there. Ctrl-C raises KeyboardInterrupt; what was reached
        is written.
        """
        keep: Optional["tempfile.TemporaryDirectory[str]"] = None
        if directory is None:
            keep = tempfile.TemporaryDirectory(prefix="elamin-")
            where = os.path.join(keep.name, "run")
        else:
            where = os.fspath(directory)
        document = self._document
        if (self._arrays.density == 0).any() and (document.has("gravity") or document.has("dynamics")):
            self._system()                                 # tells what has no density
        if self._arrays:                                   # their file lies in the directory, whatever becomes of this process
            if not force:
                _elamin.require_results(where)
            os.makedirs(where, exist_ok=True)
            document, force = self._with_data(where), True
        status, _, verdicts = _elamin.run(document, self._made, where, not progress, force, report, threads)
        if self._arrays:
            _elamin.list_also(where, "particles.data")
        run = Run(where, status, verdicts, keep)
        if status == 2:
            message = run.summary["message"] if (run.directory / "summary.json").exists() else "some of its runs did not converge"
            warnings.warn(f"the run ended: {message}", NotConverged, stacklevel=2)
        return run

    # ---- pictures

    def picture(self, x: Where = None, load_factor: Optional[float] = None, *, width: float = 240,
                bodies: Optional[ArrayLike] = None) -> Figure:
        """The shape, drawn as `elamin plot` draws states; width [pt]."""
        system = self._system()
        return Figure(_elamin.picture(system, self._state(x, load_factor, bodies), width, system.title or "shape"))

    def _repr_html_(self) -> str:
        try:
            return f"<p>{_escaped(repr(self))}</p>{self.picture().svg}"
        except InputError as error:
            return f"<p>{_escaped(repr(self))}</p><pre>{_escaped(str(error))}</pre>"

    def __repr__(self) -> str:
        try:
            system = self._system()
        except InputError as error:
            return f"<elamin.Problem with {max(1, len(error.mistakes))} mistakes>"
        bodies = f", {system.body_count} bodies" if system.body_count else ""
        name = system.title or self._document.name
        return f"<elamin.Problem {name!r}: {system.particles} particles{bodies}, {system.dofs} free coordinates>"


def minimise(problem: Problem, x0: Where = None, method: Optional[str] = None, load_factor: Optional[float] = None, *,
             tolerance: Optional[float] = None, max_iterations: Optional[int] = None, bodies: Optional[ArrayLike] = None) -> Minimum:
    """The minimum of the energy near x0.

    Args:
        x0: positions (n, 3) [length], a state, a step; its driven coordinates are put where the load factor has them. By default the
            start, from which supports and walls go there in steps.
        method: "newton", "auto", "ipopt", "fire", "nlopt:LD_LBFGS", …; by default the problem's, [solver] method.
        load_factor: by default that of x0, or p.load_factor: 0 of a path from 0.
        tolerance: residual, relative to the largest internal force.
        max_iterations: by default as many as suit the method.

    Returns:
        x, state, energy, terms, stable, converged, message, iterations, residual. Not converging is told by `converged`, not raised.
    """
    return problem.minimise(x0, method, load_factor, tolerance=tolerance, max_iterations=max_iterations, bodies=bodies)
