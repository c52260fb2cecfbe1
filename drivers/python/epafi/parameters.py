"""Scenes as keyword objects: a class for each list of docs/parameters.md, made of the schema that Epafi checks by.

Each is a dictionary. Names are those of the file, or the same as a keyword: `youngs_modulus` is "Young's Modulus". Values
are numbers, words, and sequences or arrays of numbers; None is as if not given.
"""

import inspect
import numbers
import operator
from collections.abc import Iterator, Mapping
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy

from . import _epafi

SCHEMA = _epafi.schema()


class Parameters(dict):
    """Parameters by keywords."""

    def __init__(self, **parameters: Any):
        super().__init__(parameters)


def keyword(name: str) -> str:
    return name.lower().replace("'", "").replace(" ", "_").replace("-", "_")


def _class(name: str, schema: Mapping) -> type:
    own = {keyword(key): entry for key, entry in schema.items() if key}
    lines = [schema.get("", "A scene."), ""]
    for key, entry in own.items():
        lines.append(f"{key}: {entry[0]} = {entry[1]}. {entry[2]}" if isinstance(entry, tuple) else f"{key}: {entry['']}")
    signature = inspect.Signature([inspect.Parameter(key, inspect.Parameter.KEYWORD_ONLY, default=None) for key in own])
    return type(name, (Parameters,), {"__doc__": "\n".join(lines), "__signature__": signature, "__module__": __name__})


def _classes(name: str, schema: Mapping) -> Iterator[type]:
    """One for each list that has parameters of its own or lists of known names."""
    pattern = [key for key in schema if key.startswith("<")]
    if not pattern:
        yield _class(name, schema)
    for key, entry in schema.items():
        if isinstance(entry, Mapping):
            yield from _classes(key.strip("<>").replace(" ", "") if not key.startswith("<") else key.strip("<>").title(), entry)


# For type checkers; what follows makes them.
Accuracy: type[Parameters]
Body: type[Parameters]
Decomposition: type[Parameters]
Equation: type[Parameters]
Load: type[Parameters]
Obstacle: type[Parameters]
Pair: type[Parameters]
Region: type[Parameters]
Scene: type[Parameters]
Solver: type[Parameters]
Step: type[Parameters]
Support: type[Parameters]
for _made in _classes("Scene", SCHEMA):
    globals().setdefault(_made.__name__, _made)


def _spelled(value: Any, wanted: str | None) -> tuple[str, str]:
    """A value's type and text as an XML file has them."""
    if isinstance(value, (bool, numpy.bool_)):
        return "bool", str(bool(value)).lower()
    if isinstance(value, numbers.Number):
        if isinstance(value, numbers.Integral) and wanted != "double":
            return "int", str(operator.index(value))
        return "double", repr(float(value))  # type: ignore[arg-type]
    if isinstance(value, (list, tuple, numpy.ndarray)):
        entries = [_spelled(entry, None if wanted is None else wanted[6:-1]) for entry in numpy.ravel(value).tolist()]
        kind = "double" if any(entry[0] == "double" for entry in entries) else "int"
        return wanted if not entries and wanted else f"Array({kind})", "{" + ", ".join(entry[1] for entry in entries) + "}"
    return "string", str(value)


def elements(values: Mapping, schema: Mapping) -> Iterator[str]:
    """The XML elements of a list's entries."""
    names = {keyword(name): name for name in schema if name and not name.startswith("<")}
    pattern = next((schema[name] for name in schema if name.startswith("<")), None)
    for key, value in values.items():
        name = names.get(keyword(str(key)), str(key))
        known = schema.get(name, pattern)
        if isinstance(value, Mapping):
            yield f"<ParameterList name={quoteattr(name)}>"
            yield from elements(value, known if isinstance(known, Mapping) else {})
            yield "</ParameterList>"
        elif value is not None:
            kind, text = _spelled(value, known[0] if isinstance(known, tuple) else None)
            yield f"<Parameter name={quoteattr(name)} type={quoteattr(kind)} value={quoteattr(text)}/>"


def xml(values: Mapping, schema: Mapping, name: str) -> str:
    return "\n".join([f"<ParameterList name={quoteattr(name)}>", *elements(values, schema), "</ParameterList>", ""])
