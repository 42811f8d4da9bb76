"""Measure all models; write the table of the docs, or compare it with what was measured."""

from __future__ import annotations

import argparse
import os
import shutil
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from embedded.building import ObjectStore
from embedded.cases import HEADLINE, LIMITED, cases
from embedded.measuring import Result, measure
from embedded.table import PAGE, stale_rows, table_in, table_of, with_table
from embedded.target import COMPILER, MAIN, missing_tools

# What the inverse of a modified model of 10 plays may need, single precision on a Cortex-M4F:
# instructions, bytes of code, bytes of state.
GOALS = {HEADLINE: (400, 2048, 256), LIMITED: (420, 2048, 64)}
NEEDS = "instructions", "bytes of code", "bytes of state"


def beyond_goal(results: list[Result]) -> list[str]:
    """Tell where a model that has goals misses one."""
    problems = []
    for each in results:
        main = each.costs.get(MAIN)
        if main is None or each.name not in GOALS:
            continue
        needed = main.worst, main.sizes.code, main.state
        problems += [
            f"{each.name}: {need} {what} are more than {most}"
            for need, what, most in zip(needed, NEEDS, GOALS[each.name], strict=True)
            if need > most
        ]
    return problems


def main() -> int:
    """Run, report and return what the process ends with."""
    parser = argparse.ArgumentParser(prog="python -m embedded", description=__doc__)
    parser.add_argument("names", nargs="*", help="models to measure; all if left out")
    parser.add_argument("--write", action="store_true", help="write the table of docs/embedded.md")
    parser.add_argument("--folder", type=Path, default=Path("build/embedded"))
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    chosen = parser.parse_args()
    if unknown := set(chosen.names) - {each.name for each in cases()}:
        parser.error(f"there is no model {', '.join(sorted(unknown))}; docs/embedded.md lists them")
    if missing := missing_tools():
        skipped = may_skip(missing)
        print(f"embedded: {'skipped' if skipped else 'failed'}, there is no {', '.join(missing)}")
        return 0 if skipped else 1
    results = measured(chosen.names, chosen.folder, chosen.jobs)
    problems = [f"{each.name}: {problem}" for each in results for problem in each.problems]
    problems += beyond_goal(results)
    if not problems and not chosen.names:
        problems += settle_table(results, chosen.write)
    elif not problems:
        print(table_of(results))
    for problem in problems:
        print(problem)
    print(f"embedded: {len(results)} models, {len(problems)} problems")
    return 1 if problems else 0


def may_skip(missing: list[str]) -> bool:
    """Tell whether tools may be missing: not in CI, which installs them, nor half of them."""
    return COMPILER in missing and not os.environ.get("CI")


def measured(names: list[str], folder: Path, jobs: int) -> list[Result]:
    """Measure the models that are named, or all."""
    wanted = [each for each in cases() if not names or each.name in names]
    shutil.rmtree(folder, ignore_errors=True)
    store = ObjectStore(folder / "core")
    with ThreadPoolExecutor(jobs) as pool:
        places = (folder / each.name.replace(" ", "-") for each in wanted)
        return list(pool.map(lambda case, place: measure(case, place, store), wanted, places))


def settle_table(results: list[Result], write: bool) -> list[str]:
    """Write the table, or tell where it is stale."""
    page = PAGE.read_text(encoding="utf-8")
    table = table_of(results)
    if write:
        PAGE.write_text(with_table(page, table), encoding="utf-8")
        return []
    stale = stale_rows(table_in(page), table)
    return [*stale, "docs/embedded.md is stale: make embedded-table"] if stale else []


if __name__ == "__main__":
    sys.exit(main())
