"""From a record to a model, with all that the page tells of it."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hyst.identification import Identified, identify
from hyst.identification.families.registry import families
from hyst.identification.progress import Step
from hyst.report import in_short, metrics_table
from hyst.report.table import Table
from hyst.studio.drawing.extremes import extreme_samples
from hyst.studio.drawing.plot import Line, Plot
from hyst.studio.work.choice import Choice
from hyst.studio.work.measuring import COLUMNS, KINDS, labels_of, loop_plot, record_of

AUTO = "auto"


@dataclass(frozen=True)
class FoundModel:
    """A model as the page shows it.

    Parameters
    ----------
    name
        On the page, and of its folder.
    asked, family
        What was asked for, and what it is.
    full_name
        Of its family.
    level, sentences
        Of its verdict.
    short
        What it is, in sentences.
    errors
        Table.
    invertible
        Whether there is a way to a command.
    kept
        The whole result, for later work on it by the same program.
    """

    name: str
    asked: str
    family: str
    full_name: str
    level: str
    sentences: tuple[str, ...]
    short: tuple[str, ...]
    errors: Table
    kept: bytes

    def result(self) -> Identified:
        """Give the whole result."""
        # Made by this program and never out of its memory.
        found: Identified = pickle.loads(self.kept)
        return found


def find_model(
    path: Path, choice: Choice, family: str, name: str, tell: Callable[[Step], None]
) -> FoundModel:
    """Identify a model.

    Parameters
    ----------
    path, choice
        The file and how to read it.
    family
        As of ``hyst.identify``.
    name
        To call it.
    tell
        Told the steps.

    Raises
    ------
    HystError
        As of ``hyst.identify``.
    """
    tell(Step("reading", 0.0))
    record = record_of(path, choice)
    found = identify(record, family=family, progress=tell)
    known = families.get(found.family)
    return FoundModel(
        name,
        family,
        found.family,
        known.words_for(found).full_name if known is not None else found.family,
        found.verdict.level,
        tuple(found.verdict.sentences),
        tuple(in_short(found, (record,))),
        metrics_table(found),
        pickle.dumps(found),
    )


def overlay(
    path: Path, choice: Choice, models: tuple[FoundModel, ...], tell: Callable[..., None]
) -> tuple[str, str]:
    """Draw the loops of models over that of the record, and what each leaves of it over time.

    Parameters
    ----------
    path, choice
        The file and how to read it.
    models
        Of it.
    tell
        Not told anything.

    Returns
    -------
    tuple of str
        Two pictures.
    """
    record = record_of(path, choice)
    outputs = [(each.name, each.result().predict(record.u, record.dt)) for each in models]
    lines = []
    for k, (name, y) in enumerate(outputs):
        error = y - record.y
        at = extreme_samples(COLUMNS, error)
        time = (at * record.dt).astype(np.float64)
        lines.append(Line(time, error[at], name, 1 + k % 6, KINDS[k % 2]))
    rms = ", ".join(f"{name} {_rms(y - record.y):.3g} rms" for name, y in outputs)
    label = labels_of(record)[1]
    errors = Plot(lines, "time [s]", f"model - measured, {label}", f"Errors over time: {rms}")
    return loop_plot(record, outputs).svg(), errors.svg()


def _rms(error: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(error))))
