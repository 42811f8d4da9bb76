"""Why weights cannot be met: which row fails, at which frequency, and what would have to change."""

from __future__ import annotations

import numpy as np

from hyst.control.disturbance_observer.certificate import Certificate
from hyst.control.disturbance_observer.stacked_gain import StackedGain


def shortfall(gain: StackedGain, certificate: Certificate, bound: float) -> str:
    """Say what stands in the way of a norm below 1; nothing if nothing does.

    Parameters
    ----------
    gain
        The problem, ready for frequencies.
    certificate
        Of the best gain.
    bound
        No observer of any order has a lower norm.
    """
    c = certificate
    rows = [
        (c.uncertainty_norm, c.uncertainty_frequency, "Wu T"),
        (c.performance_norm, c.performance_frequency, "Wp (1 - Q)"),
    ]
    if c.noise_norm is not None and c.noise_frequency is not None:
        rows.append((c.noise_norm, c.noise_frequency, "Wn K S"))
    failing = [f"{name} is {norm:.3g} at {w:.4g} rad/s" for norm, w, name in rows if norm >= 1.0]
    if c.stacked_norm < 1.0 and not failing:
        return ""
    reason = _at_one_frequency(gain) or _by_controller(gain)
    if not reason and bound >= 1.0:
        reason = f"with every observer: lower Wu or Wp, both by {bound:.3g} times at least"
    if not reason and c.stacked_norm < 1.0:
        reason = "allow more noise in the drive, or lower Wp"
    if not reason:
        reason = (
            f"Wu and Wp both lowered {c.stacked_norm:.3g} times are met by this gain, and "
            "order='auto' looks for one of higher order"
        )
    return (
        ", ".join(failing or ["each row alone is below 1, both together are not"]) + ": " + reason
    )


def _at_one_frequency(gain: StackedGain) -> str:
    """Find a frequency at which no number 1 - Q meets both weights."""
    Wp_high = abs(gain.problem.Wp.D[0, 0])
    if Wp_high >= 1.0:
        return (
            f"Wp is {Wp_high:.3g} at high frequencies, where 1 - Q is 1 for every observer; give "
            "one that falls below 1"
        )
    for pole in gain.model_poles[np.abs(gain.model_poles.real) <= 1e-9 * gain.scale]:
        held = float(np.abs(gain.Wu.response(np.array([1j * abs(pole.imag)])))[0])
        if held >= 1.0:
            return (
                f"Wu is {held:.3g} at {abs(pole.imag):.4g} rad/s, where the internal model makes "
                "T = 1; give one below 1 there, or know the plant better"
            )
    at = gain.grid
    S0 = np.abs(at.S0)
    least = np.sqrt(at.Wu2 * at.Wp2 / np.maximum(at.Wu2 * S0**2 + at.Wp2, 1e-300))
    i = int(np.argmax(least))
    if least[i] < 1.0:
        return ""
    Wu, Wp = np.sqrt(at.Wu2[i]), np.sqrt(at.Wp2[i])
    ways = []
    if Wu > 1.0:
        ways.append(f"Wp below {Wu * S0[i] / np.sqrt(Wu**2 - 1.0):.3g}")
    if Wp > S0[i]:
        ways.append(f"Wu below {Wp / np.sqrt(Wp**2 - S0[i] ** 2):.3g}")
    return (
        f"at {at.w[i]:.4g} rad/s Wu = {Wu:.3g} and Wp = {Wp:.3g} exclude each other for every "
        f"observer; give {' or '.join(ways)} there"
    )


def _by_controller(gain: StackedGain) -> str:
    """Find whether the loop without an observer already fails for a plant within Wu."""
    at = gain.grid
    alone = np.sqrt(at.Wu2) * np.abs(1.0 - at.S0)
    i = int(np.argmax(alone))
    if alone[i] < 1.0:
        return ""
    return (
        f"without an observer Wu T is {alone[i]:.3g} at {at.w[i]:.4g} rad/s already; lower the "
        "controller's gain there, or know the plant better"
    )
