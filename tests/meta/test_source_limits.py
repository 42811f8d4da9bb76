"""Files and functions stay short enough to be read."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

FILE_LIMIT = 400
FUNCTION_LIMIT = 60  # lines, the docstring not counted
SOURCE_SUFFIXES = {".py", ".c", ".h", ".cpp", ".hpp"}


def test_files_have_at_most_400_lines(repository: Path, tracked_files: list[Path]) -> None:
    long = {
        str(file.relative_to(repository)): lines
        for file in tracked_files
        if file.suffix in SOURCE_SUFFIXES
        and (lines := len(file.read_text().splitlines())) > FILE_LIMIT
    }
    assert not long


def python_functions(text: str) -> Iterator[tuple[str, int]]:
    """Name and length without docstring of every function in a Python file."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            first = node.body[0]
            described = ast.get_docstring(node, clean=False) is not None
            docstring = (first.end_lineno or 0) - first.lineno + 1 if described else 0
            yield node.name, (node.end_lineno or 0) - node.lineno + 1 - docstring


def c_functions(text: str) -> Iterator[tuple[str, int]]:
    """First line and length of every block whose head and closing brace stand in column 0."""
    start = 0
    before = ""
    for number, line in enumerate(text.splitlines()):
        if line == "}":
            yield text.splitlines()[start], number - start + 1
        elif line and line[0] not in " {}#/" and not before.rstrip().endswith(","):
            start = number
        before = line


def test_functions_have_at_most_60_lines(repository: Path, tracked_files: list[Path]) -> None:
    long = []
    for file in tracked_files:
        if file.suffix not in SOURCE_SUFFIXES:
            continue
        functions = python_functions if file.suffix == ".py" else c_functions
        long += [
            f"{file.relative_to(repository)}: {name} has {lines} lines"
            for name, lines in functions(file.read_text())
            if lines > FUNCTION_LIMIT
        ]
    assert not long


def test_length_of_a_function_is_counted_right() -> None:
    python = 'def f():\n    """One\n\n    two.\n    """\n    x = 1\n    return x\n'
    c = "#include <a.h>\n\nint f(int a,\n      int b)\n{\n    return a;\n}\n\nvoid g() {\n}\n"
    assert list(python_functions(python)) == [("f", 3)]
    assert [lines for _, lines in c_functions(c)] == [5, 2]
