"""cppcheck's MISRA C:2012 report on the core and on exports, against docs/misra.md."""

from __future__ import annotations

import os
import re
import shutil
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from embedded.cases import cases
from embedded.target import run
from hyst.control import TrackingController
from hyst.export import c_project
from hyst.online import JointEstimator
from hyst.operators import Operator

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "misra.md"
CORE = ROOT / "core" / "src"
INCLUDE = ROOT / "core" / "include"

FINDING = re.compile(r"^(?P<file>[^:]+):(?P<line>\d+):(?P<what>\S+)", re.MULTILINE)
ROW = re.compile(
    r"^\| (?P<rule>[\d.]+) \| \w+ \| (?P<core>\d+|any) \| (?P<export>\d+|any) \| .{20,} \|$",
    re.MULTILINE,
)

Place = tuple[str, int]

# C++ is not what MISRA C speaks of, and a header of the user's is the user's.
UNDEFINED = ("POWER_HEADER", "ROOT_HEADER", "REAL_HEADER", "EXTERN_C")
OF_THE_CORE = tuple(
    (f"-I{INCLUDE}", precision, *(f"-UHYST_{each}" for each in UNDEFINED))
    for precision in ("-UHYST_SINGLE", "-DHYST_SINGLE")
)
OF_AN_EXPORT = (tuple(f"-USTAGE_CORE_{each}" for each in UNDEFINED),)


def report(
    sources: Iterable[Path], configurations: Iterable[tuple[str, ...]]
) -> dict[str, set[Place]]:
    """Give where cppcheck finds what, by its names, as misra-c2012-15.5."""
    found: defaultdict[str, set[Place]] = defaultdict(set)
    for options in configurations:
        command = ["cppcheck", "--addon=misra", "--std=c99", "--quiet", "--inline-suppr"]
        command += ["--enable=warning,style,performance,portability", "--platform=unix32"]
        command += ["--template={file}:{line}:{id}", "-U__cplusplus", *options]
        command += map(str, sources)
        for each in FINDING.finditer(run(command, seconds=300.0)):
            found[each["what"]].add((each["file"], int(each["line"])))
    return dict(found)


def accepted(page: str, column: str) -> dict[str, float]:
    """Give the rules that the core or an export may break, and in how many places at most."""
    return {
        f"misra-c2012-{row['rule']}": float("inf") if row[column] == "any" else float(row[column])
        for row in ROW.finditer(page)
    }


def excess(found: dict[str, set[Place]], allowed: dict[str, float]) -> list[str]:
    """Tell what is found and not accepted, with all places of its kind."""
    problems = []
    for what, places in sorted(found.items()):
        most = allowed.get(what, 0.0)
        if len(places) > most:
            listed = ", ".join(f"{Path(file).name}:{line}" for file, line in sorted(places))
            problems.append(f"{what}: {len(places)} places, {most:g} accepted: {listed}")
    return problems


def unseen(found: dict[str, set[Place]]) -> list[str]:
    """Tell whether cppcheck came to an end without its add-on, and so without a finding."""
    ran = any(what.startswith("misra-") for what in found)
    return [] if ran else ["cppcheck's MISRA add-on found nothing at all: it cannot have run"]


def exported_sources(folder: Path) -> list[Path]:
    """Export one model with stages of every kind, in single precision."""
    kinds: dict[str, Operator | TrackingController | JointEstimator] = {}
    for case in cases():
        block = case.block("single")
        for kind in [f"{stage.kind} {stage.form}" for stage in block.stages] or [block.kind]:
            kinds.setdefault(kind, case.model)
    sources = []
    for number, model in enumerate({id(each): each for each in kinds.values()}.values()):
        project = folder / f"export_{number}"
        c_project(model, project, precision="single")
        sources.append(project / "stage.c")
    return sources


def findings_of_export(source: Path) -> dict[str, set[Place]]:
    """Give what is found in an export itself, not in the headers of the core."""
    found = report([source], OF_AN_EXPORT)
    return {
        what: {place for place in places if Path(place[0]).parent == source.parent}
        for what, places in found.items()
    }


def main() -> int:
    """Check the core, and exports with stages of every kind."""
    if shutil.which("cppcheck") is None:
        skipped = not os.environ.get("CI")  # which installs it
        print(f"misra: {'skipped' if skipped else 'failed'}, there is no cppcheck")
        return 0 if skipped else 1
    page = PAGE.read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(2) as pool:
        of_core = pool.submit(report, sorted(CORE.glob("*.c")), OF_THE_CORE)
        of_exports = pool.map(findings_of_export, exported_sources(Path(folder)))
        problems = unseen(of_core.result()) + excess(of_core.result(), accepted(page, "core"))
        for found in of_exports:
            problems += excess(found, accepted(page, "export"))
    for problem in problems:
        print(problem)
    print(f"misra: {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
