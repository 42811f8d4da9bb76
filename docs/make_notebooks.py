"""Make notebooks of pages, and run them.

    python docs/make_notebooks.py          # writes docs/notebooks
    python docs/make_notebooks.py --run    # runs what is there, each in a folder of its own

Prose becomes text, Python and commands become cells, and what a page says that they print is left
out, for the notebook prints it itself. A block with the name of a file as its title writes it.
"""

from __future__ import annotations

import json
import os
import re
import sys
import tempfile
from pathlib import Path
from typing import Any

DOCS = Path(__file__).resolve().parent
FOLDER = DOCS / "notebooks"
PAGES = ("tutorials/first_loop_in_python.md", "coming_from.md", "python_control.md")
BLOCK = re.compile(r"^```(\w+)(?: title=\"([^\"]+)\")?\n(.*?)^```\n", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\((?![a-z]+:|#)([^)]+)\)")
SECONDS = 60
"""A notebook takes at most."""


def notebook_of(page: str) -> dict[str, Any]:
    """Give the notebook of a page."""
    text = (DOCS / page).read_text(encoding="utf-8")
    cells: list[dict[str, Any]] = []
    end = 0
    for block in BLOCK.finditer(text):
        _add(cells, _prose(text[end : block.start()], page))
        language, name, body = block.groups()
        if language != "text":
            _add(cells, _code(language, name, body))
        end = block.end()
    _add(cells, _prose(text[end:], page))
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    kept = [{**cell, "id": f"cell-{number}"} for number, cell in enumerate(cells)]
    return {"cells": kept, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}


def _add(cells: list[dict[str, Any]], cell: dict[str, Any]) -> None:
    if cell["source"]:
        cells.append(cell)


def _prose(text: str, page: str) -> dict[str, Any]:
    """Links of a page lead from the folder of the notebooks to the same place."""

    def moved(link: re.Match[str]) -> str:
        target = os.path.normpath(os.path.join(os.path.dirname(page), link[1]))
        return f"]({os.path.relpath(target, 'notebooks')})"

    return {"cell_type": "markdown", "metadata": {}, "source": LINK.sub(moved, text).strip()}


def _code(language: str, name: str, body: str) -> dict[str, Any]:
    if name:
        source = f"%%writefile {name}\n{body}"
    elif language == "bash":
        source = "\n".join(f"!{line}" for line in body.replace("\\\n", " ").splitlines())
    else:
        source = body
    outside = {"execution_count": None, "outputs": []}
    return {"cell_type": "code", "metadata": {}, **outside, "source": source.strip()}


def write() -> None:
    """Write all of them."""
    FOLDER.mkdir(exist_ok=True)
    for page in PAGES:
        path = FOLDER / Path(page).with_suffix(".ipynb").name
        path.write_text(json.dumps(notebook_of(page), indent=1, ensure_ascii=False) + "\n", "utf-8")


def run() -> None:
    """Run all of them; the first that fails ends it with what failed."""
    import nbformat
    from nbclient import NotebookClient
    from traitlets.config import Config

    os.environ["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    for path in sorted(FOLDER.glob("*.ipynb")):
        notebook = nbformat.read(path, as_version=4)
        with tempfile.TemporaryDirectory() as folder:
            there = {"metadata": {"path": folder}}
            # Sockets of files, which nobody else on this machine can speak to.
            private = Config(KernelManager={"transport": "ipc", "ip": str(Path(folder, "kernel"))})
            NotebookClient(notebook, config=private, timeout=SECONDS, resources=there).execute()
        _refuse_failed_commands(path.name, notebook)


def _refuse_failed_commands(name: str, notebook: Any) -> None:
    """Stop where a command has failed, which stops no notebook: it begins with ``error:``."""
    for cell in notebook.cells:
        for output in cell.get("outputs", ()):
            if re.search(r"^(error: |Traceback)", output.get("text", ""), re.MULTILINE):
                sys.exit(f"{name}: {cell.source}\n{output['text']}")


if __name__ == "__main__":
    run() if "--run" in sys.argv[1:] else write()
