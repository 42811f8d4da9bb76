"""What was found, in sentences a control engineer understands."""

from __future__ import annotations

import math

import numpy as np

from hyst.compensation import methods_for
from hyst.errors import NotInvertibleError
from hyst.identification import Identified
from hyst.identification.families.family import Words
from hyst.identification.families.registry import families
from hyst.models import LinearDynamics
from hyst.operators import Operator
from hyst.operators.composition import leaves_of
from hyst.operators.verdict import UNFIT, Verdict
from hyst.report.delay_words import delay_sentence, lag_in_words
from hyst.report.table import number, with_unit
from hyst.signals import Record

CREEP_EQUATION = (
    "with creep z + \u03a3 w_i x_i in the place of z, the output above without its offset; "
    "\u03c4_i dx_i/dt = z - x_i"
)
CREEP_TEXT = (
    "After a step of z the output goes on by the share w_i of the step, with the time constant "
    "\u03c4_i; the lags x_i answer one sample later, so that the inverse stays exact."
)


def words_of(identified: Identified) -> Words:
    """Give the words of a result, its equations with the sign of its output.

    Parameters
    ----------
    identified
        Any result; also one of a family that this version does not know, or of none.

    Returns
    -------
    Words
    """
    family = families.get(identified.family)
    if family is None:
        shape = f"{identified.family} model" if identified.family else "model of the given shape"
        return Words(shape, (), ())
    words = family.words_for(identified)
    parameters = identified.model.parameters()
    gains = [
        value
        for name, value in zip(parameters.names, parameters.values, strict=True)
        if name.rpartition(".")[2] == "gain"
    ]
    sign = "-" if gains and gains[-1] < 0.0 else ""
    equations = tuple(each.format(sign=sign) for each in words.equations)
    if not any(each.kind == "creep" for each in leaves_of(identified.model)):
        return Words(words.full_name, equations, words.explanations)
    return Words(
        f"{words.full_name} with creep",
        (*equations, CREEP_EQUATION),
        (*words.explanations, CREEP_TEXT),
    )


def command_method(identified: Identified) -> str:
    """Name the method that turns a whole reference into a command; empty where there is none.

    Parameters
    ----------
    identified
        The result.

    Returns
    -------
    str
        ``"exact"`` where there is an exact inverse; else what suits the family best and the model
        can.
    """
    able = methods_for(identified.model)
    family = families.get(identified.family)
    wanted = ("exact", *(() if family is None else family.methods), *able)
    return next((each for each in wanted if each in able), "")


def straight_line_rms(record: Record, start: int) -> float:
    """Give the rms error of the best straight line, output units.

    Parameters
    ----------
    record
        The record.
    start
        First sample that counts.

    Returns
    -------
    float

    Examples
    --------
    >>> line = straight_line_rms(Record([0.0, 1.0, 2.0], [1.0, 2.0, 0.0], 1.0), 0)
    >>> round(line**2, 12)  # the line is 1.5 - u / 2, and misses by 0.5, 1, 0.5
    0.5
    """
    u, y = record.u[start:], record.y[start:]
    centred = u - u.mean()
    spread = y - y.mean()
    slope = float(np.dot(centred, spread)) / max(float(np.dot(centred, centred)), math.ulp(0.0))
    return float(np.sqrt(np.mean((spread - slope * centred) ** 2)))


def in_short(identified: Identified, records: tuple[Record, ...]) -> tuple[str, ...]:
    """Say in a few sentences what was found and how good it is, its verdict apart.

    Parameters
    ----------
    identified
        The result.
    records
        Training records.

    Returns
    -------
    tuple of str
    """
    sentences = [f"The model is a {words_of(identified).full_name}{_plays_of(identified.model)}."]
    if (driver := identified.description.driver) is not None:
        sentences.append(f"Its input is what the driver gives, not its codes: {driver.told()}.")
    unit = identified.description.output_unit
    training = identified.metrics.get("training")
    if training is not None:
        line = straight_line_rms(records[0], identified.used_of_shown[0].start)
        line_percent = 100.0 * line / training.output_range
        instant = " without the delay" if identified.delay else ""
        sentences.append(
            f"On the record it was identified from it misses the recorded output by "
            f"{with_unit(number(training.rms, 3), unit)} rms, {training.rms_percent:.2f} % of the "
            f"output's range (at most {with_unit(number(training.max_abs, 3), unit)}, "
            f"{training.max_percent:.2f} %); a straight line{instant} misses it by "
            f"{line_percent:.2f} % rms."
        )
    for name, each in identified.metrics.items():
        if name.startswith("validation") and "offset" not in name:
            sentences.append(
                f"On the {name} record, which it has not seen, it misses by "
                f"{with_unit(number(each.rms, 3), unit)} rms, {each.rms_percent:.2f} %."
            )
    if not any(name.startswith("validation") for name in identified.metrics):
        sentences.append(
            "No validation record was given, so how well it predicts another drive is not measured."
        )
    sentences.append(lag_sentence(identified))
    sentences += stage_of_lag(identified)
    if identified.verdict.level != UNFIT:
        sentences.append(invertible_sentence(identified.model))
    return tuple(sentences)


