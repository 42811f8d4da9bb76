"""Draw the figure of docs/tutorials/learning.md: `python docs/figures/draw_learning.py`.

The commands of the page are run as they stand there; its first block of Python is stage.py.
"""

from __future__ import annotations

import contextlib
import re
import runpy
import shlex
import shutil
import sys
import tempfile
from pathlib import Path
from unittest import mock

from hyst.cli import main

HERE = Path(__file__).resolve().parent
PAGE = HERE.parent / "tutorials" / "learning.md"


def blocks(kind: str) -> list[str]:
    """Give the blocks of a kind, without their fences."""
    return re.findall(rf"```{kind}[^\n]*\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S)


def follow() -> None:
    """Run the commands of the page in this folder."""
    stage, motion = blocks("python")[:2]
    Path("stage.py").write_text(stage, encoding="utf-8")
    exec(compile(motion, str(PAGE), "exec"), {})
    for line in "".join(blocks("bash")).splitlines():
        program, *words = shlex.split(line)
        if program == "python":
            with mock.patch.object(sys, "argv", words):
                runpy.run_path(words[0])
        elif main(words):
            sys.exit(f"failed: {line}")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        follow()
        shutil.copy("learning.png", HERE / "learning.png")
