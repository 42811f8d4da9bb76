"""Put a stage with constants of its own into what is fitted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import partial
from typing import Literal, Self

import numpy as np
from numpy.typing import NDArray

from hyst.errors import NotIdentifiableError
from hyst.identification.fit.parametrization import Parametrization
from hyst.operators import Affine, Composition, Operator

Array = NDArray[np.float64]
Start = tuple[Parametrization, Array]
Where = Literal["drive", "output"]


@dataclass(frozen=True, eq=False)
class StagedParametrization(Parametrization):
    """A parametrization with one more stage; theta ends with the constants of that stage.

    Parameters
    ----------
    base
        Without the stage; theta starts with its free parameters.
    stage
        The stage as it was put in.
    where
        ``"drive"``: before the first stage; ``"output"``: after the hysteresis, before the offset.
    """

    base: Parametrization = None  # type: ignore[assignment]  # the fields before have defaults
    stage: Operator = None  # type: ignore[assignment]
    where: Where = "output"

    @property
    def free_count(self) -> int:
        """Number of parameters that can move, counted by the base as it counts them."""
        own = slice(self.base.size, None)
        return self.base.free_count + int((self.lower[own] < self.upper[own]).sum())

    def operator(self, theta: Array) -> Operator:
        """Give the operator that the base makes, with the stage in its place."""
        own = self.stage.with_parameters(theta[self.base.size :])
        return with_part(self.base.operator(theta[: self.base.size]), own, self.where)

    def in_units(self, theta: Array, input_scale: float, output_scale: float) -> Self:
        """Give the same free parameters in other units, the base's too."""
        scaled = super().in_units(theta, input_scale, output_scale)
        base = self.base.in_units(theta[: self.base.size], input_scale, output_scale)
        # The unit of what the stage is driven by; its constants are scaled by transform.
        scale = input_scale if self.where == "drive" else output_scale
        return replace(scaled, base=base, stage=self.stage.in_units(scale, scale))


def with_stage(
    parametrization: Parametrization,
    theta: Array,
    stage: Operator,
    where: Where,
    lower: Array,
    upper: Array,
) -> Start:
    """Put a stage that keeps the unit of its signal into a model that is fitted.

    Parameters
    ----------
    parametrization, theta
        Of the model without it.
    stage
        Its constants are where they start.
    where
        ``"drive"``: before the first stage, as what the amplifier does; ``"output"``: after the
        hysteresis and before sign and offset, as creep.
    lower, upper
        Shape (constants of the stage,), bounds; equal where a constant is held.

    Returns
    -------
    StagedParametrization
    theta : numpy.ndarray
        That of the model, then the constants of the stage.

    Raises
    ------
    NotIdentifiableError
        If the model has no place for it.
    """
    constants, count = stage.parameters().values, parametrization.size
    at = _constants_before(parametrization.template, where)
    own = np.arange(at, at + constants.size)
    rows = np.delete(np.arange(parametrization.fixed.size + constants.size), own)
    transform = np.zeros((rows.size + own.size, count + own.size))
    transform[np.ix_(rows, np.arange(count))] = parametrization.transform
    transform[own, count + np.arange(own.size)] = 1.0
    fixed = np.zeros(len(transform))
    fixed[rows] = parametrization.fixed
    taken = {each.name: getattr(parametrization, each.name) for each in fields(Parametrization)}
    taken |= {
        "template": with_part(parametrization.template, stage, where),
        "transform": transform,
        "fixed": fixed,
        "lower": np.concatenate([parametrization.lower, lower]),
        "upper": np.concatenate([parametrization.upper, upper]),
        "canonical": partial(_canonical, parametrization),
        "gauges": _gauges(parametrization, own.size),
        "is_allowed": _is_allowed(parametrization),
        "is_linear": False,
    }
    if parametrization.prior is not None:
        taken["prior"] = np.pad(parametrization.prior, ((0, 0), (0, own.size)))
    staged = StagedParametrization(**taken, base=parametrization, stage=stage, where=where)
    return staged, np.concatenate([theta, np.clip(constants, lower, upper)])


def with_part(operator: Operator, stage: Operator, where: Where) -> Operator:
    """Give an operator with a stage in its place.

    Parameters
    ----------
    operator
        As a family makes it.
    stage, where
        As of ``with_stage``.
    """
    parts = _parts(operator)
    at = _place(operator, where)
    return Composition((*parts[:at], stage, *parts[at:]))


def without_part(operator: Operator, kind: str) -> Operator | None:
    """Give a composition without its stage of a kind; None if it has none.

    Parameters
    ----------
    operator
        Any.
    kind
        Of the stage.
    """
    parts = _parts(operator)
    rest = [each for each in parts if each.kind != kind]
    return Composition(tuple(rest)) if rest and len(rest) < len(parts) else None


def _parts(operator: Operator) -> tuple[Operator, ...]:
    return operator.parts if isinstance(operator, Composition) else (operator,)


def _place(operator: Operator, where: Where) -> int:
    """Give before which part the stage comes."""
    parts = _parts(operator)
    if where == "drive":
        return 0
    if not isinstance(parts[-1], Affine):
        raise NotIdentifiableError(
            f"the model ends in a {parts[-1].kind}, whose constant would creep: creep is "
            "identified with families whose offset comes last; choose another family, or leave "
            "creep out"
        )
    return len(parts) - 1


def _constants_before(operator: Operator, where: Where) -> int:
    return sum(len(each.parameters()) for each in _parts(operator)[: _place(operator, where)])


def _canonical(base: Parametrization, theta: Array) -> Array:
    return np.concatenate([base.canonical(theta[: base.size]), theta[base.size :]])


def _is_allowed(base: Parametrization) -> Callable[[Array], bool] | None:
    allowed = base.is_allowed
    return None if allowed is None else partial(_is_allowed_before, allowed, base.size)


def _is_allowed_before(allowed: Callable[[Array], bool], size: int, theta: Array) -> bool:
    return allowed(theta[:size])


def _gauges(base: Parametrization, more: int) -> Callable[[Array], tuple[Array, Array]] | None:
    gauges = base.gauges
    if gauges is None:
        return None
    return partial(_padded, gauges, base.size, more)


def _padded(
    gauges: Callable[[Array], tuple[Array, Array]], size: int, more: int, theta: Array
) -> tuple[Array, Array]:
    values, rows = gauges(theta[:size])
    return values, np.pad(rows, ((0, 0), (0, more)))
