"""The README of a C project."""

from __future__ import annotations

from hyst.export.c.block import Block
from hyst.export.c.names import plain_text
from hyst.export.c.selftest import SelfTest
from hyst.export.c.templating import filled
from hyst.operators import ModelDescription


def readme(
    block: Block,
    places: dict[str, str],
    about: ModelDescription,
    test: SelfTest,
) -> str:
    """Give the README.

    Parameters
    ----------
    block
        What is exported.
    places
        What the templates have in common.
    about
        What the numbers mean.
    test
        The self-test.

    Returns
    -------
    str
    """
    length = max(len(block.start), 1)
    word = int(places["word_bytes"])
    rows = {
        "model": plain_text(block.kind),
        "precision": places["precision"],
        "state": f"{word * (length + 1) + 8} bytes, {len(block.start)} numbers of memory",
        "saved state": f"{places['saved_bytes']} bytes",
        "sample time": "any" if block.dt is None else f"{block.dt!r} s, and no other",
    }
    if places["precision"] == "single":
        rows["away from double"] = (
            f"at most {test.away_from_double:.3g} over the self-test, whose input goes "
            f"from {test.drive.low * test.drive.unit:.6g} to {test.drive.high:.6g}"
        )
    rows |= {signal: _signal(*meant) for signal, meant in signals(block, about).items()}
    rows |= verdict_row(about) | lag_row(about)
    more = {
        "rows": "\n".join(f"| {key} | {value} |" for key, value in rows.items()),
        "usage": _ESTIMATOR_USAGE if block.is_estimator else _USAGE,
        "faults": _ESTIMATOR_FAULTS
        if block.is_estimator
        else _FAULTS
        + (_SCHEDULE_FAULTS if block.second else "")
        + (_LIMIT_FAULTS if block.limits is not None else "")
        + (_REPETITIVE if block.forgets else "")
        + (_CHANGED if "REFERENCE_CHANGED" in block.tells else ""),
        "in_precision": " in single precision" if places["precision"] == "single" else "",
        "elements": ", ".join(block.inputs),
    }
    for part in ("usage", "faults"):
        for key in ("name", "NAME", "output", "elements"):
            more[part] = more[part].replace(f"@{{{key}}}", (places | more)[key])
    return filled("README.md", places | more)


def signals(block: Block, about: ModelDescription) -> dict[str, tuple[str, str]]:
    """Give name and unit of the signals of a ``block`` by what C calls them, if ``about`` tells."""
    named = (about.input_name, about.input_unit), (about.output_name, about.output_unit)
    if block.is_estimator:
        return dict(zip(block.inputs, named, strict=True))
    if len(block.inputs) == 1:
        return dict(zip((block.inputs[0], block.output), named, strict=True))
    if block.second:
        meant = (named[0], block.second_meaning, named[1])
        return dict(zip((*block.inputs, block.output), meant, strict=True))
    return {}


def verdict_row(about: ModelDescription) -> dict[str, str]:
    """Give the row of a table that says that no command should come from what ``about`` tells of.

    Parameters
    ----------
    about
        Of the model.
    """
    if about.verdict is None or not about.is_unfit:
        return {}
    return {"verdict": f"{about.verdict.level}: {plain_text(about.verdict.sentences[0])}"}


def lag_row(about: ModelDescription) -> dict[str, str]:
    """Give the row of a table that says what lag ``about`` tells of, which no code contains."""
    if about.delay == 0:
        return {}
    time = "" if about.dt is None else f" of {about.dt!r} s"
    if about.delay < 0:
        ahead = f"the recorded output was {-about.delay} sample(s){time} ahead of the input, which"
        return {"lag": f"{ahead} no actuator is: its channels were not aligned"}
    low, _ = about.delay_interval or (about.delay, about.delay)
    if low <= 0.0:
        return {}  # the records would bear none
    return {"lag": f"the recorded output lagged {about.delay} sample(s){time}; this code does not"}


def _signal(name: str, unit: str) -> str:
    return f"{plain_text(name)} in {plain_text(unit)}" if unit else plain_text(name)


_USAGE = """\
    @{output} = @{name}_step(&state, @{elements});    /* every sample */
    if (@{name}_fault(&state)) { ... }                /* since when a sample was not finite */
"""
_FAULTS = """\
A sample that is NaN or infinite, or that overflows inside, is answered with the last output; the
memory it did not reach stays as it was, and `@{name}_fault` gives `@{NAME}_NOT_FINITE` until
`@{name}_clear_fault`. A step before `@{name}_init` gives 0 and `@{NAME}_NOT_READY`.
"""
_SCHEDULE_FAULTS = """\
Constants follow the second signal by straight lines; outside the values they are known at they are
held at the nearer end, and `@{name}_fault` gives `@{NAME}_OFF_SCHEDULE` too.
"""
_LIMIT_FAULTS = """\
The drive never leaves its limits, before `@{name}_init` and after bad samples neither; where more
was asked for it is held there, and `@{name}_fault` gives `@{NAME}_OUT_OF_RANGE` too. That is no
error: the controller goes on with what was applied.
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
_ESTIMATOR_USAGE = """\
    u = @{name}_command(&state, y_ref);               /* the input for the output that is wanted */
    (void)@{name}_update(&state, u, y);               /* with the output that was measured then */
    if (@{name}_fault(&state)) { ... }                /* since when a sample was not finite */
"""
_ESTIMATOR_FAULTS = """\
A sample that is NaN or infinite, or that would overflow, changes no parameter; `@{name}_fault`
gives `@{NAME}_NOT_FINITE` or `@{NAME}_REFUSED` until `@{name}_clear_fault`. Where a command would
not be finite, it is the last input. The estimate stands in `state.memory` from `@{NAME}_THETA` on.
"""
