"""What linear dynamics of any order leave of a signal, without a model of them.

In a narrow band of frequencies every transfer function, and what the unknown past leaves of the
spectra, is a polynomial of low degree. So no pole is searched for, and where the drive has no power
nothing is ill-conditioned.

Source: R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed.,
Wiley 2012, chapter 7 (local polynomial method).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Spectrum = NDArray[np.complex128]

_DEGREE = 2
_WIDTHS = (2, 3, 5, 9, 17, 33, 65)  # lines of a band, times the numbers fitted in it
_LINES_FOR_A_NUMBER = 1.5  # that carry the input's power in the band: fewer are met by chance


def left_by_dynamics(error: Array, inputs: list[Array]) -> float:
    """Give the mean square of what linear dynamics behind given inputs would leave.

        E(f) = sum_i H_i(f) X_i(f) + T(f),  H_i and T polynomials of second degree in a band

    The numbers fitted are paid for: noise alone leaves its own mean square, on the average. Of all
    widths of band that counts which leaves least.

    Parameters
    ----------
    error
        Shape (n,).
    inputs
        Each of shape (n,): what is in front of the dynamics.
    """
    n = error.size
    total = float(np.mean(np.square(error - error.mean())))
    lines = (n - 1) // 2
    spectra = np.fft.rfft(np.stack([error, *inputs]), axis=1)[:, 1 : lines + 1]
    found = [total]
    for factor in _WIDTHS:
        width = factor * (_DEGREE + 1) * (len(inputs) + 1)
        if 2 * width > lines:
            break
        found.append(total - 2.0 * _explained(spectra, width) / n**2)
    return max(min(found), 0.0)


def _explained(spectra: Spectrum, width: int) -> float:
    """Give the power of the first row that the others explain in bands of so many lines.

    What the unknown past leaves is taken out before: slow drift and narrow noise look like it.
    """
    count = spectra.shape[1] // width
    bands = spectra[:, : count * width].reshape(spectra.shape[0], count, width)
    error, inputs = bands[0], bands[1:]
    powers = np.linspace(-1.0, 1.0, width) ** np.arange(_DEGREE + 1)[:, None]
    size = np.linalg.norm(inputs, axis=2, keepdims=True)
    inputs = inputs / np.where(size > 0.0, size, 1.0)
    local = np.concatenate([np.ones((1, count, width)), inputs])
    columns = local.transpose(1, 2, 0)[:, :, :, None] * powers.T[None, :, None, :]
    q = np.linalg.qr(columns.reshape(count, width, -1))[0]
    fitted = np.abs(np.einsum("bwk,bw->bk", q.conj(), error)) ** 2
    power = np.sum(np.abs(error) ** 2, axis=1)
    past, whole = _DEGREE + 1, q.shape[2]
    before = (power - fitted[:, :past].sum(axis=1)) / (width - past)
    after = (power - fitted.sum(axis=1)) / (width - whole)
    left = np.divide(after, before, out=np.ones(count), where=before > 0.0)
    enough = _carrying(inputs).min(axis=0) >= _LINES_FOR_A_NUMBER * (_DEGREE + 1)
    return float(np.sum((power * (1.0 - left))[enough]))


def _carrying(inputs: Spectrum) -> Array:
    """Give how many lines of each band carry the power of each input."""
    power = np.abs(inputs) ** 2
    square, whole = np.sum(power**2, axis=2), np.sum(power, axis=2)
    where = square > 0.0
    return np.asarray(np.divide(whole**2, square, out=np.zeros_like(whole), where=where))
