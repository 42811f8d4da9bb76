"""Operators one after the other."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError, NotInvertibleError
from hyst.operators.base import Operator
from hyst.operators.inequalities import Inequalities, side_by_side
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.registry import delayed, entries, operator_from_dict, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Traits

Array = NDArray[np.float64]


class Chained(Operator):
    """Operators one after the other; subclasses say which, everything else follows.

    The inverse of a composition is the composition of the inverses, reversed.
    """

    @property
    @abstractmethod
    def parts(self) -> tuple[Operator, ...]:
        """The operators in the order the signal passes them."""

    @abstractmethod
    def _with_parts(self, parts: tuple[Operator, ...]) -> Operator:
        """Give the same kind of composition of other operators."""

    def traits(self) -> Traits:
        """Give what follows from the traits of the parts.

        Loops stay congruent through a stage with memory, whose input they are, but not through a
        curved map of a signal that already has memory.
        """
        leaves = leaves_of(self)
        traits = [leaf.traits() for leaf in leaves]
        return Traits(
            memoryless=lambda: all(each.memoryless for each in traits),
            rate_independent=min(each.rate_independent for each in traits),
            return_point_memory=lambda: (
                all(each.return_point_memory for each in traits)
                and all(each.monotone for each in traits[:-1])
            ),
            congruent_loops=lambda: _keep_loops_congruent(leaves),
            monotone=lambda: all(each.monotone for each in traits),
            invertible=lambda: all(each.invertible for each in traits),
        )

    @property
    def dt(self) -> float | None:
        """The sample time of the parts that have one, seconds."""
        return _common_sample_time(self.parts)

    def at_sample_time(self, dt: float) -> Operator:
        """Give the same composition with every part for another sample time."""
        if self.dt is None:
            return self
        return self._with_parts(tuple(part.at_sample_time(dt) for part in self.parts))

    def initial_state(self) -> Array:
        """Give the states of the parts, one after the other."""
        return np.concatenate([part.initial_state() for part in self.parts])

    def exact_inverse(self) -> Operator:
        """Give the inverses of the parts in reversed order.

        Raises
        ------
        NotInvertibleError
            If a part has none; its own message says why.
        """
        return Composition(tuple(part.exact_inverse() for part in reversed(self.parts)))

    def preview_range(self) -> tuple[int, int]:
        """Give none where there is an exact inverse; else the sums over the parts.

        Raises
        ------
        NotInvertibleError
            If a part has no inverse, with preview neither; its own message says why.
        """
        if self.is_invertible():
            return 0, 0
        ranges = [part.preview_range() for part in self.parts]
        return sum(least for least, _ in ranges), sum(most for _, most in ranges)

    def preview_inverse(self, samples: int) -> Operator:
        """Give the inverses of the parts in reversed order, each with its share of the preview.

        Parts with exact inverses need none. What is left over is shared evenly by those that get
        better by it, so that none starves another, and delays the command in the end.

        Raises
        ------
        NotInvertibleError
            If the preview is too short for the parts together, or a part has no inverse.
        """
        if self.is_invertible():
            return super().preview_inverse(samples)
        ranges = [part.preview_range() for part in self.parts]
        spare = samples - sum(least for least, _ in ranges)
        if spare < 0:
            raise NotInvertibleError(
                f"a preview of {samples} is too short: the parts of this model need "
                f"{samples - spare} samples of the reference beyond the present one"
            )
        shares, spare = _shared_evenly(ranges, spare)
        pairs = zip(reversed(self.parts), reversed(shares), strict=True)
        inverse = Composition(tuple(part.preview_inverse(share) for part, share in pairs))
        return inverse if spare == 0 else delayed(inverse, spare)

    def parameters(self) -> Parameters:
        """Give the parameters of the parts, one after the other, named by part."""
        leaves = leaves_of(self)
        parts = [leaf.parameters() for leaf in leaves]
        names = [
            f"{prefix}.{name}"
            for prefix, part in zip(_prefixes(leaves), parts, strict=True)
            for name in part.names
        ]
        return Parameters(
            values=np.concatenate([part.values for part in parts]),
            names=tuple(names),
            lower=np.concatenate([part.lower for part in parts]),
            upper=np.concatenate([part.upper for part in parts]),
        )

    def nearest_parameters(self, theta: Array) -> Array:
        """Give the nearest vectors of the stages, one after the other."""
        counts = [len(stage.parameters()) for stage in self.parts]
        pieces = np.split(theta, np.cumsum(counts)[:-1])
        pairs = zip(self.parts, pieces, strict=True)
        return np.concatenate([stage.nearest_parameters(piece) for stage, piece in pairs])

    def inequalities(self) -> Inequalities:
        """Give those of the stages, side by side."""
        return side_by_side([stage.inequalities() for stage in self.parts])

    def with_parameters(self, theta: Sequence[float] | Array) -> Operator:
        """Give the same composition with other constants."""
        counts = [len(part.parameters()) for part in self.parts]
        vector = as_parameter_vector(theta, sum(counts))
        pieces = np.split(vector, np.cumsum(counts)[:-1])
        return self._with_parts(
            tuple(s.with_parameters(piece) for s, piece in zip(self.parts, pieces, strict=True))
        )

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of the stages' parameters, one after the other."""
        shares = _scales_of_stages(self.parts, input_scale, output_scale)
        pairs = zip(self.parts, shares, strict=True)
        return np.concatenate([stage.parameter_scales(*share) for stage, share in pairs])

    def in_units(self, input_scale: float, output_scale: float) -> Operator:
        """Give the same composition in other units.

        Maps keep the unit of their signal, and so does what only shifts or delays it; the first
        stage that is neither turns the unit of the input into that of the output.
        """
        shares = _scales_of_stages(self.parts, input_scale, output_scale)
        pairs = zip(self.parts, shares, strict=True)
        return self._with_parts(tuple(stage.in_units(*share) for stage, share in pairs))

    def lipschitz_constant(self) -> float:
        """Give the product of the parts' constants."""
        constant = 1.0
        for part in self.parts:
            constant *= part.lipschitz_constant()
        return constant

    def stages(self) -> tuple[Stage, ...]:
        """Give the stages of all parts in the order the signal passes them."""
        return tuple(stage for part in self.parts for stage in part.stages())


