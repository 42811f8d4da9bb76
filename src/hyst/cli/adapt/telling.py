"""What hyst adapt tells of an estimate: a table of what is known, and sentences of what is not."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.cli.console import note, show_table

Array = NDArray[np.float64]

_WORSE = 1.05


def draw(
    estimator: hyst.online.Estimator,
    about: hyst.operators.ModelDescription,
    trajectory: hyst.online.Trajectory,
    data: Path,
) -> bytes:
    """Draw the estimates over time."""
    units = about.input_unit, about.output_unit
    if isinstance(estimator, hyst.online.JointEstimator):
        units = hyst.online.units_of_plays(estimator.model, *units)
    bands = "bands of two standard errors"
    if isinstance(estimator, hyst.online.JointEstimator):
        bands = "two standard errors of the filter; what is known: knowledge.json"
    heading = f"Estimates along {data.name}, {bands}"
    return hyst.report.draw_estimates({"": trajectory}, {}, heading, units)


def write_parameters(path: Path, trajectory: hyst.online.Trajectory) -> None:
    """Write the estimates over time with their standard errors."""
    columns = [trajectory.time]
    headers = ["time [s]"]
    for index, name in enumerate(trajectory.names):
        columns += [trajectory.values[:, index], trajectory.standard_errors[:, index]]
        headers += [name, f"{name} standard error"]
    hyst.io.write_columns(path, headers, columns)


def write_knowledge(path: Path, knowledge: hyst.online.Knowledge) -> None:
    """Write what is known at the end, as the table on the console has it; infinite is null."""
    told = zip(
        knowledge.names,
        knowledge.low.tolist(),
        knowledge.high.tolist(),
        knowledge.determined.tolist(),
        knowledge.reasons,
        strict=True,
    )
    rows = [
        {
            "name": name,
            "low": low if math.isfinite(low) else None,
            "high": high if math.isfinite(high) else None,
            "determined": is_determined,
            "reason": reason,
        }
        for name, low, high, is_determined, reason in told
    ]
    content = {"known": knowledge.known, "doubts": knowledge.doubts, "constants": rows}
    path.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def tell_gain(trajectory: hyst.online.Trajectory, y: Array, frozen: Array) -> None:
    """Say what estimating has gained over the constants from before, in the last half.

    Parameters
    ----------
    trajectory
        Errors of predictions, shape (N,).
    y, frozen
        Shape (N,), the output, measured and with the constants from before.
    """
    half = slice(y.size // 2, None)
    adapted = float(np.sqrt(np.mean(trajectory.error[half] ** 2)))
    held = float(np.sqrt(np.mean((y - frozen)[half] ** 2)))
    said = (
        f"predictions miss by {adapted:.4g} rms in the last half, with the constants from before "
        f"by {held:.4g}"
    )
    if adapted <= _WORSE * held:
        print(said)
        return
    less = "" if "scale" in trajectory.names else ", or estimate less (--only scale,offset)"
    note(f"{said}: estimating made them worse; keep the model from before{less}")


def tell(
    estimator: hyst.online.Estimator,
    knowledge: hyst.online.Knowledge,
    before: list[float],
    about: hyst.operators.ModelDescription,
) -> None:
    """Print the estimate: constants with what is known of each, noise, and what there is to doubt.

    Parameters
    ----------
    estimator
        At the end.
    knowledge
        Its own.
    before
        Its parameters at the start.
    about
        Of the model it started from.
    """
    show_table(_table(estimator, knowledge, before))
    if any(name.startswith(("front", "back")) for name in estimator.names):
        print("front, back: weights of the maps before and after the plays")
    counts = estimator.counts
    print(
        f"\nnoise of the output: {hyst.report.number(estimator.noise)}; {counts['used']} samples "
        "used"
    )
    if counts["skipped"] or counts["refused"]:
        note(f"{counts['skipped']} samples were not finite, {counts['refused']} led to an overflow")
    if isinstance(estimator, hyst.online.JointEstimator):
        print(f"excitation: {estimator.excitation}")
    _tell_doubts(estimator, knowledge)
    if about.verdict is not None and about.is_unfit:
        note(
            "the model it started from is unfit, and the estimate has its shape: "
            f"{about.verdict.sentences[0]}"
        )


def _table(
    estimator: hyst.online.Estimator, knowledge: hyst.online.Knowledge, before: list[float]
) -> hyst.report.Table:
    number = hyst.report.number
    rows = []
    for index, name in enumerate(estimator.names):
        low, high = float(knowledge.low[index]), float(knowledge.high[index])
        known = f"{number(low)} to {number(high)}"
        if not knowledge.determined[index]:
            known = "not determined"
        elif low == high:
            known = "held"
        value = float(estimator.parameters[index])
        rows.append((name, number(before[index]), number(value), known))
    within = "known within" if not knowledge.doubts else "within, in doubt"
    header = ("constant", "before", "after", within)
    return hyst.report.Table("Estimates, and bands of two standard errors", header, tuple(rows))


def _tell_doubts(estimator: hyst.online.Estimator, knowledge: hyst.online.Knowledge) -> None:
    for sentence in knowledge.said:
        note(sentence)
    innovation = estimator.innovation
    if innovation.consistent:
        print(f"innovation: {innovation}")
    elif not any(str(innovation) in sentence for sentence in knowledge.sentences):
        note(f"innovation: {innovation}")
    if innovation.replacements:
        print(f"search: another start did better, {innovation.replacements} of {innovation.rivals}")
