"""Scales between the stages of a chain that no record can show.

``f(g(u))`` stays what it is when the output of g grows by a factor that f takes back. Where free
constants of both can do that, one of them has to be held; which one is a convention.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.errors import HystError
from hyst.models import Delay, Lag, LinearDynamics
from hyst.operators import Affine, Operator

Array = NDArray[np.float64]

_FACTOR = 2.0


@dataclass(frozen=True, eq=False)
class Link:
    """A stage of a chain, and which of its constants are free.

    Parameters
    ----------
    name
        As in the names of its constants.
    stage
        The operator.
    constant
        Place of its first constant among those of the chain.
    free
        Shape (constants of the stage,).
    """

    name: str
    stage: Operator
    constant: int
    free: NDArray[np.bool_]

    def takes(self, input_scale: float, output_scale: float) -> bool:
        """Tell whether free constants make the stage one of signals in other units.

        Parameters
        ----------
        input_scale, output_scale
            By which the numbers of its signals grow.
        """
        moved = self.moved(input_scale, output_scale)
        return moved is not None and (input_scale == output_scale or bool(moved.any()))

    def moved(self, input_scale: float, output_scale: float) -> NDArray[np.bool_] | None:
        """Give which constants change with the units; None where those that are free cannot.

        Parameters
        ----------
        input_scale, output_scale
            As of ``takes``.
        """
        try:
            values = self.stage.parameters().values
            scaled = values * self.stage.parameter_scales(input_scale, output_scale)
            wanted = self.stage.in_units(input_scale, output_scale)
            if not _alike(self.stage.with_parameters(scaled).to_dict(), wanted.to_dict()):
                return None
        except HystError:  # it has no scale of its own, as creep, or what scales is no parameter
            return None
        changed = np.asarray(scaled != values)
        return None if (changed & ~self.free).any() else changed

    def passes(self) -> bool:
        """Tell whether a factor before the stage is a factor behind it."""
        return isinstance(self.stage, Delay) or self.takes(_FACTOR, _FACTOR)


def hidden_scales(links: Sequence[Link], free: Iterable[int]) -> tuple[tuple[int, int], ...]:
    """Give the pairs of stages with a scale between them that no record shows.

    Parameters
    ----------
    links
        The chain, in the order of the signal.
    free
        Which of them are linear dynamics that are free as a whole; without any there is no pair.

    Returns
    -------
    tuple of (int, int)
        In the order of the signal.
    """
    whole = frozenset(free)
    pairs = list[tuple[int, int]]()
    for at in range(len(links) - 1 if whole else 0):
        if at in whole or links[at].takes(1.0, _FACTOR):
            behind = _absorber(links, at, whole)
            pairs += [(at, behind)] if behind is not None else []
    return tuple(pairs)


def neighbours(links: Sequence[Link], free: Iterable[int]) -> tuple[tuple[int, int], ...]:
    """Give the pairs of free dynamics with nothing but linear stages between them.

    Parameters
    ----------
    links, free
        As of ``hidden_scales``.
    """
    places = sorted(free)
    linear = (Affine, Delay, Lag, LinearDynamics)
    return tuple(
        (one, other)
        for one, other in itertools.pairwise(places)
        if all(isinstance(each.stage, linear) for each in links[one + 1 : other])
    )


def _absorber(links: Sequence[Link], at: int, whole: frozenset[int]) -> int | None:
    """Go behind a stage, through others that let a factor pass, to the first that takes it back."""
    for behind in range(at + 1, len(links)):
        if behind in whole or links[behind].takes(_FACTOR, 1.0):
            return behind
        if not links[behind].passes():
            return None
    return None


def _alike(one: Any, other: Any) -> bool:
    """Tell whether two dictionaries of plain data are the same to rounding."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_alike(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_alike, one, other))
    if isinstance(one, float) and isinstance(other, float):
        return bool(np.isclose(one, other, rtol=1e-12, atol=0.0))
    return bool(one == other)
