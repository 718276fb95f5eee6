"""What goes wrong, told in sentences."""
from __future__ import annotations

from typing import Any, Iterable, List, NamedTuple, Tuple


class Mistake(NamedTuple):
    """One mistake of a problem. line 0: it is of no place in a file."""

    file: str
    line: int
    column: int
    key: str
    what: str


class InputError(ValueError):
    """Wrong input: every mistake at once, a sentence each.

    Attributes:
        mistakes: the mistakes, with file, line, column, key and what is wrong.
    """

    def __init__(self, text: str, mistakes: Iterable[Tuple[Any, ...]] = ()) -> None:
        super().__init__(text)
        self.mistakes: List[Mistake] = [Mistake(*m) for m in mistakes]

    def __reduce__(self) -> Tuple[Any, ...]:
        return InputError, (str(self), [tuple(m) for m in self.mistakes])


class NotConverged(UserWarning):
    """A path or a run ended before its end."""
