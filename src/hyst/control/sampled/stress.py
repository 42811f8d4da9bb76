"""A search for plants within the uncertainty that break a block, as good as certificates are."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, final

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.checks.numbers import whole_number
from hyst.control.discretization import discretize
from hyst.control.largest_value import largest
from hyst.control.linear_system import LinearSystem, balanced, in_series
from hyst.control.sampled.block_loop import BlockLoop
from hyst.control.sampled.certificate import plant_of_block, stable_weight
from hyst.control.sampled.folding import folded_uncertainty
from hyst.control.sampled.plant import SampledPlant, sampled_plant
from hyst.control.tracking_controller import TrackingController
from hyst.errors import InputError

Array = NDArray[np.float64]

_ALIASES = 8  # on each side, whose phases are directed
_DAMPINGS = (0.3, 0.1, 0.03, 0.01, 0.003)
_ROUNDING = 100.0 * float(np.finfo(float).eps)
_AS_GOOD_AS_A_GAIN = 0.9998


@final
@dataclass(frozen=True, eq=False)
class StressTest:
    """What a search for a plant within Wu that breaks a block found.

    Parameters
    ----------
    tried
        Number of plants.
    broken
        Number of those around which the sampled loop is unstable.
    radius
        Largest modulus of a pole of all loops.
    worst
        The plant of that loop; continuous, or sampled where the nominal one is.
    """

    tried: int
    broken: int
    radius: float
    worst: LinearSystem

    @property
    def holds(self) -> bool:
        """Whether no plant was found that breaks the block."""
        return self.broken == 0


def stress(
    block: TrackingController,
    plant: Any,
    Wu: Any,
    tries: int = 100,
    *,
    delay: float = 0.0,
    slope: float = 1.0,
    seed: int = 0,
) -> StressTest:
    """Look for a plant within Wu around which a sampled block is unstable.

    Each plant is ``P = Pn (1 + Wu Delta)`` with a stable Delta, ``|Delta| <= 1``, sampled exactly.
    The first few have phases that add up at the frequency where the certificate is weakest, at its
    aliases too; the others are drawn at random.

    Parameters
    ----------
    block, plant, Wu, delay
        As in ``sampled_certificate``.
    tries
        Number of plants, >= 1.
    slope
        Of hysteresis after inverse, a gain in the loop.
    seed
        The same seed gives the same plants.

    Returns
    -------
    StressTest

    Raises
    ------
    InputError
        As ``sampled_certificate``, or if there is nothing to try.

    Notes
    -----
    Finding nothing proves nothing; the certificate does. Finding one refutes it.

    Examples
    --------
    >>> quick = TrackingController.from_continuous(([900.0], [1.0, 0.0]), dt=1e-3)
    >>> stress(quick, ([100.0], [1.0, 100.0]), Wu=0.1, tries=20).holds
    True
    >>> stress(quick, ([100.0], [1.0, 100.0]), Wu=0.9, tries=20).holds
    False
    """
    loop = BlockLoop(block, plant_of_block(plant, block, delay))
    weight = _realized(stable_weight(Wu, "Wu"), loop)
    count, draw = whole_number(tries, "tries", 1), np.random.default_rng(seed)
    broken, radius, worst = 0, -1.0, loop.plant.system
    deltas = _deltas(loop, weight, slope, draw)
    for _, delta in zip(range(count), deltas, strict=False):
        true = _deviated(loop.plant, weight, delta)
        sampled = sampled_plant(true, loop.dt, loop.plant.delay if true.dt == 0.0 else 0.0)
        grows, size = _judged(BlockLoop(block, sampled).closed(slope))
        broken += grows
        if size > radius:
            radius, worst = size, true
    return StressTest(count, int(broken), radius, worst)


def _judged(closed: LinearSystem) -> tuple[bool, float]:
    """Tell whether a loop is unstable by more than rounding of its poles, and their radius."""
    poles = closed.poles()
    radius = float(np.abs(poles).max(initial=0.0))
    if radius < 1.0:
        return False, radius
    A = balanced(closed).A
    found, left, right = scipy.linalg.eig(A, left=True, right=True)
    # What a deviation that is slow against a sample brings is as good as a double pole at 1.
    alike = np.abs(np.sum(left.conj() * right, axis=0))
    unsure = _ROUNDING * np.linalg.norm(A, 2) / np.maximum(alike, 1e-300)
    if (np.abs(found) >= 1.0 + unsure).any():
        return True, radius
    return False, float(np.nextafter(1.0, 0.0))


def _deviated(plant: SampledPlant, Wu: LinearSystem, delta: LinearSystem) -> LinearSystem:
    """Give ``P = Pn (1 + Wu Delta)``, continuous where the nominal plant is."""
    nominal = plant.system if plant.continuous is None else plant.continuous
    off = in_series(Wu, delta)
    one_more = LinearSystem(off.A, off.B, off.C, off.D + 1.0, off.dt)
    return in_series(one_more, nominal)


def _deltas(
    loop: BlockLoop, Wu: LinearSystem, slope: float, draw: np.random.Generator
) -> Iterator[LinearSystem]:
    """Directed ones first, then random ones without end."""
    yield from _directed(loop, Wu, slope)
    nyquist = np.pi / loop.dt
    while True:
        total = _gain(draw.choice([-1.0, 1.0]) * draw.uniform(0.5, 1.0))
        for _ in range(int(draw.integers(1, 4))):
            w = nyquist * 10.0 ** draw.uniform(-2.5, 0.7)
            damping = 10.0 ** draw.uniform(-2.5, 0.3)
            kind = int(draw.integers(0, 4))
            total = in_series(total, _factor(kind, w, damping))
        yield _of_time(total, loop)


def _factor(kind: int, w: float, damping: float) -> LinearSystem:
    """All-pass of first or second order, band-pass or low-pass: none is above 1."""
    if kind == 0:
        return _first_order(w)
    if kind == 1:
        return _second_order(w, damping)
    den = [1.0, 2.0 * damping * w, w**2]
    if kind == 2:
        return _of([0.0, 2.0 * damping * w, 0.0], den)
    return _of([0.0, w], [1.0, w])


def _directed(loop: BlockLoop, Wu: LinearSystem, slope: float) -> Iterator[LinearSystem]:
    """Deviations whose phases add up against the loop where it is weakest."""
    w = loop.grid(Wu, slope=slope)

    def row(at: Array) -> Array:
        return np.asarray(folded_uncertainty(loop.plant, Wu, at) * np.abs(loop.at(at, slope).N))

    _, weakest = largest(row, w)
    values = row(w)
    others = w[np.argsort(-values)][:: max(1, w.size // 20)]
    for at in (weakest, *others[:4]):
        for damping in _DAMPINGS:
            yield _of_time(_pointing(loop, Wu, slope, float(at), damping), loop)


def _pointing(
    loop: BlockLoop, Wu: LinearSystem, slope: float, w: float, damping: float
) -> LinearSystem:
    """Make an all-pass with ``N P Wu H Delta = -|N P Wu H|`` at a frequency and its aliases."""
    wanted, at = _wanted_phases(loop, Wu, slope, w)
    for sign in (1.0, -1.0):
        if (sign * np.cos(wanted) > _AS_GOOD_AS_A_GAIN).all():
            return _gain(sign)
    total = _gain(1.0)
    # Each section turns its own frequency; what the others do there is taken off, a few times.
    turns = wanted.copy()
    for _ in range(20):
        total = _gain(1.0)
        for each, turn in zip(at, turns, strict=True):
            total = in_series(total, _turning(float(each), float(turn), damping))
        reached = np.angle(total.response(1j * at)[:, 0, 0])
        off = (wanted - reached + np.pi) % (2.0 * np.pi) - np.pi
        if np.abs(off).max() < 1e-6:
            break
        turns = turns + off
    return total


def _wanted_phases(
    loop: BlockLoop, Wu: LinearSystem, slope: float, w: float
) -> tuple[Array, Array]:
    N = loop.at(np.array([w]), slope).N[0]
    if loop.plant.continuous is None:
        z = np.exp(1j * np.array([w]) * loop.dt)
        value = loop.plant.system.response(z)[:, 0, 0] * Wu.response(z)[:, 0, 0] * N
        # All-passes are made in continuous time and sampled by the bilinear rule, which maps w so.
        at = np.array([2.0 / loop.dt * np.tan(0.5 * min(w * loop.dt, 0.999 * np.pi))])
        return np.pi - np.angle(value), at
    k = np.arange(-_ALIASES, _ALIASES + 1)
    signed = w + 2.0 * np.pi * k / loop.dt
    s = 1j * signed
    hold = (1.0 - np.exp(-s * loop.dt)) / s * np.exp(-s * loop.plant.delay)
    value = loop.plant.continuous.response(s)[:, 0, 0] * Wu.response(s)[:, 0, 0] * hold * N
    large = np.flatnonzero(np.abs(value) > 5e-4 * np.abs(value).max())
    phase = np.pi - np.angle(value[large])
    # Of a real Delta the value at -w is the conjugate of that at w.
    return np.where(signed[large] < 0.0, -phase, phase), np.abs(signed[large])


def _turning(w: float, turn: float, damping: float) -> LinearSystem:
    """Make an all-pass with a phase of ``turn`` at w, 0 far below and far above it."""
    angle = turn % (2.0 * np.pi)
    # Phase of (w0^2 - 2 z w0 s + s^2) / (w0^2 + 2 z w0 s + s^2) is -2 atan2(2 z w0 w, w0^2 - w^2).
    tangent = (2.0 * np.pi - angle) / 2.0
    cotangent = np.cos(tangent) / max(np.sin(tangent), 1e-9)
    ratio = damping * cotangent + np.sqrt((damping * cotangent) ** 2 + 1.0)
    return _second_order(w * ratio, damping)


def _second_order(w: float, damping: float) -> LinearSystem:
    return _of([1.0, -2.0 * damping * w, w**2], [1.0, 2.0 * damping * w, w**2])


def _first_order(w: float) -> LinearSystem:
    return _of([-1.0, w], [1.0, w])


def _gain(value: float) -> LinearSystem:
    return LinearSystem(np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0)), np.array([[value]]))


def _of(num: list[float], den: list[float]) -> LinearSystem:
    """Realize a factor of first or second order in states of like size."""
    if len(den) == 2:
        w = den[1]
        return LinearSystem(
            np.array([[-w]]), np.array([[w]]),
            np.array([[num[1] / w - num[0]]]), np.array([[num[0]]]),
        )  # fmt: skip
    w = float(np.sqrt(den[2]))
    rest = np.array([[(num[2] - num[0] * den[2]) / w**2, (num[1] - num[0] * den[1]) / w]])
    A = np.array([[0.0, w], [-w, -den[1]]])
    return LinearSystem(A, np.array([[0.0], [w]]), rest, np.array([[num[0]]]))


def _of_time(delta: LinearSystem, loop: BlockLoop) -> LinearSystem:
    """Give a continuous Delta as the plant needs it: the bilinear rule keeps its norm."""
    if loop.plant.continuous is not None:
        return delta
    return discretize(delta, loop.dt, "tustin")


def _realized(Wu: LinearSystem, loop: BlockLoop) -> LinearSystem:
    """Give Wu in the time of the plant; a sampled one is nowhere above a continuous one."""
    if loop.plant.continuous is not None:
        if Wu.dt > 0.0:
            raise InputError(
                "Wu is sampled and the plant continuous: its plants between samples are not known; "
                "give Wu in continuous time, or the sampled plant"
            )
        return Wu
    if Wu.dt > 0.0 or Wu.order == 0:
        return LinearSystem(Wu.A, Wu.B, Wu.C, Wu.D, loop.dt)
    sampled = discretize(Wu, loop.dt, "tustin")
    w = loop.grid(Wu)
    ratio = np.abs(Wu.response(1j * w)) / np.maximum(
        np.abs(sampled.response(np.exp(1j * w * loop.dt))), 1e-300
    )
    share = min(1.0, float(ratio.min()))
    return LinearSystem(sampled.A, sampled.B, share * sampled.C, share * sampled.D, loop.dt)
