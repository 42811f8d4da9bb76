"""What hyst learn says and draws."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import hyst
from hyst._files import replacing
from hyst.cli.console import note, show_files, show_table
from hyst.cli.learn.reference import Reference
from hyst.operators import Verdict
from hyst.operators.verdict import Level

if TYPE_CHECKING:
    from hyst.cli.learn.replay import Replayed


_MOST_NOTES = 5  # on the console; the page has all
_FAR_WORSE = 5.0  # times the best error: what no repetition of the same misses by
_NOTHING_LEFT = ("at the noise", "settled")


def write_extras(
    done: Replayed,
    about: hyst.ModelDescription,
    wanted: Reference,
    extras: tuple[Path | None, Path | None],
    read: list[Path],
) -> None:
    """Write the page and the figure that were asked for.

    Parameters
    ----------
    done
        Where the learning stands.
    about
        Of the model, for names and units.
    wanted
        The reference.
    extras
        Page and figure; None where not wanted.
    read
        Model file, reference and measured files.

    Raises
    ------
    InputError
        If there is nothing to draw yet.
    """
    page, picture = extras
    if page is None and picture is None:
        return
    learner = done.learner
    if not learner.history:
        raise hyst.InputError(
            "--report and --figure show what was learnt, and nothing was measured yet; leave them "
            "out for the first command"
        )
    unit = wanted.unit or about.output_unit
    drawn = hyst.report.draw_learning(
        learner,
        wanted.dt,
        output=(wanted.name or about.output_name, unit),
        command=(about.input_name, about.input_unit),
    )
    if picture is not None:
        with replacing(picture) as temporary:
            temporary.write_bytes(drawn)
    if page is None:
        return
    text = hyst.report.learning_page(
        learner,
        drawn,
        unit,
        verdict=_verdict(done),
        sources=done.sources,
        notes=done.notes,
        about={"model": str(read[0]), "reference": str(read[1])},
        then=_then(done),
    )
    with replacing(page) as temporary:
        temporary.write_text(text, encoding="utf-8")


def tell_first(done: Replayed, about: hyst.ModelDescription) -> None:
    """Say what the first command is, and what the model may miss by."""
    learner = done.learner
    print(_sentence(learner.status))
    print(_contraction(learner))
    _tell_command(done, about)


def tell_learnt(done: Replayed, about: hyst.ModelDescription) -> None:
    """Say how it stands, and list the repetitions."""
    learner = done.learner
    _note_far_worse(done)
    print(_sentence(learner.status))
    show_table(hyst.report.learning_table(learner, about.output_unit, done.sources))
    print()
    for sentence in hyst.report.learning_notes(learner)[-_MOST_NOTES:]:
        print(_sentence(sentence))
    print(_contraction(learner))
    _tell_command(done, about)


def tell_files(done: Replayed, files: list[Path]) -> None:
    """Say what was written, and what to do with it."""
    folders = dict.fromkeys(each.parent for each in files)
    for folder in folders:
        show_files([each for each in files if each.parent == folder])
    print(_then(done))


def _note_far_worse(done: Replayed) -> None:
    """Say that the last repetition is not like those before, which learning may go on from."""
    *before, last = done.learner.history
    if not before:
        return
    best = min(before, key=lambda each: each.error_rms)
    if last.error_rms <= _FAR_WORSE * max(best.error_rms, last.noise):
        return
    note(
        f"repetition {last.number} ({done.sources[-1]}) missed by "
        f"{last.error_rms / best.error_rms:.3g} times as much as repetition {best.number}; if "
        "something other than the actuator has changed (the sensor, the trigger, the file), leave "
        "its file out and measure anew"
    )


def _contraction(learner: hyst.compensation.LearningCompensator) -> str:
    """Say whether learning contracts, in the words of the command line where it is not known."""
    if learner.contraction.known:
        return _sentence(learner.contraction.sentence)
    return (
        "whether learning contracts is not known before a repetition shows the slopes of the "
        "actuator behind the model's inverse, or --slopes says them."
    )


def _tell_command(done: Replayed, about: hyst.ModelDescription) -> None:
    u = done.learner.command
    unit = f" {about.input_unit}" if about.input_unit else ""
    limits = done.input_range
    kept = "no limits" if limits is None else f"limits {limits[0]:.6g} to {limits[1]:.6g}"
    print(f"command from {u.min():.6g} to {u.max():.6g}{unit} ({kept})")


def _then(done: Replayed) -> str:
    """Say what to do next, in one sentence."""
    number = len(done.learner.history) + 1
    if done.stopped:
        return (
            "next: the command written is that of the best repetition; find out what changed "
            "(the actuator, the zero of the sensor, the trigger) before another one is learnt"
        )
    if done.learner.state in _NOTHING_LEFT:
        return "next: nothing is left to learn; play the command written, and measure now and then"
    return (
        f"next: play the command, record drive and output as repetition {number}, and add its file "
        "to the same line"
    )


def _verdict(done: Replayed) -> Verdict | None:
    """Judge what was learnt; nothing is decided while it goes on."""
    levels: dict[str, Level] = {"at the noise": "good", "settled": "fair", "diverged": "unfit"}
    level = levels.get(done.learner.state)
    return None if level is None else Verdict(level, (_sentence(done.learner.status),))


def _sentence(text: str) -> str:
    return text if text.endswith(".") else f"{text}."
