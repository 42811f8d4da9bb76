"""Records that the fit has not seen, and how much worse the model is there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from hyst.operators.verdict import Level
from hyst.signals import Metrics

FAR_ABOVE = 3.0
"""Times the training error, beyond which validation is told as what it is."""

HARDLY_BETTER_THAN_THE_MEAN = 20.0
"""Percent of the deviation from the mean that a model must explain of a record."""

ANOTHER_AMPLITUDE = 1.25
OFFSET = ", free offset"


@dataclass(frozen=True)
class Validation:
    """What validation records say.

    Parameters
    ----------
    level
        The best that a verdict may be.
    sentences
        What they show; empty where the model is as good as on its own records.
    """

    level: Level
    sentences: tuple[str, ...]


def validated(metrics: Mapping[str, Metrics], noise: float, unit: str) -> Validation:
    """Compare the errors on records that the fit has not seen with those on its own.

    Parameters
    ----------
    metrics
        Errors by record.
    noise
        Of the training records, output units.
    unit
        Of the output, as text.
    """
    training = metrics.get("training")
    level: Level = "good"
    sentences = []
    for name, each in metrics.items():
        if training is None or not name.startswith("validation") or name.endswith(OFFSET):
            continue
        if each.rms <= FAR_ABOVE * max(training.rms, noise, 5e-4 * training.output_range):
            continue
        level = "unfit" if level == "unfit" or _is_unfit(each) else "fair"
        sentences.append(_sentence(name, training, each, metrics.get(name + OFFSET), unit))
    return Validation(level, tuple(sentences))


def _is_unfit(each: Metrics) -> bool:
    return each.nrmse_fit_percent < HARDLY_BETTER_THAN_THE_MEAN


def _sentence(
    name: str, training: Metrics, each: Metrics, centred: Metrics | None, unit: str
) -> str:
    said = f" {unit}" if unit else ""
    return (
        f"On {name} the model misses by {each.rms:.3g}{said} rms "
        f"({each.rms_percent:.3g} % of its range), {_times(each, training)} as on the records it "
        f"was identified from ({training.rms:.3g}{said}): {_reason(training, each, centred)}."
    )


def _times(each: Metrics, training: Metrics) -> str:
    ratio = each.rms / training.rms if training.rms > 0.0 else float("inf")
    return f"{ratio:.2g} times as much" if ratio < 1000.0 else "more than 1000 times as much"


def _reason(training: Metrics, each: Metrics, centred: Metrics | None) -> str:
    if centred is not None and centred.rms * FAR_ABOVE < each.rms:
        return f"its zero is off by {abs(each.bias):.3g}, the rest of it fits"
    if each.output_range > ANOTHER_AMPLITUDE * training.output_range:
        return "it is driven further than the model has seen"
    if each.output_range * ANOTHER_AMPLITUDE < training.output_range:
        return "it is driven less far, and the records do not determine smaller loops"
    return (
        "it holds what the training records do not, as minor loops, another rate or another "
        "amplitude, and the model does not carry over"
    )
