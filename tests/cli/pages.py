"""Pages of docs/ as programs: their blocks, and their commands run one by one."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest
from command_runs import Run

DOCS = Path(__file__).resolve().parents[2] / "docs"
FENCE = re.compile(r"^```(\w+)(?: title=\"([^\"]+)\")?\n(.*?)^```", re.MULTILINE | re.DOTALL)


def named_blocks(page: str) -> list[tuple[str, str]]:
    """Give the fenced blocks of a page, each with its language, in order."""
    found = FENCE.findall((DOCS / page).read_text(encoding="utf-8"))
    return [(language, text) for language, _, text in found]


def blocks(page: str, kind: str) -> list[str]:
    """Give those in one language."""
    return [text for language, text in named_blocks(page) if language == kind]


def commands(page: str) -> list[str]:
    """Give the lines of its blocks of bash; a backslash at the end goes on."""
    return "".join(blocks(page, "bash")).replace("\\\n", " ").splitlines()


def write_files(page: str) -> None:
    """Write the blocks that have the name of a file as their title."""
    for _, name, text in FENCE.findall((DOCS / page).read_text(encoding="utf-8")):
        if name:
            Path(name).write_text(text, encoding="utf-8")


def follow(page: str, run: Run) -> str:
    """Run every command of a page, each of which must end with 0; give what they said."""
    told = ""
    for line in commands(page):
        program, *words = shlex.split(line)
        if program == "hyst":
            ended = run(*words)
            assert ended.code == 0, f"{line}: {ended.err}"
            told += ended.out
        elif shutil.which(program) is None:
            pytest.skip(f"{page} needs {program}")
        else:
            done = subprocess.run(line, shell=True, check=False, capture_output=True, text=True)
            assert done.returncode == 0, f"{line}: {done.stdout}{done.stderr}"
            told += done.stdout
    return told


def untold(page: str, told: str) -> list[str]:
    """Give the lines of a page's blocks of text that its commands did not say."""
    said = " ".join(told.split())
    lines = "".join(blocks(page, "text")).splitlines()
    return [line for line in lines if " ".join(line.split()) not in said]
