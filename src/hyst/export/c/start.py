"""What moves the memory of a block to that of an actuator with a history, and blocks so moved."""

from __future__ import annotations

from dataclasses import replace

from numpy.typing import ArrayLike

from hyst import _engine
from hyst.checks.arrays import finite_vector
from hyst.control.limited_drive.bank_limits import bank_of
from hyst.errors import InputError, NotInvertibleError
from hyst.export.c.core_stage import core_stages
from hyst.export.c.drive_range import DriveRange
from hyst.export.c.exported import Block
from hyst.export.c.following import Following, Passed
from hyst.export.c.numbers import Precision, rounded
from hyst.export.c.stage_code import StageCode
from hyst.operators import Operator
from hyst.operators.stage import Stage

_SOLVED = "$signal = hyst_pi_solved_step(&$model, $memory, $signal);"
SOLVED_HEADER = "hyst/solved.h"


def moved_bank(inverse: Operator) -> bool:
    """Tell whether the drive alone moves the memory of an ``inverse``: a bank of plays at its end.

    The bank is solved for what belongs to the drive, and what is before it has no memory.
    """
    chain = _engine.Chain(inverse.stages())
    stages = [chain.constants(i) for i in range(len(chain))]
    return bank_of(stages, inverse.initial_state()) is not None


def bank_passed(inverse: Operator, first: int, place: int) -> Passed:
    """Give how a drive passes the bank at the end of an ``inverse``.

    Parameters
    ----------
    inverse
        One that ``moved_bank`` tells of.
    first, place
        Of the inverse: its first stage among those of the code, and its memory in the block's.
    """
    stages = core_stages(inverse)
    bank = stages[-1]
    constants = (bank.numbers["p0"], *bank.tables["p"], *bank.tables["r"])
    solved = Stage("pi_solved", constants)
    return Passed((solved,), first + len(stages) - 1, place, call=_SOLVED)


def inverse_following(
    inverse: Operator,
    before: StageCode,
    place: int,
    last: int | None = None,
    first: int | None = None,
) -> tuple[StageCode, Following]:
    """Give what moves the memory of an inverse beside which no model is kept.

    Parameters
    ----------
    inverse
        Its stages are the last of ``before``, if not told otherwise.
    before
        The stages of the step.
    place
        Of the memory of the inverse in that of the block.
    last
        Place of the last drive.
    first
        Of its stages among those of ``before``.

    Returns
    -------
    StageCode
        The same, with the stages behind it that the start needs.
    Following

    Raises
    ------
    NotInvertibleError
        If the model is not known of which it is the inverse.
    InputError
        If its constants cannot be written in this precision.
    """
    if first is None:
        first = len(before.stages) - len(core_stages(inverse))
    if moved_bank(inverse):
        return before, Following.of(before, [bank_passed(inverse, first, place)], last)
    forward = inverse.inverse()
    code = StageCode((*before.stages, *core_stages(forward)), before.precision)
    start = tuple(forward.initial_state().tolist())
    passed = [
        Passed(forward.stages(), len(before.stages), None, start),
        Passed(inverse.stages(), first, place),
    ]
    return code, Following.of(code, passed, last)


def with_start(
    block: Block, code: StageCode, inverse: Operator, place: int, first: int | None = None
) -> Block:
    """Give a ``block`` with the start of the ``inverse`` in it, or with why it has none.

    Parameters
    ----------
    block
        What is exported.
    code
        The stages of its step.
    inverse, place, first
        As of ``inverse_following``.
    """
    try:
        whole, following = inverse_following(inverse, code, place, first=first)
    except (NotInvertibleError, InputError) as reason:
        return replace(block, no_start=f"the model in front of it is not known: {reason}")
    headers = tuple(sorted({*whole.headers(), *([SOLVED_HEADER] * moved_bank(inverse))}))
    return replace(block, head=whole.declarations(), headers=headers, following=following)


def after_history(
    block: Block, history: ArrayLike | None, precision: Precision, second: float | None = None
) -> Block:
    """Give a ``block`` that starts after a history.

    Parameters
    ----------
    block
        What is exported.
    history
        Drives of the actuator in time order; None for the start before any.
    precision
        Of the target.
    second
        The second signal meanwhile, as ``history_at`` is given; None where there is none.

    Raises
    ------
    InputError
        If there is none, one is not finite or beyond the limits, or the block cannot follow them;
        or if the second signal is missing, of no use or outside the schedule.
    """
    if history is None:
        return block
    drives = finite_vector(history, "history")
    following = block.following
    if following is None:
        raise InputError(f"there is no start after a history: {block.no_start}; leave it out")
    told = [_told(each, block.drive, precision) for each in drives.tolist()]
    at = _second(block, second, precision)
    memory, answer = following.after(block.start, told, precision, at)
    block = replace(block, start=memory, rest=answer, before=block.virgin, history=tuple(told))
    return replace(block, history_at=at)


def _second(block: Block, second: float | None, precision: Precision) -> float | None:
    """Give the second signal of a history as a number of the target."""
    if not block.second:
        if second is not None:
            raise InputError("this model follows no second signal; leave history_at out")
        return None
    name, (low, high) = block.second_meaning[0], block.schedule
    if second is None:
        raise InputError(
            f"the history of a model that follows {name} needs its value meanwhile; give history_at"
        )
    if not low <= second <= high:
        raise InputError(
            f"history_at is {second:.9g}, outside {low:.9g} to {high:.9g}, where the model is "
            f"known; give the {name} there was within, or tell the history on the target"
        )
    return rounded(second, precision, "history_at")


def _told(value: float, drive: DriveRange, precision: Precision) -> float:
    """Give a drive of a history as a number of the target."""
    number = rounded(value, precision, "history")
    if drive.limits is None or drive.stated is None:
        return number
    if not drive.stated[0] <= value <= drive.stated[1]:
        raise InputError(
            f"history has {value:.9g}, beyond the limits of the drive, {drive.stated[0]:.9g} to "
            f"{drive.stated[1]:.9g}; give drives that the actuator can have had, or wider limits"
        )
    return min(max(number, drive.limits[0]), drive.limits[1])
