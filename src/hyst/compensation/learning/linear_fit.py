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

PEN = 2.0
_FEWEST_BINS = 40
_CLEAR = 3.0
_TURNED, _RESIZED = 0.8, 0.5
_BEYOND, _CAUTION, _SEEN = 1.6, 2.0, 0.6
_ROUNDS = 6

_AT_REST = 0.1
"""By what a plant at rest is held to depart from the model; no record says it of rest itself."""

_START, _LEAST_MISSED = 0.1, 1e-3
"""Of the signal: what the model's hysteresis is taken to miss at first, and at least."""

_MOST_BINS = 4000
"""Of a spectrum; longer ones are thinned at high frequency."""


@dataclass(frozen=True, eq=False)
class Pair:
    """What the model was told to give, and what was measured; both shape (N,)."""

    v: Array
    y: Array


def gain_over(pairs: list[Pair], noise: float) -> tuple[float, float]:
    """Give the criterion of a gain alone, and the gain."""
    found = _fitted(pairs, noise, 0, 1, 0)
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
    found = [
        each
        for delay in delays
        for poles, zeros in _SIZES
        for each in (_fitted(pairs, noise, poles, zeros, delay),)
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
    pairs: list[Pair], noise: float, poles: int, zeros: int, delay: int
) -> tuple[float, LinearPart] | None:
    """Fit one size; its information criterion beside it."""
    spectra = [_spectrum(each, delay) for each in pairs]
    used = _shown(spectra, _CLEAR * noise * np.sqrt(pairs[0].v.size))
    spectra = [(z[used], v[used], y[used]) for z, v, y in spectra]
    z = spectra[0][0]
    n, m = poles, zeros
    tail = max(n, m - 1)
    count = n + m + tail * len(pairs)
    if 2 * z.size * len(pairs) < 4 * count:
        return None
    powers = z[:, None] ** np.arange(max(n, m - 1) + 1)
    floor = _CLEAR * noise * np.sqrt(pairs[0].v.size)
    below = np.ones(z.size, dtype=complex)
    around = [_smooth(np.abs(v), z.size) for _, v, _ in spectra]
    missed = _START
    size = [np.hypot(missed * each, floor) for each in around]
    theta, cost, covariance = np.zeros(0), np.inf, np.zeros((0, 0))
    for _ in range(_ROUNDS):
        rows, wanted = [], []
        for k, (_, v, y) in enumerate(spectra):
            weight = 1.0 / (np.abs(below) * size[k])
            own = np.zeros((z.size, tail * len(pairs)), dtype=complex)
            own[:, tail * k : tail * (k + 1)] = powers[:, :tail]
            row = np.concatenate(
                [-powers[:, 1 : n + 1] * y[:, None], powers[:, :m] * v[:, None], own], axis=1
            )
            rows.append(row * weight[:, None])
            wanted.append(y * weight)
        left, right = np.concatenate(rows), np.concatenate(wanted)
        rest = np.zeros(count)
        rest[:n], rest[n : n + m] = -1.0, 1.0
        at_rest = 1.0 / (_AT_REST * abs(1.0 + theta[:n].sum())) if theta.size else 1.0 / _AT_REST
        left = np.concatenate([left.real, left.imag, rest[None, :] * at_rest])
        right = np.concatenate([right.real, right.imag, [at_rest]])
        scale = np.linalg.norm(left, axis=0)
        if not (np.isfinite(scale).all() and (scale > 0.0).all()):
            return None
        q, triangle = np.linalg.qr(left / scale)
        if np.abs(np.diag(triangle)).min() < 1e-12:
            return None
        inverse = np.linalg.inv(triangle)
        theta = (inverse @ (q.T @ right)) / scale
        covariance = (inverse @ inverse.T) / np.outer(scale, scale) * 0.5
        a, b = theta[:n], theta[n : n + m]
        if n and np.abs(np.roots(np.concatenate([[1.0], a]))).max() >= 1.0:
            return None
        below = powers[:, : n + 1] @ np.concatenate([[1.0], a])
        above = powers[:, :m] @ b
        rests = []
        for k, (_, v, y) in enumerate(spectra):
            own = powers[:, :tail] @ theta[n + m + tail * k : n + m + tail * (k + 1)]
            rests.append(np.abs(y - (above * v + own) / below))
        around = [_smooth(np.abs(above * v), z.size) / np.abs(below) for _, v, _ in spectra]
        missed = _share_missed(rests, around, floor, missed)
        size = [
            np.sqrt(
                (missed * each) ** 2
                + (_smooth(np.abs(below) * rest, z.size) / np.abs(below)) ** 2
                + floor**2
            )
            for each, rest in zip(around, rests, strict=True)
        ]
    cost = sum(
        float(np.sum(2.0 * np.log(own) + (rest / own) ** 2))
        for rest, own in zip(rests, size, strict=True)
    )
    shown = 2 * sum(int(np.count_nonzero(missed * each > floor)) for each in around)
    if shown < 2 * (n + m):
        shown = 2
    score = cost + PEN * count * np.log(2.0 + shown) + (1e30 if shown < 2 * (n + m) and n else 0.0)
    k = n + m
    return score, LinearPart(theta[n:k], theta[:n], delay, covariance[:k, :k])


