"""Commands over a second signal, and what is written and told of any command."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import hyst
from hyst.cli.arguments import history_of
from hyst.cli.console import show_files

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from hyst.operators import ModelDescription


def command_over(
    model: hyst.Scheduled,
    y_ref: NDArray[np.float64],
    s: NDArray[np.float64],
    history: Sequence[float],
    input_range: tuple[float, float] | None,
    despite_verdict: bool,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Give the command that makes the output follow a reference, and the output predicted.

    Parameters
    ----------
    model
        The model.
    y_ref, s
        Reference and second signal.
    history
        Inputs that the actuator passed just before.
    input_range
        That the command must keep; None for any.
    despite_verdict
        Whether an unfit model is used nevertheless.

    Raises
    ------
    InputError
        If the reference is out of reach, or the verdict is ``unfit``.
    NotInvertibleError
        As ``Scheduled.inverse``.
    """
    hyst.operators.verdict.refuse_if_unfit(
        model.description.verdict, "no command is made", despite_verdict
    )
    inverse = model.inverse()
    memory, solved = model.initial_state(), inverse.initial_state()
    if len(history):
        passed = model.run(history, float(s[0]))
        memory, solved = passed.state, inverse.run(passed.y, float(s[0])).state
    u = inverse.run(y_ref, s, solved).y
    predicted = model.run(u, s, memory).y
    if input_range is not None:
        beyond = (u < input_range[0]) | (u > input_range[1])
        if beyond.any():
            k = int(beyond.argmax())
            raise hyst.InputError(
                f"reference[{k}] = {y_ref[k]:.6g} needs an input of {u[k]:.6g}, outside "
                f"{input_range[0]:.6g} to {input_range[1]:.6g}; give a reference within reach, or "
                "other --limits"
            )
    rounding = float(abs(predicted - y_ref).max())
    unit = f" {model.description.output_unit}" if model.description.output_unit else ""
    print(
        f"exact for the model (rounding {rounding:.2g}{unit}); how far the actuator is from the "
        "model, hyst info and metrics.json tell at each value"
    )
    print(f"command from {u.min():.6g} to {u.max():.6g}")
    tell_virgin(not len(history) and memory.size > 0)
    return u, predicted


def tell_virgin(is_virgin: bool) -> None:
    """Say that no history was given to a model with memory, where that is so."""
    if is_virgin:
        print(
            "memory taken as virgin, as of an actuator never driven; if it was driven, give the "
            "turns of the drive just before with --history"
        )


def compensate_over(
    model: hyst.Scheduled,
    y_ref: NDArray[np.float64],
    s: NDArray[np.float64],
    history: str | None,
    input_range: tuple[float, float] | None,
    despite_verdict: bool,
    out: Path,
    time: tuple[list[str], list[Any]],
) -> None:
    """Write the command for a reference while the second signal moves.

    Parameters
    ----------
    model, y_ref, s, input_range, despite_verdict
        As of ``command_over``.
    history
        As typed.
    out
        The file to write.
    time
        Headers and columns that come first.
    """
    turns = () if history is None else history_of(history)
    done = command_over(model, y_ref, s, turns, input_range, despite_verdict)
    write_command(out, model.description, time, (y_ref, *done))
    show_files([out])


def write_command(
    out: Path,
    about: ModelDescription,
    time: tuple[list[str], list[Any]],
    signals: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
) -> None:
    """Write reference, command and predicted output.

    Parameters
    ----------
    out
        The file to write.
    about
        Of the model, for units.
    time
        Headers and columns that come first.
    signals
        The three.
    """
    headers, columns = time
    named = (
        ("reference", about.output_unit),
        ("command", about.input_unit),
        ("predicted", about.output_unit),
    )
    headers = [*headers, *(hyst.io.join_unit(*each) for each in named)]
    hyst.io.write_columns(out, headers, [*columns, *signals])
