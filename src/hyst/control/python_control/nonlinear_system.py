"""Sampled blocks as ``control.nlsys``."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.numbers import as_sample_time
from hyst.control.linear_system import _python_control
from hyst.control.python_control.sampled_block import SampledBlock, sampled_block
from hyst.errors import InputError

Array = NDArray[np.float64]
Names: TypeAlias = str | Sequence[str]
Function: TypeAlias = Callable[[float, ArrayLike, ArrayLike, Any], Array]


def to_nlsys(
    block: Any,
    dt: float | None = None,
    *,
    name: str | None = None,
    inputs: Names | None = None,
    outputs: Names | None = None,
    watch: bool = False,
) -> Any:
    """Give a discrete-time ``control.NonlinearIOSystem`` with the numbers of a block of hyst.

    ``x_{k+1} = update(x_k, u_k), y_k = output(x_k, u_k)``: ``control.input_output_response`` gives
    the bits of ``run`` sample by sample. Both functions leave the block as it is, however often
    they are evaluated. The output answers to the input of the same sample.

    The state is that of the block. Where its initial state is not zero a last entry is added, 0
    before the first sample and 1 from then on, so that python-control's own start, X0 = 0, is the
    block's ``initial_state()`` too; to begin at another state give it with a 1 behind.

    Parameters
    ----------
    block
        Any operator (inverses and compositions too), input u, output y; a Scheduled model or its
        inverse, inputs u and s, output y; a TrackingController, inputs y_ref and y, output u.
    dt
        Sample time, s. That of the block if left out; True, as python-control calls a sample time
        that is not told, where the block runs at any.
    name
        Of the system, for ``control.interconnect``; the kind of the block if left out.
    inputs, outputs
        Other names of the signals.
    watch
        Have more outputs: of a TrackingController v, which belongs to the drive, and d_hat, where
        it is known; of a Scheduled model ``outside``, 1 where s is outside the schedule.

    Returns
    -------
    control.NonlinearIOSystem

    Raises
    ------
    InputError
        If the block is none of these, or dt is not above 0 or not the block's. In a simulation: if
        an input is not finite, or the block overflows; the time is named.
    MissingExtraError
        If python-control is not installed.

    Examples
    --------
    >>> import control
    >>> from hyst import Play
    >>> backlash = to_nlsys(Play(0.5), dt=0.1)
    >>> t, u = 0.1 * np.arange(3), [1.0, 2.0, 1.8]
    >>> control.input_output_response(backlash, t, u).outputs.tolist()
    [0.5, 1.5, 1.5]
    """
    read = sampled_block(block, watch)
    return system_of(read, _sample_time(read, dt), name, inputs, outputs)


def system_of(
    block: SampledBlock,
    dt: float | bool,
    name: str | None = None,
    inputs: Names | None = None,
    outputs: Names | None = None,
) -> Any:
    """Give the ``control.NonlinearIOSystem`` of one sample of a block.

    Parameters
    ----------
    block
        Its step.
    dt
        Sample time, s, or True.
    name, inputs, outputs
        As in ``to_nlsys``.
    """
    control = _python_control()
    called = block.name if name is None else name
    update, output = _functions(block, called)
    return control.nlsys(
        update,
        output,
        inputs=list(block.inputs) if inputs is None else inputs,
        outputs=list(block.outputs) if outputs is None else outputs,
        states=block.start.size + _has_flag(block),
        dt=dt,
        name=called,
    )


def _functions(block: SampledBlock, name: str) -> tuple[Function, Function]:
    flag = np.ones(int(_has_flag(block)))

    # python-control asks for the same sample up to nine times in an interconnected system.
    @functools.lru_cache(maxsize=4)
    def sample(x: bytes, u: bytes) -> tuple[Array, Array]:
        given = np.frombuffer(u)
        if given.size != len(block.inputs):
            raise InputError(f"{given.size} inputs are given; it has {', '.join(block.inputs)}")
        for label, value in zip(block.inputs, given.tolist(), strict=True):
            if not math.isfinite(value):
                raise InputError(
                    f"{label} is {value}; the loop diverges, or a signal given to it is not finite"
                )
        outputs, following = block.sample(_state(block, np.frombuffer(x)), given)
        return outputs, np.concatenate([following, flag])

    def step(t: float, x: ArrayLike, u: ArrayLike) -> tuple[Array, Array]:
        try:
            return sample(_bytes(x), _bytes(u))
        except InputError as reason:
            raise InputError(f"{name} at {t:.6g} s: {reason}") from None

    def update(t: float, x: ArrayLike, u: ArrayLike, params: Any) -> Array:
        return step(t, x, u)[1].copy()

    def output(t: float, x: ArrayLike, u: ArrayLike, params: Any) -> Array:
        return step(t, x, u)[0].copy()

    return update, output


def _bytes(values: ArrayLike) -> bytes:
    return np.asarray(values, dtype=np.float64).tobytes()


def _has_flag(block: SampledBlock) -> bool:
    return bool(block.start.any())


def _state(block: SampledBlock, x: Array) -> Array:
    if not _has_flag(block):
        return x
    state, running = x[:-1], x[-1]
    if running == 1.0:
        return state
    if running == 0.0 and (not state.any() or np.array_equal(state, block.start)):
        return block.start
    raise InputError(
        f"its last state is {running:g} and the others neither zero nor its initial state; give 1 "
        "behind a state to begin at"
    )


def _sample_time(block: SampledBlock, dt: float | None) -> float | bool:
    if dt is None or dt is True:
        return True if block.dt is None else block.dt
    if isinstance(dt, int | float) and dt == 0:
        raise InputError(
            "dt = 0 asks for continuous time, but hyst steps from sample to sample; give the "
            "sample time in seconds, and sample what is continuous around it"
        )
    time = as_sample_time(dt)
    if block.dt is not None and abs(time - block.dt) > 1e-6 * block.dt:
        raise InputError(
            f"dt is {time:.6g} s, that of {block.name} {block.dt:.6g} s; leave dt out, or make "
            "the block anew for this sample time"
        )
    return time if block.dt is None else block.dt
