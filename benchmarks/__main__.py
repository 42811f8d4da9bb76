"""Run the benchmarks: all of them, or those named on the command line."""

from __future__ import annotations

import os

# One BLAS thread, set before NumPy is loaded: threaded BLAS times how busy the machine is.
for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

import importlib  # noqa: E402
import pkgutil  # noqa: E402
import sys  # noqa: E402

import benchmarks  # noqa: E402

SUPPORT = {
    "__main__",
    "learning_stage",
    "measured_tasks",
    "peers",
    "plants",
    "resonant_records",
    "resonant_stage",
    "timing",
}


def main(names: list[str]) -> None:
    found = [each.name for each in pkgutil.iter_modules(benchmarks.__path__)]
    # A benchmark reads its options itself.
    for name in _without_options(names) or [each for each in sorted(found) if each not in SUPPORT]:
        print(f"## {name}\n", flush=True)
        importlib.import_module(f"benchmarks.{name}").main()
        print(flush=True)


def _without_options(words: list[str]) -> list[str]:
    options = [k for k, word in enumerate(words) if word.startswith("-")]
    return words[: options[0]] if options else words


if __name__ == "__main__":
    main(sys.argv[1:])
