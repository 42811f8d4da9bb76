"""Export, compile, run and compare one model; everything that is wrong ends up in words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from embedded.building import (
    ObjectStore,
    Sizes,
    compile_model,
    link_program,
    sizes_of,
    unexpected_symbols,
)
from embedded.cases import Case
from embedded.emulator import Report, on_processor
from embedded.rounding_bound import NoBoundError
from embedded.target import BUILDS, SOFT_DOUBLE, Build
from hyst.export import c_project
from hyst.export.c.numbers import PRECISIONS

Array = NDArray[np.float64]

NOT_FINITE = 1  # the fault that the records of all cases raise
OUT_OF_RANGE = 16  # and those of a limited drive beside it

UNITS_APART = {("degrading bouc-wen without inverse", SOFT_DOUBLE): 2}
"""Units in the last place by which a build may differ, as docs/embedded.md says; others by none."""


@dataclass(frozen=True)
class Cost:
    """What one build of a model needs.

    `stack` is the bound from the call graph; with the compiler's own arithmetic below it, which has
    no call graph, what was used.
    """

    worst: int
    mean: float
    sizes: Sizes
    stack: int
    state: int


@dataclass(frozen=True)
class Result:
    """Costs of all builds, the error of single precision, its bound, and what went wrong."""

    name: str
    costs: dict[Build, Cost]
    error: float
    bound: float | None
    problems: tuple[str, ...]


def write_vectors(inputs: Array, precision: str, step: str, file: Path) -> None:
    """Write the record as bits, and how a sample enters the model."""
    single = precision == "single"
    bits = inputs.astype(np.float32).view(np.uint32) if single else inputs.view(np.uint64)
    suffix = "u" if single else "ull"
    word, number = ("uint32_t", "float") if single else ("uint64_t", "double")
    numbers = ",\n    ".join(f"0x{each:x}{suffix}" for each in bits.ravel().tolist())
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(
        f"typedef {word} word;\ntypedef {number} number;\n\n"
        f"enum {{ SAMPLES = {inputs.shape[0]}, INPUTS = {inputs.shape[1]} }};\n\n"
        f"static const word input_bits[] = {{\n    {numbers}}};\n\n"
        "static number step(stage_state *model, const number *u)\n"
        f"{{\n    {step}\n}}\n"
    )


def measure(case: Case, work: Path, store: ObjectStore) -> Result:
    """Export, compile, run and compare one case in all builds."""
    problems: list[str] = []
    projects = {}
    for precision in PRECISIONS:
        projects[precision] = work / precision / "project"
        projects[precision].parent.mkdir(parents=True, exist_ok=True)
        c_project(case.model, projects[precision], precision=precision, force=True)
    expected = {precision: case.expected(precision) for precision in PRECISIONS}
    costs = {}
    for build in BUILDS:
        wanted = expected[build.precision]
        try:
            report, sizes = run_build(case, build, projects[build.precision], work, store)
        except (RuntimeError, ValueError) as wrong:
            problems.append(f"{build.name}: {wrong}")
            continue
        apart = UNITS_APART.get((case.name, build), 0)
        differing = compare(report, wanted, apart)
        problems += [f"{build.name}: {each}" for each in differing]
        costs[build] = cost_of(report, sizes, build, problems.append)
    error = float(np.abs(expected["single"] - expected["double"]).max())
    bound = bound_of(case)
    if bound is not None and not error <= bound:
        problems.append(f"single precision is off by {error:.3g}, more than the bound {bound:.3g}")
    return Result(case.name, costs, error, bound, tuple(problems))


def run_build(
    case: Case, build: Build, project: Path, work: Path, store: ObjectStore
) -> tuple[Report, Sizes]:
    """Compile one build of an exported project, look at its objects, and run it."""
    folder = work / build.name.replace(" ", "-")
    write_vectors(case.inputs, build.precision, case.step, folder / "vectors.h")
    objects = compile_model(project, folder, store, build)
    if foreign := unexpected_symbols(objects, build):
        raise RuntimeError(f"the objects need or hold {', '.join(foreign)}")
    program = link_program(objects, project, folder, build)
    sizes = sizes_of(objects, folder, build, ("stage_init", *case.steps))
    return on_processor(program, build.processor, build.precision), sizes


def compare(report: Report, wanted: NDArray[np.floating], apart: int = 0) -> list[str]:
    """Compare outputs bit by bit, or to some units in the last place, and the fault at the end."""
    problems = []
    ours, theirs = _bits(report.y), _bits(wanted)
    different = np.flatnonzero(np.maximum(ours, theirs) - np.minimum(ours, theirs) > apart)
    if different.size:
        k = int(different[0])
        problems.append(
            f"{different.size} outputs differ, the first is y[{k}] = {report.y[k]!r}, not "
            f"{wanted[k]!r}"
        )
    if report.fault & ~OUT_OF_RANGE != NOT_FINITE:
        problems.append(f"the fault is {report.fault} at the end, not {NOT_FINITE}")
    return problems


def _bits(values: NDArray[np.floating]) -> NDArray[np.unsignedinteger]:
    return values.view(f"u{values.itemsize}")


def cost_of(report: Report, sizes: Sizes, build: Build, complain: Callable[[str], None]) -> Cost:
    """Gather what a build needs; the stack that was used must be within what was foreseen."""
    uses_own_arithmetic = build.precision == "double" and build.processor.lacks_double
    if report.stack > sizes.stack and not uses_own_arithmetic:
        complain(f"{build.name}: {report.stack} bytes of stack are used, {sizes.stack} foreseen")
    counts = report.instructions
    stack = report.stack if uses_own_arithmetic else sizes.stack
    return Cost(int(counts.max()), float(counts.mean()), sizes, stack, report.state)


def bound_of(case: Case) -> float | None:
    """Give the bound of single precision's error; None where there is none."""
    try:
        return case.bound()
    except NoBoundError:
        return None
