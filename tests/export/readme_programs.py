"""The program and the commands in the README of an export, as a reader copies them."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

from c_builds import compiler

MAIN, END = "int main(void) {", "    return 0;\n}"


def program_of(folder: Path, name: str = "") -> str:
    """The program of the README, of the export called `name` where there are several."""
    (readme,) = folder.glob(f"{name}*README.md")
    (program,) = re.findall(r"```c\n(.*?)\n```", readme.read_text(), re.DOTALL)
    return str(program)


def pasted(programs: list[str]) -> str:
    """One program of several: their heads one below the other, and their bodies in one main."""
    parts = [each.removesuffix(END).split(MAIN) for each in programs]
    heads = "".join(head for head, _ in parts).splitlines()
    bodies = "".join(body.strip("\n") + "\n" for _, body in parts)
    return "\n".join([*dict.fromkeys(heads), MAIN, bodies + END])


def run_readme(folder: Path, what: str, program: str = "", *options: str) -> str:
    """What the README's command prints, a `program` saved as it says; "example" or "test"."""
    if program:
        (folder / "example.c").write_text(program)
    (readme,) = folder.glob("*README.md")
    lines = readme.read_text().splitlines()
    (command,) = [
        each for each in lines if each.startswith("cc ") and re.search(rf"-o \w*{what} ", each)
    ]
    compiler("cc")
    command = command.replace("cc ", " ".join(["cc", *options, ""]), 1)
    done = subprocess.run(
        command, shell=True, cwd=folder, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, f"{command}\n{done.stderr}{done.stdout}"
    return done.stdout
