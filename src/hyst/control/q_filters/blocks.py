"""The same comparison for what runs: each design as a sampled block, with hold and delay."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from hyst.control.discretization import Method
from hyst.control.q_filters.comparison import NO_OBSERVER
from hyst.control.q_filters.design import design_q_filter
from hyst.control.q_filters.sampled_design import design_sampled_q_filter
from hyst.control.sampled.certificate import SampledCertificate, sampled_certificate
from hyst.control.sampled.plant import sampled_plant
from hyst.control.tracking_controller import TrackingController
from hyst.errors import InputError


def compare_blocks(
    plant: Any,
    controller: Any,
    Wu: Any,
    Wp: Any,
    dt: float,
    designs: Mapping[str, Any] | None = None,
    *,
    delay: float = 0.0,
    order: int | None = None,
    method: Method = "tustin",
) -> tuple[tuple[str, SampledCertificate], ...]:
    """Certify designs as sampled blocks, beside no observer and the classical filter.

    Parameters
    ----------
    plant, controller, Wu, Wp
        As for ``design_q_filter``, or ``design_sampled_q_filter`` where the plant is sampled.
    dt, delay
        Of the block, s.
    designs
        By the name of their row, whatever ``TrackingController.from_continuous`` takes as observer.
    order
        Of the classical filter; one above the least if left out.
    method
        How continuous parts are sampled.

    Returns
    -------
    tuple of pairs
        Name and certificate: ``"no observer"``, the classical filter, then the designs. The
        classical filter is the better of the continuous one, sampled, and that of the sampled
        plant.

    Raises
    ------
    InputError
        If a system cannot be used, or the sampled controller does not stabilize the plant.

    Examples
    --------
    >>> Wu, Wp = ([1.0, 1.0], [1.0, 30.0]), ([0.3, 0.6], [1.0, 0.01])
    >>> found = compare_blocks(([10.0], [1.0, 10.0]), ([1.0], [1.0, 0.0]), Wu, Wp, 1e-3)
    >>> [name for name, _ in found]
    ['no observer', '1/(tau s + 1)^2']
    """
    seen = sampled_plant(plant, dt, delay)

    def certified(observer: Any) -> SampledCertificate:
        block = TrackingController.from_continuous(controller, dt, observer=observer, method=method)
        return sampled_certificate(block, seen, Wu, Wp)

    with threadpool_limits(1, user_api="blas"):
        sampled = design_sampled_q_filter(seen, controller, Wu, Wp, order=order, method=method)
        name, best = sampled.name.removeprefix("sampled "), sampled.certificate
        if seen.continuous is not None:
            try:
                continuous = design_q_filter(seen.continuous, controller, Wu, Wp, order)
            except InputError:  # a sampled controller or weight has no continuous design
                pass
            else:
                found = certified(continuous)
                if found.stacked_norm < best.stacked_norm:
                    name, best = continuous.name, found
        rows = [(NO_OBSERVER, certified(None)), (name, best)]
        rows += [(name, certified(design)) for name, design in (designs or {}).items()]
    return tuple(rows)


def table_of_blocks(rows: tuple[tuple[str, SampledCertificate], ...]) -> str:
    """Write the rows of ``compare_blocks`` as plain text, bandwidth in Hz.

    Parameters
    ----------
    rows
        Of ``compare_blocks``.

    Raises
    ------
    InputError
        If there are none.
    """
    if not rows:
        raise InputError("there are no rows; give those of compare_blocks")
    head = ("stacked", "Wu T", "Wp (1-Q)", "robust", "noise to v", "Hz")
    width = max(len(name) for name, _ in rows)
    lines = [" " * width + "".join(f"{each:>11}" for each in head)]
    for name, c in rows:
        values = (
            c.stacked_norm,
            c.uncertainty_norm,
            c.performance_norm,
            c.robust_performance,
            c.noise_gain,
            c.rejection_bandwidth / (2.0 * np.pi),
        )
        lines.append(f"{name:<{width}}" + "".join(f"{each:>11.4g}" for each in values))
    return "\n".join(lines)
