"""What a controller takes back of what its drive could not do.

The block wants v, the drive gives v_a, and ``x+ = A x + B [y_ref, y] + W (v_a - v)``. Of W it is
asked that the observer sees the v that was applied, so that its estimate stays one of the
disturbance, and that C comes to rest where it gives what was applied, whatever the error is.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.control.linear_system import LinearSystem
from hyst.errors import InputError

Array = NDArray[np.float64]

_INSIDE = 1e-9  # zeros of C nearer to the unit circle count as on it
_ALTERNATING = 0.9  # of larger modulus, a zero left of the origin makes states that change sign


def anti_windup(controller: LinearSystem, observer: LinearSystem) -> tuple[Array, float]:
    """Give the gains of a block that ``joined`` has made of both.

    With ``v + d_hat`` the output of C, ``d_hat`` of an observer with feedthrough D_v from v moves
    with v: what was applied of C's output differs by ``(1 + D_v) (v_a - v)``.

    Parameters
    ----------
    controller
        Sampled, from y_ref to its output, to which the estimate is added: C, or C and a
        feedforward of the reference beside it.
    observer
        Sampled, as ``joined`` takes it.

    Returns
    -------
    W : numpy.ndarray
        Shape (n,): ``(1 + D_v) L`` for the states of C, L as ``conditioning_gain`` gives it, and
        the observer's own input column of v.
    G : float
        What is to be added to the estimate of the same sample, times ``v_a - v``: D_v.

    Raises
    ------
    InputError
        As ``conditioning_gain``.
    """
    share = float(observer.D[0, 0])
    of_controller = (1.0 + share) * conditioning_gain(controller)
    return np.concatenate([of_controller, observer.B[:, 0]]), share


def conditioning_gain(controller: LinearSystem) -> Array:
    """Give L with ``A - L C`` stable, by which C follows an output that is not its own.

    ``x+ = A x + B e + L (applied - C x - D e)``. Where C has feedthrough and its zeros are inside
    the unit circle, ``L = B/D``: C then goes on as if the error had been the one that gives what
    was applied, and the loop as one never limited, with a reference within reach. Else L is the
    gain of the stationary Kalman predictor of C with white noise for the error and as much noise,
    independent of it, at the output as C's largest answer to it; which is ``B/D`` without that
    noise, and with it keeps zeros on the unit circle or outside, and C without feedthrough, off
    the poles of ``A - L C``.

    Parameters
    ----------
    controller
        Sampled, one input, one output.

    Returns
    -------
    numpy.ndarray
        Shape (n,).

    Raises
    ------
    InputError
        If a pole of C on the unit circle is not reached by its input.

    Source
    ------
    Hanus, Kinnaert, Henrotte: Conditioning technique, a general anti-windup and bumpless transfer
    method, Automatica 23 (1987), for ``B/D``.
    """
    n = controller.order
    if n == 0:
        return np.zeros(0)
    scaled, (scale, _) = scipy.linalg.matrix_balance(controller.A, permute=False, separate=True)
    b, of_b = _near_one(controller.B[:, 0] / scale)
    c, of_c = _near_one(controller.C[0] * scale)
    d = float(controller.D[0, 0]) / (of_b * of_c)
    if d != 0.0 and _well_inside(np.linalg.eigvals(scaled - np.outer(b, c) / d)):
        return np.asarray(scale * b / d / of_c)
    gain = _predictor_gain(scaled, b, c, d)
    if gain is None or np.abs(np.linalg.eigvals(scaled - np.outer(gain, c))).max() >= 1.0:
        worst = complex(max(controller.poles(), key=abs))
        raise InputError(
            f"the controller's pole {worst:.6g} is not reached by its input, so nothing keeps it "
            "from winding up while the drive is limited; give a controller without hidden poles"
        )
    return np.asarray(scale * gain / of_c)


def _near_one(vector: Array) -> tuple[Array, float]:
    """Divide by a power of two, so that results do not depend on units."""
    largest = float(np.abs(vector).max(initial=0.0))
    factor = float(2.0 ** np.floor(np.log2(largest))) if largest > 0.0 else 1.0
    return vector / factor, factor


def _well_inside(zeros: NDArray[np.complexfloating]) -> bool:
    size = np.abs(zeros)
    return bool(np.all((size < 1.0 - _INSIDE) & ((zeros.real > 0.0) | (size < _ALTERNATING))))


def _predictor_gain(A: Array, b: Array, c: Array, d: float) -> Array | None:
    answer, x = [d], b
    for _ in range(b.size + 1):
        answer.append(float(c @ x))
        x = A @ x
    noise = float(np.square(answer).max())
    if noise == 0.0:
        return np.zeros(b.size)
    try:
        P = scipy.linalg.solve_discrete_are(
            A.T, c[:, None], np.outer(b, b), np.array([[d * d + noise]]), s=d * b[:, None]
        )
    except (np.linalg.LinAlgError, ValueError):
        return None
    gain: Array = (A @ P @ c + d * b) / (c @ P @ c + d * d + noise)
    return gain if np.isfinite(gain).all() else None
