"""One family, size, delay and number of creeping lags for a whole fleet."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from hyst.fleet.device_fit import sentence_of
from hyst.fleet.sources import Measurement
from hyst.identification import Candidate, identify
from hyst.identification.families.family import Family
from hyst.models import Creep
from hyst.operators.composition import leaves_of

LOOKED_AT, MOST_TRIED = 16, 64
"""Records that the choice is made on, and records that are tried to get as many."""

EQUAL = 0.02
"""Errors that differ by this share are equal, as for one record."""

LEFT_ASIDE = 0.15
"""Share of the records that a candidate may suit worst without being judged by them: outliers."""

AGREE = 0.75
"""Share of the records that have to agree about a delay for it to be that of all."""

_WORST = math.log(3.0)
"""Of the logarithm of an error over the best one; what is beyond counts no more."""


@dataclass(frozen=True, eq=False)
class Look:
    """What one record says when it is identified alone.

    Parameters
    ----------
    identifier
        The device.
    failure
        Why it says nothing; empty where it does.
    family, plays
        Chosen; plays is None where the family has no size.
    candidates
        What was compared.
    delay, delay_interval
        s.
    creeps
        Number of creeping lags.
    input_unit, output_unit
        Of the record.
    """

    identifier: str
    failure: str = ""
    family: str = ""
    plays: int | None = None
    candidates: tuple[Candidate, ...] = ()
    delay: float = 0.0
    delay_interval: tuple[float, float] = (0.0, 0.0)
    creeps: int = 0
    input_unit: str = ""
    output_unit: str = ""


@dataclass(frozen=True, eq=False)
class Choice:
    """What a fleet was settled on.

    Parameters
    ----------
    family
        Its name; empty if no record could be used, and each device chooses.
    plays
        Its size; None where the family has none, or it was given.
    delay
        s; None if each device finds its own, or it was given.
    creep
        Number of lags; None for none.
    input_unit, output_unit
        Of the fleet.
    sentences
        How it came about.
    """

    family: str
    plays: int | None
    delay: float | None
    creep: int | None
    input_unit: str
    output_unit: str
    sentences: tuple[str, ...]


def spread_order(count: int) -> list[int]:
    """Give all places of a fleet in an order whose beginnings are spread evenly, in no period.

    Parameters
    ----------
    count
        Devices.
    """
    golden = 0.5 * (math.sqrt(5.0) - 1.0)
    spread = [int(count * (((k + 0.5) * golden) % 1.0)) for k in range(3 * count)]
    return list(dict.fromkeys((*spread, *range(count))))


def look_at(work: tuple[Measurement, Mapping[str, Any] | None]) -> Look:
    """Identify one record alone, with everything that is not given chosen by it.

    Parameters
    ----------
    work
        The device, and keyword arguments of ``hyst.identify``; None where only its units matter.
    """
    measurement, options = work
    try:
        record = measurement.load()
        if options is None:
            return Look(
                measurement.identifier,
                input_unit=record.input_unit,
                output_unit=record.output_unit,
            )
        found = identify(record, **options)
    except Exception as error:
        # It is told with the device when its turn comes.
        return Look(measurement.identifier, sentence_of(error)[0])
    chosen = [each for each in found.candidates if each.chosen]
    low, high = found.delay_interval
    creep = [each for each in leaves_of(found.model) if isinstance(each, Creep)]
    return Look(
        measurement.identifier,
        family=found.family,
        plays=chosen[0].plays if chosen and chosen[0].plays else None,
        candidates=found.candidates,
        delay=found.delay * record.dt,
        delay_interval=(low * record.dt, high * record.dt),
        creeps=len(creep[0].weights) if creep else 0,
        input_unit=record.input_unit,
        output_unit=record.output_unit,
    )


def choose(looks: Sequence[Look], count: int, asked: Mapping[str, Any]) -> Choice:
    """Choose for all what suits most of the records that were looked at.

    Parameters
    ----------
    looks
        At a part of the fleet.
    count
        Devices of the fleet.
    asked
        Keyword arguments of ``hyst.identify`` that the user gave, with ``family``.
    """
    useful = [each for each in looks if not each.failure]
    if not useful:
        why = looks[0].failure if looks else "there is none"
        told = (
            f"None of {len(looks)} records that were looked at can be used, so nothing is chosen "
            f"for all; the first: {why}"
        )
        return Choice("", None, None, None, "", "", (told,))
    family, plays, how = _family_and_size(useful)
    given = isinstance(asked.get("family"), Family) or not any(each.candidates for each in useful)
    sentences = [
        f"Every device gets a model of family {_named(family, plays)}, "
        + ("as asked for." if given else f"{how} {len(useful)} of {count} records.")
    ]
    delay, about_delay = _delay(useful) if "delay" not in asked else (None, "")
    creep, about_creep = _creep(useful) if "creep" not in asked else (None, "")
    sentences += [each for each in (about_delay, about_creep) if each]
    units = (_most(each.input_unit for each in useful), _most(each.output_unit for each in useful))
    return Choice(family, plays, delay, creep, *units, tuple(sentences))


def units_only(looks: Sequence[Look], sentence: str) -> Choice:
    """Give the units of a fleet for which there is nothing to choose.

    Parameters
    ----------
    looks
        At a part of the fleet.
    sentence
        Why there is nothing.
    """
    useful = [each for each in looks if not each.failure]
    units = (_most(each.input_unit for each in useful), _most(each.output_unit for each in useful))
    return Choice("", None, None, None, units[0] or "", units[1] or "", (sentence,))


def _named(family: str, plays: int | None) -> str:
    return family if plays is None else f"{family} with {plays} plays"


def _family_and_size(looks: Sequence[Look]) -> tuple[str, int | None, str]:
    """Choose the simplest candidate whose error on left-out blocks is not above the best one's."""
    compared = [each for each in looks if each.candidates]
    if 2 * len(compared) < len(looks) or not compared:
        alone = _most(each.family for each in looks)
        plays = _most(each.plays for each in looks if each.family == alone)
        return alone, plays, "the one most often found in"
    kinds = {
        (each.family, each.plays): each.parameters for look in compared for each in look.candidates
    }
    excess = {kind: np.array([_excess(kind, each) for each in compared]) for kind in kinds}
    kept = max(1, math.ceil((1.0 - LEFT_ASIDE) * len(compared)))
    pooled = {kind: float(np.sort(each)[:kept].mean()) for kind, each in excess.items()}
    best = min(pooled, key=lambda kind: pooled[kind])
    good = [kind for kind in kinds if _is_as_good(excess[kind] - excess[best], kept)]
    family, plays = min(good or [best], key=lambda kind: (kinds[kind], pooled[kind]))
    how = "the simplest that left-out blocks do not show to be worse than the best, over"
    return family, plays or None, how