@register
@final
@dataclass(frozen=True, eq=False, repr=False, init=False)
class Composition(Chained):
    """A composition without a name of its own; ``f @ g`` makes one.

    Parameters
    ----------
    parts
        Operators in the order the signal passes them: ``(f @ g)`` has the parts ``(g, f)``.
        Compositions without a name among them are replaced by their own parts.

    Raises
    ------
    InputError
        If there is no stage, something else than an operator among them, or stages made for
        different sample times.

    Examples
    --------
    >>> from hyst.operators import Affine, Play
    >>> backlash = Affine(2.0, 1.0) @ Play(0.5)
    >>> backlash([0.0, 1.0, 2.0, 1.5])
    array([1., 2., 4., 4.])
    """

    _parts: tuple[Operator, ...]

    kind = "composition"

    def __init__(self, parts: Sequence[Operator]) -> None:
        if not isinstance(parts, list | tuple) or not parts:
            raise InputError("a composition has no stage; give a list of at least one operator")
        for part in parts:
            if not isinstance(part, Operator):
                raise InputError(
                    f"a stage is of type {type(part).__name__}; compose operators only"
                )
        flat = (each for part in parts for each in _parts(part))
        object.__setattr__(self, "_parts", tuple(flat))
        _common_sample_time(self._parts)

    @property
    def parts(self) -> tuple[Operator, ...]:
        """The operators in the order the signal passes them."""
        return self._parts

    def _with_parts(self, parts: tuple[Operator, ...]) -> Operator:
        return Composition(parts)

    def __repr__(self) -> str:
        return " @ ".join(repr(part) for part in reversed(self._parts))

    def to_dict(self) -> dict[str, Any]:
        """Give the kind and the parts."""
        return {"kind": self.kind, "stages": [part.to_dict() for part in self._parts]}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Operator:
        """Rebuild a composition.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        stages = entries(data, required=("stages",))["stages"]
        if not isinstance(stages, list):
            raise InputError("composition: 'stages' must be a list of operators")
        return cls([operator_from_dict(stage) for stage in stages])


def _shared_evenly(ranges: list[tuple[int, int]], spare: int) -> tuple[list[int], int]:
    """Give every part its least and a sample in turn, up to its most; and what nobody can use."""
    shares = [least for least, _ in ranges]
    while spare and any(share < most for share, (_, most) in zip(shares, ranges, strict=True)):
        for i, (_, most) in enumerate(ranges):
            if spare and shares[i] < most:
                shares[i] += 1
                spare -= 1
    return shares, spare


def _parts(operator: Operator) -> tuple[Operator, ...]:
    """Flatten nested compositions without a name; those with a name stay whole."""
    return operator.parts if type(operator) is Composition else (operator,)


def leaves_of(operator: Operator) -> tuple[Operator, ...]:
    """Give the operators that are no compositions themselves, in the order of the signal.

    Parameters
    ----------
    operator
        Any operator.

    Returns
    -------
    tuple of Operator
        ``operator`` alone if it is no composition.
    """
    if not isinstance(operator, Chained):
        return (operator,)
    return tuple(leaf for part in operator.parts for leaf in leaves_of(part))


def _keep_loops_congruent(leaves: tuple[Operator, ...]) -> bool:
    remembers = False
    for leaf in leaves:
        traits = leaf.traits()
        curved = traits.memoryless and leaf.kind != "affine"
        if not traits.congruent_loops or (remembers and curved):
            return False
        remembers = remembers or not traits.memoryless
    return True


def _scales_of_stages(
    stages: tuple[Operator, ...], input_scale: float, output_scale: float
) -> list[tuple[float, float]]:
    """Give input and output scale of every stage: one of them takes the change of the unit."""
    turning = [
        not all(leaf.is_map or leaf.keeps_unit() for leaf in leaves_of(stage)) for stage in stages
    ]
    if not any(turning):
        turning = [
            not all(leaf.is_map for leaf in leaves_of(stage)) and _may_turn_units(stage)
            for stage in stages
        ]
    at = turning.index(True) if any(turning) else len(stages) - 1
    before, after = (input_scale, input_scale), (output_scale, output_scale)
    count = len(stages)
    return [before] * at + [(input_scale, output_scale)] + [after] * (count - at - 1)


def _may_turn_units(stage: Operator) -> bool:
    """Tell whether a stage has a gain of its own, which creep has not."""
    try:
        stage.parameter_scales(1.0, 2.0)
    except InputError:
        return False
    return True


def _prefixes(leaves: tuple[Operator, ...]) -> list[str]:
    """Name operators by kind, numbered from 1 where a kind comes more than once."""
    kinds = [leaf.kind.replace("-", "_") for leaf in leaves]
    seen: dict[str, int] = {}
    prefixes = []
    for kind in kinds:
        seen[kind] = seen.get(kind, 0) + 1
        prefixes.append(f"{kind}_{seen[kind]}" if kinds.count(kind) > 1 else kind)
    return prefixes


def _common_sample_time(stages: tuple[Operator, ...]) -> float | None:
    own = [stage.dt for stage in stages if stage.dt is not None]
    if own and max(own) - min(own) > 1e-6 * min(own):
        raise InputError(
            f"stages are made for sample times of {min(own):.6g} s and {max(own):.6g} s; compose "
            "operators of one sample time"
        )
    return own[0] if own else None
