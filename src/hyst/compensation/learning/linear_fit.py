"""The linear part of a plant behind the model's inverse, from one or more repetitions.

In the spectrum of a record, with what it was before and after it as a polynomial T,

    A(z) Y = z^-d B(z) V + T(z) + A(z) R

is linear in the coefficients. What is left, R, is noise and what the model's hysteresis misses; it
is far larger at the low harmonics of the reference than beyond them, so that its size over
frequency is estimated too and every frequency weighs as much as it can be trusted: Sanathanan and
Koerner, IEEE Trans. Autom. Control 8 (1963) 56, eq. 7, iterated with R.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hyst.compensation.learning.linear_part import LinearPart

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

_SIZES = ((0, 1), (0, 2), (2, 1), (2, 2), (2, 3), (4, 5))
"""Poles and coefficients above them."""

_PENALTY = 2.0
"""Of the information criterion: four times BIC's, as what is left is no white noise."""

_NOT_SHOWN = 1e9

_FEWEST_BINS = 40

_CLEAR = 3.0
"""Times the noise: changes of a command have come from noise too, so that more counts as none."""

_SEEN = 0.6
"""Of the response: what is left of it at most where a mode counts as seen."""

_TURNED, _RESIZED = 0.8, 0.5
"""Radians, and the logarithm of a size: more than a hysteresis does to a harmonic."""

_BEYOND, _CAUTION = 1.6, 2.0
"""Times its frequency: how far a mode's shape is believed; and times its standard error."""

_SURE = 0.06
"""No response is known better."""

_SMEARED = 2.0
"""Sum of the sizes of weights over their sum, at most, without poles."""

_ROUNDS = 6
_TINY, _SINGULAR, _ROUNDING, _SAME = 1e-150, 1e-12, 1e-9, 1e-12

_AT_REST = 0.1
"""By what a plant at rest is held to depart from the model; no record says it of rest itself."""

_START, _LEAST_MISSED = 0.1, 1e-3
"""Of the signal: what the model's hysteresis is taken to miss at first, and at least."""

_MOST_BINS = 4000
"""Of a spectrum; longer ones are thinned at high frequency."""


@dataclass(frozen=True, eq=False)
class Pair:
    """What the model was told to give, and what was measured.

    Parameters
    ----------
    v, y
        Shape (N,).
    """

    v: Array
    y: Array


def gain_over(pairs: list[Pair], noise: float) -> tuple[float, float]:
    """Give the criterion of a gain alone, and the gain.

    Parameters
    ----------
    pairs, noise
        As of ``fit_linear_part``.
    """
    found = _fitted(pairs, noise, 0, 1, 0, _seen_frequencies(pairs, noise))
    return (np.inf, 1.0) if found is None else (found[0], float(found[1].b[0]))


def fit_linear_part(
    pairs: list[Pair], noise: float, delays: tuple[int, ...]
) -> tuple[float, LinearPart]:
    """Find the linear part that explains repetitions, of the size that they pay for.

    Parameters
    ----------
    pairs
        Of one length.
    noise
        Rms of what does not repeat, output units.
    delays
        To try, samples.
    """
    shown = _seen_frequencies(pairs, noise)
    found = [
        each
        for delay in delays
        for poles, zeros in _SIZES
        for each in (_fitted(pairs, noise, poles, zeros, delay, shown),)
        if each is not None
    ]
    for score, linear in sorted(found, key=lambda each: each[0]):
        if _is_seen(linear, pairs, noise):
            return score, linear
    return np.inf, LinearPart.one()


def _is_seen(linear: LinearPart, pairs: list[Pair], noise: float) -> bool:
    """Tell whether repetitions show what a linear part does, and that it is no hysteresis.

    Every mode must be seen where it is, and somewhere the phase must turn, or the size change, by
    more than a hysteresis does: at low frequency alone, a lag or a delay looks the same.
    """
    if linear.b.size == 1 and not linear.order and not linear.delay:
        return True
    frequency, doubt = _own_doubt(pairs, linear, noise)
    modes = linear.modes()
    if modes.size and not (np.interp(modes, frequency, doubt) < _SEEN).all():
        return False
    relative = linear.at(frequency[doubt < _SEEN]) / linear.at([0.0])[0].real
    turned = np.abs(np.angle(relative)) > _TURNED
    return bool((turned | (np.abs(np.log(np.abs(relative) + 1e-300)) > _RESIZED)).any())


