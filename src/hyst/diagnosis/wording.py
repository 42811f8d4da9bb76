"""How findings put numbers and records into words."""

from __future__ import annotations

from hyst.diagnosis.evidence import Evidence


def amount(value: float, unit: str, per: str = "") -> str:
    """Give a number with its unit, as ``1.5 um/s``.

    Parameters
    ----------
    value
        The number.
    unit
        Its unit; empty if unknown.
    per
        What the unit is divided by.
    """
    whole = f"{unit}/{per}" if per and unit else (f"per {per}" if per else unit)
    return f"{value:.3g} {whole}".rstrip()


def of_record(evidence: Evidence, number: int) -> str:
    """Name the record at the beginning of a sentence, if there are several.

    Parameters
    ----------
    evidence
        All records.
    number
        Which, counted from 1.
    """
    return "" if len(evidence.records) == 1 else f"in record {number} "


def counted(count: int, what: str) -> str:
    """Give a number of things, as ``1 level`` and ``2 levels``.

    Parameters
    ----------
    count
        How many.
    what
        One of them.
    """
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def percent(share: float) -> str:
    """Give a share in percent, as ``0.38 %``."""
    value = 100.0 * share
    return f"{value:.0f} %" if abs(value) >= 100.0 else f"{value:.2g} %"
