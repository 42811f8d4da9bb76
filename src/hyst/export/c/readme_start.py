"""What the README of an export says of the start: an actuator remembers, and the code must know."""

from __future__ import annotations

from hyst.export.c.block import Block
from hyst.export.c.example import starts_from_extremes, swept_name
from hyst.export.c.names import plain_text
from hyst.export.c.signal_names import identifier

_LONGEST_REASON = 300
_MOST_DRIVES = 6


def start_section(block: Block, name: str) -> str:
    """Give the section on the start of the actuator.

    Parameters
    ----------
    block, name
        What is exported, and its prefix.

    Returns
    -------
    str
        Empty for what has no memory of an actuator.
    """
    if block.following is None:
        if not block.no_start:
            return ""
        reason = plain_text(block.no_start, _LONGEST_REASON)
        return f"\n{_TITLE}\n\n{_WHY}\n\nThis code can be told no history: {reason}.\n"
    ends = "the highest drive it may have and then to the lowest"
    if block.drive.limits is not None:
        ends = f"`{name.upper()}_U_MAX` and then to `{name.upper()}_U_MIN`"
    second = plain_text(block.second_meaning[0]) if block.second else ""
    more = f", {identifier(block.second_meaning[0]) or block.inputs[1]}" if second else ""
    drives = f"{swept_name(block, name)}, 2u{more}" if starts_from_extremes(block) else "..."
    told = f"Call `{name}_init_after(&{name}, {drives})` with the drives at which it turned."
    if block.chain.dt is not None:
        told = (
            f"Call `{name}_init_after(&{name}, drives, count{more})` "
            "with the drive at every sample\n"
            "   of the sweep and of the rest behind it, for in this model time counts."
        )
    if block.history:
        told = (
            f"Call `{name}_init(&{name})`, which is the state after those drives; or\n"
            f"   `{name}_init_after(&{name}, drives, count{more})` with others."
        )
        ends = history_said(block)
    return f"""
{_TITLE}

{_WHY} So, at power-on:

1. Drive the actuator to {ends}, as slowly as it needs.
   What it remembered from before is then without effect, if it was never driven beyond.
2. {told}
3. Step. The first output goes on from the last of those drives.

`{name}_init_after` gives 0; or 1, and the state before any drive, if one is not finite or beyond
the limits.{_at_one_value(name, second) if second else ""}
"""


def _at_one_value(name: str, second: str) -> str:
    """Say what is taken for granted where a second signal moves the constants."""
    return f""" The constants are those at the {second} that it is told, one value for
the whole history: do not let it drift meanwhile. If it is not finite, 1 is given, too; outside the
values that the constants are known at, they are held, and `{name.upper()}_OFF_SCHEDULE` of the
fault says so."""


def history_said(block: Block) -> str:
    """Give the drives that a ``block`` was exported with."""
    first = [f"{each:.6g}" for each in block.history[:_MOST_DRIVES]]
    more = len(block.history) - len(first)
    unit = f" {plain_text(block.drive.unit)}" if block.drive.unit else ""
    said = ", ".join(first) + unit + (f" and {more} more" if more else "")
    if block.history_at is None:
        return said
    name, of = (plain_text(each) for each in block.second_meaning)
    return f"{said} at {name} {block.history_at:.6g}" + (f" {of}" if of else "")


_TITLE = "## How to start the actuator"
_WHY = """\
An actuator remembers how it was driven. As long as the code knows less than that, it is wrong by up
to the width of the loop."""
