"""hyst adapt: follow a model's constants along a record."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import hyst
from hyst._files import replacing_files, require_folder
from hyst.cli.adapt.guard_run import GuardRun, guard_sentences, run_guard, write_guard_run
from hyst.cli.adapt.law import (
    Law,
    asks_law,
    law_from,
    model_from_slopes,
    run_law,
    start_law,
    tell_law,
)
from hyst.cli.adapt.measured import Measured, read_measured
from hyst.cli.adapt.options import (
    Commands,
    Files,
    Folder,
    Guard,
    Maps,
    Memory,
    Only,
    Resume,
    Spread,
    Start,
    Which,
    Window,
)
from hyst.cli.adapt.starting import Asked, Found, guarded, resumed, started
from hyst.cli.adapt.telling import draw, tell, tell_gain, write_knowledge, write_parameters
from hyst.cli.arguments import load_operator
from hyst.cli.console import at_work, show_files
from hyst.cli.reading_options import reads_records

_ROWS = 2000


@reads_records
@asks_law
def adapt(
    files: Files,
    folder: Folder,
    how: dict[str, Any],
    law: dict[str, Any],
    start: Start = 0,
    memory: Memory = None,
    spread: Spread = None,
    only: Only = "",
    estimator: Which = "auto",
    estimate_maps: Maps = False,
    guard: Guard = False,
    window: Window = "auto",
    commands: Commands = None,
    resume: Resume = None,
) -> None:
    """Estimate a model's constants sample by sample along a record; write them over time."""
    require_folder(folder)
    is_guarded = guard or window != "auto" or commands is not None
    asked = Asked(memory, spread, only, estimator, estimate_maps, is_guarded, window)
    rule = law_from(law, resume is not None, {**asked.of_all_constants, "--guard": is_guarded})
    model_file, data = _model_and_data(files, resume, rule)
    found = None if resume is None else resumed(resume, model_file, asked)
    model = None if found is None else found.model
    if model is None and not rule.from_slopes:
        model = load_operator(model_file or data)
    about = hyst.operators.ModelDescription() if model is None else model.description
    measured = read_measured(data, how, about, start, commands)
    if model is None:
        model = model_from_slopes(rule, measured.record)
    follower = _follower(found, rule, model, measured.record, asked, how)
    inverse = None if found is None else found.inverse
    if measured.history.size:
        (follower if inverse is None else inverse).follow(measured.history)
    if inverse is None and is_guarded:
        inverse = guarded(follower, asked)
    before = follower.parameters.tolist()
    frozen = follower.model.run(measured.record.u, follower.memory)[0]
    with at_work("estimating") as say:
        source = data, how, about.delay
        trajectory, run = _followed(follower, inverse, measured, rule, source)
        _refuse_if_few_used(follower, data)
        say("figure")
        picture = draw(follower, about, trajectory, data)
    follower.description = _described(follower, about, measured.whole)
    knowledge = follower.knowledge
    if inverse is None:
        knowledge = hyst.online.at_better_fit(follower, knowledge)
    made = trajectory, run, picture, knowledge
    files_there = _write(folder, follower, inverse, made, measured, about)
    tell(follower, knowledge, before, about)
    if isinstance(follower, hyst.online.RadiusEstimator):
        tell_law(follower, before, measured.record)
    elif run is None:
        tell_gain(trajectory, measured.record.y, frozen)
    if inverse is not None and run is not None:
        for sentence in guard_sentences(run, inverse, measured.record):
            print(sentence)
    show_files(files_there)


def _write(
    folder: Path,
    follower: hyst.online.Estimator,
    inverse: hyst.online.AdaptiveInverse | None,
    made: tuple[hyst.online.Trajectory, GuardRun | None, bytes, hyst.online.Knowledge],
    measured: Measured,
    about: hyst.operators.ModelDescription,
) -> list[Path]:
    """Write all files or none, and give where they are."""
    trajectory, run, picture, knowledge = made
    names = ["model.json", "estimator.json", "parameters.csv", "parameters.png", "knowledge.json"]
    with replacing_files(folder) as temporary:
        follower.model.save(temporary / names[0])
        follower.save(temporary / names[1])
        write_parameters(temporary / names[2], trajectory)
        (temporary / names[3]).write_bytes(picture)
        write_knowledge(temporary / names[4], knowledge)
        if inverse is not None and run is not None:
            names += ["guard.csv", "guard.json"]
            write_guard_run(temporary / names[5], run, measured.record, about)
            inverse.save(temporary / names[6])
    return [folder / name for name in names]


def _follower(
    found: Found | None,
    rule: Law,
    model: hyst.operators.Operator,
    record: hyst.Record,
    asked: Asked,
    how: dict[str, Any],
) -> hyst.online.Estimator:
    """Give the estimator an earlier run has left, or one that starts by the law or without it."""
    if found is not None:
        return found.estimator
    if rule.method is not None:
        return start_law(rule, model, record, asked.memory, how["dead_band"])
    return started(model, record.dt, asked)


def _followed(
    follower: hyst.online.Estimator,
    inverse: hyst.online.AdaptiveInverse | None,
    measured: Measured,
    rule: Law,
    source: tuple[Path, dict[str, Any], float],
) -> tuple[hyst.online.Trajectory, GuardRun | None]:
    every = max(1, measured.record.samples // _ROWS)
    if isinstance(follower, hyst.online.RadiusEstimator):
        return run_law(follower, rule, measured, source, every), None
    if rule.column is not None:
        raise hyst.InputError("the estimator needs no slope; leave out --slope and --regime")
    if inverse is None:
        return follower.run(measured.record, every), None
    return run_guard(inverse, measured, every)


def _model_and_data(files: list[Path], resume: Path | None, rule: Law) -> tuple[Path | None, Path]:
    if len(files) == 2 and not rule.from_slopes:
        return files[0], files[1]
    if len(files) == 1 and (resume is not None or rule.from_slopes):
        return None, files[0]
    wanted = "MODEL and DATA" if resume is None else "DATA, or MODEL and DATA,"
    if rule.from_slopes:
        wanted = "DATA alone, since weights come from its slopes,"
    names = ", ".join(str(each) for each in files)
    raise hyst.InputError(f"there are {len(files)} files ({names}); give {wanted} here")


def _described(
    estimator: hyst.online.Estimator,
    about: hyst.operators.ModelDescription,
    measured: hyst.Record,
) -> hyst.operators.ModelDescription:
    """Give the model's description with the origin of the estimate in the place of its own."""
    asked = {name: each for name, each in estimator.settings.items() if name != "model"}
    return replace(
        about.of_estimate(),
        dt=measured.dt,
        provenance=hyst.operators.provenance.provenance([measured], asked),
    )


def _refuse_if_few_used(estimator: hyst.online.Estimator, data: Path) -> None:
    counts = estimator.counts
    if counts["refused"] >= counts["used"]:
        raise hyst.InputError(
            f"{data} led to an overflow at {counts['refused']} samples and taught at "
            f"{counts['used']}; give the columns in the units of the model"
        )
