"""The options of an identification: what they are, and what is refused."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.data import Data
from hyst.identification.delay import estimate_delay
from hyst.identification.families import FAMILIES, KNOWN, LINEAR, PI, RAMBERG_OSGOOD, WITHOUT_PLAYS
from hyst.identification.fitting import AUTO
from hyst.identification.selection import SIZES
from hyst.identification.separable import PowerLawOptions
from hyst.identification.weight_rules import RULES
from hyst.signals import Record

Array = NDArray[np.float64]

MOST_PLAYS = 200


@dataclass(frozen=True, eq=False)
class Options:
    """The keyword arguments of ``identify`` for families without rate and dynamics.

    Parameters
    ----------
    knots, weights
        As of ``identify``, unchecked.
    power_law
        Options of ``ramberg-osgood``.
    validation
        Records that take no part.
    say
        Told what is being done.
    plays, radii, delay, start, max_iterations, allow_unconverged
        As of ``identify``, unchecked.
    """

    knots: int
    weights: str
    power_law: PowerLawOptions
    validation: tuple[Record, ...]
    say: Callable[[str], None]
    plays: int | str = AUTO
    radii: ArrayLike | None = None
    delay: int | str = AUTO
    start: int | Literal["auto"] = "auto"
    max_iterations: int = 200
    allow_unconverged: bool = False


def as_families(family: str, radii: Array | None) -> tuple[str, ...]:
    """Give the families to compare.

    Parameters
    ----------
    family
        As of ``identify``.
    radii
        Radii to keep, or None.

    Raises
    ------
    InputError
        If one is unknown, or has no plays while radii are given.
    """
    if family == "auto":
        return FAMILIES if radii is None else FAMILIES[1:]
    families = tuple(dict.fromkeys(each.strip() for each in family.split(",")))
    for each in families:
        if each not in KNOWN:
            known = ", ".join(("auto", *FAMILIES, RAMBERG_OSGOOD))
            raise InputError(f"unknown family {each!r}; choose one of {known}")
        if each in WITHOUT_PLAYS and radii is not None:
            raise InputError(f"family {each!r} has no plays; leave out radii")
    return families


def as_sizes(plays: int | str, radii: Array | None) -> tuple[int, ...]:
    """Give the numbers of plays to compare.

    Parameters
    ----------
    plays
        As of ``identify``.
    radii
        Radii to keep, or None.

    Raises
    ------
    InputError
        If it is no number from 1 to 200, or disagrees with the radii.
    """
    if radii is not None:
        if plays not in ("auto", radii.size):
            raise InputError(f"plays is {plays} but {radii.size} radii are given; leave out plays")
        return (radii.size,)
    if plays == "auto":
        return SIZES
    return (whole_number(plays, "plays", 1, MOST_PLAYS, ", or 'auto'"),)


def whole_number(value: Any, name: str, least: int, most: int, more: str = "") -> int:
    """Check a number that counts something.

    Parameters
    ----------
    value
        A whole number from ``least`` to ``most``.
    name
        What messages call it.
    least, most
        Ends of the range.
    more
        What messages add after the range: a unit, or a word that is taken in its place.

    Raises
    ------
    InputError
        If it is something else.
    """
    is_whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    if not is_whole or not least <= value <= most:
        raise InputError(f"{name} is {value!r}; give {least} to {most}{more}")
    return int(value)


def as_radii(radii: ArrayLike) -> Array:
    """Give radii ascending and once each.

    Parameters
    ----------
    radii
        As of ``identify``.

    Raises
    ------
    InputError
        If there is none, or one is not positive and finite.
    """
    values = np.unique(np.asarray(radii, dtype=np.float64))
    if values.size == 0 or not np.isfinite(values).all() or values[0] <= 0.0:
        raise InputError("radii must be one or more positive, finite numbers")
    return values


def as_knots(knots: int) -> int:
    """Give the number of knots.

    Parameters
    ----------
    knots
        As of ``identify``.

    Raises
    ------
    InputError
        If it is no number from 1 to 50.
    """
    return whole_number(knots, "knots", 1, 50)


def as_rule(weights: str) -> str:
    """Give the rule for weights.

    Parameters
    ----------
    weights
        As of ``identify``.

    Raises
    ------
    InputError
        If it is unknown.
    """
    if weights not in (AUTO, *RULES):
        raise InputError(f"weights is {weights!r}; choose one of {', '.join((AUTO, *RULES))}")
    return weights


def as_delay(delay: int | str, data: Data) -> int:
    """Give the delay, estimated if it is to be.

    Parameters
    ----------
    delay
        As of ``identify``.
    data
        The records.

    Raises
    ------
    InputError
        If it is no number of samples a record has.
    """
    if delay == "auto":
        return estimate_delay(data)
    shortest = min(len(r) - s for r, s in zip(data.records, data.starts, strict=True))
    return whole_number(delay, "delay", 0, shortest - 1, " samples, or 'auto'")


def within_reach(radii: Array | None, data: Data) -> tuple[Array | None, tuple[str, ...]]:
    """Leave out radii the input never passes, and say so.

    Parameters
    ----------
    radii
        Shape (n,), input units, or None.
    data
        The records.

    Returns
    -------
    radii : numpy.ndarray or None
    left_out : tuple of str
        A sentence for each radius that was left out.

    Raises
    ------
    NotIdentifiableError
        If none is left.
    """
    if radii is None:
        return None, ()
    reached = radii < data.half_range
    if not reached.any():
        raise NotIdentifiableError(
            f"no radius is below {data.half_range:.6g}, half the input range; a play that never "
            "moves cannot be identified"
        )
    return radii[reached], tuple(
        f"the play of radius {r:.6g} never moves: half the input range is {data.half_range:.6g}; "
        "it was left out"
        for r in radii[~reached]
    )


def require_samples(data: Data, families: Sequence[str], sizes: Sequence[int], knots: int) -> None:
    """Refuse records with no more samples than the smallest model has parameters.

    Parameters
    ----------
    data
        The records.
    families, sizes, knots
        What is to be compared.

    Raises
    ------
    NotIdentifiableError
        If so.
    """
    samples = data.measured().size
    least = {LINEAR: 2, RAMBERG_OSGOOD: 4, PI: 2 * sizes[0] + 2}
    needed = min(least.get(family, 2 * sizes[0] + 2 + knots) for family in families)
    if samples <= needed:
        raise NotIdentifiableError(
            f"{samples} samples can be used but the model has {needed} parameters; give a longer "
            "record or fewer plays"
        )
