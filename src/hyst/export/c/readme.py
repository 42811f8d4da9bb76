"""The README of a C project."""

from __future__ import annotations

from hyst.export.c.block import Block
from hyst.export.c.driver_codes import words
from hyst.export.c.example import example_of
from hyst.export.c.names import plain_text
from hyst.export.c.readme_rows import (
    drive_rows,
    error_rows,
    lag_row,
    provenance_row,
    signal_rows,
    verdict_row,
)
from hyst.export.c.readme_start import start_section
from hyst.export.c.selftest import SelfTest
from hyst.export.c.short_test import short_test_cost
from hyst.export.c.templating import filled
from hyst.operators import ModelDescription


def readme(
    block: Block,
    places: dict[str, str],
    about: ModelDescription,
    test: SelfTest,
    takes_power: bool,
) -> str:
    """Give the README.

    Parameters
    ----------
    block
        What is exported.
    places
        What the templates have in common, those of the layout among them.
    about
        What the numbers mean.
    test
        The self-test.
    takes_power
        Whether the sources of the core take powers, which may be another's.

    Returns
    -------
    str
    """
    precision = places["precision"]
    example = example_of(block, places["name"], precision, about, test)
    rows = signal_rows(block, about, example.variable)
    rows |= drive_rows(block, places["name"])
    rows |= {"sample time": "any" if block.dt is None else f"{block.dt!r} s, and no other"}
    if precision == "single":
        rows["away from double"] = (
            f"at most {test.away_from_double:.3g} over the self-test, whose input goes "
            f"from {test.drive.low * test.drive.unit:.6g} to {test.drive.high:.6g}"
        )
    if block.codes is not None:
        rows["codes"] = plain_text(block.codes.row())
    rows |= error_rows(about) | verdict_row(about, all_levels=True) | lag_row(about)
    rows |= provenance_row(about) | _size_rows(block, places)
    more = {
        "rows": "\n".join(f"| {key} | {value} |" for key, value in rows.items()),
        "program": example.program,
        "start_section": start_section(block, places["name"]),
        "power_section": _power_section(places["core_prefix"]) if takes_power else "",
        "faults": _faults(block) + words(block),
        "in_precision": " in single precision" if precision == "single" else "",
        "test_bytes": short_test_cost(block, places),
    }
    for key, word in {**places, "rest": f"{block.virgin[1]:.6g}"}.items():
        more["faults"] = more["faults"].replace(f"@{{{key}}}", word)
    return filled("README.md", places | more)


def _size_rows(block: Block, places: dict[str, str]) -> dict[str, str]:
    length = max(len(block.start), 1)
    size = int(places["word_bytes"]) * (length + 1) + 8
    return {
        "model": f"{plain_text(block.kind)}, SHA-256 {block.sha256()[:16]}...",
        "precision": places["precision"],
        "state": f"{size} bytes, {len(block.start)} numbers of memory",
        "saved state": f"{places['saved_bytes']} bytes",
    }


def _power_section(prefix: str) -> str:
    """Give what is told of powers, whose function in the core starts with ``prefix``."""
    return _POWER.replace("@{prefix}", prefix).replace("@{PREFIX}", prefix.upper())


def _faults(block: Block) -> str:
    if block.is_estimator:
        return _ESTIMATOR_FAULTS + (_CLAMPED if block.drive.limits is not None else "")
    return (
        _FAULTS
        + (_SCHEDULE_FAULTS if block.second else "")
        + _LIMIT_FAULTS.get(block.drive.side if block.drive.is_limited else "", "")
        + (_REPETITIVE if block.forgets else "")
        + (_CHANGED if "REFERENCE_CHANGED" in block.tells else "")
    )


_POWER = """
## A power function of your own

The step takes powers, in plain arithmetic that gives the same bits everywhere. If your target has a
better function, compile every file with `-D@{PREFIX}POWER_HEADER='"my_power.h"'`. That header
defines, for this precision and as `static inline`, `@{prefix}power(x, e)` for x >= 0,
`@{prefix}log2(x)` for x > 0, and `@{prefix}exp2(v)`. The bits are then no longer those of Python:
both self-tests say so, and the difference that the first one prints is yours to judge.
"""
_FAULTS = """\
A sample that is NaN or infinite, or that overflows inside, is answered with the last output; the
memory it did not reach stays as it was, and `@{name}_fault` gives `@{NAME}_NOT_FINITE` until
`@{name}_clear_fault`. A step before `@{name}_init` gives @{rest} and `@{NAME}_NOT_READY`.
"""
_SCHEDULE_FAULTS = """\
Constants follow the second signal by straight lines; outside the values they are known at they are
held at the nearer end, and `@{name}_fault` gives `@{NAME}_OFF_SCHEDULE` too.
"""
_HELD = """\
was asked for it is held there, and `@{name}_fault` gives `@{NAME}_OUT_OF_RANGE` too. That is no
error: the memory goes on with what was applied.
"""
_LIMIT_FAULTS = {
    "output": f"""\
The drive never leaves its limits, before `@{{name}}_init` and after bad samples neither; where more
{_HELD}""",
    "input": f"""\
What drives the actuator is held to its limits before it enters the model; where more
{_HELD}""",
}
_CLAMPED = """\
A command never leaves the limits of the drive; update with what was applied.
"""
_REPETITIVE = """\

The step must be called at every sample, for what is learned belongs to a place in the period: a
lost sample teaches nothing, and time goes on. `@{name}_reset` forgets what was learned, for another
reference; what is known of the actuator's memory stays.
"""
_CHANGED = """\
Where the reference is another one than a period before, the block forgets by itself, and
`@{name}_fault` gives `@{NAME}_REFERENCE_CHANGED` too.
"""
_ESTIMATOR_FAULTS = """\
A sample that is NaN or infinite, or that would overflow, changes no parameter; `@{name}_fault`
gives `@{NAME}_NOT_FINITE` or `@{NAME}_REFUSED` until `@{name}_clear_fault`. Where a command would
not be finite, it is the last input. The estimate stands in `@{name}.memory`, from `@{NAME}_THETA`.
"""
