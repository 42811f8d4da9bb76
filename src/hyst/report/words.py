"""What was found, in sentences a control engineer understands."""

from __future__ import annotations

import math

import numpy as np

from hyst.errors import NotInvertibleError
from hyst.identification import Identified
from hyst.identification.families.hammerstein import IdentifiedHammerstein
from hyst.operators import Operator
from hyst.report.tables import number, with_unit
from hyst.signals import Record

FAMILY_NAMES = {
    "linear": "straight line",
    "ramberg-osgood": "Ramberg-Osgood model",
    "pi": "Prandtl-Ishlinskii model",
    "gpi": "generalized Prandtl-Ishlinskii model",
    "mpi": "modified Prandtl-Ishlinskii model",
    "rdpi": "rate-dependent Prandtl-Ishlinskii model",
    "hammerstein": "Hammerstein model (hysteresis, then linear dynamics)",
}

_PLAYS = "P[w](t) = p0 w(t) + \u03a3 p\u1d62 F\u1d63\u1d62[w](t)"
_EQUATIONS = {
    "linear": ("y(t) = gain \u00b7 u(t) + offset",),
    "ramberg-osgood": (
        "y(t) = {sign}R[u](t) + offset",
        "dR/du = c1 + c2 p^c3,  p = |u - u at the last reversal|",
    ),
    "pi": ("y(t) = {sign}P[u](t) + offset", _PLAYS),
    "gpi": ("y(t) = {sign}P[\u03b3(u)](t) + offset", _PLAYS),
    "mpi": ("y(t) = {sign}\u039b(P[u](t)) + offset", _PLAYS),
    "rdpi": (
        "y(t) = {sign}P[u](t) + offset",
        "P[u](t) = p0 u(t) + \u03a3 p\u1d62 F\u1d68[u](t),  \u03c1 = r\u1d62 + \u03b2 |du/dt|",
    ),
}
_DYNAMICS = "y(t) = G[v](t)"
_PLAY_TEXT = (
    "F with radius r is a play (backlash of half-width r): its output rests until its input has "
    "come r away from it, and then follows at that distance. The sum of plays gives the loop and "
    "its minor loops; p0 is the part without hysteresis."
)
_MAP_TEXT = {
    "gpi": "\u03b3 is a piecewise linear map of the input before the plays; it bends the loop over "
    "the input, so that it may be asymmetric and saturate.",
    "mpi": "\u039b is a piecewise linear map after the plays; it bends the loop over the output, "
    "so that it may be asymmetric.",
    "rdpi": "The faster the input moves, the wider the plays: \u03b2 (beta) is the growth of their "
    "radii with the rate of the input; the figure shows them at rest.",
}
_SLOPES_TEXT = (
    "In the table below this map is called dead_zone: each of its weights is the change of slope "
    "at a threshold; the thresholds are in the model file."
)
_DYNAMICS_TEXT = (
    "v is the output of the hysteresis, which nobody measured. G is linear dynamics of gain 1 at "
    "rest, in the table y_k = b[0] v_k + b[1] v_(k-1) + .. - a[1] y_(k-1) - ..; a delay comes on "
    "top."
)
_LINEAR_TEXT = "This model has no hysteresis: the output depends on the present input alone."

_POWER_LAW_TEXT = (
    "Right after a reversal the output follows the input with the slope c1; the further the input "
    "goes, the steeper it gets. With nested memory a branch that closes a loop goes on along the "
    "branch the loop started from, so that minor loops close."
)


def family_name(family: str) -> str:
    """Give the full name of a family.

    Examples
    --------
    >>> family_name("mpi"), family_name("new")
    ('modified Prandtl-Ishlinskii model', 'new model')
    """
    return FAMILY_NAMES.get(family, f"{family} model")


def equations(family: str, model: Operator) -> tuple[str, ...]:
    """Give the equations of a model of a family in plain characters; none for an unknown family."""
    parameters = model.parameters()
    gains = [v for n, v in zip(parameters.names, parameters.values, strict=True) if "gain" in n]
    sign = "-" if family != "linear" and gains and gains[-1] < 0.0 else ""
    return tuple(each.format(sign=sign) for each in _EQUATIONS.get(family, ()))


def explanations(family: str) -> tuple[str, ...]:
    """Say what the signs in the equations mean."""
    if family == "linear":
        return (_LINEAR_TEXT,)
    if family == "ramberg-osgood":
        return (_POWER_LAW_TEXT,)
    slopes = _SLOPES_TEXT if family in ("gpi", "mpi") else ""
    return tuple(text for text in (_PLAY_TEXT, _MAP_TEXT.get(family, ""), slopes) if text)


def equations_of(identified: Identified) -> tuple[str, ...]:
    """Give the equations of what was identified, those of the dynamics included."""
    if not isinstance(identified, IdentifiedHammerstein):
        return equations(identified.family, identified.model)
    front = equations(identified.hysteresis_family, identified.hysteresis)
    return (*(each.replace("y(t)", "v(t)", 1) for each in front), _DYNAMICS)


def explanations_of(identified: Identified) -> tuple[str, ...]:
    """Say what the signs in the equations of what was identified mean."""
    if not isinstance(identified, IdentifiedHammerstein):
        return explanations(identified.family)
    return (*explanations(identified.hysteresis_family), _DYNAMICS_TEXT)


def command_method(identified: Identified) -> str:
    """Name the method that turns a whole reference into a command; empty where there is none.

    Parameters
    ----------
    identified
        The result.

    Returns
    -------
    str
        ``"exact"`` where there is an exact inverse.
    """
    if identified.model.is_invertible():
        return "exact"
    if isinstance(identified, IdentifiedHammerstein):
        return "noncausal" if identified.inverse_of_dynamics is not None else ""
    return "trajectory" if identified.family == "rdpi" else ""


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
    """Say in a few sentences what was found and how good it is.

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
    sentences = [f"The model is a {family_name(identified.family)}{_plays_of(identified)}."]
    unit = identified.description.output_unit
    training = identified.metrics.get("training")
    if training is not None:
        line = straight_line_rms(records[0], identified.used[0].start)
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
    sentences += [
        lag_sentence(identified),
        invertible_sentence(identified.model),
    ]
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
    if not isinstance(identified, IdentifiedHammerstein):
        return delay_sentence(identified.delay, identified.description.dt)
    delay = identified.dynamics.delay
    if delay == 0:
        return "The dynamics have no delay beside their own lag."
    time = number(delay * identified.dynamics.dt)
    return f"The dynamics contain a delay of {delay} sample{'s' * (delay > 1)} ({time} s)."


def delay_sentence(delay: int, dt: float | None) -> str:
    """Say by how much the output lags.

    Parameters
    ----------
    delay
        Whole samples.
    dt
        Sample time, s, if known.

    Returns
    -------
    str
    """
    if delay == 0:
        return "The output does not lag by a whole sample or more."
    time = "" if dt is None else f" ({number(delay * dt)} s)"
    return (
        f"The recorded output lags the model by {delay} sample{'s' * (delay > 1)}{time}. The "
        "model itself has no delay; the lag is kept in the model file and cannot be compensated, "
        "only anticipated, by giving the command that much earlier."
    )


def invertible_sentence(model: Operator) -> str:
    """Say whether there is an exact inverse, or what stands in its way.

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


def _plays_of(identified: Identified) -> str:
    count = sum(name.rpartition(".")[2].startswith("r[") for name in identified.parameter_names)
    if count == 0:
        return ""
    return f" with {count} play{'s' * (count > 1)}"
