"""Writes a method for each table of a problem file, of what `elamin schema` says of them: make_tables.py ELAMIN OUT."""
import json
import keyword
import subprocess
import sys
import textwrap

HEAD = '''"""A method for each table of a problem file. Made of `elamin schema` when elamin is built."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, Literal, Mapping, Optional, Sequence, TypeVar, Union

from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from ._problem import Path

Values = Union[Sequence[Any], NDArray[Any]]
_Self = TypeVar("_Self", bound="Tables")


class Tables:
    """The tables of a problem file as methods, their keys as keywords; `from`, a word of Python's, is `from_`."""

    def table(self: _Self, name: str, /, **keys: object) -> _Self:
        """Adds a table of that name, or to a single one these keys."""
        raise NotImplementedError

'''
CONSTANTS = '''
    def constants(self: _Self, **numbers: Union[float, str]) -> _Self:
        """[constants] Numbers with names of your own: `p.constants(t=1e-3).beam(thickness="t/2", …)`; each may be an expression of those before it."""
        return self.table("constants", **numbers)
'''
OWN = {"constants", "modes", "particles", "bonds", "angles"}   # of Problem itself, or written here


def name_of(key):
    return key + "_" if keyword.iskeyword(key) else key


def type_of(key):
    if "enum" in key:
        return "Literal[" + ", ".join(json.dumps(word) for word in key["enum"]) + "]"
    types = {"string": "str", "number": "float", "integer": "int", "boolean": "bool", "array": "Values", "object": "Mapping[str, object]"}
    given = key.get("type")
    if isinstance(given, list):                           # a number, or an expression of constants
        return "Union[" + ", ".join(types[one] for one in given) + "]"
    return types.get(given, "object")


def wrapped(text, indent):
    return textwrap.fill(text, 138, initial_indent=" " * indent, subsequent_indent=" " * indent, break_long_words=False)


def method(table, spec):
    spec = spec.get("items", spec)
    keys = spec["properties"]
    parameters = [f"{name_of(key)}: Optional[{type_of(k)}] = None" for key, k in keys.items()]
    values = "{" + ", ".join(f'"{key}": {name_of(key)}' for key in keys) + "}"
    lines = [f"    def {name_of(table)}(self: _Self, *,"]
    lines += ["        " + p + "," for p in parameters]
    before = []
    if table == "group":
        lines.append("        particles: Optional[ArrayLike] = None,")
        before = ["        if particles is not None:", "            ids = self._ids(particles)"]
    lines.append("    ) -> Path:" if table == "path" else "    ) -> _Self:")
    means = [wrapped(f"{name_of(key)}: {k['description']}" if k.get("description") else name_of(key), 12) for key, k in keys.items()]
    if table == "group":
        means.append(wrapped("particles: numbers of particles, from 0, instead of ids", 12))
    about = f"[{table}] " + wrapped(spec.get("description", ""), 8).strip()
    if table == "path":
        about = "The path of equilibria, as an iterator: `for step in p.path(): …`. Keys change the table first.\n\n        " + about
    text = about + "\n\n        Args:\n" + "\n".join(means) + "\n        "
    lines.append('        """' + text.replace("\\", "\\\\") + '"""')
    lines += before
    lines.append(f'        return self._path({values})' if table == "path" else f'        return self.table("{table}", **{values})')
    return "\n".join(lines) + "\n"


def main():
    program, out = sys.argv[1:]
    schema = json.loads(subprocess.run([program, "schema"], check=True, capture_output=True, encoding="utf-8").stdout)
    tables = {name: spec for name, spec in schema["properties"].items() if spec.get("type") in ("array", "object")}
    text = HEAD
    text += "    def _ids(self, particles: ArrayLike) -> List[int]:\n        raise NotImplementedError\n\n"
    text += "    def _path(self, keys: Dict[str, object]) -> Path:\n        raise NotImplementedError\n\n"
    text += "\n".join(method(name, spec) for name, spec in tables.items() if name not in OWN)
    text += CONSTANTS
    text += "\n\nMANY = " + repr(frozenset(name for name, spec in tables.items() if spec.get("type") == "array")) + "\n"
    with open(out, "w", encoding="utf-8") as file:
        file.write(text)


main()
