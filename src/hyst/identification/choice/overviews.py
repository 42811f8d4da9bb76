"""The records of each family, with what is found out about them shared by all that use the same."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

from hyst.identification.choice.task import Task
from hyst.identification.families.family import Family
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data


def with_overviews(
    tasks: Sequence[Task], delay: float | str, known: dict[Hashable, Overview]
) -> list[tuple[Family, Overview]]:
    """Give every family its records; those that use the same share what is found out.

    Parameters
    ----------
    tasks
        Families and records.
    delay
        As of ``Overview``.
    known
        Of earlier searches, which this one adds its own to.
    """
    shared = dict[Hashable, Overview]()
    result = []
    for task in tasks:
        rates_matter = task.family.depends_on_rate
        # Whole records are not kept from one search to the next.
        found = shared if rates_matter else known
        key = (rates_matter, delay, *_identity(task.data))
        if key not in found:
            found[key] = Overview(task.searched(), delay, rates_matter=rates_matter)
        result.append((task.family, found[key]))
    return result


def _identity(data: Data) -> tuple[Hashable, ...]:
    """Give what tells records from others; a family may take the noise out of its drives."""
    signals = tuple(hash((each.u.tobytes(), each.y.tobytes())) for each in data.records)
    counted = tuple(None if each is None else hash(each.tobytes()) for each in data.kept)
    return data.starts, data.lag, data.keeps_corners, signals, counted
