"""Loops of one range that differ with the rate at which they are run."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.loops import CELLS, INNER_SHARE, Loop, mean_loop
from hyst.diagnosis.wording import amount, percent

Array = NDArray[np.float64]

NAME = "rate dependence"
_LEAST_RATIO = 1.4  # of rates that are told apart
_SAME_RATE = 1.15
_LEAST = 0.005  # of the height of the loop, rms
_LEAST_NOISES = 5.0
_LAG_EXPLAINS = 0.8
# A branch between two samples is taken as straight; of so much per square of samples in a cell.
_COARSE = 0.02


@dataclass(frozen=True, eq=False)
class Pace:
    """Loops of one range at one rate.

    Parameters
    ----------
    rate
        Mean of ``|du/dt|``, input units per second.
    curve
        Rising branch, then falling branch, without offset, shape (2 CELLS,).
    rates
        ``|du/dt|`` along it, of sign +1 on the rising and -1 on the falling branch.
    noise
        rms error of the curve.
    width
        Widest opening over the height.
    height
        Range of the output.
    span
        Range of the input that the cells cover.
    coarseness
        What few samples may bend the curve by, over its height.
    first
        One of the loops.
    """

    rate: float
    curve: Array
    rates: Array
    noise: float
    width: float
    height: float
    span: float
    coarseness: float
    first: Loop


def find(evidence: Evidence) -> Iterator[Finding]:
    """Warn where loops at different rates differ by more than their noise."""
    paces = _paces(evidence)
    if len(paces) < 2:
        return
    slow, fast = paces[0], paces[-1]
    if fast.rate < _LEAST_RATIO * slow.rate:
        return
    change = fast.curve - slow.curve
    size = float(np.sqrt(np.mean(change**2)))
    height = max(slow.height, fast.height)
    noise = float(np.hypot(slow.noise, fast.noise))
    coarse = max(each.coarseness for each in (slow, fast)) + slow.first.mismatch(fast.first)
    if size < max(_LEAST * height, _LEAST_NOISES * noise, coarse * height):
        return
    lag, explained = _lag(paces)
    record = next(record for _, record in evidence.numbered())
    sentence = (
        f"loops at {amount(slow.rate, '')} and {amount(fast.rate, record.input_unit, 's')} differ "
        f"by {percent(size / height)} of the output's range (rms; noise {percent(noise / height)}):"
        f" the loop is {percent(slow.width)} wide at the lower and {percent(fast.width)} at the "
        "higher rate"
    )
    amounts = {
        "slowest": slow.rate,
        "fastest": fast.rate,
        "difference": size,
        "share": size / height,
        "slowest width": slow.width,
        "fastest width": fast.width,
    }
    advice = "A model without rates cannot describe both: try --family rdpi."
    if explained > _LAG_EXPLAINS and lag > 0.0:
        amounts["lag"] = lag
        sentence += f"; an output that is {amount(lag, 's')} late would explain it"
        advice = (
            "Such a lag comes of filters and of dynamics of actuator or amplifier: try --delay "
            "auto, --family hammerstein or --family rdpi, and compare."
        )
    yield Finding(NAME, "warning", f"{sentence}.", advice, amounts=amounts)


def _paces(evidence: Evidence) -> list[Pace]:
    """Give the loops of the one range that was run at the most different rates, slowest first."""
    loops = [
        (loop, evidence.noise(number))
        for number, _ in evidence.numbered()
        for loop in evidence.loops(number)
        if loop.closed
    ]
    best: list[tuple[Loop, float | None]] = []
    spread = _LEAST_RATIO
    left = loops
    while left:
        alike = [each for each in left if each[0].comparable(left[0][0])]
        left = [each for each in left if not each[0].comparable(left[0][0])]
        rates = [each.rate for each, _ in alike]
        if max(rates) >= spread * min(rates):
            best, spread = alike, max(rates) / min(rates)
    best.sort(key=lambda each: each[0].rate)
    paces: list[Pace] = []
    while best:
        same = [each for each in best if each[0].rate <= _SAME_RATE * best[0][0].rate]
        best = best[len(same) :]
        paces.append(_pace(tuple(each for each, _ in same), [noise for _, noise in same]))
    return paces


def _pace(loops: tuple[Loop, ...], noises: list[float | None]) -> Pace:
    up, down = mean_loop(loops)
    curves = np.array([np.concatenate([each.up, each.down]) - each.middle.mean() for each in loops])
    curve = np.concatenate([up, down])
    known = [each for each in noises if each is not None]
    cells = float(np.mean([each.samples for each in loops]))
    noise = max(known, default=0.0) / np.sqrt(max(cells, 1.0) * len(loops))
    if len(loops) > 1:
        scatter = float(np.sqrt(np.mean((curves - curve) ** 2)) / np.sqrt(len(loops) - 1))
        noise = max(noise, scatter)
    rates = np.concatenate(
        [
            np.mean([each.up_rate for each in loops], axis=0),
            -np.mean([each.down_rate for each in loops], axis=0),
        ]
    )
    height = float(np.mean([each.height for each in loops]))
    width = float(np.abs(down - up).max()) / height if height > 0.0 else 0.0
    rate = float(np.mean([each.rate for each in loops]))
    span = float(np.mean([each.high - each.low for each in loops])) * INNER_SHARE
    return Pace(rate, curve, rates, float(noise), width, height, span, _COARSE / cells**2, loops[0])


def _lag(paces: list[Pace]) -> tuple[float, float]:
    """Give the time by which the output would have to be late, and the least share it explains.

    The lag is fitted to the slowest and the fastest loops; those between must agree.
    """
    slow = paces[0]
    cell = slow.span / CELLS
    slope = np.concatenate([np.gradient(slow.curve[:CELLS]), np.gradient(slow.curve[CELLS:])])
    # A late output is that of an input by rate times lag behind.
    patterns = [-slope / cell * (each.rates - slow.rates) for each in paces[1:]]
    changes = [each.curve - slow.curve for each in paces[1:]]
    energy = float(patterns[-1] @ patterns[-1])
    if energy == 0.0:
        return 0.0, 0.0
    lag = float(patterns[-1] @ changes[-1]) / energy
    shares = []
    for pace, pattern, change in zip(paces[1:], patterns, changes, strict=True):
        left = change - lag * pattern
        noise = change.size * (pace.noise**2 + slow.noise**2)
        shares.append(1.0 - max(float(left @ left) - noise, 0.0) / float(change @ change))
    return lag, min(shares)
