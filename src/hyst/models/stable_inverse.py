"""The stable inverse of linear dynamics: two-sided, so it looks ahead.

1/G is expanded on the unit circle, ``1/G(z) = sum_i h_i z^-i``, i from -d to r. Zeros of G outside
the circle and missing samples (relative degree, delay) make h_i with i < 0: samples of the output
that are yet to come. So it serves whole records and trajectories, not a control loop.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Self, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import one_record
from hyst.checks.numbers import as_positive
from hyst.errors import NotInvertibleError
from hyst.models.linear_dynamics import LinearDynamics

Array = NDArray[np.float64]

SMALLEST_DISTANCE = 1e-3
"""Of a zero from the unit circle."""

LARGEST_LENGTH = 2**20
_ROLL_OFF = 1.3  # the gain falls to zero between the band limit and this multiple of it


@final
@dataclass(frozen=True, eq=False)
class StableInverse:
    """``v_k = sum_{i=-d}^{r} h_i y_{k-i}``, the truncated Laurent expansion of 1/G.

    Parameters
    ----------
    h
        Shape (d + 1 + r,), from ``h_{-d}`` to ``h_r``.
    preview
        d, samples of y ahead of k that are needed.
    dt
        Sample time, s.
    max_gain, max_gain_frequency
        Largest ``|1/G|`` on the unit circle, by which noise is amplified at most, and where, Hz.
    noise_gain
        By how much the standard deviation of white noise on y grows: ``sqrt(sum h_i^2)``.

    Notes
    -----
    S0 eqs. 45-47.

    Examples
    --------
    >>> G = LinearDynamics.from_zeros_poles_gain([1.6], [0.5, 0.3], 1.0, dt=1e-3)
    >>> inverse = StableInverse.of(G)
    >>> v = np.sin(np.arange(400) / 7.0)
    >>> edges = inverse.valid(400)
    >>> bool(np.abs(inverse(G(v)) - v)[edges].max() < 1e-9)
    True
    """

    h: Array
    preview: int
    dt: float
    max_gain: float
    max_gain_frequency: float
    noise_gain: float

    @classmethod
    def of(
        cls,
        dynamics: LinearDynamics,
        *,
        tolerance: float = 1e-12,
        band: float | None = None,
        smallest_distance: float = SMALLEST_DISTANCE,
    ) -> Self:
        """Expand 1/G.

        Parameters
        ----------
        dynamics
            G, stable, any relative degree and delay, minimum phase or not.
        tolerance
            The taps left out sum up to no more than this share of all.
        band
            Highest frequency to invert, Hz; above it the gain falls smoothly to zero at 1.3 times
            the limit. None inverts all.
        smallest_distance
            A zero nearer to the unit circle than this is refused, unless it is beyond the band.

        Returns
        -------
        StableInverse

        Raises
        ------
        NotInvertibleError
            If G is zero or not stable, or a zero lies on or next to the unit circle; it is named.
        InputError
            If an argument cannot be used.
        """
        as_positive(tolerance, "tolerance", "a share", most=0.1)
        nyquist = 0.5 / dynamics.dt
        if band is not None:
            as_positive(band, "band", "a frequency in Hz")
        _require_expandable(dynamics, band, smallest_distance)
        length = _first_length(dynamics, smallest_distance)
        while True:
            frequency = np.arange(length // 2 + 1) / (length * dynamics.dt)
            response = _inverse_response(dynamics, frequency, band)
            h = np.fft.irfft(response, length)
            taps, preview, complete = _truncated(h, tolerance)
            if complete or 2 * length > LARGEST_LENGTH:
                break
            length *= 2
        gain = np.abs(response)
        peak = int(gain.argmax())
        return cls(
            h=taps,
            preview=preview,
            dt=dynamics.dt,
            max_gain=float(gain[peak]),
            max_gain_frequency=float(min(frequency[peak], nyquist)),
            noise_gain=float(np.sqrt(np.square(taps).sum())),
        )

    @property
    def memory(self) -> int:
        """Give r, samples of y before k that are needed."""
        return self.h.size - 1 - self.preview

    def __call__(self, y: ArrayLike) -> Array:
        """Give the input that makes G answer with y.

        Parameters
        ----------
        y
            Shape (N,), finite. Before the first and after the last sample it is taken to rest at
            that sample's value.

        Returns
        -------
        numpy.ndarray
            Shape (N,). Samples outside ``valid(N)`` depend on what was not measured.

        Raises
        ------
        InputError
            If y is not one record of finite numbers.
        """
        signal = one_record(y, "y")
        padded = np.concatenate(
            [np.full(self.memory, signal[0]), signal, np.full(self.preview, signal[-1])]
        )
        return _convolve(padded, self.h)

    def valid(self, samples: int) -> slice:
        """Tell which samples of a record of that length depend on measured samples only.

        Parameters
        ----------
        samples
            Length of the record.

        Returns
        -------
        slice
            Empty if the record is shorter than the expansion.
        """
        return slice(min(self.memory, samples), max(samples - self.preview, 0))


def _require_expandable(
    dynamics: LinearDynamics, band: float | None, smallest_distance: float
) -> None:
    if not dynamics.is_stable():
        raise NotInvertibleError(
            f"the pole {dynamics.poles()[0]:.6g} does not lie inside the unit circle; only stable "
            "dynamics have an output to invert"
        )
    if dynamics.relative_degree() > dynamics.order + dynamics.delay:
        raise NotInvertibleError("G is zero: no input shows in the output")
    for zero in dynamics.zeros():
        frequency = abs(np.angle(zero)) / (2.0 * np.pi * dynamics.dt)
        beyond = band is not None and frequency > _ROLL_OFF * band
        if abs(abs(zero) - 1.0) < smallest_distance and not beyond:
            raise NotInvertibleError(
                f"the zero {zero:.6g} (|z| = {abs(zero):.6g}, {frequency:.6g} Hz) lies within "
                f"{smallest_distance:g} of the unit circle: what the input does there does not "
                "show in the output; limit the inverse to a band below that frequency"
            )


def _first_length(dynamics: LinearDynamics, smallest_distance: float) -> int:
    """Power of two so long that the slowest part of the expansion dies out within half of it."""
    moduli = np.abs(dynamics.zeros())
    moduli = moduli[np.abs(moduli - 1.0) >= smallest_distance]
    rates = np.where(moduli < 1.0, moduli, 1.0 / np.maximum(moduli, 1e-300))
    slowest = float(rates.max(initial=0.5))
    needed = 40.0 / -math.log(slowest) + 4.0 * (dynamics.order + dynamics.delay) + 64.0
    return int(min(2.0 ** math.ceil(math.log2(2.0 * needed)), LARGEST_LENGTH))


def _inverse_response(
    dynamics: LinearDynamics, frequency: Array, band: float | None
) -> NDArray[np.complex128]:
    passes = np.ones(frequency.size)
    if band is not None:
        # Smooth to all orders, so that the taps die out quickly.
        x = np.clip((frequency / band - 1.0) / (_ROLL_OFF - 1.0), 0.0, 1.0)
        inside = (x > 0.0) & (x < 1.0)
        bend = 1.0 / x[inside] - 1.0 / (1.0 - x[inside])
        passes = np.where(x >= 1.0, 0.0, 1.0)
        passes[inside] = 1.0 / (1.0 + np.exp(-np.clip(bend, -700.0, 700.0)))
    result = np.zeros(frequency.size, dtype=np.complex128)
    used = passes > 0.0
    result[used] = passes[used] / dynamics.frequency_response(frequency[used])
    return result


def _truncated(h: Array, tolerance: float) -> tuple[Array, int, bool]:
    """Taps in ascending order from -d to r, d, and whether both tails were found to die out."""
    half = h.size // 2
    ordered = np.concatenate([h[half:], h[:half]])  # from -half to half - 1
    size = np.abs(ordered)
    size[size < 2e-15 * size.max()] = 0.0  # rounding of the transform
    total = float(size.sum())
    left = np.cumsum(size) > 0.5 * tolerance * total
    right = np.cumsum(size[::-1]) > 0.5 * tolerance * total
    first, last = int(left.argmax()), size.size - 1 - int(right.argmax())
    first, last = min(first, half), max(last, half)
    complete = first > half // 4 and last < 2 * half - half // 4
    return ordered[first : last + 1].copy(), half - first, complete


def _convolve(padded: Array, h: Array) -> Array:
    """Convolve without edges; in blocks, so that memory does not grow with the record."""
    if h.size <= 64:
        return np.convolve(padded, h, mode="valid")
    block = int(2.0 ** math.ceil(math.log2(max(4 * h.size, 65536))))
    step = block - h.size + 1
    spectrum = np.fft.rfft(h, block)
    result = np.empty(padded.size - h.size + 1)
    for start in range(0, result.size, step):
        part = np.fft.irfft(np.fft.rfft(padded[start : start + block], block) * spectrum, block)
        count = min(step, result.size - start)
        result[start : start + count] = part[h.size - 1 : h.size - 1 + count]
    return result
