"""From what was asked for to a watch, and what is said at its end."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.checks.numbers import as_positive
from hyst.cli.arguments import load_operator, refuse_inputs_as_outputs
from hyst.cli.console import note
from hyst.cli.exit_codes import DONE, UNFIT
from hyst.cli.watch.log import LogFiles, log_files
from hyst.cli.watch.loop import Loop, Waiting, ended_by_signals
from hyst.cli.watch.session import Plan, Session
from hyst.cli.watch.sources import source_of
from hyst.io.growing import GrowingRows
from hyst.online.choice import ESTIMATORS, estimator_for
from hyst.online.estimator import Estimator
from hyst.online.watch.limits import Limits

_FORGETS_AFTER, _FORGETS_SAMPLES = 60.0, 10_000
_SPREAD = 0.1


@dataclass(frozen=True)
class Wishes:
    """What was asked for.

    Parameters
    ----------
    rate, time_unit, only, every, log, stop_after, tolerance, drift, memory, spread, resume, wait
        Options of the verb.
    knows_memory, silence, as_json
        Of ``--known-memory``, ``--silence`` and ``--json``.
    """

    rate: float | None
    time_unit: str | None
    only: str
    every: float
    log: Path | None
    stop_after: str | None
    tolerance: float | None
    drift: float
    memory: float | None
    spread: float | None
    resume: Path | None
    knows_memory: bool
    wait: float
    silence: float
    as_json: bool


def watch_source(
    model_file: Path, data: str, columns: dict[str, str | None], wishes: Wishes
) -> int:
    """Watch a file or standard input until it ends; give the exit code."""
    model = load_operator(model_file)
    about = model.description
    if about.verdict is not None and about.is_unfit:
        note(f"the model is unfit, and so is what is estimated: {about.verdict.sentences[0]}")
    estimator = None if wishes.resume is None else _resumed(wishes.resume, model, wishes)
    plan = Plan(
        model=model,
        make=_maker(model, estimator, wishes),
        dt=_sample_time(model, estimator, wishes.rate, columns["time"]),
        has_stamps=columns["time"] is not None,
        every=as_positive(wishes.every, "--every", "seconds"),
        limits=Limits(error=wishes.tolerance, drift=wishes.drift),
        knows_memory=wishes.knows_memory,
        start=None if estimator is None else _start_of(model, estimator),
    )
    waiting = _waiting(wishes)
    files = None if wishes.log is None else _files_beside(wishes.log, [model_file, Path(data)])
    name = "standard input" if data == "-" else Path(data).name
    rows = GrowingRows(name, columns, wishes.time_unit)
    source = source_of(data)
    if wishes.wait > 0.0 and data != "-" and not Path(data).exists():
        note(f"waiting for {data}")
    goes_on = wishes.resume is not None
    loop = Loop(source, Session(plan, rows, note), waiting, files, goes_on, wishes.as_json)
    with ended_by_signals() as stop:
        loop.run(stop)
    _tell_end(loop, rows, files)
    return UNFIT if loop.active else DONE


def _sample_time(
    model: hyst.operators.Operator,
    estimator: Estimator | None,
    rate: float | None,
    time: str | None,
) -> float | None:
    """Give the sample time if it is known before the first row."""
    if rate is not None and time is not None:
        raise hyst.InputError("both --rate and --time are given; give one")
    own = model.dt if estimator is None else estimator.dt
    if rate is not None:
        dt = 1.0 / as_positive(rate, "--rate", "samples per second")
        model.require_sample_time(dt, "the file by its --rate")
        if estimator is not None and not math.isclose(dt, estimator.dt, rel_tol=1e-6):
            raise hyst.InputError(
                f"--rate gives {dt:.6g} s, the estimator was made for {estimator.dt:.6g} s; record "
                "at its rate, or start anew without --resume"
            )
        return dt if own is None else own
    if own is None and time is None:
        raise hyst.InputError("neither of --rate and --time is given; give one")
    return own


def _maker(
    model: hyst.operators.Operator,
    estimator: Estimator | None,
    wishes: Wishes,
) -> Callable[[float], Estimator]:
    names = [each.strip() for each in wishes.only.split(",") if each.strip()]

    def make(dt: float) -> Estimator:
        usual = max(_FORGETS_AFTER, _FORGETS_SAMPLES * dt)
        seconds = usual if wishes.memory is None else wishes.memory
        spread = _SPREAD if wishes.spread is None else wishes.spread
        return estimator_for(model, dt=dt, memory=seconds, spread=spread, only=names)

    if estimator is None:
        make(1.0 if model.dt is None else model.dt)  # refuses options before anything is waited for
        return make
    return lambda _: estimator


def _resumed(path: Path, model: hyst.operators.Operator, wishes: Wishes) -> Estimator:
    if wishes.only or wishes.memory or wishes.spread:
        raise hyst.InputError(
            f"{path} has its own options; leave out --only, --memory and --spread with --resume"
        )
    found = hyst.load(path)
    if not isinstance(found, Estimator):
        raise hyst.InputError(f"{path} holds no estimator; give one that hyst watch saved")
    if found.settings.get("model", model.to_dict()) != model.to_dict():
        raise hyst.InputError(
            f"{path} was started from another model; give that one, or leave out --resume"
        )
    return found


def _start_of(model: hyst.operators.Operator, estimator: Estimator) -> NDArray[np.float64] | None:
    """Give the parameters that an estimator of the same kind starts from, if one can be made."""
    if estimator.kind not in ESTIMATORS:
        return None
    fresh = estimator_for(model, dt=estimator.dt, estimator=estimator.kind)
    return fresh.parameters if fresh.names == estimator.names else None


def _waiting(wishes: Wishes) -> Waiting:
    silence = as_positive(wishes.silence, "--silence", "seconds")
    asked = wishes.stop_after
    if asked is None or asked == "at-end":
        return Waiting(wishes.wait, silence, None, asked is not None)
    try:
        seconds = float(asked)
    except ValueError:
        raise hyst.InputError(f"--stop-after is {asked!r}; give seconds, or at-end") from None
    return Waiting(wishes.wait, silence, as_positive(seconds, "--stop-after", "seconds"), False)


def _files_beside(log: Path, inputs: list[Path]) -> LogFiles:
    files = log_files(log)
    refuse_inputs_as_outputs(files.all(), inputs)
    return files


def _tell_end(loop: Loop, rows: GrowingRows, files: LogFiles | None) -> None:
    if rows.head is None:
        note(f"{rows.source} gave no rows")
        return
    if rows.first_unreadable is not None:
        line, text = rows.first_unreadable
        note(f"{rows.unreadable} lines could not be read, the first was line {line}: {text!r}")
    if loop.active:
        note(f"alarms at the end: {', '.join(loop.active)}")
    if files is not None:
        note(f"wrote {', '.join(each.name for each in files.all())} in {files.log.parent}")
