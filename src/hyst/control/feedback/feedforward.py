"""Feedforward of the reference: what the plant needs is asked of it before an error shows."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.checks.numbers import whole_number
from hyst.control.controller_parts import refuse_unstable
from hyst.control.discretization import Method, discretize
from hyst.control.feedback.loop_plant import static_gain
from hyst.control.linear_system import LinearSystem, as_linear_system
from hyst.control.loop_system import plant_of
from hyst.control.sampled.plant import SampledPlant, sampled_plant
from hyst.errors import InputError

Array = NDArray[np.float64]


def with_feedforward(
    controller: LinearSystem,
    feedforward: Any,
    method: Method,
    plant: Any = None,
    designs: tuple[Any, ...] = (),
) -> LinearSystem:
    """Put a feedforward beside a sampled controller: ``v = F y_ref + C (y_ref - y)``.

    Parameters
    ----------
    controller
        C, sampled.
    feedforward
        None or False for none; True for the static ``1 / Pn(0)``; or F, from y_ref to v.
    method
        How a continuous F is sampled.
    plant
        Pn, for its static gain.
    designs
        What may know it where ``plant`` is left out: a designed controller, the design of an
        observer. If none does, ``Pn(0)`` is 1.

    Returns
    -------
    LinearSystem
        C as it is without feedforward; else with the inputs y_ref and y, states of C first.

    Raises
    ------
    InputError
        If F cannot be read or is unstable, or the plant has no static gain.
    """
    if feedforward is None or feedforward is False:
        return controller
    if feedforward is True:
        F = LinearSystem(*_nothing(), np.array([[1.0 / _gain_of(plant, designs)]]), controller.dt)
    else:
        F = _read(feedforward, controller.dt, method)
    difference = np.array([[1.0, -1.0]])
    only_reference = np.array([[1.0, 0.0]])
    n, m = controller.order, F.order
    A = scipy.linalg.block_diag(controller.A, F.A) if n + m else np.zeros((0, 0))
    return LinearSystem(
        A,
        np.vstack([controller.B @ difference, F.B @ only_reference]),
        np.hstack([controller.C, F.C]),
        controller.D @ difference + F.D @ only_reference,
        controller.dt,
    )


def reference_feedforward(
    plant: Any, dt: float | None = None, delay: float = 0.0, order: int = 2
) -> LinearSystem:
    """Make a feedforward that undoes what the plant and its dead time do to a slow reference.

    ``F(z) = a_0 + a_1 (1 - 1/z) + a_2 (1 - 1/z)^2 + ...`` with ``F(z) Pd(z) = 1`` up to the power
    ``order`` of ``1 - 1/z``: gain, velocity and acceleration feedforward, with nothing to tune.

    Parameters
    ----------
    plant, dt, delay
        As ``loop_margins`` takes them; the loop must be sampled.
    order
        0: the static gain; 1: also the lag, for ramps; 2: also the curvature. 0 to 3. A jump of the
        reference is answered by a kick of some samples, the larger the higher the order.

    Returns
    -------
    LinearSystem
        F, sampled; for ``TrackingController.from_continuous(..., feedforward=F)``.

    Raises
    ------
    InputError
        If the plant cannot be used, or has a pole or a zero at the origin.

    Examples
    --------
    A plant that is one sample late: the reference is carried on along its slope.

    >>> F = reference_feedforward(1.0, dt=1e-3, order=1)
    >>> F.D[0, 0].item(), (F.C @ F.B)[0, 0].item()
    (2.0, -1.0)
    """
    degree = whole_number(order, "order", 0, 3)
    met = sampled_plant(plant, dt, delay).system
    series = _taylor(met, degree)
    a = np.zeros(degree + 1)
    a[0] = 1.0 / series[0]
    for k in range(1, degree + 1):
        a[k] = -float(a[:k] @ series[k:0:-1]) / series[0]
    taps = np.zeros(degree + 1)  # of powers of 1/z
    for k in range(degree + 1):
        taps[: k + 1] += a[k] * np.array([math.comb(k, j) * (-1.0) ** j for j in range(k + 1)])
    A, B = np.eye(degree, k=-1), np.eye(degree, 1)
    return LinearSystem(A, B, taps[None, 1:], taps[None, :1], met.dt)


def _taylor(plant: LinearSystem, degree: int) -> Array:
    """Coefficients of Pd in powers of 1 - 1/z."""
    gain = static_gain(plant)
    if math.isinf(gain) or gain == 0.0:
        raise InputError(
            f"the plant's static gain is {gain:g}, so no feedforward of a constant reference exists"
        )
    rest = np.eye(plant.order) - plant.A
    x = np.linalg.solve(rest, plant.B)
    found = []
    for _ in range(degree + 1):
        found.append(float((plant.C @ x)[0, 0]))
        x = -np.linalg.solve(rest, plant.A @ x)
    # z^-1 stands before the states: Pd = (1 - d) sum of found_k d^k + D.
    series = np.array(found) - np.concatenate([[0.0], found[:-1]])
    series[0] += float(plant.D[0, 0])
    return np.asarray(series)


def _nothing() -> tuple[Array, Array, Array]:
    return np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0))


def _gain_of(plant: Any, designs: tuple[Any, ...]) -> float:
    """Give the static gain of the plant, or of the first design that knows it, or else 1."""
    gains = [] if plant is None else [static_gain(plant_of(plant))]
    gains += [float(each.static_gain) for each in designs if hasattr(each, "static_gain")]
    plants = [each.problem.plant for each in designs if hasattr(each, "problem")]
    gains += [
        static_gain(each.system if isinstance(each, SampledPlant) else each) for each in plants
    ]
    gain = gains[0] if gains else 1.0
    if gain == 0.0 or math.isinf(gain):
        raise InputError(
            f"the plant's static gain is {gain:g}, so there is no static feedforward; give a "
            "system as feedforward, or none"
        )
    return gain


def _read(feedforward: Any, dt: float, method: Method) -> LinearSystem:
    F = as_linear_system(feedforward, "the feedforward")
    if (F.inputs, F.outputs) != (1, 1):
        raise InputError(
            f"the feedforward has {F.inputs} inputs and {F.outputs} outputs; give a system from "
            "the reference to the plant's input, or True"
        )
    refuse_unstable(F, "the feedforward")
    return discretize(F, dt, method)
