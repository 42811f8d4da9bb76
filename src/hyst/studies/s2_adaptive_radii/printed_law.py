"""The law as it is printed, and inputs for which it does not converge though remark 3 says so."""

from __future__ import annotations

import itertools
import math
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hyst.online import RadiusEstimator, Trajectory
from hyst.report.table import Table, number
from hyst.signals import Record
from hyst.studies.s2_adaptive_radii.paper import DT, GAIN, PLAYS, P, R

Array = NDArray[np.float64]
Reading = Literal["last reversal", "estimated plays"]

SECONDS = 100.0
# What is added to 30 sin x, x = 2 pi t, and the share of the radii the estimate starts from.
CASES = (
    ("30 sin x + 6 sin 9x", 6.0, 9.0, 0.0),
    ("30 sin x + 6 sin 5x", 6.0, 5.0, 1.5),
)


def nested(height: float, factor: float, seconds: float = SECONDS) -> Array:
    """Give ``30 sin x + height sin(factor x)``, x = 2 pi t: minor loops in each period.

    Parameters
    ----------
    height, factor
        Of the second sine.
    seconds
        How long.
    """
    x = 2.0 * np.pi * np.arange(round(seconds / DT)) * DT
    return np.asarray(30.0 * np.sin(x) + height * np.sin(factor * x))


def true_regimes(u: Array, r: Array) -> Array:
    """Count the plays of radii ``r`` on the envelope that ``u`` moves along; NaN while it rests."""
    regimes = np.full(u.size, math.nan)
    z, before = np.zeros(r.size), float(u[0])
    for k, v in enumerate(u.tolist()):
        z = np.clip(z, v - r, v + r)
        s = (v > before) - (v < before)
        if s:
            regimes[k] = np.count_nonzero(s * (v - z) >= r * (1.0 - 1e-12))
        before = v
    return regimes


def printed_law(
    u: Array, y: Array, regimes: Array, start: Array, reading: Reading, every: int = 1000
) -> Array:
    """Run eqs. 17-23 as printed, with regimes of the true plays from outside.

    The modified error is that of eq. 17, ``s phi' (r - r_hat)`` where interior plays are on the
    envelope they left at the last reversal. Its two readings: the cases' own formula for the
    estimate, ``v(t_k-1) + r_hat`` for a play inside; or the estimate of eq. 7, whose plays have
    their own memory, less the cases' delta.

    Parameters
    ----------
    u, y
        Shape (N,), input and output without noise.
    regimes
        Shape (N,), plays on their envelopes; NaN while the input rests.
    start
        Shape (n,), radii.
    reading
        Of the modified error.
    every
        Keep the radii after every so many samples.

    Returns
    -------
    numpy.ndarray
        Shape (N // every, n).
    """
    r, p = start.tolist(), P.tolist()
    z = np.clip(0.0, u[0] - start, u[0] + start).tolist()
    turned_at, before, s = float(u[0]), float(u[0]), 0.0
    r_then, z_then = list(r), list(z)
    kept = []
    for k, (v, out, regime) in enumerate(
        zip(u.tolist(), y.tolist(), regimes.tolist(), strict=True), 1
    ):
        way = (v > before) - (v < before)
        if way and way != s:
            turned_at, s = before, float(way)
            r_then, z_then = list(r), list(z)
        before = v
        z = [max(v - r_i, min(v + r_i, z_i)) for r_i, z_i in zip(r, z_then, strict=True)]
        if way:
            on = int(regime)
            if reading == "last reversal":
                error = _error_of_cases(p, r, on, s, v, turned_at) - out
            else:
                error = _error_of_plays(p, r, on, s, v - turned_at, (z, r_then, v)) - out
            step = DT * GAIN * s * error
            r = [
                r_i + (step if i < on else -step) * p_i
                for i, (r_i, p_i) in enumerate(zip(r, p, strict=True))
            ]
            r = _ordered(r)
        if k % every == 0:
            kept.append(r)
    return np.array(kept)


