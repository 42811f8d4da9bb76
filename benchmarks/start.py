"""Processor time of starts, against bare Python and against Python with NumPy on this machine.

Each program runs in a process of its own, in turn, with its compiled modules at hand; printed is
the least time of each, for what a busy machine adds is none of theirs, and the ratio to that of
`import numpy`.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile

from benchmarks.timing import report

ROUNDS = 7
_PROGRAM = "import sys; from hyst.cli import main; sys.exit(main(sys.argv[1:]))"
_BANK = "import hyst; hyst.PrandtlIshlinskii([0.5, 0.4], [0.1, 0.2], 1.0)([1.0, 0.0])"
STARTS: dict[str, list[str]] = {
    "python": ["pass"],
    "import numpy": ["import numpy"],
    "import typer, rich": ["import typer.rich_utils"],
    "import scipy.optimize": ["import scipy.optimize"],
    "import matplotlib.figure": ["import matplotlib.figure"],
    "import hyst": ["import hyst"],
    "hyst --version": [_PROGRAM, "--version"],
    "hyst --help": [_PROGRAM, "--help"],
    "hyst identify --help": [_PROGRAM, "identify", "--help"],
    "PrandtlIshlinskii": [_BANK],
    "read_record": ["import hyst; hyst.read_record"],
    "identify": ["import hyst; hyst.identify"],
    "report": ["import hyst.report; hyst.report.write_report"],
}


def main() -> None:
    """Print the table."""
    with tempfile.TemporaryDirectory() as folder:
        # What is compiled goes where it disturbs nobody, and the first round fills it.
        environment = {**os.environ, "PYTHONPYCACHEPREFIX": folder}
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
        for words in STARTS.values():
            spent(words, environment)
        least = dict.fromkeys(STARTS, float("inf"))
        for _ in range(ROUNDS):
            for name, words in STARTS.items():
                least[name] = min(least[name], spent(words, environment))
    print(f"  {'start':26s}{'seconds':>9s}{'of numpy':>10s}")
    for name, seconds in least.items():
        of_numpy = seconds / least["import numpy"]
        print(f"  {name:26s}{seconds:9.3f}{of_numpy:10.2f}")
        if not name.startswith(("import ", "python")) or name == "import hyst":
            report(f"{name}, over importing NumPy", of_numpy, better="smaller")


def spent(words: list[str], environment: dict[str, str]) -> float:
    """Run a program and give the time it had on processors."""
    before = os.times()
    subprocess.run(
        [sys.executable, "-c", *words], check=True, stdout=subprocess.DEVNULL, env=environment
    )
    after = os.times()
    user = after.children_user - before.children_user
    return user + after.children_system - before.children_system
