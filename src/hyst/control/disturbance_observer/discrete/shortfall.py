"""Why weights cannot be met by a sampled observer: which row fails, where, and what would do."""

from __future__ import annotations

from hyst.control.disturbance_observer.discrete.certificate import SampledObserverCertificate
from hyst.control.disturbance_observer.discrete.lower_bound import LowerBound


def sampled_shortfall(certificate: SampledObserverCertificate, bound: LowerBound) -> str:
    """Say what stands in the way of a norm below 1; nothing if nothing does.

    Parameters
    ----------
    certificate
        Of the best gain.
    bound
        What no observer of any order goes below.
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
    if bound.value >= 1.0:
        reason = f"with every observer, for {bound.reason}"
    elif c.stacked_norm < 1.0:
        reason = "allow more noise in the drive, or lower Wp"
    else:
        reason = (
            f"Wu and Wp both lowered {c.stacked_norm:.3g} times are met by this gain; order='auto' "
            "looks for one of higher order, and a shorter dt or delay leaves more room"
        )
    return (
        ", ".join(failing or ["each row alone is below 1, both together are not"]) + ": " + reason
    )