def lag_sentence(identified: Identified) -> str:
    """Say by how much the output lags, and whether the lag is part of the model.

    Parameters
    ----------
    identified
        The result.

    Returns
    -------
    str
    """
    inside = [each for each in leaves_of(identified.model) if isinstance(each, LinearDynamics)]
    if identified.delay or not inside:
        about = identified.description
        if identified.delay and identified.verdict.level == UNFIT:
            lag = lag_in_words(identified.delay, about.dt, identified.delay_interval)
            return (
                f"The fit took a delay of {lag}; of a model that does not describe its record it "
                "means nothing."
            )
        return delay_sentence(identified.delay, about.dt, identified.delay_interval)
    delay = sum(each.delay for each in inside)
    if delay == 0:
        return "The dynamics have no delay beside their own lag."
    time = number(delay * inside[0].dt)
    return f"The dynamics contain a delay of {delay} sample{'s' * (delay > 1)} ({time} s)."


def stage_of_lag(identified: Identified) -> tuple[str, ...]:
    """Say what first-order lag of the drive is a stage of the model; nothing without one.

    Parameters
    ----------
    identified
        The result.

    Returns
    -------
    tuple of str
    """
    tau, interval = identified.lag, identified.lag_interval
    if tau is None:
        return ()
    how = ""
    if interval is not None:
        low, high = interval
        how = " (held)" if low == high else f" ({number(low, 3)} to {number(high, 3)} s)"
    return (
        f"Before the hysteresis the drive passes a first-order lag of {number(tau, 3)} s{how}; it "
        "is a stage of the model, and the inverse undoes it.",
    )


def verdict_lines(verdict: Verdict) -> str:
    """Say how far a model can be trusted, and why, a line a sentence.

    Parameters
    ----------
    verdict
        Of the model.

    Returns
    -------
    str

    Examples
    --------
    >>> print(verdict_lines(Verdict("good", ("What is left is noise.", "Go on."))))
    verdict: good - What is left is noise.
      Go on.
    """
    return verdict.told()


def invertible_sentence(model: Operator) -> str:
    """Say whether there is an exact inverse, what stands in its way, and if it is of any use.

    Parameters
    ----------
    model
        Any operator.

    Returns
    -------
    str
    """
    try:
        model.inverse()
    except NotInvertibleError as error:
        return f"It has no exact inverse: {error}."
    if model.description.is_unfit:
        return "It has an exact inverse, but its verdict is unfit: no command should come from it."
    return "It has an exact inverse, so a wanted output can be turned into a command."


def error_sentence(lag_one: float, samples: int) -> str:
    """Say what the autocorrelation of the error at one sample means.

    Parameters
    ----------
    lag_one
        Correlation of neighbouring errors.
    samples
        Number of samples.

    Returns
    -------
    str
    """
    if abs(lag_one) <= 3.0 / math.sqrt(max(samples, 1)):
        return "Neighbouring errors are not correlated: what is left looks like white sensor noise."
    return (
        f"Neighbouring errors have the correlation {lag_one:.2f}: what is left is not white noise "
        "alone but also drift, dynamics, or hysteresis of another shape. The standard errors take "
        "this into account."
    )


def memory_sentence(record: Record) -> str:
    """Say where the model's memory starts and how to tell it otherwise."""
    high = with_unit(number(float(record.u.max())), record.input_unit)
    low = with_unit(number(float(record.u.min())), record.input_unit)
    return (
        "The model starts without memory, as an actuator that has never been driven. A used one "
        "remembers: drive it once through its range before the command, and tell hyst so. After a "
        f"sweep to {high} and back to {low}, for instance, add --history with these two numbers."
    )


def _plays_of(model: Operator) -> str:
    count = sum(each.portrait().r.size for each in leaves_of(model))
    if count == 0:
        return ""
    return f" with {count} play{'s' * (count > 1)}"
