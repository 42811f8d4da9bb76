"""What the estimator of radii is made from, and what its state means."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.checks.arrays import one_each
from hyst.checks.numbers import as_not_negative, as_number, as_positive, given_or
from hyst.errors import InputError
from hyst.models import PrandtlIshlinskii
from hyst.online.checks import memory_or_none
from hyst.online.estimator_file import check_saved_radii
from hyst.online.joint.parts import take_apart
from hyst.operators import Operator

Array = NDArray[np.float64]

_TOLERANCES = {"gradient": 1.0, "least-squares": 0.25}
# Places of the scalars in the state, as radius_estimator.h has them.
_INPUT, _DIRECTION, _EXTREME = 9, 10, 11


def checked_settings(start: PrandtlIshlinskii, given: Mapping[str, Any]) -> dict[str, Any]:
    """Check what an estimator is made from; in the form its file has.

    Parameters
    ----------
    start
        Weights, radii and memory.
    given
        The other arguments of ``RadiusEstimator``.

    Raises
    ------
    InputError
        If a weight or gain is negative, or a number is out of range.
    """
    n = start.p.size
    if (start.p < 0.0).any():
        worst = int(np.argmin(start.p))
        raise InputError(
            f"p[{worst + 1}] is {start.p[worst]:.6g}; slopes tell regimes apart only where "
            "every weight is positive, so use the joint estimator"
        )
    gains = one_each(given["gain"], n, "gain", "play")
    if (gains < 0.0).any():
        raise InputError(f"gain has the entry {gains.min():.6g}; give gains of at least 0")
    largest = float(start.r[-1]) if n else 0.0
    most = given["most_radius"]
    bound = (1e3 * largest or 1e9) if most is None else most
    if as_positive(bound, "most_radius", "a radius") < largest:
        raise InputError(
            f"most_radius is {bound:.6g}, but the start has r[{n}] = {largest:.6g}; raise the "
            "bound or start below it"
        )
    share = given_or(given["tolerance"], _TOLERANCES.get(given["method"], 1.0))
    return {
        "p": start.p.tolist(),
        "r": start.r.tolist(),
        "gain": gains.tolist(),
        "dt": given["dt"],
        "p0": start.p0,
        "method": given["method"],
        "memory": memory_or_none(given["memory"]),
        "filter_time": as_not_negative(given["filter_time"], "filter_time"),
        "dead_time": as_not_negative(given["dead_time"], "dead_time"),
        "dead_band": as_not_negative(given["dead_band"], "dead_band"),
        "tolerance": as_positive(share, "tolerance", "a share", most=1.0),
        "most_radius": float(bound),
        "z0": start.z0.tolist(),
        "offset": as_number(given["offset"], "offset"),
    }


def new_core(settings: Mapping[str, Any]) -> _engine.RadiusEstimation:
    """Make the core from checked settings.

    Parameters
    ----------
    settings
        As ``checked_settings`` gives them.

    Raises
    ------
    InputError
        If the method is unknown, or the gradient would diverge.
    """
    p, gains, dt = np.array(settings["p"]), np.array(settings["gain"]), settings["dt"]
    is_gradient = settings["method"] == "gradient"
    if not is_gradient and settings["method"] != "least-squares":
        raise InputError(f"method is {settings['method']!r}; choose 'gradient' or 'least-squares'")
    speed = dt * float(gains @ p**2)
    if is_gradient and speed >= 2.0:
        raise InputError(
            f"dt sum(gain p^2) is {speed:.6g}, at which the gradient diverges; keep it below 2"
        )
    core = _engine.RadiusEstimation(
        settings["p0"], p.tolist(), (gains * dt).tolist(), gains.tolist()
    )
    memory = settings["memory"]
    kept = 1.0 if memory is None else max(1.0 - dt / memory, 0.5)
    core.set_method(not is_gradient, kept**-0.5, settings["most_radius"])
    filter_time = settings["filter_time"]
    core.set_slope_filter(
        math.exp(-dt / filter_time) if filter_time > 0.0 else 0.0,
        round(settings["dead_time"] / dt),
        settings["dead_band"],
        settings["tolerance"],
    )
    return core


def memory_of(state: Array, at: Mapping[str, int], r: Array) -> Array:
    """Give what plays hold after the inputs that the state has seen, shape (n,).

    Parameters
    ----------
    state
        Of the core.
    at
        Places in it.
    r
        Shape (n,), radii of this moment.
    """
    home, side = state[at["home"] : at["side"]], state[at["side"] : at["age"]]
    z, before = home + side * r, float(state[_INPUT])
    s = float(state[_DIRECTION])
    if s != 0.0:
        z = s * np.maximum(s * z, s * float(state[_EXTREME]) - r)
    # No play is farther from the one before than their radii allow, the first from the input.
    for i, gap in enumerate(np.diff(r, prepend=0.0).tolist()):
        z[i] = before = min(max(float(z[i]), before - gap), before + gap)
    return z


def radii_of(model: Operator, settings: Mapping[str, Any]) -> Array:
    """Give the radii of a model of the same weights and offset.

    Parameters
    ----------
    model
        Plays with at most an offset behind them.
    settings
        Of the estimator.

    Raises
    ------
    InputError
        If it is another model, or a radius is out of bounds.
    """
    parts = take_apart(model)
    fixed = (parts.pi.p0, parts.pi.p.tolist(), parts.after.gain, parts.after.offset)
    own = (settings["p0"], settings["p"], 1.0, settings["offset"])
    around = (parts.before, parts.front, parts.back)
    if fixed != own or any(each is not None for each in around):
        raise InputError(
            "the model has other weights or another offset than the one at the start; give one "
            "that differs in radii alone"
        )
    check_saved_radii(parts.pi.r, settings["most_radius"])
    return parts.pi.r


def reasons_of(
    names: tuple[str, ...], p: Array, sides: Array, method: str, measures_regimes: bool
) -> dict[str, str]:
    """Say why radii are not determined, by name.

    Parameters
    ----------
    names, p, sides
        Of the plays: names of radii, weights, and envelopes they were on last (0: none yet).
    method
        Of the estimator.
    measures_regimes
        Whether regimes were taken from the measured slope.
    """
    if method == "gradient":
        return dict.fromkeys(names, "the gradient has no standard error")
    if measures_regimes:
        return dict.fromkeys(
            names, "regimes come from the measured slope, which noise and large steps make wrong"
        )
    reasons = {}
    for name, weight, side in zip(names, p.tolist(), sides.tolist(), strict=True):
        if weight == 0.0:
            reasons[name] = "its weight is 0, so it does not show"
        elif side == 0.0:
            reasons[name] = "the input has not turned while its play was on an envelope"
    return reasons
