"""What a scale estimate knows, and what no estimate can have reached."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.online.joint.innovation import Innovation
from hyst.online.knowledge import Knowledge, knowledge_from

Array = NDArray[np.float64]

_LEAST_SAMPLES = 10
# The samples must know the scale twice as well as the start was believed in.
_LEAST_GAIN = 0.5
_TOLD_WIDENESS = 4.0
_AGAIN = "which no estimator reaches; save the estimator again"
_NOT_NEGATIVE = ("noise", "variance", "mean_variance", "weight", "ww", "used", "skipped", "refused")


@final
@dataclass(frozen=True)
class ScaleSums:
    """What the core has summed up.

    Parameters
    ----------
    variance, mean_variance, slope_variance
        Of the scale, of the mean output, and of the scale by the samples alone; negative while
        they say nothing.
    noise, product
        Mean squares of residuals, and of their products with the ones before.
    noise_samples, used
        How many there are in these means, and altogether.
    wide_slope, wide_mean, wide_samples
        By what variances are widened, and over how many samples errors follow each other.
    mean_w, swing, slope
        Mean of the model's output, its range, as of a sine of its standard deviation, and the scale
        by the samples alone, whatever its bounds.
    start
        Scale to start from.
    """

    variance: float
    mean_variance: float
    slope_variance: float
    noise: float
    product: float
    noise_samples: int
    used: int
    wide_slope: float
    wide_mean: float
    wide_samples: int
    mean_w: float
    swing: float
    slope: float
    start: float

    @classmethod
    def of(cls, state: Array, at: Mapping[str, int]) -> Self:
        """Read them from a state.

        Parameters
        ----------
        state
            Shape (length,).
        at
            Its places, by name.

        Returns
        -------
        ScaleSums
        """
        ww, weight = float(state[at["ww"]]), float(state[at["slope_weight"]])

        def number(name: str) -> float:
            return float(state[at[name]])

        return cls(
            variance=number("variance"),
            mean_variance=number("mean_variance"),
            slope_variance=number("slope_variance"),
            noise=number("noise"),
            product=number("product"),
            noise_samples=int(number("noise_samples")),
            used=int(number("used")),
            wide_slope=number("wide_slope"),
            wide_mean=number("wide_mean"),
            wide_samples=int(number("wide_samples")),
            mean_w=number("mean_w"),
            swing=2.0 * math.sqrt(2.0 * ww / weight) if weight > 0.0 else 0.0,
            slope=number("wy") / ww if ww > 0.0 else 0.0,
            start=number("start"),
        )


def innovation_of(sums: ScaleSums, scale: float, settings: dict[str, Any]) -> Innovation:
    """Say what the estimate leaves unexplained.

    Parameters
    ----------
    sums
        Of the core.
    scale
        The estimate.
    settings
        Of the estimator.

    Returns
    -------
    Innovation
    """
    is_wide = max(sums.wide_slope, sums.wide_mean) >= _TOLD_WIDENESS
    if bound_of(sums, scale, settings):
        # The noise is that of the slope the samples have; on the bound more is left.
        more = (sums.slope - scale) ** 2 * sums.swing**2 / 8.0
        return Innovation(
            rms=math.sqrt(sums.noise + more),
            correlation=0.0,
            loop_height=abs(scale) * sums.swing,
            over=sums.used if more > sums.noise / max(sums.used, 1) else 0,
        )
    return Innovation(
        rms=math.sqrt(sums.noise),
        correlation=sums.product / sums.noise if sums.noise > 0.0 else 0.0,
        loop_height=abs(scale) * sums.swing,
        over=sums.wide_samples if is_wide else 0,
    )


def knowledge_of(
    sums: ScaleSums, parameters: Array, standard_errors: Array, settings: dict[str, Any]
) -> Knowledge:
    """Say what is known of scale and offset.

    Parameters
    ----------
    sums
        Of the core.
    parameters, standard_errors
        Shape (2,).
    settings
        Of the estimator.

    Returns
    -------
    Knowledge
    """
    reasons = _reasons(sums, float(parameters[0]), standard_errors, settings)
    names = ("scale", "offset")
    sentences = _sentences(sums, float(parameters[0]), settings)
    # Off its bounds the variances are widened by what errors that follow each other ask for.
    doubts = sentences if bound_of(sums, float(parameters[0]), settings) else ()
    said = () if doubts else sentences
    return knowledge_from(names, parameters, standard_errors, reasons, said, doubts)


def bound_of(sums: ScaleSums, scale: float, settings: dict[str, Any]) -> str:
    """Give the name of the bound that the estimate is on; empty if it is on none.

    Parameters
    ----------
    sums
        Of the estimator.
    scale
        The estimate.
    settings
        Of the estimator: the bounds over the start.
    """
    share = scale / sums.start
    return next((each for each in ("least", "most") if share == settings[each]), "")


def _reasons(
    sums: ScaleSums, scale: float, standard_errors: Array, settings: dict[str, Any]
) -> dict[str, str]:
    held, reasons = settings["held"], {}
    few = f"{sums.noise_samples} samples are too few"
    if "scale" not in held:
        why = few if sums.noise_samples < _LEAST_SAMPLES else _unknown_scale(sums, settings)
        bound = bound_of(sums, scale, settings)
        if bound:
            why = (
                f"it is on its bound, {bound} = {settings[bound]:.4g} of the start, where samples "
                f"alone say {sums.slope:.4g}; check sign and units of input and output"
            )
        if why:
            reasons["scale"] = why
    if "offset" not in held:
        by_scale = sums.mean_w**2 * sums.variance > sums.mean_variance
        by_scale = by_scale or bool(bound_of(sums, scale, settings))
        if sums.noise_samples < _LEAST_SAMPLES:
            reasons["offset"] = few
        elif "scale" in reasons and by_scale:
            reasons["offset"] = "it depends on the scale, which is not"
    return reasons


def _unknown_scale(sums: ScaleSums, settings: dict[str, Any]) -> str:
    spread = settings["spread"] * abs(sums.start)
    if sums.slope_variance < 0.0:
        return "the model's output has not moved"
    known = math.sqrt(sums.slope_variance)
    if known <= _LEAST_GAIN * spread:
        return ""
    return (
        f"the model's output swings by {sums.swing:.4g} in errors of {math.sqrt(sums.noise):.4g}, "
        f"which tells it to {known:.3g} only, the start to {spread:.3g}; move farther"
    )


def _sentences(sums: ScaleSums, scale: float, settings: dict[str, Any]) -> tuple[str, ...]:
    innovation = innovation_of(sums, scale, settings)
    if not innovation.over:
        return ()
    if bound_of(sums, scale, settings):
        return (f"{innovation}",)
    widest = max(sums.wide_slope, sums.wide_mean)
    return (
        f"{innovation}: the shape is not the plant's, or constants drift faster than the memory "
        f"forgets; bands are up to {math.sqrt(widest):.3g} times as wide as for noise, and hold "
        "for errors that do not repeat with the input",
    )


def refuse_state(state: Array, at: Mapping[str, int], settings: dict[str, Any]) -> None:
    """Refuse a saved state that no estimator can have reached.

    Parameters
    ----------
    state
        Shape (length,).
    at
        Its places.
    settings
        Of the estimator.

    Raises
    ------
    InputError
        If the scale is out of its bounds or 0, or a variance or count is negative.
    """
    start, scale = float(state[at["start"]]), float(state[at["scale"]])
    least, most = settings["least"], settings["most"]
    # A bound times the start may differ from the estimate on it in the last place.
    slack = 4.0 * np.finfo(np.float64).eps
    if start == 0.0 or not least * (1.0 - slack) <= scale / start <= most * (1.0 + slack):
        raise InputError(
            f"the saved estimate has scale = {scale:.6g} from the start {start:.6g}, outside "
            f"{least:.6g} to {most:.6g} times that, {_AGAIN}"
        )
    for name in _NOT_NEGATIVE:
        if state[at[name]] < 0.0:
            raise InputError(
                f"the saved estimate has {name.replace('_', ' ')} = {state[at[name]]:.6g}, {_AGAIN}"
            )
