"""What is exported: signals, memory, and the C that takes one sample."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst import _single
from hyst.control.drive_limits import stated, within
from hyst.control.repetitive.controller import RepetitiveController
from hyst.control.repetitive.saved import REPETITIVE_KIND
from hyst.control.saved_block import KIND
from hyst.control.tracking_controller import TrackingController
from hyst.errors import InputError
from hyst.export.c.core_stage import CoreStage, core_stages
from hyst.export.c.limited import OUT_OF_RANGE, LimitedStages, limits_in
from hyst.export.c.numbers import Precision
from hyst.export.c.repetitive import REFERENCE_CHANGED, RepetitiveStages
from hyst.export.c.scheduled import OFF_SCHEDULE, scheduled_code, second_values
from hyst.export.c.stage_code import StageCode
from hyst.models.schedule_run import ScheduledSystem
from hyst.models.scheduled import Scheduled
from hyst.models.scheduled_inverse import ScheduledInverse
from hyst.models.stable_inverse import StableInverse
from hyst.online import JointEstimator, ScaleEstimator
from hyst.operators import Affine, ModelDescription, Operator, Play
from hyst.operators.registry import compose
from hyst.operators.verdict import refuse_if_unfit

Array = NDArray[np.float64]

Model = (
    Operator
    | ScheduledSystem
    | TrackingController
    | RepetitiveController
    | StableInverse
    | JointEstimator
    | ScaleEstimator
)


@final
@dataclass(frozen=True)
class Block:
    """Something that gives one number for every sample.

    Parameters
    ----------
    kind
        Of the model, for people.
    inputs
        Names of the signals it takes, as C has them.
    output
        Name of the signal it gives.
    head
        C declarations of constants for the head of the file.
    body
        C statements that take the inputs and leave the output in ``signal``.
    signal
        The variable they leave it in.
    headers
        Of the core, that they need.
    start
        Memory before the first sample.
    dt
        Sample time, seconds; None if any will do.
    model
        Plain data that say all there is to know of the model.
    stages
        What the statements take a sample through.
    chain
        What a signal passes, for the choice of a test signal.
    stepper
        Makes a function that gives the same numbers in Python, in double.
    single_stepper
        The same in single, for what is no chain of stages.
    is_estimator
        Whether it takes in samples and gives commands instead of one output a sample.
    more
        What else the templates of an estimator need.
    second
        Values of a second signal for the self-test; empty where there is none.
    second_meaning
        Its name and unit.
    faults
        C that defines further bits of the fault.
    written
        Makes the body anew of the stages' C, for constants in another place; where the body is not
        one call of the stages after the other.
    limits
        Lowest and highest output, in numbers of the target; None without limits.
    source_template
        Of the source file, where it is another one than that of its header.
    forgets
        Numbers at the start of the memory that its reset makes 0; none has no reset.
    tells
        Bits of the fault, without the prefix, that no bad sample raises.
    """

    kind: str
    inputs: tuple[str, ...]
    output: str
    head: str
    body: str
    signal: str
    headers: tuple[str, ...]
    start: tuple[float, ...]
    dt: float | None
    model: dict[str, Any]
    stages: tuple[CoreStage, ...]
    chain: Operator
    stepper: Callable[[], Callable[..., float]]
    single_stepper: Callable[[], Callable[..., float]] | None = None
    is_estimator: bool = False
    more: Mapping[str, str] = field(default_factory=dict)
    second: tuple[float, ...] = ()
    second_meaning: tuple[str, str] = ("", "")
    faults: str = ""
    written: Callable[[StageCode], str] | None = None
    limits: tuple[float, float] | None = None
    source_template: str = ""
    forgets: int = 0
    tells: tuple[str, ...] = ()

    def sha256(self) -> str:
        """Give the hash of the model."""
        text = json.dumps(self.model, sort_keys=True, separators=(",", ":"), allow_nan=False)
        return hashlib.sha256(text.encode()).hexdigest()

    def identity(self, precision: Precision) -> int:
        """Give the number above 0 that marks the states of this model in a ``precision``."""
        digest = hashlib.sha256(f"hyst state 1 {precision} {self.sha256()}".encode()).digest()
        return int.from_bytes(digest[:4], "big") or 1


def stepper_of(block: Block, precision: Precision) -> Callable[..., float]:
    """Give what takes one sample at a time with the numbers of a target.

    Parameters
    ----------
    block
        What is exported.
    precision
        Of the target.

    Returns
    -------
    callable
        From the inputs to the output, guarded, from the initial state.
    """
    if precision == "double":
        return block.stepper()
    if block.single_stepper is not None:
        return block.single_stepper()
    return _single.Stepper([told(stage) for stage in block.stages], block.start)


def told(stage: CoreStage) -> tuple[Any, ...]:
    """Give a ``stage`` as the twin in single precision takes it."""
    choices = {**stage.choices, **({"inside": stage.inside} if stage.inside else {})}
    return stage.kind, stage.form, dict(stage.numbers), dict(stage.tables), choices


def block_of(model: Model, precision: Precision) -> Block:
    """Give what is exported of a model.

    Parameters
    ----------
    model
        Any operator, a scheduled model or its inverse, a tracking or a repetitive controller; a
        stable inverse is refused with the reason.
    precision
        Of the target.

    Returns
    -------
    Block

    Raises
    ------
    InputError
        If it is something else, or a constant cannot be written in that precision.
    """
    if isinstance(model, TrackingController):
        return _controller(model, precision)
    if isinstance(model, RepetitiveController):
        return _repetitive(model, precision)
    if isinstance(model, Scheduled | ScheduledInverse):
        return _scheduled(model, precision)
    if isinstance(model, StableInverse):
        raise InputError(
            f"a stable inverse looks {model.preview} samples ahead, which a target cannot; compute "
            "the command beforehand with hyst compensate --method noncausal"
        )
    if not isinstance(model, Operator):
        raise InputError(
            f"{type(model).__name__} cannot be exported; give an operator, a tracking controller, "
            "a joint estimator, or the model that an estimator has found"
        )
    code = StageCode(core_stages(model), precision)
    return Block(
        kind=model.kind,
        inputs=("u",),
        output="y",
        head=code.declarations(),
        body=code.calls(),
        signal="u",
        headers=code.headers(),
        start=tuple(model.initial_state().tolist()),
        dt=model.dt,
        model=model.to_dict(),
        stages=code.stages,
        chain=model,
        stepper=model.stepper,
    )


def described(model: Model, description: ModelDescription | None) -> ModelDescription:
    """Give the ``description`` asked for, or that of the ``model``, which can be exported."""
    if description is not None or isinstance(model, StableInverse):
        return description or ModelDescription()
    return model.description


def refuse_unfit(model: Model, description: ModelDescription | None, despite_verdict: bool) -> None:
    """Refuse to export a ``model`` that no command should come from, or one so described.

    Parameters
    ----------
    model, description
        As given to the export.
    despite_verdict
        Whether the user wants it nevertheless.

    Raises
    ------
    InputError
        If a verdict is ``unfit`` and the user does not.
    """
    for about in (getattr(model, "description", None), description):
        verdict = about.verdict if isinstance(about, ModelDescription) else None
        refuse_if_unfit(verdict, "nothing is exported", despite_verdict)


def _scheduled(model: Scheduled | ScheduledInverse, precision: Precision) -> Block:
    code = scheduled_code(model, precision)
    start = tuple(model.initial_state().tolist())

    def single_stepper() -> Callable[..., float]:
        knots = [[told(stage) for stage in each] for each in code.knots]
        return _single.MovingStepper(model.values.tolist(), knots, start)

    first = model.models[0] if isinstance(model, Scheduled) else model.scheduled.models[0].inverse()
    return Block(
        kind=model.kind,
        inputs=("u", "s"),
        output="y",
        head=code.head,
        body=code.body,
        signal="u",
        headers=code.headers,
        start=start,
        dt=model.dt,
        model=model.to_dict(),
        stages=code.knots[0],
        chain=first,
        stepper=model.stepper,
        single_stepper=single_stepper,
        second=second_values(model),
        second_meaning=(model.name, model.unit),
        faults=OFF_SCHEDULE,
    )


def _controller(model: TrackingController, precision: Precision) -> Block:
    inverse = () if model.inverse is None else core_stages(model.inverse)
    # What the test signal passes: the gain from y_ref to v, then the inverse.
    gain = Affine(abs(float(model.D[0])) or 1.0)
    passed = gain if model.inverse is None else compose((gain, model.inverse))
    if model.W is not None:
        return _limited(model, model.W, inverse, passed, precision)
    code = StageCode((_linear_part(model), *inverse), precision)
    return Block(
        kind=KIND,
        inputs=("y_ref", "y"),
        output="u",
        head=code.declarations(),
        body="hyst_real v = (y_ref - y_ref) + (y - y); /* 0, or NaN if one is not finite */\n"
        + code.calls("v"),
        signal="v",
        headers=code.headers(),
        start=tuple(model.initial_state().tolist()),
        dt=model.dt,
        model=model.to_dict(),
        stages=code.stages,
        chain=passed,
        stepper=model.stepper,
    )


def _limited(
    model: TrackingController,
    W: Array,
    inverse: tuple[CoreStage, ...],
    passed: Operator,
    precision: Precision,
) -> Block:
    forward = () if model.forward is None else core_stages(model.forward)
    numbers = limits_in(precision, *stated(model.limits, model.rate, model.dt))
    stages = LimitedStages(_linear_part(model), inverse, forward, numbers, tuple(W.tolist()))
    code = StageCode(stages.all, precision)
    low, high, _ = numbers
    last = within((low, high), model.u0)
    reach = [abs(each) for each in model.limits or () if each != 0.0]
    return Block(
        kind=KIND,
        inputs=("y_ref", "y"),
        output="u",
        head=code.declarations(),
        body=stages.body(code),
        signal="v",
        headers=code.headers(),
        start=(*model.initial_state()[:-1].tolist(), last),
        dt=model.dt,
        model=model.to_dict(),
        stages=code.stages,
        # Far enough to meet the limits, too.
        chain=compose((passed, Play(max(reach)))) if reach else passed,
        stepper=model.stepper,
        faults=OUT_OF_RANGE,
        written=stages.body,
        limits=(low, high),
        tells=("OUT_OF_RANGE",),
    )


def _repetitive(model: RepetitiveController, precision: Precision) -> Block:
    stages = RepetitiveStages.of(model, precision)
    code = StageCode(stages.all, precision)
    passed = Affine(1.0) if model.inverse is None else model.inverse
    start = model.initial_state()
    tells = ("OUT_OF_RANGE",) if stages.limits is not None else ()
    if stages.limits is not None:
        start[-1] = within(stages.limits[:2], model.u0)
        reach = [abs(each) for each in model.limits or () if each != 0.0]
        # Far enough to meet the limits, too.
        passed = compose((passed, Play(max(reach)))) if reach else passed
    return Block(
        kind=REPETITIVE_KIND,
        inputs=("y_ref", "y"),
        output="u",
        head=code.declarations(),
        body=stages.body(code),
        signal="v",
        headers=code.headers(),
        start=tuple(start.tolist()),
        dt=model.dt,
        model=model.to_dict(),
        stages=code.stages,
        chain=passed,
        stepper=model.stepper,
        faults=("" if stages.limits is None else OUT_OF_RANGE)
        + ("" if model.tolerance is None else REFERENCE_CHANGED),
        written=stages.body,
        limits=None if stages.limits is None else stages.limits[:2],
        forgets=model.compiled.memory_length,
        tells=tells if model.tolerance is None else (*tells, "REFERENCE_CHANGED"),
    )


def _linear_part(model: TrackingController) -> CoreStage:
    tables = {
        "a": tuple(model.A.T.ravel().tolist()),
        "b": tuple(model.B.T.ravel().tolist()),
        "c": tuple(model.C.tolist()),
    }
    numbers = {"d_y_ref": float(model.D[0]), "d_y": float(model.D[1])}
    return CoreStage(
        kind="tracking_controller",
        numbers=numbers,
        tables=tables,
        choices={},
        form="",
        state_length=model.order,
        offers=dict.fromkeys((*numbers, *tables), (0, "")),
        feeds_through=True,
        header="hyst/tracking_controller.h",
        # Without an inverse: its stages are called one by one, after the linear part.
        structure="hyst_tracking_controller $model = "
        "{#c, $a, $b, $c, {$d_y_ref, $d_y}, {0u, NULL}};",
        call="$signal = hyst_tracking_controller_linear(&$model, $memory, y_ref, y);",
    )
