"""The exact inverse of a model whose constants follow a second signal."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import NDArray

from hyst.errors import NotInvertibleError
from hyst.models.creep import Creep
from hyst.models.maxwell_slip import MaxwellSlip
from hyst.models.prandtl_ishlinskii import PrandtlIshlinskii
from hyst.models.schedule_run import ScheduledSystem
from hyst.models.schedule_stages import moving_places, with_kind
from hyst.operators import Affine, DeadZone, Operator
from hyst.operators.composition import leaves_of
from hyst.operators.stage import Stage

if TYPE_CHECKING:
    from hyst.models.scheduled import Scheduled

Array = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False)
class ScheduledInverse(ScheduledSystem):
    """The inverse of a ``Scheduled`` model: ``u = inverse(y_ref, s)``.

    Stage by stage, reversed, each sample solves ``y = f(u, memory)`` with the constants of now.

    Parameters
    ----------
    scheduled
        The model.

    Raises
    ------
    NotInvertibleError
        If a stage cannot be solved.
    """

    scheduled: Scheduled

    kind = "scheduled-inverse"

    def __post_init__(self) -> None:
        _ = self.scheduled.knot_stages, self._stages
        about = self.scheduled.description.of_inverse()
        vars(self).update(vars(self.with_description(about)))

    @property
    def values(self) -> Array:  # type: ignore[override]
        """Values of the second signal."""
        return self.scheduled.values

    @property
    def name(self) -> str:  # type: ignore[override]
        """Name of the second signal."""
        return self.scheduled.name

    @property
    def unit(self) -> str:
        """Unit of the second signal."""
        return self.scheduled.unit

    @property
    def dt(self) -> float | None:
        """The sample time it is made for, seconds; None if any will do."""
        return self.scheduled.dt

    def initial_state(self) -> Array:
        """Give the memory of the model's stages, reversed."""
        parts = [each.initial_state() for each in self._solved()[0]]
        return np.concatenate(parts) if parts else np.empty(0)

    def inverse(self) -> Scheduled:
        """Give the model."""
        return self.scheduled

    @property
    def knot_stages(self) -> tuple[tuple[Stage, ...], ...]:
        """The stages at each value of the schedule, which differ in their constants alone."""
        return self._stages

    def to_dict(self) -> dict[str, Any]:
        """Give kind and model."""
        return {"kind": self.kind, "scheduled": self.scheduled.to_dict()}

    def __eq__(self, other: object) -> bool:
        """Tell whether it is the inverse of the same model."""
        return isinstance(other, ScheduledInverse) and self.scheduled == other.scheduled

    def __hash__(self) -> int:
        """Give the hash of kind and model."""
        return hash((self.kind, self.scheduled))

    def __reduce__(self) -> tuple[Any, ...]:
        """Carry what it is made of, not the compiled chains."""
        return ScheduledInverse, (self.scheduled,), self._carried()

    @functools.cached_property
    def _stages(self) -> tuple[tuple[Stage, ...], ...]:
        return tuple(
            tuple(stage for part in parts for stage in part.stages()) for parts in self._solved()
        )

    def _solved(self) -> list[list[_Solved]]:
        """Give what solves each stage, reversed, at each value."""
        leaves = [leaves_of(each) for each in self.scheduled.models]
        by_stage = [
            _solved_stage(tuple(each[i] for each in leaves), self.scheduled)
            for i in reversed(range(len(leaves[0])))
        ]
        return [list(each) for each in zip(*by_stage, strict=True)]


@dataclass(frozen=True)
class _Solved:
    """What solves a stage: the stage itself under another kind, or an ordinary inverse."""

    operator: Operator
    kind: str = ""

    def stages(self) -> tuple[Stage, ...]:
        stages = self.operator.stages()
        return tuple(with_kind(each, self.kind) for each in stages) if self.kind else stages

    def initial_state(self) -> Array:
        return self.operator.initial_state()


