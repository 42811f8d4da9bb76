"""The samples that models of different delays are all judged on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hyst.errors import InputError
from hyst.identification.record_use.part_of_a_sample import lag_in_samples
from hyst.identification.record_use.used_samples import Data, UsedSamples, prepare
from hyst.operators import ModelDescription
from hyst.signals import Record


def lag_on(about: ModelDescription, record: Record) -> float:
    """Give the delay of a model in samples of a record.

    Parameters
    ----------
    about
        The model's description: its delay is in samples of its own ``dt``.
    record
        The record.
    """
    own = record.dt if about.dt is None else about.dt
    return lag_in_samples(about.delay, own, record.dt)


def common_samples(
    records: Sequence[Record], about: Sequence[ModelDescription]
) -> tuple[Data, tuple[UsedSamples, ...]]:
    """Give the records with those samples that every model can be judged on.

    Of each model they are the samples a validation record is judged on: from where the input has
    passed its range, and as far as the delayed input goes. Those of all models at once are left, so
    that no model is judged on easier samples than another.

    Parameters
    ----------
    records
        At least one.
    about
        What the models say of themselves.

    Returns
    -------
    Data
        Without a delay; what counts is marked.
    tuple of UsedSamples
        The first and last of them, for each record.

    Raises
    ------
    InputError
        If no sample of a record is left.
    NotIdentifiableError
        If input or output of a record is constant, or its input does not turn.
    """
    given = tuple(records)
    used = [prepare(given, "auto", lag_on(each, given[0])).used() for each in about]
    starts = tuple(max(each[i].start for each in used) for i in range(len(given)))
    stops = tuple(min(each[i].stop for each in used) for i in range(len(given)))
    for number, (record, start, stop) in enumerate(zip(given, starts, stops, strict=True), 1):
        if stop - start < 2:
            raise InputError(
                f"record {number} has {len(record)} samples, and none is left beside the delays of "
                f"the models ({', '.join(f'{each.delay:.4g}' for each in about)} samples); give a "
                "longer one"
            )
    sizes = [len(record) for record in given]
    kept = tuple(np.arange(size) < stop for size, stop in zip(sizes, stops, strict=True))
    data = replace(prepare(given, "auto"), starts=starts, kept=kept)
    return data, tuple(map(UsedSamples, starts, stops, sizes))