def _fitted(
    pairs: list[Pair],
    noise: float,
    poles: int,
    zeros: int,
    delay: int,
    seen: tuple[Array, NDArray[np.bool_]],
) -> tuple[float, LinearPart] | None:
    """Fit one size; its information criterion beside it.

    A delay leaves fewer bins, and the logarithm of a size in any unit is no reason for that: the
    criterion is for the same frequencies, and as many of them, whatever the delay.
    """
    task = _task(pairs, noise, poles, zeros, delay, seen)
    if 2 * task.z.size * len(pairs) < 4 * task.count:
        return None
    below: Complex = np.ones(task.z.size, dtype=complex)
    around = [_smooth(np.abs(v)) for v in task.v]
    missed, theta, rests = _START, np.zeros(0), list[Array]()
    size = [np.hypot(missed * each, task.floor) for each in around]
    covariance = np.zeros((0, 0))
    for _ in range(_ROUNDS):
        solved = _solved(task, below, size, theta)
        if solved is None:
            return None
        theta, covariance = solved
        below, above, rests = _left(task, theta)
        around = [_smooth(np.abs(above * v)) / np.abs(below) for v in task.v]
        missed = _share_missed(rests, around, task.floor, missed)
        size = [
            _sizes(*each, below, missed, task.floor) for each in zip(rests, around, strict=True)
        ]
    cost = sum(
        float(np.sum(2.0 * np.log(own) + (rest / own) ** 2))
        for rest, own in zip(rests, size, strict=True)
    )
    cost *= int(np.count_nonzero(seen[1])) / task.z.size
    shown = 2 * sum(int(np.count_nonzero(missed * each > task.floor)) for each in around)
    n, k = poles, poles + zeros
    if theta[n:k].sum() <= 0.0 or 1.0 + theta[:n].sum() <= 0.0:
        return None  # the other way round at rest
    if not n and np.abs(theta[:k]).sum() > _SMEARED * abs(theta[:k].sum()):
        return None  # a differentiator: the delay was taken too large
    if shown < 2 * k:
        cost, shown = cost + (_NOT_SHOWN if n else 0.0), 2
    score = cost + _PENALTY * task.count * np.log(2.0 + shown)
    return score, LinearPart(theta[n:k], theta[:n], delay, covariance[:k, :k])


@dataclass(frozen=True, eq=False)
class _Task:
    """Spectra of pairs at the frequencies that tell, and the size that is fitted."""

    z: Complex
    v: list[Complex]
    y: list[Complex]
    poles: int
    zeros: int
    floor: float

    @property
    def tail(self) -> int:
        """Coefficients of what was before and after a record, for each."""
        return max(self.poles, self.zeros - 1)

    @property
    def count(self) -> int:
        """All coefficients."""
        return self.poles + self.zeros + self.tail * len(self.v)

    @property
    def powers(self) -> Complex:
        """Of z^-1, a column each."""
        return np.asarray(self.z[:, None] ** np.arange(max(self.poles, self.zeros - 1) + 1))


def _task(
    pairs: list[Pair],
    noise: float,
    poles: int,
    zeros: int,
    delay: int,
    seen: tuple[Array, NDArray[np.bool_]],
) -> _Task:
    spectra = [_spectrum(each, delay) for each in pairs]
    frequency, shown = seen
    own = _bins(pairs[0].v.size - delay) / (pairs[0].v.size - delay)
    used = shown[np.minimum(np.searchsorted(frequency, own - _SAME), shown.size - 1)]
    floor = _floor(pairs, noise)
    v, y = [each[1][used] for each in spectra], [each[2][used] for each in spectra]
    return _Task(spectra[0][0][used], v, y, poles, zeros, floor)


def _floor(pairs: list[Pair], noise: float) -> float:
    """Give the size of a spectrum that noise, or rounding, has."""
    size = float(np.sqrt(pairs[0].v.size))
    largest = max(float(np.std(each.y)) for each in pairs)
    return max(_CLEAR * noise * size, _ROUNDING * largest * size)


