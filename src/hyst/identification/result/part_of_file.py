"""The part of a record in a file on which all but the constants was found."""

from __future__ import annotations

from dataclasses import dataclass

from hyst.identification.record_use.used_samples import UsedSamples


@dataclass(frozen=True)
class PartOfFile:
    """Samples in a row of a record that stays in its file.

    Parameters
    ----------
    start
        The first.
    stop
        One past the last.
    used
        Which of them took part, counted from ``start``.
    """

    start: int
    stop: int
    used: UsedSamples
