"""How findings put numbers and records into words."""

from __future__ import annotations

from hyst.diagnosis.evidence import Evidence


def amount(value: float, unit: str, per: str = "") -> str:
    """Give a number with its unit, as ``1.5 um/s``."""
    whole = f"{unit}/{per}" if per and unit else (f"per {per}" if per else unit)
    return f"{value:.3g} {whole}".rstrip()


def of_record(evidence: Evidence, number: int) -> str:
    """Name the record at the beginning of a sentence, if there are several."""
    return "" if len(evidence.records) == 1 else f"in record {number} "


def percent(share: float) -> str:
    """Give a share in percent, as ``0.38 %``."""
    return f"{100.0 * share:.2g} %"
