"""Run the benchmarks, all or those named, and say what got worse since it was recorded.

python -m benchmarks [NAMES] [--strict]     compare; --strict: exit code 1 where worse
python -m benchmarks [NAMES] --record       run three times, write benchmarks/recorded.json
"""

from __future__ import annotations

import os

# One BLAS thread, set before NumPy is loaded: threaded BLAS times how busy the machine is.
for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

import importlib  # noqa: E402
import pkgutil  # noqa: E402
import sys  # noqa: E402

import benchmarks  # noqa: E402
from benchmarks import recording, timing  # noqa: E402
from benchmarks.comparison import Ratio, compared, of_runs, table  # noqa: E402

SUPPORT = {
    "__main__",
    "comparison",
    "learning_stage",
    "measured_tasks",
    "peers",
    "plants",
    "recording",
    "resonant_records",
    "resonant_stage",
    "timing",
}
OWN_OPTIONS = {"--record", "--strict"}


def main(words: list[str]) -> int:
    found = [each.name for each in pkgutil.iter_modules(benchmarks.__path__)]
    names = _without_options(words) or [each for each in sorted(found) if each not in SUPPORT]
    runs = 3 if "--record" in words else 1
    of_all = {name: _ratios(name, runs) for name in names}
    reported = {name: ratios for name, ratios in of_all.items() if ratios}
    print("## against what was recorded\n")
    for line in recording.other_peers(recording.pinned(recording.PEERS)):
        print(f"Another version of a peer: {line}.")
    if "--record" in words:
        recording.write(reported)
        print(f"Recorded: {', '.join(reported) or 'nothing, for no benchmark reported a ratio'}.")
        return 0
    worse = [name for name, ratios in reported.items() if _got_worse(name, ratios)]
    return 1 if worse and "--strict" in words else 0


def _ratios(name: str, runs: int) -> dict[str, Ratio]:
    """Run a benchmark, which prints its tables, and give what it reported."""
    found = []
    for _ in range(runs):
        print(f"## {name}\n", flush=True)
        timing.REPORTED.clear()
        importlib.import_module(f"benchmarks.{name}").main()
        print(flush=True)
        found.append(dict(timing.REPORTED))
        if not timing.REPORTED:
            break
    return of_runs(found)


def _got_worse(name: str, ratios: dict[str, Ratio]) -> bool:
    before = recording.read().get(name)
    if before is None:
        print(f"{name}: not recorded yet; `python -m benchmarks {name} --record` does it.")
        return False
    print(f"### {name}\n")
    for line in recording.differences(before["machine"], recording.machine()):
        print(f"Recorded on another machine: {line}. What follows is a hint only.")
    comparison = compared(before["ratios"], ratios)
    print(table(comparison), flush=True)
    return bool(comparison.worse)


def _without_options(words: list[str]) -> list[str]:
    """Give the names; a benchmark reads options of its own itself, which come last."""
    words = [word for word in words if word not in OWN_OPTIONS]
    options = [k for k, word in enumerate(words) if word.startswith("-")]
    return words[: options[0]] if options else words


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