def _excess(kind: tuple[str, int], look: Look) -> float:
    """Give the logarithm of the error of a candidate over the best one of a record.

    Sizes were tried in order until one gained nothing: a larger one is as good as the last.
    """
    scores = {(each.family, each.plays): each.score for each in look.candidates}
    floor = 1e-12 * max(scores.values(), default=1.0) + 1e-300
    best = min(scores.values())
    own = scores.get(kind)
    if own is None:
        smaller = [
            score for (name, plays), score in scores.items() if name == kind[0] and plays < kind[1]
        ]
        if not smaller:
            return _WORST
        own = min(smaller)
    return min(math.log((own + floor) / (best + floor)), _WORST)


def _is_as_good(more: Any, kept: int) -> bool:
    """Tell whether errors are no more above those of the best than is equal or may be chance."""
    ordered = np.sort(more)[:kept]
    error = float(ordered.std() / math.sqrt(max(kept - 1, 1)))
    return bool(ordered.mean() <= math.log1p(EQUAL) or ordered.mean() <= min(error, 2.0 * EQUAL))


def _delay(looks: Sequence[Look]) -> tuple[float | None, str]:
    middle = float(np.median([each.delay for each in looks]))
    agree = [
        each
        for each in looks
        if each.delay == middle or each.delay_interval[0] <= middle <= each.delay_interval[1]
    ]
    share = f"{len(agree)} of {len(looks)} records"
    if len(agree) < AGREE * len(looks):
        return None, f"Each device finds its own delay, for only {share} agree with {middle:.3g} s."
    return middle, f"The delay is held at {middle:.3g} s, which {share} agree with."


def _creep(looks: Sequence[Look]) -> tuple[int | None, str]:
    lags = [each.creeps for each in looks]
    if 2 * sum(each > 0 for each in lags) <= len(lags):
        seen = sum(each > 0 for each in lags)
        told = f"{seen} of {len(lags)} records show creep, so no model has any." if seen else ""
        return None, told
    count = int(np.median([each for each in lags if each]))
    return count, f"Every model creeps with {count} lags, as most of the records do."


def _most(values: Iterable[Any]) -> Any:
    """Give the most frequent of what is given; None, or empty text, where nothing is."""
    listed = list(values)
    given = [each for each in listed if each not in ("", None)]
    return max(dict.fromkeys(given), key=given.count) if given else next(iter(listed), None)
