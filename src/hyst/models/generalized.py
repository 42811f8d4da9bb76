"""Generalized Prandtl-Ishlinskii model: an envelope map before the plays."""

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
    followed by the inverse envelope, a modified Prandtl-Ishlinskii model.

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
    def stages(self) -> tuple[Operator, ...]:
        """The envelope, then the plays."""
        return (self.envelope, self.pi)

    def _with_stages(self, stages: tuple[Operator, ...]) -> Operator:
        return GeneralizedPrandtlIshlinskii(*stages)

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
