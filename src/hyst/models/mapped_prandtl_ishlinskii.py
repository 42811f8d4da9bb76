"""Plays with a map before or after them: two models, each of the kind of the other's inverse."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

from hyst.models.parts import as_map, as_plays
from hyst.operators.base import Operator
from hyst.operators.composition import Chained
from hyst.operators.registry import entries, operator_from_dict, register


@register
@final
@dataclass(frozen=True, eq=False)
class GeneralizedPrandtlIshlinskii(Chained):
    """Generalized Prandtl-Ishlinskii model: ``y = (pi @ envelope)(u)``.

    Loops may be asymmetric and saturate; they stay congruent. The inverse is the inverse plays
    followed by the inverse envelope, a ``ModifiedPrandtlIshlinskii``.

    Parameters
    ----------
    envelope
        A memoryless operator, usually a ``DeadZone``; strictly monotone if the model is to be
        inverted.
    pi
        The ``PrandtlIshlinskii`` model of the envelope's output.

    Raises
    ------
    InputError
        If the envelope has memory or ``pi`` is no Prandtl-Ishlinskii model.

    Notes
    -----
    S1 secs. 2.1-2.2, eq. 5.

    Examples
    --------
    >>> from hyst.models import PrandtlIshlinskii
    >>> from hyst.operators import DeadZone
    >>> envelope = DeadZone.odd([0.65, 0.2], [0.0, 7.56])
    >>> model = GeneralizedPrandtlIshlinskii(envelope, PrandtlIshlinskii([0.5], [1.0], p0=0.1))
    >>> u = [0.0, 9.0, 3.0, 8.0]
    >>> bool(abs(model.inverse()(model(u)) - u).max() < 1e-13)
    True
    """

    envelope: Operator
    pi: Operator

    kind = "generalized-prandtl-ishlinskii"

    def __post_init__(self) -> None:
        as_map(self.envelope, "envelope")
        as_plays(self.pi)

    @property
    def parts(self) -> tuple[Operator, ...]:
        """The envelope, then the plays."""
        return (self.envelope, self.pi)

    def exact_inverse(self) -> ModifiedPrandtlIshlinskii:
        """Give the exact inverse: the inverse plays, then the inverse envelope (S1 eq. 5).

        Raises
        ------
        NotInvertibleError
            If plays or envelope have none; the message names the condition that fails.
        """
        return ModifiedPrandtlIshlinskii(self.pi.exact_inverse(), self.envelope.exact_inverse())

    def _with_parts(self, parts: tuple[Operator, ...]) -> Operator:
        return GeneralizedPrandtlIshlinskii(*parts)

    def to_dict(self) -> dict[str, Any]:
        """Give kind, envelope and plays."""
        return {"kind": self.kind, "envelope": self.envelope.to_dict(), "pi": self.pi.to_dict()}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> GeneralizedPrandtlIshlinskii:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        given = entries(data, required=("envelope", "pi"))
        return cls(operator_from_dict(given["envelope"]), operator_from_dict(given["pi"]))


@register
@final
@dataclass(frozen=True, eq=False)
class ModifiedPrandtlIshlinskii(Chained):
    """Modified Prandtl-Ishlinskii model: ``y = (output_map @ pi)(u)``.

    Loops may be asymmetric and change shape with the level they are at. The inverse is the inverse
    map followed by the inverse plays, a ``GeneralizedPrandtlIshlinskii``.

    Parameters
    ----------
    pi
        The ``PrandtlIshlinskii`` model, or the rate-dependent one.
    output_map
        A memoryless operator, usually a ``DeadZone``; strictly monotone if the model is to be
        inverted.

    Raises
    ------
    InputError
        If the map has memory or ``pi`` is no Prandtl-Ishlinskii model.

    Notes
    -----
    S4 sec. III-D, eqs. 27-33, after Kuhnen.

    Examples
    --------
    >>> from hyst.models import PrandtlIshlinskii
    >>> from hyst.operators import DeadZone
    >>> model = ModifiedPrandtlIshlinskii(
    ...     PrandtlIshlinskii([0.5], [1.0], p0=0.5), DeadZone([1.0, -0.3], [0.0, 2.0]))
    >>> u = [0.0, 9.0, 3.0, 8.0]
    >>> bool(abs(model.inverse()(model(u)) - u).max() < 1e-13)
    True
    """

    pi: Operator
    output_map: Operator

    kind = "modified-prandtl-ishlinskii"

    def __post_init__(self) -> None:
        as_plays(self.pi)
        as_map(self.output_map, "output_map")

    @property
    def parts(self) -> tuple[Operator, ...]:
        """The plays, then the map."""
        return (self.pi, self.output_map)

    def exact_inverse(self) -> GeneralizedPrandtlIshlinskii:
        """Give the exact inverse: the inverse map, then the inverse plays (S4 eqs. 28-33).

        Raises
        ------
        NotInvertibleError
            If map or plays have none; the message names the condition that fails.
        """
        return GeneralizedPrandtlIshlinskii(
            self.output_map.exact_inverse(), self.pi.exact_inverse()
        )

    def _with_parts(self, parts: tuple[Operator, ...]) -> Operator:
        return ModifiedPrandtlIshlinskii(*parts)

    def to_dict(self) -> dict[str, Any]:
        """Give kind, plays and map."""
        return {
            "kind": self.kind,
            "pi": self.pi.to_dict(),
            "output_map": self.output_map.to_dict(),
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> ModifiedPrandtlIshlinskii:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        given = entries(data, required=("pi", "output_map"))
        return cls(operator_from_dict(given["pi"]), operator_from_dict(given["output_map"]))
