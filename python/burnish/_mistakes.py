# SPDX-License-Identifier: Apache-2.0
"""Explains in one line why a call fits no signature."""

import ast
import numbers
import os
import re

from . import _burnish

_KINDS = {
    "int": lambda value: hasattr(value, "__index__"),
    "float": lambda value: isinstance(value, numbers.Real) or hasattr(value, "__float__"),
    "bool": lambda value: isinstance(value, bool) or type(value).__name__ == "bool",
    "str": lambda value: isinstance(value, str),
    "None": lambda value: value is None,
    "os.PathLike": lambda value: isinstance(value, os.PathLike),
    "dict": lambda value: isinstance(value, dict),
}


class _Signature:
    """One signature of a function, read from the line in its documentation."""

    def __init__(self, line):
        # The line has numbers in place of defaults.
        function = ast.parse(re.sub(r"\\\d+", "None", line) + ": ...").body[0]
        given = function.args
        self.name = function.name
        self.positional = given.posonlyargs + given.args
        self.keywords = given.kwonlyargs
        without = len(self.positional) - len(given.defaults)
        self.required = [one.arg for one in self.positional[:without]]
        self.required += [one.arg for one, value in zip(given.kwonlyargs, given.kw_defaults) if value is None]
        self.any_keyword = given.kwarg is not None
        self.any_number = given.vararg is not None

    def names(self):
        return [one.arg for one in self.positional + self.keywords if one.arg != "self"]

    def problem(self, positional, keywords):
        """Returns (the number of arguments that fit, the mistake), or None."""
        if len(positional) > len(self.positional) and not self.any_number:
            is_method = bool(self.positional) and self.positional[0].arg == "self"
            most, found = len(self.positional) - is_method, len(positional) - is_method
            return 0, f"expected at most {most} arguments without a name, found {found}"
        for name in keywords:
            if name not in self.names() and not self.any_keyword:
                return -1, _burnish._expected_one_of(self.names(), name)  # another signature may know the name
        by_name = {one.arg: one for one in self.positional + self.keywords}
        given = {one.arg: value for one, value in zip(self.positional, positional)}
        for name in keywords:
            if name in given:
                return 0, f"{name}: expected once, found twice"
        given |= keywords
        for place, (name, value) in enumerate(given.items()):
            wanted = by_name[name].annotation if name in by_name else None
            if name != "self" and wanted is not None and not _fits(value, wanted):
                return place, f"{name}: expected {_text(wanted)}, found {_found(value)}"
        for name in self.required:
            if name not in given:
                return len(given), f"{name}: expected {_text(by_name[name].annotation)}, found nothing"
        return None


def _text(annotation):
    return ast.unparse(annotation).replace("burnish._burnish.", "") if annotation else "a value"


def _found(value):
    name = type(value).__name__
    return f"{name} {value!r}" if isinstance(value, (str, int, float)) and len(repr(value)) < 60 else name


def _fits(value, annotation):
    """Returns True if the value may be of that type, and for types that are not examined."""
    if isinstance(annotation, ast.BinOp):
        return _fits(value, annotation.left) or _fits(value, annotation.right)
    if isinstance(annotation, ast.Subscript) and _text(annotation.value) in (
        "list",
        "Sequence",
        "collections.abc.Sequence",
    ):
        return not isinstance(value, (str, bytes)) and hasattr(value, "__iter__")
    name = _text(annotation)
    if name in _KINDS:
        return _KINDS[name](value)
    kind = getattr(_burnish, name, None)
    return isinstance(value, kind) if isinstance(kind, type) else True


def explain(function, positional, keywords):
    """Returns the line, given a function of the extension and the arguments of the call."""
    signatures = [_Signature(entry[0]) for entry in function.__nb_signature__]
    name = signatures[0].name
    if name == "__init__":
        name = function.__qualname__.split(".")[0]
    problems = [problem for one in signatures if (problem := one.problem(positional, keywords))]
    if len(problems) == len(signatures):
        unknown = [word for word in keywords if all(word not in one.names() for one in signatures)]
        if unknown:
            names = list(dict.fromkeys(known for one in signatures for known in one.names()))
            return f"{name}: {_burnish._expected_one_of(names, unknown[0])}"
        return f"{name}: {max(problems, key=lambda problem: problem[0])[1]}"
    is_method = signatures[0].positional and signatures[0].positional[0].arg == "self"
    found = [type(value).__name__ for value in positional[is_method:]]
    found += [f"{word}={type(value).__name__}" for word, value in keywords.items()]
    # The last signature is the widest.
    expected = re.sub(r" = \\\d+", "", function.__nb_signature__[-1][0])[len("def ") :]
    return f"{name}: expected {expected.replace('self, ', '')}, found ({', '.join(found)})"