def _seen_frequencies(pairs: list[Pair], noise: float) -> tuple[Array, NDArray[np.bool_]]:
    """Give frequencies, cycles a sample, and whether a dynamics of the plant is seen at them."""
    spectra = [_spectrum(each, 0) for each in pairs]
    length = pairs[0].v.size
    return _bins(length) / length, _shown(spectra, _floor(pairs, noise))


def _solved(
    task: _Task, below: Complex, size: list[Array], last: Array
) -> tuple[Array, Array] | None:
    """Solve the linear least squares with the weights of the round before; a, b, and all T."""
    n, m, tail, powers = task.poles, task.zeros, task.tail, task.powers
    rows, wanted = [], []
    for k, (v, y) in enumerate(zip(task.v, task.y, strict=True)):
        weight = 1.0 / np.maximum(np.abs(below) * size[k], _TINY)
        own = np.zeros((task.z.size, tail * len(task.v)), dtype=complex)
        own[:, tail * k : tail * (k + 1)] = powers[:, :tail]
        parts = [-powers[:, 1 : n + 1] * y[:, None], powers[:, :m] * v[:, None], own]
        rows.append(np.concatenate(parts, axis=1) * weight[:, None])
        wanted.append(y * weight)
    left, right = np.concatenate(rows), np.concatenate(wanted)
    rest = np.zeros(task.count)
    rest[:n], rest[n : n + m] = -1.0, 1.0
    at_rest = 1.0 / (_AT_REST * (abs(1.0 + last[:n].sum()) if last.size else 1.0))
    left = np.concatenate([left.real, left.imag, rest[None, :] * at_rest])
    right = np.concatenate([right.real, right.imag, [at_rest]])
    scale = np.linalg.norm(left, axis=0)
    if not (np.isfinite(scale).all() and (scale > 0.0).all()):
        return None
    q, triangle = np.linalg.qr(left / scale)
    if np.abs(np.diag(triangle)).min() < _SINGULAR:
        return None
    inverse = np.linalg.inv(triangle)
    theta = (inverse @ (q.T @ right)) / scale
    if n and np.abs(np.roots(np.concatenate([[1.0], theta[:n]]))).max() >= 1.0:
        return None
    return theta, (inverse @ inverse.T) / np.outer(scale, scale) * 0.5


def _left(task: _Task, theta: Array) -> tuple[Complex, Complex, list[Array]]:
    """Give A and B over frequency, and the size of what a fit leaves of every record."""
    n, m, tail, powers = task.poles, task.zeros, task.tail, task.powers
    below = powers[:, : n + 1] @ np.concatenate([[1.0], theta[:n]])
    above = powers[:, :m] @ theta[n : n + m]
    rests = []
    for k, (v, y) in enumerate(zip(task.v, task.y, strict=True)):
        first = n + m + tail * k
        own = powers[:, :tail] @ theta[first : first + tail]
        rests.append(np.abs(y - (above * v + own) / below))
    return below, above, rests


def _sizes(rest: Array, around: Array, below: Complex, missed: float, floor: float) -> Array:
    """Give how large what is left is taken to be: it passes the same poles."""
    shaped = _smooth(np.abs(below) * rest) / np.abs(below)
    return np.sqrt((missed * around) ** 2 + shaped**2 + floor**2 + _TINY**2)


def doubt_of(pairs: list[Pair], linear: LinearPart, noise: float) -> tuple[Array, Array]:
    """Give frequencies, in cycles a sample, and how far the linear part may be wrong there.

    Where a mode is seen, its shape is believed around it.

    Parameters
    ----------
    pairs, noise
        As of ``fit_linear_part``.
    linear
        What was found.
    """
    frequency, doubt = _own_doubt(pairs, linear, noise)
    reach = float(linear.modes().max(initial=0.0)) * _BEYOND
    fitted = np.where(frequency <= reach, _CAUTION * linear.doubt(frequency), np.inf)
    both = np.minimum(doubt, fitted)
    return frequency, both if linear.order else _beyond(frequency, both)


def _beyond(frequency: Array, doubt: Array) -> Array:
    """Extend a doubt to higher frequencies: a mode that is not known departs as their square."""
    least = np.minimum.accumulate(np.maximum(doubt, _SURE) / frequency**2)
    return np.minimum(doubt, least * frequency**2)


