"""elamin: static equilibria of elastic structures made of glued particles, and how they change with the load.

    import elamin

    p = elamin.Problem("two_beams.toml")
    for step in p.path():
        print(step.load_factor, step.energy, step.stable)

Numbers are in any consistent units. Particles count from 0. Positions are arrays (n, 3).
"""
from __future__ import annotations

import os as _os

from ._elamin import Minimum, Mode, Stability, State, Step, json_schema, set_threads
from ._elamin import rest_threads as _rest_threads
from ._elamin import version as __version__
from ._errors import InputError, Mistake, NotConverged
from ._law import check_law
from ._problem import Event, Path, Problem, minimise
from ._results import Figure, Run, StoredState

# OpenMP's threads do not survive a fork: a process made by one uses a single thread, as sweeps over processes want it.
_os.register_at_fork(before=_rest_threads, after_in_child=lambda: set_threads(1))

__all__ = ["Event", "Figure", "InputError", "Minimum", "Mistake", "Mode", "NotConverged", "Path", "Problem", "Run", "Stability", "State",
           "Step", "StoredState", "check_law", "json_schema", "minimise", "set_threads", "__version__"]
