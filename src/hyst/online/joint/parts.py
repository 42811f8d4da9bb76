"""Take a model apart into what the joint estimator estimates, and put it together again."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.models import PrandtlIshlinskii
from hyst.operators import Affine, DeadZone, Operator
from hyst.operators.composition import Chained

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Map:
    """A dead-zone map in the order of the core: 0, positive ascending, negative descending.

    Parameters
    ----------
    weights, thresholds
        Shape (m,).
    """

    weights: Array
    thresholds: Array

    def with_weights(self, weights: Array) -> DeadZone:
        """Give the operator with other ``weights``."""
        return DeadZone(weights, self.thresholds)


@dataclass(frozen=True, eq=False)
class Parts:
    """``after @ back @ pi @ front @ before``, any of them but ``pi`` and ``after`` missing.

    Parameters
    ----------
    before, after
        Gains and offsets at both ends; ``before`` and the gain of ``after`` are never estimated.
    front, back
        Maps of the generalized and the modified model.
    pi
        The plays.
    """

    before: Affine | None
    front: Map | None
    pi: PrandtlIshlinskii
    back: Map | None
    after: Affine

    def theta(self) -> Array:
        """Give the parameters in the core's order; the offset in the plays' output units."""
        maps = [each.weights for each in (self.front, self.back) if each is not None]
        offset = [self.after.offset / self.after.gain]
        return np.concatenate([[self.pi.p0], self.pi.p, self.pi.r, offset, *maps])

    def theta_for(self, other: Parts) -> Array:
        """Give the parameters to someone who has other parts.

        Parameters
        ----------
        other
            Parts whose parameters mean the same.

        Returns
        -------
        numpy.ndarray
            Shape (m,).

        Raises
        ------
        InputError
            If numbers of plays, thresholds or gains differ.
        """
        if self._fixed() != other._fixed():
            raise InputError(
                "the model has other plays, thresholds or gains than the one at the start; give "
                "one that differs in weights, radii and offset alone"
            )
        return self.theta()

    def _fixed(self) -> tuple[object, ...]:
        """Give what is never estimated."""
        maps = (None if m is None else m.thresholds.tolist() for m in (self.front, self.back))
        before = None if self.before is None else (self.before.gain, self.before.offset)
        return self.pi.p.size, before, self.after.gain, *maps

    def names(self) -> tuple[str, ...]:
        """Name the parameters in that order."""
        n = self.pi.p.size
        front = 0 if self.front is None else self.front.weights.size
        back = 0 if self.back is None else self.back.weights.size
        return (
            "p0",
            *(f"p[{i}]" for i in range(1, n + 1)),
            *(f"r[{i}]" for i in range(1, n + 1)),
            "offset",
            *(f"front[{j}]" for j in range(1, front + 1)),
            *(f"back[{j}]" for j in range(1, back + 1)),
        )

    def assemble(self, theta: Array, z: Array) -> Operator:
        """Put a model of the same kind together from parameters ``theta`` and memory ``z``."""
        n = self.pi.p.size
        model: Operator = PrandtlIshlinskii(theta[1 : n + 1], theta[n + 1 : 2 * n + 1], theta[0], z)
        maps = theta[2 * n + 2 :]
        if self.front is not None:
            model = model @ self.front.with_weights(maps[: self.front.weights.size])
        if self.back is not None:
            model = self.back.with_weights(maps[-self.back.weights.size :]) @ model
        if self.before is not None:
            model = model @ self.before
        offset = float(theta[2 * n + 1]) * self.after.gain
        return model if self._is_bare(offset) else Affine(self.after.gain, offset) @ model

    def _is_bare(self, offset: float) -> bool:
        return self.after.gain == 1.0 and offset == 0.0


def take_apart(model: Operator) -> Parts:
    """Take a model apart.

    Parameters
    ----------
    model
        A Prandtl-Ishlinskii model, with at most one dead-zone map before the plays, one after them,
        and a gain and offset at each end.

    Returns
    -------
    Parts

    Raises
    ------
    InputError
        If it is built otherwise.

    Examples
    --------
    >>> take_apart(Affine(1.0, 3.0) @ PrandtlIshlinskii([0.5], [1.0], 1.0)).theta()
    array([1. , 0.5, 1. , 3. ])
    """
    stages = _flat(model)
    before: list[Operator] = []
    while stages and not isinstance(stages[0], PrandtlIshlinskii):
        before.append(stages.pop(0))
    if not stages:
        raise InputError(f"{type(model).__name__} has no Prandtl-Ishlinskii stage to estimate")
    pi, behind = stages[0], stages[1:]
    assert isinstance(pi, PrandtlIshlinskii)
    affine_in, front = _one_of_each(before)
    affine_out, back = _one_of_each(behind[::-1])
    after = Affine(1.0) if affine_out is None else affine_out
    if after.gain == 0.0:
        raise InputError("the gain behind the plays is 0, so nothing can be learnt; give another")
    return Parts(affine_in, front, pi, back, after)


def units_of_plays(model: Operator, input_unit: str, output_unit: str) -> tuple[str, str]:
    """Give the units of the plays' input and output, empty where a gain changes them.

    Parameters
    ----------
    model
        As for ``take_apart``; its maps keep units, as their weights are pure numbers.
    input_unit, output_unit
        Of the model; empty where unknown.

    Returns
    -------
    tuple of str

    Raises
    ------
    InputError
        If the model is built otherwise.

    Examples
    --------
    >>> plays = PrandtlIshlinskii([0.5], [1.0])
    >>> units_of_plays(plays, "V", "um"), units_of_plays(plays @ Affine(2.0), "V", "um")
    (('V', 'um'), ('', 'um'))
    """
    parts = take_apart(model)
    is_input_kept = parts.before is None or parts.before.gain == 1.0
    return input_unit if is_input_kept else "", output_unit if parts.after.gain == 1.0 else ""


def _flat(model: Operator) -> list[Operator]:
    if not isinstance(model, Chained):
        return [model]
    return [part for stage in model.parts for part in _flat(stage)]


def _one_of_each(stages: list[Operator]) -> tuple[Affine | None, Map | None]:
    """From the end of the model inwards: at most a gain and offset, then at most one map."""
    rest = list(stages)
    affine = rest.pop(0) if rest and isinstance(rest[0], Affine) else None
    dead_zone = rest.pop(0) if rest and isinstance(rest[0], DeadZone) else None
    if rest:
        raise InputError(
            f"the joint estimator cannot estimate through {type(rest[0]).__name__} at this place; "
            "give plays with at most one dead-zone map, gain and offset on each side"
        )
    assert affine is None or isinstance(affine, Affine)
    assert dead_zone is None or isinstance(dead_zone, DeadZone)
    return affine, None if dead_zone is None else _sorted_map(dead_zone)


def _sorted_map(dead_zone: DeadZone) -> Map:
    if dead_zone.variant != "two-sided":
        raise InputError(
            f"the dead-zone map has the variant {dead_zone.variant!r}; give a two-sided one"
        )
    rho, place = np.unique(dead_zone.thresholds, return_inverse=True)
    weights = np.zeros(rho.size)
    np.add.at(weights, place, dead_zone.weights)
    if not (rho == 0.0).any():
        raise InputError("the dead-zone map has no threshold 0; without it it cannot be inverted")
    order = np.concatenate(
        [np.flatnonzero(rho == 0.0), np.flatnonzero(rho > 0.0), np.flatnonzero(rho < 0.0)[::-1]]
    )
    return Map(weights[order], rho[order])
