"""The inverse of rate-dependent plays that knows the next samples of the reference."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.numbers import as_number, as_positive, whole_number
from hyst.errors import InputError, NotInvertibleError
from hyst.operators.base import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.portrait import NOTHING, Portrait
from hyst.operators.registry import entries, operator_from_dict, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

if TYPE_CHECKING:
    from hyst.models.rate_dependent import RateDependentPrandtlIshlinskii

Array = NDArray[np.float64]

_PLAYS = "rate-dependent-prandtl-ishlinskii"
MOST_PLANNED = 60
"""Samples planned ahead at most; the cost of a sample grows with the third power."""
_SCALARS = 5
_BEGUN = 1


@register
@final
@dataclass(frozen=True, eq=False, repr=False, init=False)
class RateDependentPreview(Operator):
    """Commands for rate-dependent plays, planned ahead: the output at k is that for k - preview.

    Fed the wanted output, it holds the command of its first sample for ``preview`` samples, as if
    the reference had rested there; then it gives command after command. At every sample the plan of
    the next ``preview + 1`` commands is improved by one Gauss-Newton step, and beside it a second
    one that begins anew every five samples and takes over where it is better. It is no exact
    inverse: what is left is simulated, as ``model(command) - y_ref``.

    Parameters
    ----------
    plays
        The model, with p0 and all sums of weights from it on positive.
    preview
        Samples of the reference known beyond the present one, 1 to 60.
    command_range
        Lowest and highest command, input units; no limits if left out.
    largest_change
        Of the command from sample to sample, input units, > 0; no limit if left out.

    Raises
    ------
    InputError
        If the preview is no whole number from 1 to 60, or a limit is none.
    NotInvertibleError
        If the plays have no explicit inverse, from which plans begin.

    Notes
    -----
    What it starts from: S4 eqs. 12-16. ``RateDependentPrandtlIshlinskii.inverse(preview=N)`` makes
    it. Its constants are no parameters: it is given a model, not identified.

    Examples
    --------
    >>> from hyst.models import RateDependentPrandtlIshlinskii
    >>> plays = RateDependentPrandtlIshlinskii([0.5], [1.0], beta=7e-4, dt=1e-4, p0=0.5)
    >>> y_ref = 10.0 * np.sin(0.05 * np.arange(400.0))
    >>> command = plays.inverse(preview=20)(y_ref)[20:]
    >>> bool(abs(plays(command) - y_ref[:-20])[100:].max() < 0.1)
    True
    """

    plays: RateDependentPrandtlIshlinskii
    preview: int
    command_range: tuple[float, float] | None
    largest_change: float | None

    kind = "rate-dependent-preview"

    def __init__(
        self,
        plays: RateDependentPrandtlIshlinskii,
        preview: int,
        command_range: tuple[float, float] | None = None,
        largest_change: float | None = None,
    ) -> None:
        if not isinstance(plays, Operator) or plays.kind != _PLAYS:
            raise InputError(
                f"plays is a {type(plays).__name__}; give a RateDependentPrandtlIshlinskii"
            )
        plays.explicit_inverse()
        object.__setattr__(self, "plays", plays)
        object.__setattr__(self, "preview", whole_number(preview, "preview", 1, MOST_PLANNED))
        ends = None if command_range is None else _as_range(command_range)
        object.__setattr__(self, "command_range", ends)
        change = None if largest_change is None else as_positive(largest_change, "largest_change")
        object.__setattr__(self, "largest_change", change)

    @property
    def dt(self) -> float:
        """The sample time, seconds."""
        return self.plays.dt

    def __repr__(self) -> str:
        return (
            f"RateDependentPreview({self.plays!r}, {self.preview}, "
            f"command_range={self.command_range!r}, largest_change={self.largest_change!r})"
        )

    def traits(self) -> Traits:
        """Give none: it plans in time."""
        return Traits(
            memoryless=False,
            rate_independent=Degree.NO,
            return_point_memory=False,
            congruent_loops=False,
            monotone=False,
            invertible=False,
        )

    def initial_state(self) -> Array:
        """Give the memory of the plays and of their explicit inverse, with nothing known yet."""
        n, length = self.plays.p.size, self.preview + 1
        scratch = n * (length + 5) + 4 * length + length * (length + 1) // 2
        rest = np.zeros(_SCALARS + 4 * length + scratch)
        guess = self.plays.explicit_inverse().initial_state()
        return np.concatenate([self.plays.initial_state(), guess, rest])

    def state_within_a_record(self, state: Array) -> Array:
        """Give the state before a record's first sample, where no command is held before it.

        Parameters
        ----------
        state
            Of the plays, shape (n + 2,).

        Returns
        -------
        numpy.ndarray
            Fed the record's first ``preview`` samples, the next output is its first command.
        """
        plays, n = self.plays, self.plays.p.size
        held = type(plays)(plays.p, plays.r, plays.rate_curve, plays.dt, plays.p0, state[:n])
        whole = self.initial_state()
        whole[: n + 2] = state
        whole[n + 2 : 2 * n + 4] = held.explicit_inverse().initial_state()
        if state[n + 1] > 0.0:
            whole[2 * n + 2 : 2 * n + 4] = plays.p0 * state[n] + float(plays.p @ state[:n]), 1.0
        whole[2 * n + 4 + _BEGUN] = 1.0
        return whole

    def _gain(self) -> float:
        """Give by what the output's rate is divided for that of the drive in the explicit inverse.

        The slope of the output is p0 behind a turn and p0 + sum p far from it; of the values
        between, two thirds of the way leave the least errors where the preview is short.
        """
        return self.plays.p0 + 2.0 / 3.0 * float(self.plays.p.sum())

    def exact_inverse(self) -> Operator:
        """Refuse: what is planned ahead cannot be taken back.

        Raises
        ------
        NotInvertibleError
            Always.
        """
        raise NotInvertibleError(
            f"a command planned {self.preview} samples ahead is no exact inverse and has none; the "
            "model is its field 'plays'"
        )

    def parameters(self) -> Parameters:
        """Give none: the model it is made for is not identified through it."""
        return Parameters(values=np.empty(0), names=(), lower=np.empty(0), upper=np.empty(0))

    def with_parameters(self, theta: Sequence[float] | Array) -> RateDependentPreview:
        """Give the same, for there is nothing to change."""
        as_parameter_vector(theta, 0)
        return self

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give no factors."""
        return np.empty(0)

    def in_units(self, input_scale: float, output_scale: float) -> RateDependentPreview:
        """Give the same in other units: its input is the model's output."""
        ends, change = self.command_range, self.largest_change
        return RateDependentPreview(
            self.plays.in_units(output_scale, input_scale),
            self.preview,
            None if ends is None else (ends[0] * output_scale, ends[1] * output_scale),
            None if change is None else change * output_scale,
        )

    def portrait(self) -> Portrait:
        """Show nothing: a plan is seen over time."""
        return NOTHING

    def lipschitz_constant(self) -> float:
        """Give infinity: a plan may jump where another one becomes better."""
        return float("inf")

    def to_dict(self) -> dict[str, Any]:
        """Give kind, model, preview and the limits there are."""
        ends, change = self.command_range, self.largest_change
        return {
            "kind": self.kind,
            "plays": self.plays.to_dict(),
            "preview": self.preview,
            **({} if ends is None else {"command_range": list(ends)}),
            **({} if change is None else {"largest_change": change}),
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> RateDependentPreview:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        given = entries(data, ("plays", "preview"), ("command_range", "largest_change"))
        plays: Any = operator_from_dict(given.pop("plays"))
        return cls(plays, **given)

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        ends, change = self.command_range, self.largest_change
        low, high = (0.0, 0.0) if ends is None else ends
        return (
            Stage(
                "rate_preview",
                (),
                fixed={
                    **_core_constants(self.plays, ""),
                    **_core_constants(self.plays.explicit_inverse(), "guess_", self._gain()),
                    "low": (low,),
                    "high": (high,),
                    "change": (0.0 if change is None else change,),
                },
                choices={
                    "preview": self.preview,
                    "ranged": int(ends is not None),
                    "slowed": int(change is not None),
                },
                dt=self.dt,
            ),
        )


def _as_range(ends: ArrayLike) -> tuple[float, float]:
    pair = np.asarray(ends, dtype=float)
    if pair.shape != (2,):
        raise InputError(f"command_range is {ends!r}; give the lowest and the highest command")
    low, high = (as_number(float(each), "an end of command_range") for each in pair)
    if not low < high:
        raise InputError(f"command_range is {low:.6g} to {high:.6g}; give ascending numbers")
    return low, high


def _core_constants(
    plays: RateDependentPrandtlIshlinskii, prefix: str, gain: float = 1.0
) -> dict[str, tuple[float, ...]]:
    """Give the constants of the core, whose rate curve is over the change in a sample.

    ``gain`` is what the change is divided by first.
    """
    curve, dt = plays.rate_curve, plays.dt * gain
    powers = curve.powers / dt ** np.arange(2.0, curve.powers.size + 2.0)
    values: dict[str, Sequence[float] | Array] = {
        "p0": [plays.p0],
        "p": plays.p,
        "r": plays.r,
        "growth": [curve.beta / dt],
        "power": powers,
        "weight": curve.slopes / dt,
        "threshold": curve.knees * dt,
    }
    return {prefix + name: tuple(float(each) for each in value) for name, value in values.items()}
