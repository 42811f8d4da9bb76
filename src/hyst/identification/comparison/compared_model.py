"""What a comparison tells of one model."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.operators import ModelDescription, Operator, Verdict
from hyst.signals import Metrics

Array = NDArray[np.float64]


@dataclass(frozen=True)
class WorstPlace:
    """Where a model is furthest from the records.

    Parameters
    ----------
    record
        Number of the record, counted from 1.
    sample
        Of that record, counted from 0.
    time
        Of that sample, s.
    input, error
        The record's input there, and modelled minus recorded output.
    """

    record: int
    sample: int
    time: float
    input: float
    error: float


@dataclass(frozen=True, eq=False)
class ComparedModel:
    """One model on the records of a comparison.

    Parameters
    ----------
    name
        What the comparison calls it.
    model
        The operator, with its description.
    metrics, free_offset
        Errors over the samples that all models are judged on, percentages of the range of the whole
        records; and the same with the mean error taken out.
    outer_strokes, minor_loops
        Root mean square error over the longest strokes and over the others, output units; None
        where the records show no minor loops.
    worst
        Where it is furthest off.
    nanoseconds
        Time of a sample in a run over the records.
    not_invertible
        Which condition of an exact inverse fails; empty where there is one.
    seen
        Numbers of the records it was identified from, by their digests: none of them tests it.
    extrapolated
        Share of the samples whose input lies outside the range it was identified over; None where
        it does not say that range.
    outputs
        Its output over each whole record as it would be measured, delay included.
    block_errors, centred_block_errors
        Shape (blocks,): mean squared error of each, in squares of the range of the output; and the
        same with the mean error over all samples taken out.
    """

    name: str
    model: Operator
    metrics: Metrics
    free_offset: Metrics
    outer_strokes: float | None
    minor_loops: float | None
    worst: WorstPlace
    nanoseconds: float
    not_invertible: str
    seen: tuple[int, ...]
    extrapolated: float | None
    outputs: tuple[Array, ...] = field(repr=False)
    block_errors: Array = field(repr=False)
    centred_block_errors: Array = field(repr=False)

    @property
    def description(self) -> ModelDescription:
        """What the model says of itself."""
        return self.model.description

    @property
    def family(self) -> str:
        """The family it was identified in; its kind where that is not known."""
        return self.description.family or self.model.kind

    @property
    def constants(self) -> int:
        """How many constants it has, those that were held included."""
        return len(self.model.parameters())

    @property
    def verdict(self) -> Verdict | None:
        """The verdict it was saved with."""
        return self.description.verdict

    @property
    def is_invertible(self) -> bool:
        """Whether it has an exact inverse."""
        return not self.not_invertible

    def to_dict(self) -> dict[str, Any]:
        """Give everything but the model and its outputs as plain numbers and text."""
        about = self.description
        return {
            "name": self.name,
            "family": self.family,
            "constants": self.constants,
            "metrics": self.metrics.to_dict(),
            "free_offset": self.free_offset.to_dict(),
            "outer_strokes_rms": self.outer_strokes,
            "minor_loops_rms": self.minor_loops,
            "worst": asdict(self.worst),
            "delay": about.delay,
            "nanoseconds_per_sample": self.nanoseconds,
            "invertible": self.is_invertible,
            "not_invertible": self.not_invertible,
            "verdict": None if self.verdict is None else self.verdict.to_dict(),
            "seen_records": list(self.seen),
            "extrapolated_share": self.extrapolated,
        }
