"""By how much measured plants differ from the nominal one: samples of ``|P / Pn - 1|``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.numbers import as_positive
from hyst.control.linear_system import LinearSystem, as_linear_system
from hyst.control.other_systems import is_frequency_response
from hyst.control.zeros_and_poles import zeros_and_poles
from hyst.errors import InputError
from hyst.models import ContinuousDynamics

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

_PER_DECADE, _BEYOND = 60, 100.0  # of grids for systems, and how far they go beyond all poles
_AROUND = np.linspace(-4.0, 4.0, 65)  # half-widths about a resonance
_ROUNDS, _EVEN = 4, 1e-4  # of closing in on a top between points
_ZERO = 1e-12  # of the largest response: a nominal plant of less has none to compare with


@dataclass(frozen=True, eq=False)
class Deviations:
    """Samples of ``|P / Pn - 1|`` of one plant.

    Parameters
    ----------
    w
        Shape (p,), rad/s, ascending.
    radius
        Shape (p,).
    """

    w: Array
    radius: Array


def nominal_plant(plant: Any) -> LinearSystem | ContinuousDynamics:
    """Read a nominal plant, which may be continuous with dead time.

    Parameters
    ----------
    plant
        As ``as_linear_system`` takes it, or a ``ContinuousDynamics`` with its delay.

    Raises
    ------
    InputError
        If it cannot be read, or has several inputs or outputs.
    """
    if isinstance(plant, ContinuousDynamics):
        return plant
    read = as_linear_system(plant, "the nominal plant")
    _require_single(read, "the nominal plant")
    return read


def sample_time(plant: LinearSystem | ContinuousDynamics) -> float:
    """Give the sample time of a plant, s; 0 of a continuous one."""
    return plant.dt if isinstance(plant, LinearSystem) else 0.0


def response_at(plant: LinearSystem | ContinuousDynamics, w: Array) -> Complex:
    """Give the frequency response of a plant.

    Parameters
    ----------
    plant
        As ``nominal_plant`` gives it.
    w
        Shape (p,), rad/s.
    """
    if isinstance(plant, ContinuousDynamics):
        return plant.frequency_response(w / (2.0 * np.pi))
    points = 1j * w if plant.dt == 0.0 else np.exp(1j * w * plant.dt)
    return plant.response(points)[:, 0, 0]


def deviations_of(
    nominal: LinearSystem | ContinuousDynamics,
    responses: Sequence[Any],
    w: ArrayLike | None = None,
    matched_at: float | None = None,
) -> list[Deviations]:
    """Compare measured plants with the nominal one.

    Parameters
    ----------
    nominal
        Pn.
    responses
        Measured or identified frequency responses, python-control's ``frd``, pairs (w, G) with w in
        rad/s and complex G, or systems.
    w
        Where systems are compared, rad/s; a grid about all poles if left out.
    matched_at
        Frequency, Hz, at which each is given the gain of the nominal plant; None: as they are.

    Returns
    -------
    list of Deviations
        Without samples above half the sample rate of a sampled nominal plant, of which they say
        nothing.

    Raises
    ------
    InputError
        If there is none, one cannot be read, or the nominal plant is 0 where one was measured.
    """
    if isinstance(responses, str) or not isinstance(responses, Sequence) or not responses:
        raise InputError("responses is no list of frequency responses; give one or more")
    highest = np.pi / sample_time(nominal) if sample_time(nominal) else np.inf
    found = []
    names = [f"response {number}" for number in range(1, len(responses) + 1)]
    systems = [_system_of(each, name) for each, name in zip(responses, names, strict=True)]
    # All on one grid: where one plant begins, the others are known as well.
    grid = _shown(nominal, _grid(nominal, *(each for each in systems if each is not None)))
    for each, system, name in zip(responses, systems, names, strict=True):
        if system is None:
            at, values = _samples(each, name)
        else:
            at = _tops_added(grid, nominal, system) if w is None else _checked(w, w, name)[0]
            values = response_at(system, at)
        kept = at <= highest * (1.0 + 1e-9)
        if not kept.any():
            raise InputError(
                f"{name} begins at {at[0] / (2 * np.pi):.6g} Hz, above half the sample rate of the "
                f"nominal plant, {highest / (2 * np.pi):.6g} Hz; measure below it"
            )
        at, values = at[kept], values[kept]
        if matched_at is not None:
            values = values * _match(at, values, nominal, matched_at, name)
        found.append(_deviations(at, values, nominal, name))
    return found


def _match(
    w: Array,
    values: Complex,
    nominal: LinearSystem | ContinuousDynamics,
    frequency: float,
    name: str,
) -> float:
    """Give the factor that a response needs to have the nominal gain at a frequency."""
    at = 2.0 * np.pi * as_positive(frequency, "matched_at", "a frequency in Hz")
    if not w[0] <= at <= w[-1]:
        raise InputError(
            f"{name} is not known at {frequency:.6g} Hz, where gains are to be matched, but from "
            f"{w[0] / (2.0 * np.pi):.6g} to {w[-1] / (2.0 * np.pi):.6g} Hz; match them there"
        )
    gain = float(np.interp(at, w, np.abs(values)))
    if gain == 0.0:
        raise InputError(f"{name} is 0 at {frequency:.6g} Hz; match gains elsewhere")
    return float(np.abs(response_at(nominal, np.array([at])))[0]) / gain


def _deviations(
    w: Array, values: Complex, nominal: LinearSystem | ContinuousDynamics, name: str
) -> Deviations:
    Pn = response_at(nominal, w)
    nothing = np.abs(Pn) <= _ZERO * np.abs(Pn).max()
    if nothing.any():
        where = float(w[int(nothing.argmax())]) / (2.0 * np.pi)
        raise InputError(
            f"the nominal plant is 0 at {where:.6g} Hz, where {name} has a value: no multiple of 0 "
            "is anything else; leave that frequency out"
        )
    return Deviations(w, np.abs(values / Pn - 1.0))


def _system_of(given: Any, name: str) -> LinearSystem | ContinuousDynamics | None:
    """Read a response that is given as a system; None of one that was measured."""
    if is_frequency_response(given) or _is_pair_of_samples(given):
        return None
    plant = given if isinstance(given, ContinuousDynamics) else as_linear_system(given, name)
    if isinstance(plant, LinearSystem):
        _require_single(plant, name)
    return plant


def _is_pair_of_samples(given: Any) -> bool:
    pair = isinstance(given, tuple | list) and len(given) == 2
    return pair and np.iscomplexobj(np.asarray(given[1]))


def _samples(given: Any, name: str) -> tuple[Array, Complex]:
    if is_frequency_response(given):
        return values_of_response(given, name)
    return _checked(given[0], given[1], name)


def _shown(nominal: LinearSystem | ContinuousDynamics, grid: Array) -> Array:
    """Leave out the ends of a grid at which the nominal plant has decayed to rounding."""
    size = np.abs(response_at(nominal, grid))
    some = np.flatnonzero(size > 2.0 * _ZERO * size.max())
    return grid[some[0] : some[-1] + 1] if some.size else grid


def _tops_added(
    grid: Array,
    nominal: LinearSystem | ContinuousDynamics,
    plant: LinearSystem | ContinuousDynamics,
) -> Array:
    """Add where ``|P / Pn - 1|`` is largest between the points of a grid."""

    def radius(w: Array) -> Array:
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.abs(response_at(plant, w) / response_at(nominal, w) - 1.0)

    values = radius(grid)
    # Where it is even, what is largest is rounding.
    beside = np.maximum(values[:-2], values[2:]), np.minimum(values[:-2], values[2:])
    found = (values[1:-1] >= beside[0]) & (values[1:-1] > (1.0 + _EVEN) * beside[1])
    tops = 1 + np.flatnonzero(found)
    low, high, rows = grid[tops - 1], grid[tops + 1], np.arange(tops.size)
    for _ in range(_ROUNDS):
        points = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, 9)
        best = radius(points.ravel()).reshape(points.shape)[:, 1:-1].argmax(axis=1) + 1
        low, high = points[rows, best - 1], points[rows, best + 1]
    reached = 0.5 * (low + high)
    return np.union1d(grid, reached[np.abs(reached - grid[tops]) > 1e-9 * reached])


def values_of_response(given: Any, name: str) -> tuple[Array, Complex]:
    """Read what has frequencies and values: of hyst in Hz, of python-control in rad/s.

    Parameters
    ----------
    given
        MeasuredResponse of hyst or frequency response data of python-control.
    name
        What messages call it.

    Returns
    -------
    w, G : numpy.ndarray
        rad/s, and output over input.

    Raises
    ------
    InputError
        If it has several inputs or outputs, no values, or one that is not finite.
    """
    if not hasattr(given, "omega"):
        return _checked(2.0 * np.pi * np.asarray(given.frequency), given.response, name)
    values = np.asarray(given.frdata if hasattr(given, "frdata") else given.fresp)
    if values.shape[:2] != (1, 1):
        raise InputError(
            f"{name} has {values.shape[1]} inputs and {values.shape[0]} outputs; give one of each"
        )
    return _checked(given.omega, values[0, 0], name)


def _checked(w: ArrayLike, values: ArrayLike, name: str) -> tuple[Array, Complex]:
    at = np.asarray(w, dtype=np.float64).ravel()
    found = np.asarray(values, dtype=np.complex128).ravel()
    if at.size != found.size or not at.size:
        raise InputError(
            f"{name} has {at.size} frequencies and {found.size} values; give one for each"
        )
    if not (np.isfinite(at).all() and np.isfinite(found).all()) or at.min() < 0.0:
        raise InputError(
            f"{name} has a value that is not finite, or a frequency below 0; leave it out"
        )
    order = np.argsort(at, kind="stable")
    return at[order], found[order]


def _grid(*plants: LinearSystem | ContinuousDynamics) -> Array:
    """Give frequencies from far below all poles and zeros to far above, dense about sharp ones."""
    roots = np.concatenate([_roots(each) for each in plants])
    sizes = np.abs(roots)
    sizes = sizes[sizes > 1e-9 * sizes.max()] if sizes.any() else np.ones(1)
    fastest = [np.pi / sample_time(each) for each in plants if sample_time(each)]
    high = min([sizes.max() * _BEYOND, *fastest])
    low = min(sizes.min() / _BEYOND, 0.1 * high)
    grid = [np.geomspace(low, high, int(_PER_DECADE * np.log10(high / low)) + 2)]
    sharp = roots[(roots.imag > 0.0) & (np.abs(roots.real) < 0.3 * np.abs(roots))]
    grid += [abs(each) + abs(each.real) * _AROUND for each in sharp]
    w = np.unique(np.concatenate(grid))
    w = w[(w > 0.0) & (w <= high)]
    # The same root of two plants is one.
    return np.asarray(w[np.append(True, np.diff(w) > 1e-9 * w[1:])])


def _roots(plant: LinearSystem | ContinuousDynamics) -> Complex:
    """Give poles and zeros in the plane of s, rad/s."""
    if isinstance(plant, ContinuousDynamics):
        return np.concatenate([plant.poles(), plant.zeros()])
    factors = zeros_and_poles(plant)
    roots = np.concatenate([factors.poles, factors.zeros])
    if plant.dt == 0.0:
        return roots
    # A delay has its poles at 0, where no frequency is.
    return np.asarray(np.log(roots[np.abs(roots) > 1e-9]) / plant.dt)


def _require_single(plant: LinearSystem, name: str) -> None:
    if (plant.inputs, plant.outputs) != (1, 1):
        raise InputError(
            f"{name} has {plant.inputs} inputs and {plant.outputs} outputs; give one of each"
        )
