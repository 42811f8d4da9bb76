"""The loop around a hysteresis as a system of python-control whose parts can be changed."""

from __future__ import annotations

from typing import Any, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_sample_time
from hyst.control.linear_system import LinearSystem, _python_control
from hyst.control.python_control.nonlinear_system import system_of, to_nlsys
from hyst.control.python_control.sampled_block import SampledBlock
from hyst.control.sampled.plant import sampled_plant
from hyst.control.tracking_controller import TrackingController
from hyst.errors import InputError
from hyst.operators import Affine, Operator

Array = NDArray[np.float64]
Place: TypeAlias = Literal["hysteresis", "plant"]


def closed_loop_system(
    block: Any,
    *,
    plant: Any,
    hysteresis: Any = None,
    disturbance_at: Place = "hysteresis",
    delay: float = 0.0,
    dt: float | None = None,
    name: str = "loop",
) -> Any:
    """Give the loop of ``simulate_closed_loop`` as a ``control.InterconnectedSystem``.

    Its parts are named controller, hysteresis and plant, its inputs r, noise and disturbance, its
    outputs y, eta and those of the block: u, v, d_hat. Each part may be a system of the user's own
    instead, so that anything python-control can express is put into the loop.

    At every sample the block acts on y as it is before its new drive does, so nothing has to be
    solved for. A plant that answers at once would close an algebraic loop; a linear one therefore
    shows w of the sample before, as in ``simulate_closed_loop``, and one more state holds it. One
    of the user's own has to be strictly proper, or python-control says "algebraic loop detected".

    Parameters
    ----------
    block
        A TrackingController, or a sampled system with two inputs, y_ref and y, whose first output
        is u; others are outputs of the loop too.
    plant
        As ``sampled_plant`` takes it: linear, sampled or continuous; a continuous one is sampled
        with its input held between samples (zero-order hold), which is exact here, where the drive
        is held. Or a sampled ``control.NonlinearIOSystem`` from w to y.
    hysteresis
        Operator from u to w, or such a system; the identity if left out.
    disturbance_at
        ``"hysteresis"``: added to u; ``"plant"``: added to w.
    delay
        s, >= 0, from reading y to the drive that follows from it, as ``sampled_plant`` takes it.
    dt
        Sample time, s; that of the block if left out.
    name
        Of the loop.

    Returns
    -------
    control.InterconnectedSystem
        With the numbers of ``simulate_closed_loop``: the same bits while all parts are hyst's.

    Raises
    ------
    InputError
        If a part cannot be used, is continuous or has another sample time, no sample time is
        known, or ``disturbance_at`` is none of those above.
    MissingExtraError
        If python-control is not installed.

    Examples
    --------
    >>> import control, hyst
    >>> from hyst.control import TrackingController
    >>> block = TrackingController.from_continuous(([10.0], [1.0, 0.0]), dt=0.01)
    >>> loop = closed_loop_system(block, plant=([50.0], [1.0, 50.0]), hysteresis=hyst.Play(0.1))
    >>> t = 0.01 * np.arange(400)
    >>> answer = control.input_output_response(loop, t, [np.ones(400), 0.0, 0.0])
    >>> round(float(answer.outputs[0, -1]), 6)
    1.0
    """
    control = _python_control()
    if disturbance_at not in get_args(Place):
        places = ", ".join(get_args(Place))
        raise InputError(f"disturbance_at is {disturbance_at!r}; give one of {places}")
    first = _controller(block)
    time = _time_of(first, dt)
    actuator, process = _actuator(hysteresis, time), _process(plant, time, delay)
    disturbed = (1, 0) if disturbance_at == "hysteresis" else (2, 0)
    return control.interconnect(
        [first, actuator, process],
        connections=[[(0, 1), (2, 0)], [(1, 0), (0, 0)], [(2, 0), (1, 0)]],
        inplist=[(0, 0), (0, 1), disturbed],
        inputs=["r", "noise", "disturbance"],
        outlist=[(2, 0), (1, 0), *((0, i) for i in range(first.noutputs))],
        outputs=["y", "eta", "u", *first.output_labels[1:]],
        dt=time,
        name=name,
    )


