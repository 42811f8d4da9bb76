"""A scale estimator as C: the model, its inverse and the estimate, with the state as it is now."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, final

import numpy as np

from hyst import _single
from hyst.errors import InputError, NotInvertibleError
from hyst.export.c.block import Block
from hyst.export.c.core_stage import core_stages
from hyst.export.c.following import told
from hyst.export.c.numbers import Precision, literal
from hyst.export.c.stage_code import StageCode
from hyst.export.c.templating import indented
from hyst.online import ScaleEstimator
from hyst.operators import Operator
from hyst.operators.registry import operator_from_dict

_TEMPLATE = "scale_estimator"


def scale_estimator_block(estimator: ScaleEstimator, precision: Precision) -> Block:
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
        If its model has no exact inverse, or a constant cannot be written in that precision.
    """
    model = operator_from_dict(estimator.settings["model"])
    inverse = _inverse(model)
    forward, backward = core_stages(model), core_stages(inverse)
    code = StageCode((*forward, *backward), precision)
    settings, state = estimator.saved()
    start, places = state.tolist(), estimator.core.places()
    count, memory = len(forward), len(start) - places["length"]

    def in_double() -> Callable[..., float]:
        return _Follower(ScaleEstimator.restore(settings, start))

    def in_single() -> Callable[..., float]:
        return _SingleFollower(estimator, model, inverse, start)

    return Block(
        kind="scale-estimator",
        inputs=("u", "y"),
        output="u",
        head=code.declarations() + _declaration(estimator, precision),
        body="",
        signal="",
        headers=code.headers(),
        start=tuple(start),
        dt=estimator.dt,
        model={"kind": "scale-estimator", "settings": settings, "state": start},
        stages=(),
        chain=model,
        stepper=lambda _: in_double(),
        single_stepper=lambda _: in_single(),
        is_estimator=True,
        source_template=_TEMPLATE,
        more={
            "theta": str(places["scale"]),
            "parameters": "2",
            "theta_names": "scale, offset",
            "model_memory": str(memory),
            "copied": indented(_copied(memory)),
            "forward": indented(code.calls("w", only=range(count))),
            "inverse": indented(code.calls("u", only=range(count, len(code.stages)))),
        },
    )


def _copied(memory: int) -> str:
    """C that copies the memory of the model, of which a command changes nothing."""
    if memory == 0:
        return "copy[0] = HYST_REAL(0.0);"
    return (
        "{\n    size_t i;\n"
        f"    for (i = 0; i < {memory}u; ++i) {{\n"
        "        copy[i] = state->memory[HYST_SCALE_LENGTH + i];\n    }\n}"
    )


def _inverse(model: Operator) -> Operator:
    try:
        return model.inverse()
    except NotInvertibleError as error:
        raise InputError(
            f"the estimator's model has no exact inverse, so that there is no command to export: "
            f"{error}"
        ) from None


def _declaration(estimator: ScaleEstimator, precision: Precision) -> str:
    numbers = [literal(each, precision, "scale") for each in estimator.core.constants()]
    held = [str(int(name in estimator.settings["held"])) for name in estimator.names]
    return f"static const hyst_scale scale = {{{', '.join([*numbers, *held])}}};\n"


@final
class _Follower:
    """Takes in a sample and gives the command for a reference, as the self-test does."""

    def __init__(self, estimator: ScaleEstimator) -> None:
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
        self, estimator: ScaleEstimator, model: Operator, inverse: Operator, start: list[float]
    ) -> None:
        places = estimator.core.places()
        length, count = places["length"], estimator.memory.size
        held = [name in estimator.settings["held"] for name in estimator.names]
        self._scale, self._offset = places["scale"], places["offset"]
        self._core = _single.ScaleEstimator(estimator.core.constants(), held, start[:length])
        memory = start[length:]
        self._forward = _stepper(model, memory[:count])
        self._inverse = _stepper(inverse, memory[count:])
        self._last = 0.0

    def __call__(self, u: float, y: float, y_ref: float) -> float:
        if self._took(u, y):
            self._last = u
        with np.errstate(all="ignore"):
            state: Any = self._core.state
            wanted = np.float32(y_ref) - np.float32(state[self._offset])
            command = self._inverse.peek(float(wanted / np.float32(state[self._scale])))
        return command if np.isfinite(command) else self._last

    def _took(self, u: float, y: float) -> bool:
        if not (np.isfinite(u) and np.isfinite(y)):
            return False
        w = self._forward(u)
        if self._forward.fault:
            self._forward.clear_fault()
            return False
        self._inverse(w)
        self._inverse.clear_fault()
        return self._core.step(w, y) == 0


def _stepper(operator: Operator, memory: list[float]) -> _single.Stepper:
    return _single.Stepper([told(stage) for stage in core_stages(operator)], memory)