def _solved_stage(leaves: Sequence[Operator], scheduled: Scheduled) -> list[_Solved]:
    first, moves = leaves[0], bool(moving_places(leaves).any())
    for value, leaf in zip(scheduled.values, leaves, strict=True):
        _require_inverse(leaf, value, scheduled.name)
    if not moves:
        return [_Solved(first.inverse())] * len(leaves)
    if isinstance(first, Affine):
        _require_one_sign([leaf.parameters().values[0] for leaf in leaves], scheduled, "the gain")
        return [_Solved(leaf, "affine_solved") for leaf in leaves]
    if isinstance(first, DeadZone):
        _require_monotone_map(leaves, scheduled)
        return [_Solved(leaf, "dead_zone_solved") for leaf in leaves]
    if isinstance(first, MaxwellSlip):
        leaves = [leaf.as_plays() for leaf in leaves if isinstance(leaf, MaxwellSlip)]
    if isinstance(leaves[0], PrandtlIshlinskii):
        _require_monotone_plays(leaves, scheduled)
        return [_Solved(leaf, "pi_solved") for leaf in leaves]
    if isinstance(first, Creep) and not any(
        (leaf.parameters().values < 0.0).any() for leaf in leaves
    ):
        return [_Solved(leaf.inverse()) for leaf in leaves]
    raise NotInvertibleError(
        f"the constants of a {first.kind} move with {scheduled.name}, and its inverse would not "
        "keep its memory; plays, dead zones, gains, offsets and creep that adds can be inverted "
        "while they move, and at(value).inverse() is the inverse at one value"
    )


def _require_inverse(leaf: Operator, value: float, name: str) -> None:
    try:
        leaf.inverse()
    except NotInvertibleError as refusal:
        raise NotInvertibleError(f"at {name} = {value:.6g}: {refusal}") from refusal


def _require_one_sign(gains: Sequence[float], scheduled: Scheduled, what: str) -> None:
    wrong = np.flatnonzero(np.sign(gains) != np.sign(gains[0]))
    if wrong.size:
        i = int(wrong[0])
        raise NotInvertibleError(
            f"{what} is {gains[0]:.6g} at {scheduled.name} = {scheduled.values[0]:.6g} and "
            f"{gains[i]:.6g} at {scheduled.values[i]:.6g}: it passes 0 in between"
        )


def _require_monotone_plays(leaves: Sequence[Operator], scheduled: Scheduled) -> None:
    """Refuse plays that could fall for a memory that moving radii leave.

    With fixed radii the plays that move are always the narrowest, so the cumulative weights decide,
    which are straight lines. Moving radii leave memories in which any of them may move.
    """
    tables = np.array([leaf.parameters().values for leaf in leaves])
    n = (tables.shape[1] - 1) // 2
    if (tables[:, n + 1 :] == tables[0, n + 1 :]).all():
        return
    least = tables[:, 0] + np.minimum(tables[:, 1 : n + 1], 0.0).sum(axis=1)
    wrong = np.flatnonzero(least <= 0.0)
    if wrong.size:
        i = int(wrong[0])
        raise NotInvertibleError(
            f"radii move with {scheduled.name}, and at {scheduled.values[i]:.6g} p0 and the "
            f"negative weights add up to {least[i]:.6g}: the output might fall while the input "
            "rises; give or identify weights of zero or more, or radii that stay"
        )


def _require_monotone_map(leaves: Sequence[Operator], scheduled: Scheduled) -> None:
    """Refuse maps that might bend back between two values.

    Slopes are sums of weights in the order of the thresholds; while that order stays, they are
    straight lines, so what is monotone at both ends is so between.
    """
    tables = np.array([leaf.parameters().values for leaf in leaves])
    m = tables.shape[1] // 2
    slopes = [tables[:, :m][:, tables[0, m:] == 0.0].sum(axis=1)]
    _require_one_sign(slopes[0].tolist(), scheduled, "the slope of a map around 0")
    orders = np.argsort(tables[:, m:], axis=1, kind="stable")
    signs = np.sign(tables[:, m:])
    if (orders != orders[0]).any() or (signs != signs[0]).any():
        raise NotInvertibleError(
            f"the thresholds of a map change their order or side with {scheduled.name}, so that it "
            "might bend back in between; give maps whose thresholds keep their order"
        )
