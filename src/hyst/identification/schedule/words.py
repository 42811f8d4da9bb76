"""What is told of a model over a second signal: its verdict, and what was decided."""

from __future__ import annotations

from collections.abc import Sequence

from hyst.errors import InputError, NotInvertibleError
from hyst.identification.result.identified import Identified
from hyst.identification.schedule.identified_schedule import Checked, ScheduledConstant
from hyst.models import Scheduled
from hyst.operators import Verdict
from hyst.operators.verdict import LEVELS

BESIDE_NOISE = 1.0
"""What straight lines may add to the error, in rms of the noise, before it is told as a fault."""

LEAST_PERCENT = 0.5
"""Of the output's range: less than that is none."""


def verdict_of(
    model: Scheduled,
    results: Sequence[Identified],
    left_out: Sequence[Checked],
    held_out: Sequence[Checked],
) -> Verdict:
    """Give the worst verdict of all values, or what straight lines do to a better one.

    Parameters
    ----------
    model
        The model.
    results
        At each value.
    left_out, held_out
        At values that took no part.
    """
    worst = max(results, key=lambda each: LEVELS.index(each.verdict.level))
    at = model.values[list(results).index(worst)]
    name, level = model.name, worst.verdict.level
    sentences = list(worst.verdict.sentences)
    if level != "good":
        sentences[0] = f"At {name} = {at:.6g}: {sentences[0]}"
    bent = [each for each in held_out if _is_between(each) and _is_bent(each)]
    if level == "good" and bent:
        each = max(bent, key=lambda one: one.interpolation)
        return Verdict(
            "fair",
            (
                f"At each value the model leaves noise, but at {name} = {each.value:.6g} straight "
                f"lines from {each.between[0]:.6g} to {each.between[1]:.6g} add "
                f"{each.interpolation:.3g} rms to a noise of {each.noise:.3g}; record at a value "
                "in between.",
            ),
        )
    return Verdict(level, tuple(sentences))


def notes_of(
    model: Scheduled,
    results: Sequence[Identified],
    constants: Sequence[ScheduledConstant],
    left_out: Sequence[Checked],
    held_out: Sequence[Checked],
    gave_up: bool,
) -> tuple[str, ...]:
    """Say what was shared, how straight the lines are, and what the model cannot do.

    Parameters
    ----------
    model, results, constants, left_out, held_out
        As of ``IdentifiedSchedule``.
    gave_up
        Whether nothing could be shared.
    """
    notes = [_about_sharing(model, constants)]
    if gave_up:
        notes = [
            "radii of neighbouring plays would pass each other if what does not change were "
            "shared, so every value has constants of its own; give fewer plays"
        ]
    if not left_out and not any(_is_between(each) for each in held_out):
        notes.append(
            f"{model.values.size} values of {model.name} do not show whether constants follow "
            "straight lines in between; record at one more value between them, to fit or to judge "
            "by"
        )
    for each in left_out:
        if _is_bent(each):
            notes.append(
                f"without the value {each.value:.6g}, straight lines from {each.between[0]:.6g} to "
                f"{each.between[1]:.6g} would add {each.interpolation:.3g} rms to the error there; "
                "where constants bend, half the gap leaves about a quarter of that"
            )
    notes += [
        f"{model.name} = {each.value:.6g} is outside the schedule: constants are held at its end"
        for each in held_out
        if each.outside
    ]
    notes += _about_running(model)
    told = dict.fromkeys(sentence for each in results for sentence in each.undetermined)
    return tuple(notes) + tuple(told)


def _about_sharing(model: Scheduled, constants: Sequence[ScheduledConstant]) -> str:
    moving = [each.name for each in constants if each.moves]
    shared = [each.name for each in constants if not each.moves]
    if not moving:
        return (
            f"no constant changes with {model.name} beyond what scatter explains: one model would "
            "do for all values"
        )
    if not shared:
        return f"all {len(moving)} constants change with {model.name}"
    return (
        f"{len(moving)} of {len(constants)} constants change with {model.name} beyond what scatter "
        f"explains; the same at all values: {', '.join(shared)}"
    )


def _about_running(model: Scheduled) -> list[str]:
    try:
        _ = model.knot_stages
    except InputError as refusal:
        return [f"it cannot run while {model.name} moves: {refusal}"]
    try:
        model.inverse()
    except NotInvertibleError as refusal:
        return [f"it has no inverse that follows {model.name}: {refusal}"]
    return []


def _is_between(each: Checked) -> bool:
    return not each.outside and each.value not in each.between


def _is_bent(each: Checked) -> bool:
    share = each.rms_percent * each.interpolation / each.rms if each.rms > 0.0 else 0.0
    return each.interpolation > BESIDE_NOISE * each.noise and share > LEAST_PERCENT
