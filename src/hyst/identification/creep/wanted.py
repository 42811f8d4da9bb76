"""What is to be done about creep, and whether families have a place for it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

from hyst.checks.numbers import whole_number
from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.creep.joint_fit import MOST_LAGS
from hyst.identification.families.family import Family

Wanted = int | Literal["auto"] | None

DYNAMICS = (
    "creep is identified with {}, whose dynamics may be as slow, only where no other family is "
    "compared; name it alone, or leave creep out"
)


def as_creep(creep: Any) -> Wanted:
    """Check what is to be done about creep.

    Parameters
    ----------
    creep
        ``"auto"``, a number of lags, or None.

    Raises
    ------
    InputError
        If it is something else.
    """
    if creep is None or (isinstance(creep, str) and creep == "auto"):
        return creep  # type: ignore[return-value]
    if isinstance(creep, bool | str):
        raise InputError(
            f"creep is {creep!r}; give 'auto', a number of lags from 1 to {MOST_LAGS}, or None"
        )
    return whole_number(creep, "creep", 1, MOST_LAGS, ", 'auto' or None")


def require_place(families: Sequence[Family], wanted: Wanted) -> None:
    """Refuse creep that is asked for of families with dynamics of their own alone.

    Parameters
    ----------
    families
        That were chosen.
    wanted
        As of ``identify``.

    Raises
    ------
    NotIdentifiableError
        Before anything is searched.
    """
    late = [each.name for each in families if each.answers_late]
    if isinstance(wanted, int) and len(late) == len(families):
        raise NotIdentifiableError(DYNAMICS.format(", ".join(late)))


def creeping_inside(
    families: Sequence[Family], wanted: Wanted
) -> tuple[tuple[Family, ...], Wanted]:
    """Let families creep that have dynamics of their own after it, where all chosen ones have.

    Parameters
    ----------
    families
        That were chosen.
    wanted
        As of ``identify``.

    Returns
    -------
    tuple of Family
    int, "auto" or None
        What is still to be looked for beside a fit.
    """
    if not isinstance(wanted, int):
        return tuple(families), wanted
    makers = [getattr(each, "creeping", None) for each in families]
    if not all(makers):
        return tuple(families), wanted
    return tuple(make(wanted) for make in makers if make is not None), None
