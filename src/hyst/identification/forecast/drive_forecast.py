"""What is expected of a drive: a standard error for every number of a model."""

from __future__ import annotations

import math
from dataclasses import dataclass

SURE = 0.1
"""Standard error, as a share of the number, up to which it is determined."""

ROUGH = 0.3
"""Up to which it is roughly determined; beyond, it is not."""


@dataclass(frozen=True)
class ExpectedError:
    """A number of a model, and how sure a drive will make it.

    Parameters
    ----------
    name
        As ``resonance [Hz]`` or ``p[2]``.
    value
        Of the stated model.
    standard_error
        Expected; NaN if the drive leaves it open however small the noise is.
    scale
        What the error is compared with: the size of the value, or what would change the output as
        much as all of it where the value is 0.
    """

    name: str
    value: float
    standard_error: float
    scale: float
    by_own_lines: float = 0.0
    shared: bool = False
    held: bool = False

    @property
    def is_frequency(self) -> bool:
        """Whether it is that of a resonance or a lag."""
        return self.name.endswith("[Hz]")

    @property
    def error(self) -> float:
        """The larger of both standard errors; infinity where the number is left open."""
        either = (self.standard_error, self.by_own_lines)
        return max(either) if all(map(math.isfinite, either)) else math.inf

    @property
    def share(self) -> float:
        """The error as a share of the scale."""
        return self.error / self.scale if self.scale > 0.0 else math.inf

    @property
    def determined(self) -> bool:
        """Whether the error is at most 30 % of the number."""
        return self.share <= ROUGH

    @property
    def verdict(self) -> str:
        """``yes`` up to an error of a tenth, ``roughly`` up to three, ``no``, or ``held``."""
        if self.held:
            return "held"
        return "yes" if self.share <= SURE else "roughly" if self.determined else "no"


@dataclass(frozen=True)
class DriveForecast:
    """What a drive will determine of a stated model.

    Parameters
    ----------
    of_dynamics
        Resonances, damping and lags.
    of_front
        Constants of all else: weights, radii, offsets.
    free_of_dynamics, free_of_front
        How many numbers there are to determine.
    output_rms, noise_rms
        Output units, about the mean; of the model's output, and of the noise that was stated.
    samples
        Of the drive that were looked at; errors are for as many.
    delay_evidence
        By how many standard errors of the noise the delay is told from one sample more or less;
        None if the model has no dynamics.
    advice
        What stays undetermined and what to add, sentences.
    """

    of_dynamics: tuple[ExpectedError, ...]
    of_front: tuple[ExpectedError, ...]
    free_of_dynamics: int
    free_of_front: int
    output_rms: float
    noise_rms: float
    samples: int
    delay_evidence: float | None
    advice: tuple[str, ...]

    @property
    def errors(self) -> tuple[ExpectedError, ...]:
        """All numbers, those of the dynamics first."""
        return self.of_dynamics + self.of_front

    @property
    def frequencies(self) -> tuple[float, ...]:
        """Of resonances and lags, Hz."""
        return tuple(each.value for each in self.of_dynamics if each.is_frequency)

    @property
    def shared(self) -> tuple[str, ...]:
        """Names of constants that the model itself lets be traded against one another."""
        return tuple(each.name for each in self.errors if each.shared)

    @property
    def held(self) -> tuple[str, ...]:
        """Those of them that are held."""
        return tuple(each.name for each in self.errors if each.held)

    @property
    def undetermined(self) -> tuple[str, ...]:
        """Names of the numbers that stay open."""
        return tuple(each.name for each in self.errors if not each.determined)

    @property
    def sufficient(self) -> bool:
        """Whether nothing stays open, the delay included."""
        return not self.undetermined and not self.delay_is_open

    @property
    def delay_is_open(self) -> bool:
        """Whether another delay explains the output as well."""
        return self.delay_evidence is not None and self.delay_evidence < TOLD_APART


TOLD_APART = 5.0
"""Standard errors of the noise by which a delay must differ from its neighbours."""
