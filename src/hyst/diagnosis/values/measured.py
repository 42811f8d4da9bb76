"""The signals of a record without values that are no measurements, found once for all findings."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.values.codes import Code
from hyst.diagnosis.values.codes_of_record import bridged, codes_of_record, without_codes
from hyst.diagnosis.values.dropouts import Dropouts, dropouts_in
from hyst.diagnosis.values.plateaus import Plateau, plateaus_in
from hyst.diagnosis.values.spikes import Spikes, spikes_in
from hyst.diagnosis.values.steps import Levels, levels_of
from hyst.diagnosis.values.wraps import Wraps, wraps_in
from hyst.errors import InputError
from hyst.signals import Record

Array = NDArray[np.float64]

_MOST_SPIKES = 0.02
_MOST_CODES = 0.05
_MOST_DROPOUTS = 0.2
_REST = 0.02


@dataclass(frozen=True, eq=False)
class Values:
    """What the values of one record are.

    Parameters
    ----------
    number
        Of the record, counted from 1.
    record
        As it was given.
    input_codes, output_codes
        Values far outside all others.
    input_wraps, output_wraps
        Counters that start again; None if there is none.
    u, y
        Shape (N,), the signals with a straight line in the place of codes.
    input_levels, output_levels
        Steps of the converters; None where there is none to be seen.
    dropouts
        Of the output.
    plateaus
        Of the output.
    input_spikes, output_spikes
        Outliers, those of the output beside its dropouts.
    """

    number: int
    record: Record
    input_codes: tuple[Code, ...]
    output_codes: tuple[Code, ...]
    input_wraps: Wraps | None
    output_wraps: Wraps | None
    u: Array
    y: Array
    input_levels: Levels | None
    output_levels: Levels | None
    dropouts: Dropouts
    plateaus: tuple[Plateau, ...]
    input_spikes: Spikes
    output_spikes: Spikes

    @property
    def codes_are_few(self) -> bool:
        """Whether the output can be used without its codes."""
        return sum(each.samples.size for each in self.output_codes) <= _MOST_CODES * self.y.size

    @property
    def dropouts_are_few(self) -> bool:
        """Whether the output can be used without its dropouts."""
        return self.dropouts.samples.size <= _MOST_DROPOUTS * self.y.size

    def is_doubtful(self, plateau: Plateau) -> bool:
        """Tell whether a plateau is at about zero, where an actuator may as well be at rest."""
        return abs(plateau.level) <= _REST * float(np.ptp(self.y))

    @property
    def spikes_are_few(self) -> bool:
        """Whether the output has outliers, and not a way of its own."""
        return self.output_spikes.samples.size <= max(_MOST_SPIKES * self.y.size, 1.0)

    def are_measurements(self) -> NDArray[np.bool_]:
        """Tell which samples of the output are measurements, shape (N,)."""
        good = np.ones(self.y.size, dtype=bool)
        for code in self.output_codes:
            good[code.samples] = False
        for plateau in self.plateaus:
            if not self.is_doubtful(plateau):
                good[plateau.samples] = False
        good[self.dropouts.samples] = False
        if self.spikes_are_few:
            good[self.output_spikes.samples] = False
        return good


def values_of_each(evidence: Evidence) -> Iterator[Values]:
    """Give what the values of each record are, in their order."""
    for number in range(1, len(evidence.records) + 1):
        yield values_of(evidence, number)


def values_of(evidence: Evidence, number: int) -> Values:
    """Give what the values of one record are, found out only once.

    Findings of other kinds take ``values_of(evidence, number).are_measurements()`` to pass over
    samples that are none.
    """
    return evidence.once(("values", number), lambda: _look_at(evidence.records[number - 1], number))


def _look_at(record: Record, number: int) -> Values:
    """Look at one record: first codes, then what only shows without them.

    Raises
    ------
    InputError
        If a range is no number.
    """
    input_codes, output_codes = codes_of_record(record.u, record.y)
    u = without_codes(record.u, input_codes)
    y = without_codes(record.y, output_codes)
    for signal, name in ((u, record.input_name), (y, record.output_name)):
        _require_range(signal, f"record {number}: {name!r}")
    output_levels = levels_of(y)
    step = output_levels.step if output_levels else 0.0
    dropouts = dropouts_in(y, u, step)
    whole = bridged(y, dropouts.samples)
    input_levels = levels_of(u)
    return Values(
        number=number,
        record=record,
        input_codes=input_codes,
        output_codes=output_codes,
        input_wraps=wraps_in(u, y),
        output_wraps=wraps_in(y, u),
        u=u,
        y=y,
        input_levels=input_levels,
        output_levels=output_levels,
        dropouts=dropouts,
        plateaus=plateaus_in(y, u, step),
        input_spikes=spikes_in(u, None, input_levels.step if input_levels else 0.0),
        output_spikes=spikes_in(whole, u, step),
    )


def _require_range(signal: Array, name: str) -> None:
    """Refuse a signal whose range is too large for a double."""
    if float(signal.max()) / 2.0 - float(signal.min()) / 2.0 > sys.float_info.max / 2.0:
        raise InputError(f"{name} reaches over more than 1.8e308; choose units of moderate size")
