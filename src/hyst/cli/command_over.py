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
    driver: hyst.Driver | None = None,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64] | None]:
    """Give the command that makes the output follow a reference, the output predicted, and codes.

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
    driver
        Whose codes are given and predicted; None for none.

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
    if input_range is not None:
        beyond = (u < input_range[0]) | (u > input_range[1])
        if beyond.any():
            k = int(beyond.argmax())
            raise hyst.InputError(
                f"reference[{k}] = {y_ref[k]:.6g} needs an input of {u[k]:.6g}, outside "
                f"{input_range[0]:.6g} to {input_range[1]:.6g}; give a reference within reach, or "
                "other --limits"
            )
    predicted = model.run(u, s, memory).y
    rounding = float(abs(predicted - y_ref).max())
    unit = f" {model.description.output_unit}" if model.description.output_unit else ""
    print(
        f"exact for the model (rounding {rounding:.2g}{unit}); how far the actuator is from the "
        "model, hyst info and metrics.json tell at each value"
    )
    print(f"command from {u.min():.6g} to {u.max():.6g}")
    codes = None
    if driver is not None:
        codes = driver.codes(u, input_range)
        predicted = model.run(driver.volts(codes), s, memory).y
        print(codes_told(driver, codes, u, predicted - y_ref, model.description))
    tell_virgin(not len(history) and memory.size > 0)
    return u, predicted, codes


def codes_told(
    driver: hyst.Driver,
    codes: NDArray[np.int64],
    u: NDArray[np.float64],
    error: NDArray[np.float64],
    about: ModelDescription,
) -> str:
    """Say in a sentence what rounding a command to codes costs."""
    off = float(abs(driver.volts(codes) - u).max())
    given = hyst.compensation.CodedCommand(driver, codes, u, 0.0 * error, error, off)
    return given.told(about.input_unit, about.output_unit)


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
    driver: hyst.Driver | None = None,
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
    driver
        Whose codes are written too; None for none.
    """
    turns = () if history is None else history_of(history)
    u, predicted, codes = command_over(model, y_ref, s, turns, input_range, despite_verdict, driver)
    write_command(out, model.description, time, (y_ref, u, predicted), codes)
    show_files([out])


def write_command(
    out: Path,
    about: ModelDescription,
    time: tuple[list[str], list[Any]],
    signals: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
    codes: NDArray[np.int64] | None = None,
) -> None:
    """Write reference, command, predicted output, and codes of the command where there are some.

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
    codes
        Of a driver; the output predicted is then that of their volts.
    """
    headers, columns = time
    reference, command, predicted = signals
    named: list[tuple[str, str, NDArray[Any]]] = [
        ("reference", about.output_unit, reference),
        ("command", about.input_unit, command),
    ]
    if codes is not None:
        named.append(("code", "", codes))
    named.append(("predicted", about.output_unit, predicted))
    headers = [*headers, *(hyst.io.join_unit(name, unit) for name, unit, _ in named)]
    hyst.io.write_columns(out, headers, [*columns, *(signal for _, _, signal in named)])