def doubt_of(pairs: list[Pair], linear: LinearPart, noise: float) -> tuple[Array, Array]:
    """Give frequencies, in cycles a sample, and how far the linear part may be wrong there.

    Where a mode is seen, its shape is believed around it.
    """
    frequency, doubt = _own_doubt(pairs, linear, noise)
    reach = float(linear.modes().max(initial=0.0)) * _BEYOND
    fitted = np.where(frequency <= reach, _CAUTION * linear.doubt(frequency), np.inf)
    return frequency, np.minimum(doubt, fitted)


def _own_doubt(pairs: list[Pair], linear: LinearPart, noise: float) -> tuple[Array, Array]:
    """Give frequencies, in cycles a sample, and how far the linear part may be wrong there.

    What it leaves of each repetition over what there was to be left, in bands of a third of an
    octave; a band without signal tells nothing.
    """
    length = pairs[0].v.size
    edges = np.unique(np.concatenate([[1, 3], np.geomspace(5, (length + 1) // 2, 40).astype(int)]))
    known = np.zeros(edges.size - 1)
    frequency = np.fft.rfftfreq(2 * length)
    for each in pairs:
        v = _apart(each.v, length)
        y = _apart(each.y, length)
        whole, got = np.fft.rfft(v), np.fft.rfft(y)
        rest = np.fft.irfft(got - linear.at(frequency) * whole, 2 * length)[:length]
        window = np.hanning(length)
        left = np.abs(np.fft.rfft(window * (rest - rest.mean()))) ** 2
        told = np.fft.irfft(linear.at(frequency) * whole, 2 * length)[:length]
        there = np.abs(np.fft.rfft(window * (told - told.mean()))) ** 2
        for k, (a, b) in enumerate(pairwise(edges.tolist())):
            floor = 0.375 * noise**2 * length
            known[k] += max(there[a:b].mean() - floor, 0.0) / max(left[a:b].mean(), floor)
    middles = np.sqrt(edges[:-1] * edges[1:]) / length
    return middles, 1.0 / np.sqrt(np.maximum(known, 1e-12))


def _apart(signal: Array, length: int) -> Array:
    """Give a record from its first level, its last one held as long again and led back."""
    own = signal - signal[0]
    fade = 0.5 + 0.5 * np.cos(np.pi * (np.arange(length) + 1.0) / (length + 1.0))
    return np.concatenate([own, own[-1] * fade])


def _shown(spectra: list[tuple[Complex, Complex, Complex]], floor: float) -> NDArray[np.bool_]:
    """Give the frequencies at which a dynamics of the plant could be seen in the noise."""
    used = np.zeros(spectra[0][0].size, dtype=bool)
    for _, v, y in spectra:
        used |= np.maximum(_smooth(np.abs(v), v.size), _smooth(np.abs(y), v.size)) > floor
    used[:_FEWEST_BINS] = True
    return used


def _share_missed(rests: list[Array], around: list[Array], floor: float, missed: float) -> float:
    """Give which share of the signal at every frequency the linear part does not explain."""
    for _ in range(3):
        above = below = 0.0
        for rest, each in zip(rests, around, strict=True):
            own = (missed * each) ** 2
            shown = (own / (own + floor**2)) ** 2
            above += float(
                np.sum(shown * np.maximum((rest**2 - floor**2), 0.0) / np.maximum(each**2, 1e-300))
            )
            below += float(np.sum(shown))
        missed = float(np.sqrt(above / below)) if below > 0.0 else missed
        missed = max(missed, _LEAST_MISSED)
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


def _smooth(size: Array, count: int) -> Array:
    """Give the rms of a spectrum around every bin, over a band that grows with frequency."""
    power = np.concatenate([[0.0], np.cumsum(size**2)])
    at = np.arange(count)
    half = 2 + at // 5
    first, last = np.maximum(at - half, 0), np.minimum(at + half + 1, count)
    return np.asarray(np.sqrt((power[last] - power[first]) / (last - first)))
