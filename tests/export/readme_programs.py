"""The program and the commands in the README of an export, as a reader copies them."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

from c_builds import compiler

MAIN, END = "int main(void) {", "    return 0;\n}"


def program_of(folder: Path, name: str = "") -> str:
    """The program of the README, of the export called `name` where there are several."""
    (program,) = re.findall(r"```c\n(.*?)\n```", readme_of(folder, name), re.DOTALL)
    return str(program)


def pasted(programs: list[str]) -> str:
    """One program of several: their heads one below the other, and their bodies in one main."""
    parts = [each.removesuffix(END).split(MAIN) for each in programs]
    heads = "".join(head for head, _ in parts).splitlines()
    bodies = "".join(body.strip("\n") + "\n" for _, body in parts)
    return "\n".join([*dict.fromkeys(heads), MAIN, bodies + END])


def readme_of(folder: Path, name: str = "") -> str:
    """The text of the README, of the export called `name` where there are several."""
    (file,) = folder.glob(f"{name}*README.md")
    return file.read_text()


def ran(folder: Path, what: str, *options: str) -> subprocess.CompletedProcess[str]:
    """The README's command for "example" or "test", carried out, with options of ours."""
    (command,) = [
        each
        for each in readme_of(folder).splitlines()
        if each.startswith("cc ") and re.search(rf"-o \w*{what} ", each)
    ]
    compiler("cc")
    command = command.replace("cc ", " ".join(["cc", *options, ""]), 1)
    return subprocess.run(
        command.replace(" -o ", " -lm -o "),
        shell=True, cwd=folder, capture_output=True, text=True, check=False,
    )  # fmt: skip


def run_readme(folder: Path, what: str, program: str = "", *options: str) -> str:
    """What that command prints, after a `program` has been saved as the README says."""
    if program:
        (place,) = re.findall(r"save it as `(\S+)`", readme_of(folder))
        (folder / place).write_text(program)
    done = ran(folder, what, *options)
    assert done.returncode == 0, done.stderr + done.stdout
    return done.stdout