# Inputs and at least how many outputs a system of the user's own must have, in words too.
_SIZES = {
    "the block": (2, 1, "from y_ref and y to u"),
    "the hysteresis": (1, 1, "from u to w"),
    "the plant": (1, 1, "from w to y"),
}


def _time_of(block: Any, dt: float | None) -> float:
    """Give the loop's sample time; a block without one takes that which is given."""
    own = block.dt
    if own is None or own is True:
        if dt is None:
            raise InputError("the block has no sample time; give dt in seconds")
        return as_sample_time(dt)
    if own == 0:
        raise InputError(
            "the block is continuous; sample it, as TrackingController.from_continuous does"
        )
    if dt is not None and abs(as_sample_time(dt) - own) > 1e-6 * own:
        raise InputError(f"dt is {dt:.6g} s, that of the block {own:.6g} s; leave dt out")
    return float(own)


def _controller(block: Any) -> Any:
    if isinstance(block, TrackingController):
        return to_nlsys(block, watch=True)
    return _own(block, "the block")


def _actuator(hysteresis: Any, dt: float) -> Any:
    if hysteresis is None:
        hysteresis = Affine(1.0)
    if isinstance(hysteresis, Operator):
        hysteresis.require_sample_time(dt, "the loop")
        return to_nlsys(hysteresis, None, name="hysteresis", outputs="w")
    return _own(hysteresis, "the hysteresis", dt)


def _process(plant: Any, dt: float, delay: float) -> Any:
    nonlinear = hasattr(plant, "updfcn") and not hasattr(plant, "A")
    if nonlinear and delay != 0.0:
        raise InputError(
            f"the delay of {delay:.6g} s cannot be put into a plant of your own; give it the "
            "states for it, or an operator that delays, hyst.Delay, as part of the hysteresis"
        )
    if nonlinear:
        return _own(plant, "the plant", dt)
    return system_of(_strictly_proper(sampled_plant(plant, dt, delay).system), dt)


def _own(system: Any, what: str, dt: float | None = None) -> Any:
    """Check a system of the user's own."""
    inputs, outputs, words = _SIZES[what]
    if not (hasattr(system, "ninputs") and hasattr(system, "noutputs")):
        raise InputError(
            f"{what} is {type(system).__name__}; give what hyst has for it, or a sampled system "
            f"of python-control {words}"
        )
    if system.ninputs != inputs or (system.noutputs or 0) < outputs:
        raise InputError(
            f"{what} has {system.ninputs} inputs and {system.noutputs} outputs; give a system "
            f"{words}"
        )
    if dt is not None and system.dt is not None and system.dt is not True:
        if system.dt == 0:
            raise InputError(f"{what} is continuous; make it with dt = {dt:.6g} s")
        if abs(system.dt - dt) > 1e-6 * dt:
            raise InputError(
                f"{what} has dt = {system.dt:.6g} s, the loop {dt:.6g} s; give the same for both"
            )
    return system


def _strictly_proper(plant: LinearSystem) -> SampledBlock:
    """Step a plant with the sums in the order of the engine, which BLAS does not keep."""
    n = plant.order
    columns = list(np.hstack([plant.A, plant.B]).T.copy())
    c = plant.C[0].tolist()

    def sample(state: Array, given: Array) -> tuple[Array, Array]:
        values, y = state.tolist(), 0.0
        for weight, value in zip(c, values, strict=True):
            y += weight * value
        following = np.zeros(n)
        for column, value in zip(columns, [*values, float(given[0])], strict=True):
            following += column * value
        return np.array([y]), following

    return SampledBlock("plant", plant.dt, ("w",), ("y",), np.zeros(n), sample)