def _error_of_cases(
    p: list[float], r: list[float], on: int, s: float, v: float, turned_at: float
) -> float:
    """Give the output the cases write down, with ``on`` plays on their envelopes."""
    return sum(
        p_i * (v - s * r_i if i < on else turned_at + s * r_i)
        for i, (p_i, r_i) in enumerate(zip(p, r, strict=True))
    )


def _error_of_plays(
    p: list[float],
    r: list[float],
    on: int,
    s: float,
    way: float,
    plays: tuple[list[float], list[float], float],
) -> float:
    """Give the output of eq. 7 less the delta of the case each play is in."""
    z, r_then, v = plays
    total = 0.0
    for i, (p_i, r_i, z_i) in enumerate(zip(p, r, z, strict=True)):
        is_outside = z_i == v - s * r_i
        if i < on:
            delta = 0.0 if is_outside else -way + s * (r_then[i] + r_i)
        else:
            delta = way - 2.0 * s * r_i if is_outside else s * (r_then[i] - r_i)
        total += p_i * (z_i - delta)
    return total


def _ordered(r: list[float]) -> list[float]:
    """Project onto ``0 <= r_1 <= .. <= r_n``: the nearest point, by pooling neighbours."""
    if r[0] >= 0.0 and all(a <= b for a, b in itertools.pairwise(r)):
        return r
    pools: list[tuple[float, int]] = []
    for each in r:
        pools.append((each, 1))
        while len(pools) > 1 and pools[-2][0] > pools[-1][0]:
            (a, m), (b, n) = pools[-2:]
            pools[-2:] = [((a * m + b * n) / (m + n), m + n)]
    return [max(mean, 0.0) for mean, count in pools for _ in range(count)]


def remark_3() -> Table:
    """Compute what the law makes of inputs that prop. 2 and remark 3 allow, without noise."""
    rows = []
    for name, height, factor, share in CASES:
        u = nested(height, factor)
        y, regimes, start = PLAYS(u), true_regimes(u, R), share * R
        own = RadiusEstimator(P, start, GAIN, DT)
        kept = own.run(Record(u, y, DT), u.size, regimes=regimes).values[-1]
        rows.append(
            (
                name,
                "u_m of the last reversal (eq. 17)",
                *_of(printed_law(u, y, regimes, start, "last reversal", u.size)[-1]),
            )
        )
        rows.append(
            (
                "",
                "estimate of eq. 7 less delta",
                *_of(printed_law(u, y, regimes, start, "estimated plays", u.size)[-1]),
            )
        )
        rows.append(("", "u_m of each play (hyst)", *_of(kept)))
    return Table(
        f"Remark 3 is false for the printed law: radii after {SECONDS:g} s without noise, true "
        "regimes (0.4, 1, 1.5, 2, 3.6 are true)",
        ("input", "interior plays", "r1", "r2", "r3", "r4", "r5", "worst [%]"),
        tuple(rows),
    )


def _of(radii: Array) -> tuple[str, ...]:
    worst = 100.0 * float(np.abs(radii / R - 1.0).max())
    return (*(f"{each:.3f}" for each in radii), number(worst, 2))


def trajectories() -> dict[str, Trajectory]:
    """Give the radii over time for the first case, of the printed law and of hyst's."""
    _, height, factor, share = CASES[0]
    u = nested(height, factor, 20.0)
    y, regimes, start = PLAYS(u), true_regimes(u, R), share * R
    own = RadiusEstimator(P, start, GAIN, DT).run(Record(u, y, DT), 200, regimes=regimes)
    values = printed_law(u, y, regimes, start, "last reversal", 200)
    unknown = np.full(values.shape, np.nan)
    printed = Trajectory(own.time, own.names, values, unknown, np.zeros(u.size))
    return {"u_m of the last reversal": printed, "u_m of each play": own}
