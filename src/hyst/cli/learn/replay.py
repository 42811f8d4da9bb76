"""Lead a compensator through the measured repetitions, as if it had given their commands."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.cli.learn.measured import Measured, at_rate_of_reference
from hyst.cli.learn.placing import unlike
from hyst.cli.learn.reference import Reference
from hyst.cli.learn.repetitions import MeasuredRepetition, repetitions_in

Array = NDArray[np.float64]

_FAR_OUTPUT = 0.5  # of the reference's range, rms: more than any model misses by
_ROUNDING = 1e-9  # of the command's range, rms: what printed numbers leave
_READ_BACK = 0.01  # likewise: what reading a drive back may add to it
_CLEARLY_EARLIER = 0.3  # of its distance to its own command: as near a drive is to the one it is


@dataclass(frozen=True)
class Wish:
    """What the learning is to keep and to know.

    Parameters
    ----------
    input_range, rate_limit, periodic, noise, history, slopes
        As of ``hyst.compensation.LearningCompensator``.
    repetitions
        In each record; None to see.
    """

    input_range: tuple[float, float] | None
    rate_limit: float | None
    periodic: bool
    noise: float | None
    history: list[float] | None
    slopes: tuple[float, float] | None
    repetitions: int | None


@dataclass(frozen=True, eq=False)
class Replayed:
    """Where the learning stands.

    Parameters
    ----------
    learner
        After the last measured repetition.
    sources
        Where each repetition was measured.
    notes
        What was done to the records, and what was seen in their drives.
    expected
        Output to expect of the next command, shape (N,), output units.
    input_range
        That the command keeps; None for any.
    """

    learner: hyst.compensation.LearningCompensator
    sources: tuple[str, ...]
    notes: tuple[str, ...]
    expected: Array
    input_range: tuple[float, float] | None

    @property
    def stopped(self) -> bool:
        """Whether no command should be learnt any more, since the repetitions got worse."""
        return self.learner.state == "diverged"


def replay(
    model: hyst.Operator,
    wanted: Reference,
    records: Sequence[tuple[str, hyst.Record]],
    wish: Wish,
    say: Callable[[str], None],
) -> Replayed:
    """Make the compensator and give it every repetition with the drive that was applied.

    Parameters
    ----------
    model
        To start from.
    wanted
        The reference.
    records
        Measured, by the names of their files.
    wish
        Limits and what is known.
    say
        Told what is at work.

    Raises
    ------
    InputError
        If a record does not hold the motion, or its output is not that of the reference.
    """
    measured = [at_rate_of_reference(*each, wanted.dt, wanted.y.size) for each in records]
    wish = _with_noise(wish, measured, _learner(model, wanted, wish).command)
    learner = _learner(model, wanted, wish)
    sources: list[str] = []
    notes: list[str] = []
    for each in measured:
        say(each.name)
        cut = repetitions_in(each, learner.command, wish.repetitions, wish.periodic)
        for repetition in cut:
            if not sources:
                _refuse_other_output(repetition, wanted)
            notes += [f"{repetition.name}: {text}" for text in repetition.notes]
            u, told = _applied(repetition, learner)
            notes += told
            _teach(learner, repetition, u)
            sources.append(repetition.name)
    return Replayed(
        learner,
        tuple(sources),
        tuple(notes),
        _expected(model, learner, wish),
        wish.input_range,
    )


def _with_noise(wish: Wish, measured: Sequence[Measured], command: Array) -> Wish:
    """Take the noise from periods of the first record, if they show it and nobody says it.

    Later records are left alone: commands given before them were made without knowing them, and
    must come out again.
    """
    if wish.noise is not None or not measured:
        return wish
    first = repetitions_in(measured[0], command, wish.repetitions, wish.periodic)[0]
    return replace(wish, noise=first.noise)


def _learner(
    model: hyst.Operator, wanted: Reference, wish: Wish
) -> hyst.compensation.LearningCompensator:
    return hyst.compensation.LearningCompensator(
        model,
        wanted.y,
        wish.input_range,
        dt=wanted.dt,
        rate_limit=wish.rate_limit,
        periodic=wish.periodic,
        noise=wish.noise,
        history=wish.history,
        slopes=wish.slopes,
        despite_verdict=True,  # refused before, unless the user insists
    )


def _teach(
    learner: hyst.compensation.LearningCompensator, repetition: MeasuredRepetition, u: Array
) -> None:
    """Give a repetition to the compensator; a refusal names the file."""
    try:
        learner.update(repetition.y, u)
    except hyst.InputError as refusal:
        here = str(refusal).replace("reset(forget=True)", "this file as the only one")
        raise hyst.InputError(f"{repetition.name}: {here}") from refusal


def _refuse_other_output(first: MeasuredRepetition, wanted: Reference) -> None:
    """Refuse an output that no model started from could have missed so far."""
    error = first.y - wanted.y
    extent = float(np.ptp(wanted.y)) or float(np.abs(wanted.y).max()) or 1.0
    share = float(np.sqrt(np.mean(error**2))) / extent
    if share <= _FAR_OUTPUT:
        return
    unit = f" {wanted.unit}" if wanted.unit else ""
    raise hyst.InputError(
        f"the output of {first.name} is {share:.3g} times the range of its reference off (rms), "
        f"{float(error.mean()):.4g}{unit} in the mean, another signal or another zero; "
        "give its column as --output, in the unit and from the zero of the reference"
    )


def _applied(
    repetition: MeasuredRepetition, learner: hyst.compensation.LearningCompensator
) -> tuple[Array, list[str]]:
    """Give the drive to learn from, and what is to be told of it.

    A drive that was read back is the command but for its own noise and gain, and must not be
    learnt from: both would be in the next command.
    """
    off = unlike(repetition.u, learner.command)
    if off < _ROUNDING:
        return learner.command, []
    number = len(learner.history) + 1
    said = f"{repetition.name}: its drive is {100.0 * off:.2g} % of its range off command {number}"
    earlier = [unlike(repetition.u, each.command) for each in learner.history]
    nearest = int(np.argmin(earlier)) if earlier else 0
    if earlier and earlier[nearest] < _CLEARLY_EARLIER * off:
        again = f"{said}, and is command {nearest + 1} again; it counts as such"
        return learner.history[nearest].command, [again]
    if off <= _READ_BACK:
        return learner.command, []
    return repetition.u, [f"{said}; what was applied counts"]


def _expected(
    model: hyst.Operator, learner: hyst.compensation.LearningCompensator, wish: Wish
) -> Array:
    """Give the output to expect: that of the best repetition, changed as the model says."""
    modelled = _answer(model, learner.command, wish)
    best = learner.best
    return (
        modelled
        if best is None
        else best.y_measured + modelled - _answer(model, best.command, wish)
    )


def _answer(model: hyst.Operator, u: Array, wish: Wish) -> Array:
    before = np.asarray([] if wish.history is None else wish.history, dtype=np.float64)
    whole = np.concatenate([before, u, u]) if wish.periodic else np.concatenate([before, u])
    answer: Array = model(whole)[-u.size :]
    return answer
