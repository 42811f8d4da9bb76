"""What is public says what it takes and when it refuses.

What users reach, the names a package exports, has a section for its parameters; what only other
modules of hyst call may name them in a sentence, or leave a single one to its type. Left to say
nothing: a method that overrides a documented one, and commands, which document their parameters in
their options' help.
"""

from __future__ import annotations

import ast
import contextlib
import dataclasses
import functools
import importlib
import inspect
import re
import textwrap
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

PACKAGE = Path(__file__).resolve().parents[2] / "src" / "hyst"


def public_members(owner: ModuleType | type) -> Iterator[tuple[str, Any]]:
    """What a module or class defines itself under a public name."""
    module = owner.__name__ if isinstance(owner, ModuleType) else owner.__module__
    for name, member in vars(owner).items():
        plain = member.__func__ if isinstance(member, classmethod | staticmethod) else member
        is_code = inspect.isfunction(plain) or inspect.isclass(plain)
        if not name.startswith("_") and is_code and plain.__module__ == module:
            yield f"{owner.__name__}.{name}", plain


def parameters_of(function: Callable[..., Any]) -> list[str]:
    names = inspect.signature(function).parameters
    return [name for name in names if name not in {"self", "cls"}]


def raises_something(function: Callable[..., Any]) -> bool:
    """Whether the function itself, not one inside it, has a ``raise`` of its own."""
    source = textwrap.dedent(inspect.getsource(function))
    pending: list[ast.AST] = list(ast.parse(source).body[0].body)  # type: ignore[attr-defined]
    while pending:
        node = pending.pop()
        if isinstance(node, ast.Raise) and node.exc is not None:
            return True
        if not isinstance(node, ast.FunctionDef | ast.Lambda | ast.ClassDef):
            pending.extend(ast.iter_child_nodes(node))
    return False


def has_section(text: str, *titles: str) -> bool:
    return any(f"{title}\n{'-' * len(title)}" in text for title in titles)


@functools.cache
def exported() -> set[Any]:
    """What a user reaches: every function and class that a package gives under a public name."""
    given = []
    for file in PACKAGE.rglob("__init__.py"):
        name = ".".join(file.parent.relative_to(PACKAGE.parent).parts)
        with contextlib.suppress(ImportError):  # the test of that file itself says so
            package = importlib.import_module(name)
            # Names are loaded when they are first asked for: __all__ knows them, vars() does not.
            given += [getattr(package, each) for each in vars(package).get("__all__", [])]
    return {member for member in given if inspect.isfunction(member) or inspect.isclass(member)}


def unnamed_in(text: str, names: list[str]) -> list[str]:
    return [name for name in names if not re.search(rf"\b{name}\b", text)]


def missing_from(
    name: str, function: Callable[..., Any], text: str | None, reached_by_users: bool
) -> Iterator[str]:
    if not text:
        yield f"{name} has no docstring"
        return
    if not has_section(text, "Parameters"):
        names = parameters_of(function)
        if names if reached_by_users else len(names) > 1 and unnamed_in(text, names):
            yield f"{name} does not describe its parameters"
    if raises_something(function) and not has_section(text, "Raises"):
        yield f"{name} raises without saying when"


def missing_from_class(name: str, described: type) -> Iterator[str]:
    text = inspect.cleandoc(described.__doc__ or "")
    reached = described in exported()
    if not text:
        yield f"{name} has no docstring"
    elif dataclasses.is_dataclass(described) and not has_section(text, "Parameters", "Attributes"):
        fields = [field.name for field in dataclasses.fields(described) if field.init]
        if fields if reached else unnamed_in(text, fields):
            yield f"{name} does not describe its fields"
    for method_name, method in public_members(described):
        short = method_name.rpartition(".")[2]
        overridden = any(short in vars(base) for base in described.__mro__[1:])
        text = inspect.getdoc(getattr(described, short))
        if inspect.isfunction(method) and not (overridden and text):
            yield from missing_from(f"{name}.{short}", method, text, reached)


def test_public_names_are_described(source_file: Path, module_name: str) -> None:
    module = importlib.import_module(module_name)
    in_command_line = module_name.startswith("hyst.cli")
    missing: list[str] = [] if module.__doc__ else [f"{module_name} has no docstring"]
    for name, member in public_members(module):
        if inspect.isclass(member):
            missing += missing_from_class(name, member)
        elif in_command_line:
            missing += [] if member.__doc__ else [f"{name} has no docstring"]
        else:
            missing += missing_from(name, member, inspect.getdoc(member), member in exported())
    assert not missing


def undescribed(u: float, r: float = 0.0) -> float:
    """Give u back."""
    if u < r:
        raise ValueError
    return u


def test_what_is_missing_is_found() -> None:
    complete = "Parameters\n----------\nu\n\nRaises\n------\nValueError\n"
    assert len(list(missing_from("f", undescribed, undescribed.__doc__, True))) == 2
    assert len(list(missing_from("f", undescribed, undescribed.__doc__, False))) == 2
    assert len(list(missing_from("f", undescribed, "Give u back, unless below r.", False))) == 1
    assert not list(missing_from("f", undescribed, complete, True))


def test_a_raise_in_an_inner_function_is_not_the_function_s_own() -> None:
    def outer() -> None:
        def inner() -> None:
            raise ValueError

        with contextlib.suppress(ValueError):
            inner()

    assert not raises_something(outer)
    assert raises_something(undescribed)
