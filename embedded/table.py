"""The table of docs/embedded.md: written from measurements, compared with them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from embedded.measuring import Result
from embedded.target import (
    FAST,
    FAST_DOUBLE,
    MAIN,
    SMALL,
    SOFT_DOUBLE,
    compiler_version,
)

PAGE = Path(__file__).resolve().parents[1] / "docs" / "embedded.md"
BEGIN = "<!-- table: make embedded-table -->"
END = "<!-- end of table -->"

HEADER = (
    "model",
    "M4F",
    "mean",
    "-Os",
    "M7",
    "M7 double",
    "M4F double",
    "code",
    "-Os",
    "constants",
    "state",
    "stack",
    "error",
    "bound",
)

# The constants of some models come from NumPy's linear algebra, whose last bits differ between
# machines: then a branch may go the other way, and the largest error is another sample's.
SAME_COMPILER = 0.01
OTHER_ERROR = 2.0

# Another compiler chooses other instructions; a change of the sources that costs more than this, or
# of the numbers a compiler has no say in, is none of its doing.
OTHER_COMPILER = 0.25
OTHER_COMPILER_LEAST = 16.0
EXACT = ("constants", "state")


def row_of(result: Result) -> tuple[str, ...]:
    """Give the cells of a model."""
    costs, main = result.costs, result.costs[MAIN]
    bound = "none" if result.bound is None else f"{result.bound:.1e}"
    return (
        result.name,
        str(main.worst),
        f"{main.mean:.0f}",
        str(costs[SMALL].worst),
        str(costs[FAST].worst),
        str(costs[FAST_DOUBLE].worst),
        str(costs[SOFT_DOUBLE].worst),
        str(main.sizes.code),
        str(costs[SMALL].sizes.code),
        str(main.sizes.constants),
        str(main.state),
        str(main.stack),
        f"{result.error:.1e}",
        bound,
    )


def table_of(results: Sequence[Result]) -> str:
    """Give the table with the compiler it was made by."""
    lines = [f"Measured with arm-none-eabi-gcc {compiler_version()}.", ""]
    lines += [_line(HEADER), _line(["---"] + ["---:"] * (len(HEADER) - 1))]
    lines += [_line(row_of(each)) for each in results]
    return "\n".join(lines)


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def table_in(page: str) -> str:
    """Give what stands between the markers."""
    found = re.search(f"{re.escape(BEGIN)}\n(.*?)\n?{re.escape(END)}", page, re.DOTALL)
    if found is None:
        raise ValueError(f"the page has no {BEGIN} .. {END}")
    return found[1]


def with_table(page: str, table: str) -> str:
    """Replace what stands between the markers."""
    before, rest = page.split(f"{BEGIN}\n", 1)
    return f"{before}{BEGIN}\n{table}\n{END}{rest.split(END, 1)[1]}"


def stale_rows(kept: str, made: str) -> list[str]:
    """Tell where a table no longer says what is measured.

    By the same compiler costs may differ by one in a hundred, by another one by a quarter; what
    the compiler has no say in must be the same.
    """
    (by, old), (now_by, new) = _compiler_and_rows(kept), _compiler_and_rows(made)
    same = by == now_by
    problems = [f"{name} is not in the table" for name in new.keys() - old.keys()]
    problems += [f"{name} is in the table and is no more" for name in old.keys() - new.keys()]
    for name in old.keys() & new.keys():
        for column, before, now in zip(HEADER[1:], old[name], new[name], strict=True):
            if not _agree(column, before, now, same):
                problems.append(f"{name}: {column} is {now}, the table says {before}")
    told = [] if same or not problems else [f"Another compiler. The table: {by} Here: {now_by}"]
    return [*told, *sorted(problems)]


def _compiler_and_rows(table: str) -> tuple[str, dict[str, list[str]]]:
    lines = table.strip().splitlines()
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]
    return lines[0], {row[0]: row[1:] for row in rows[2:]}


def _agree(column: str, before: str, now: str, same_compiler: bool) -> bool:
    if before == now:
        return True
    if column in ("error", "bound"):
        numbers = () if "none" in (before, now) else (float(before), float(now))
        return bool(numbers) and max(numbers) <= OTHER_ERROR * min(numbers)
    if column in EXACT:
        return False
    room = SAME_COMPILER * float(before)
    if not same_compiler:
        room = max(OTHER_COMPILER * float(before), OTHER_COMPILER_LEAST)
    return abs(float(now) - float(before)) <= room
