"""Any model made of plays between two maps, taken apart."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from hyst.errors import InputError
from hyst.models.piecewise_map import PiecewiseMap
from hyst.models.prandtl_ishlinskii import PrandtlIshlinskii
from hyst.operators import Affine, DeadZone, Operator
from hyst.operators.composition import leaves_of

_WHAT = "a Prandtl-Ishlinskii model, alone or between maps (DeadZone, Affine)"


@final
@dataclass(frozen=True, eq=False)
class MappedPlays:
    """A map, one bank of plays, a map: ``y = after(plays(before(u)))``.

    Parameters
    ----------
    before
        The map before the plays; the envelope of a generalized model.
    plays
        The plays; the identity if the operator has none.
    after
        The map after the plays.
    """

    before: PiecewiseMap
    plays: PrandtlIshlinskii
    after: PiecewiseMap

    @classmethod
    def of(cls, operator: Operator, name: str, like: MappedPlays | None = None) -> MappedPlays:
        """Take an operator apart.

        Gains on either side of the plays become part of them where there is no other map on that
        side, neither here nor in ``like``: ``k F_r(u)`` is a play with a weight,
        ``F_r(k u) = k F_(r / |k|)(u)``.

        Parameters
        ----------
        operator
            Plays and maps, in any composition with one bank of plays at most.
        name
            What messages call it.
        like
            What it will be compared with, part by part. Maps without plays are taken to stand
            where ``like`` has one; before the plays if it has none, or is left out.

        Returns
        -------
        MappedPlays

        Raises
        ------
        InputError
            If it is no operator, holds another one than plays, two-sided dead zones and affine
            maps, holds two banks of plays, or does not start from rest.
        """
        if not isinstance(operator, Operator):
            raise InputError(f"{name} is of type {type(operator).__name__}; give {_WHAT}")
        leaves = leaves_of(operator)
        places = [k for k, leaf in enumerate(leaves) if isinstance(leaf, PrandtlIshlinskii)]
        if len(places) > 1:
            raise InputError(f"{name} holds {len(places)} banks of plays; give {_WHAT}")
        alone = 0 if like is not None and like.after.stages else len(leaves)
        at = places[0] if places else alone
        before = _maps(leaves[:at], name)
        after = _maps(leaves[at + len(places) :], name)
        banks = [leaf for leaf in leaves if isinstance(leaf, PrandtlIshlinskii)]
        plays = banks[0] if banks else PrandtlIshlinskii([], [], 1.0)
        if plays.z0.any():
            raise InputError(
                f"{name} starts with play outputs z0 up to {np.abs(plays.z0).max():.6g}; the bound "
                "is one from rest, so give a model whose z0 is 0"
            )
        if like is None or not like.before.stages:
            before, plays = _gain_before_in_plays(before, plays)
        if like is None or not like.after.stages:
            plays, after = _gain_after_in_plays(plays, after)
        return cls(before, plays, after)

    def inverse(self) -> MappedPlays:
        """Give the exact inverse.

        Raises
        ------
        NotInvertibleError
            If a part has none; its message says why.
        """
        return MappedPlays(self.after.inverse(), self.plays.exact_inverse(), self.before.inverse())


def _maps(leaves: tuple[Operator, ...], name: str) -> PiecewiseMap:
    stages: list[Affine | DeadZone] = []
    for leaf in leaves:
        if isinstance(leaf, Affine) or (isinstance(leaf, DeadZone) and leaf.variant == "two-sided"):
            stages.append(leaf)
        else:
            raise InputError(f"{name} holds a {leaf.kind}; give {_WHAT}")
    return PiecewiseMap(tuple(stages))


def _gain_before_in_plays(
    before: PiecewiseMap, plays: PrandtlIshlinskii
) -> tuple[PiecewiseMap, PrandtlIshlinskii]:
    gain = before.gain
    if gain is None or gain == 0.0:
        return before, plays
    merged = PrandtlIshlinskii(gain * plays.p, plays.r / abs(gain), gain * plays.p0)
    return PiecewiseMap(), merged


def _gain_after_in_plays(
    plays: PrandtlIshlinskii, after: PiecewiseMap
) -> tuple[PrandtlIshlinskii, PiecewiseMap]:
    gain = after.gain
    if gain is None:
        return plays, after
    return PrandtlIshlinskii(gain * plays.p, plays.r, gain * plays.p0), PiecewiseMap()
