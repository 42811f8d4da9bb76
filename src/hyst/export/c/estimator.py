"""A joint estimator as C: its constants, its state as it is now, and the gains around the plays."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import final

import numpy as np

from hyst import _single
from hyst.export.c.block import Block
from hyst.export.c.numbers import Precision, literal, refuse_vanishing, table
from hyst.online import JointEstimator
from hyst.online.joint.parts import take_apart
from hyst.operators import Affine
from hyst.operators.registry import operator_from_dict

Constants = dict[str, list[float]]


def estimator_block(estimator: JointEstimator, precision: Precision) -> Block:
    """Give what is exported of an estimator.

    Parameters
    ----------
    estimator
        It goes on from the estimate and the memory it has.
    precision
        Of the target.

    Returns
    -------
    Block

    Raises
    ------
    InputError
        If a constant cannot be written in that precision.
    """
    parts = take_apart(operator_from_dict(estimator.settings["model"]))
    constants = estimator.core.constants()
    places = estimator.core.places()
    settings, state = estimator.saved()
    del settings["folded"]  # samples; the core does not need them
    start = state.tolist()

    def in_double() -> Callable[..., float]:
        return _Follower(JointEstimator.restore(settings, start))

    def in_single() -> Callable[..., float]:
        return _SingleFollower(constants, start, parts.before, parts.after)

    return Block(
        kind="joint-estimator",
        inputs=("u", "y"),
        output="u",
        head=_declarations(constants, precision),
        body="",
        signal="",
        headers=(),
        start=tuple(start),
        dt=estimator.dt,
        model={"kind": "joint-estimator", "settings": settings, "state": start},
        stages=(),
        chain=operator_from_dict(estimator.settings["model"]),
        stepper=lambda _: in_double(),
        single_stepper=lambda _: in_single(),
        is_estimator=True,
        more={
            "theta": str(places["theta"]),
            "parameters": str(places["m"]),
            "theta_names": _named(len(parts.pi.p)),
            **_gains(parts.before, parts.after, precision),
        },
    )


def _named(plays: int) -> str:
    plays_named = f"p_1 .. p_{plays}, r_1 .. r_{plays}, " if plays else ""
    return f"p0, {plays_named}offset, weights of the maps"


def _gains(before: Affine | None, after: Affine, precision: Precision) -> dict[str, str]:
    """Give what C writes for the input and the output of the plays."""
    over = ""
    if after.gain != 1.0:
        over = f" / ({literal(after.gain, precision, 'gain')})"
    plays_input, command = "u", "v"
    if before is not None:
        gain = f"({literal(before.gain, precision, 'gain')})"
        offset = f"({literal(before.offset, precision, 'offset')})"
        plays_input, command = f"{gain} * u + {offset}", f"(v - {offset}) / {gain}"
    return {
        "plays_input": plays_input,
        "plays_output": f"y{over}",
        "plays_reference": f"y_ref{over}",
        "command": command,
    }


def _declarations(constants: Constants, precision: Precision) -> str:
    def number(name: str, place: int) -> str:
        refuse_vanishing([constants[name][place]], precision, f"{name}[{place}]")
        return literal(constants[name][place], precision, f"{name}[{place}]")

    tables = {
        "front_threshold": constants["front"],
        "back_threshold": constants["back"],
        "limit": constants["limit"],
        "cell_radius": constants["cell_radius"],
        "cell_start": constants["cell_start"],
        "cell_limit": constants["cell_limit"],
    }
    lines = [
        f"static const hyst_real {name}[{len(values)}] = {table(values, precision, name)};"
        for name, values in tables.items()
        if values
    ]
    of = {name: name if values else "NULL" for name, values in tables.items()}
    bounds = ", ".join(number("bounds", i) for i in range(3))
    memory = ", ".join(number("memory", i) for i in range(5))
    maps = [
        f"    {{{len(constants[name])}u, {_positive(constants[name])}u, {of[f'{name}_threshold']}, "
        f"{number(f'{name}_slopes', 0)}, {number(f'{name}_slopes', 1)}}},"
        for name in ("front", "back")
    ]
    lines += [
        f"static const hyst_joint joint = {{\n    {int(constants['plays'][0])}u,",
        *maps,
        f"    {bounds},\n    {memory},\n    {of['limit']}}};",
        f"static const hyst_search search = {{&joint, {len(constants['cell_radius'])}u, "
        f"{of['cell_radius']}, {of['cell_start']},\n    {of['cell_limit']}, "
        f"{number('cell_noise', 0)}}};",
    ]
    return "\n".join(lines) + "\n"


def _positive(thresholds: Sequence[float]) -> int:
    return sum(each > 0.0 for each in thresholds)


@final
class _Follower:
    """Takes in a sample and gives the command for a reference, as the self-test does."""

    def __init__(self, estimator: JointEstimator) -> None:
        self._estimator = estimator
        self._last = 0.0

    def __call__(self, u: float, y: float, y_ref: float) -> float:
        if self._estimator.update(u, y):
            self._last = u
        command = self._estimator.command(y_ref)
        return command if np.isfinite(command) else self._last


@final
class _SingleFollower:
    """The same in single precision, every operation rounded."""

    def __init__(
        self, constants: Constants, start: list[float], before: Affine | None, after: Affine
    ) -> None:
        self._core = _single.Estimator(constants, start)
        self._before = None
        if before is not None:
            self._before = np.float32(before.gain), np.float32(before.offset)
        self._gain = np.float32(after.gain)
        self._last = 0.0

    def __call__(self, u: float, y: float, y_ref: float) -> float:
        with np.errstate(all="ignore"):
            plays_input = np.float32(u)
            if self._before is not None:
                plays_input = self._before[0] * plays_input + self._before[1]
            if self._core.step(float(plays_input), float(np.float32(y) / self._gain)) == 0:
                self._last = u
            command = np.float32(self._core.command(float(np.float32(y_ref) / self._gain)))
            if self._before is not None:
                command = (command - self._before[1]) / self._before[0]
        return float(command) if np.isfinite(command) else self._last