def _own_doubt(pairs: list[Pair], linear: LinearPart, noise: float) -> tuple[Array, Array]:
    """Give what the linear part leaves of repetitions over what it gives of them.

    In bands of a third of an octave; a band without signal tells nothing.
    """
    length = pairs[0].v.size
    edges = np.unique(np.concatenate([[1, 3], np.geomspace(5, (length + 1) // 2, 40).astype(int)]))
    known = np.zeros(edges.size - 1)
    response = linear.at(np.fft.rfftfreq(2 * length))
    window = np.hanning(length)
    floor = noise**2 * float(np.sum(window**2))
    for each in pairs:
        told = np.fft.irfft(response * np.fft.rfft(_apart(each.v)), 2 * length)[:length]
        rest = each.y - each.y[0] - told
        left = np.abs(np.fft.rfft(window * (rest - rest.mean()))) ** 2
        there = np.abs(np.fft.rfft(window * (told - told.mean()))) ** 2
        for k, (a, b) in enumerate(pairwise(edges.tolist())):
            below = max(float(left[a:b].mean()), floor, _TINY)
            known[k] += max(float(there[a:b].mean()) - floor, 0.0) / below
    middles = np.sqrt(edges[:-1] * edges[1:]) / length
    return middles, 1.0 / np.sqrt(np.maximum(known, 1e-12))


def _apart(signal: Array) -> Array:
    """Give a record from its first level, its last one led back as long again."""
    own = signal - signal[0]
    fade = 0.5 + 0.5 * np.cos(np.pi * (np.arange(own.size) + 1.0) / (own.size + 1.0))
    return np.concatenate([own, own[-1] * fade])


def _shown(spectra: list[tuple[Complex, Complex, Complex]], floor: float) -> NDArray[np.bool_]:
    """Give the frequencies at which a dynamics of the plant could be seen in the noise."""
    used = np.zeros(spectra[0][0].size, dtype=bool)
    for _, v, y in spectra:
        used |= np.maximum(_smooth(np.abs(v)), _smooth(np.abs(y))) > floor
    used[:_FEWEST_BINS] = True
    return used


def _share_missed(rests: list[Array], around: list[Array], floor: float, missed: float) -> float:
    """Give which share of the signal at every frequency the linear part does not explain."""
    for _ in range(3):
        above = below = 0.0
        for rest, each in zip(rests, around, strict=True):
            power = np.maximum(each**2, _TINY)
            shown = (missed**2 * power / (missed**2 * power + floor**2)) ** 2
            above += float(np.sum(shown * np.maximum(rest**2 - floor**2, 0.0) / power))
            below += float(np.sum(shown))
        missed = max(float(np.sqrt(above / below)) if below > 0.0 else missed, _LEAST_MISSED)
    return missed


def _spectrum(pair: Pair, delay: int) -> tuple[Complex, Complex, Complex]:
    """Give z^-1 and the two spectra at the frequencies of a record, 0 left out."""
    length = pair.v.size - delay
    v, y = pair.v[:length] - pair.v[0], pair.y[delay:] - pair.y[0]
    bins = _bins(length)
    z = np.exp(-2j * np.pi * bins / length)
    return z, np.fft.rfft(v)[bins], np.fft.rfft(y)[bins]


def _bins(length: int) -> NDArray[np.intp]:
    """Give the bins that are looked at."""
    last = (length - 1) // 2
    if last <= _MOST_BINS:
        return np.arange(1, last + 1)
    dense = _MOST_BINS // 2
    sparse = np.unique(np.geomspace(dense + 1, last, _MOST_BINS - dense).astype(np.intp))
    return np.concatenate([np.arange(1, dense + 1), sparse])


def _smooth(size: Array) -> Array:
    """Give the rms of a spectrum around every bin, over a band that grows with frequency."""
    power = np.concatenate([[0.0], np.cumsum(size**2)])
    at = np.arange(size.size)
    half = 2 + at // 5
    first, last = np.maximum(at - half, 0), np.minimum(at + half + 1, size.size)
    return np.asarray(np.sqrt((power[last] - power[first]) / (last - first)))
