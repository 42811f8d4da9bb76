"""The yardstick in words, and what it makes of a verdict."""

from __future__ import annotations

from hyst.identification.families.hammerstein.yardstick.yardstick import TELLS, Yardstick
from hyst.identification.judgement.causes.dynamics import DYNAMICS
from hyst.identification.judgement.left_over import NOT_FOUND, SAME_CYCLE
from hyst.operators import Verdict
from hyst.operators.verdict import Level

UNFIT_RATIO, UNFIT_SHARE = 1.4, 0.1
"""Ratio, and what is left beside noise over the output's deviation, from which it is unfit."""

LIKE_LINEAR, LINEAR_SHARE = 0.7, 0.05
"""Of what linear dynamics leave beside noise, from which hysteresis explains nothing; and the
share of the output's deviation from which that is unfit."""

FAIR_SHARE = 0.01
"""Of the output's deviation: a smaller rms beside noise is not worth a word."""

LEAST_DOUBTED, MOST_DOUBTED = 0.05, 0.5
"""Of the output's deviation, between which the structure is doubted: with less, the drive may not
show it, with more it is the fit that failed."""

_ADVICE = {
    "dynamics": (
        "Give G more states (--state-order), leave out dynamics that were given, or drive a band "
        "that shows what is missing."
    ),
    "hysteresis": (
        "Try another hysteresis in front (--hysteresis) or more plays (--plays), or leave out one "
        "that was given."
    ),
    "both": (
        "Try another hysteresis in front (--hysteresis), more plays (--plays) and more states "
        "(--state-order)."
    ),
    "structure": (
        "Use a model that is built otherwise, as dynamics before the hysteresis or on both sides "
        "of it (hyst.fit), or measure at the input of the dynamics."
    ),
    "unknown": (
        "Compare a record of another amplitude and of another band, to see where the model fails."
    ),
}


def lowered(verdict: Verdict, yardstick: Yardstick, unit: str) -> Verdict:
    """Lower a verdict to what a yardstick allows, and tell the ratio if it is no good one.

    Parameters
    ----------
    verdict
        By what the model leaves alone.
    yardstick
        What richer models leave.
    unit
        Of the output, as text.
    """
    level = level_of(yardstick)
    # The model has dynamics: no advice to use one that has.
    before = tuple(each for each in verdict.sentences if each != DYNAMICS.advice)
    if level == "good":
        return Verdict(verdict.level, before)
    told = sentences(yardstick, unit)
    if _missing(yardstick) != "unknown":  # then it has been found
        before = tuple(each for each in before if not each.endswith((NOT_FOUND, SAME_CYCLE)))
    if verdict.level == "unfit":
        return Verdict("unfit", (*before, *told))
    if level == "unfit":
        told = (f"No command should come from this model. {told[0]}", *told[1:])
    # That what is left is noise is what the yardstick denies.
    return Verdict(level, (*told, *(before if verdict.level == "fair" else before[1:])))


def level_of(yardstick: Yardstick) -> Level:
    """Give the best level that a yardstick allows.

    Parameters
    ----------
    yardstick
        What richer models leave.
    """
    left = yardstick.beside_noise(yardstick.model)
    if yardstick.ratio >= UNFIT_RATIO and (left >= UNFIT_SHARE or _is_like_linear(yardstick)):
        return "unfit"
    return "fair" if yardstick.ratio >= TELLS and left >= FAIR_SHARE else "good"


def sentences(yardstick: Yardstick, unit: str) -> tuple[str, ...]:
    """Say what a model leaves beside richer ones, what it lacks, and what to do about it.

    Parameters
    ----------
    yardstick
        What richer models leave.
    unit
        Of the output, as text.
    """
    said = f" {unit}" if unit else ""
    percent = 100.0 * yardstick.model / yardstick.deviation
    first = (
        f"The model leaves {yardstick.model:.3g}{said} rms ({percent:.2g} % of the output's "
        f"deviation), {in_one_line(yardstick)}."
    )
    missing = _missing(yardstick)
    told = [first, _meaning(yardstick, missing, said)]
    if missing != "dynamics" and _is_like_linear(yardstick):
        told.append(
            f"Linear dynamics without hysteresis leave {yardstick.linear:.3g}{said}: the model "
            "is hardly better, or worse."
        )
    return (*told, _ADVICE[missing])


def in_one_line(yardstick: Yardstick) -> str:
    """Tell the ratio and what it refers to.

    Parameters
    ----------
    yardstick
        What richer models leave.
    """
    if yardstick.best == yardstick.noise:
        other = "the noise from one period of the drive to the next"
    elif yardstick.best == yardstick.linear:
        other = "what linear dynamics without hysteresis leave"
    elif yardstick.best == yardstick.other_dynamics:
        other = "what other dynamics behind its hysteresis leave"
    elif yardstick.best == yardstick.both:
        other = "what other hysteresis and dynamics leave"
    else:
        other = "what plays with dynamics of their own, or of the output, leave"
    ratio = yardstick.ratio
    times = f"{ratio:.3g}" if ratio < 1000.0 else "more than 1000"
    return f"{times} times {other}"


def _is_like_linear(yardstick: Yardstick) -> bool:
    left = yardstick.beside_noise(yardstick.model)
    line = yardstick.beside_noise(yardstick.linear)
    return left >= max(LINEAR_SHARE, LIKE_LINEAR * line)


def _missing(yardstick: Yardstick) -> str:
    missing, left = yardstick.missing, yardstick.beside_noise(yardstick.model)
    doubtful = missing == "structure" and not LEAST_DOUBTED <= left <= MOST_DOUBTED
    return "unknown" if doubtful else missing


def _meaning(yardstick: Yardstick, missing: str, said: str) -> str:
    hysteresis, both = f"{yardstick.other_hysteresis:.3g}{said}", f"{yardstick.both:.3g}{said}"
    if missing == "dynamics":
        return (
            "Other dynamics behind the same hysteresis leave "
            f"{yardstick.other_dynamics:.3g}{said}: G lacks a resonance, a zero or a part of its "
            "delay, as far as this drive tells."
        )
    if missing == "hysteresis":
        return (
            f"Another hysteresis before the same dynamics leaves {hysteresis}: the loops are of "
            "another shape, as far as this drive tells."
        )
    if missing == "both":
        return (
            f"Another hysteresis with other dynamics behind it leaves {both}: the loops are of "
            "another shape, or G is wrong as well."
        )
    if missing == "structure":
        return (
            f"Any hysteresis followed by linear dynamics leaves about {both}, but hysteresis or a "
            "curve of the output, or plays with dynamics of their own, "
            f"{yardstick.generous:.3g}{said}: it is no hysteresis followed by linear dynamics. It "
            "lies behind them, as the curve of a sensor does, or in a feedback."
        )
    return (
        "Neither another hysteresis, nor other dynamics, nor plays with dynamics of their own "
        "explain what it is."
    )
