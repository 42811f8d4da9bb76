"""The block a target runs for a reference that repeats: memory of a period, then the inverse."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.checks.arrays import as_constants, as_state
from hyst.checks.numbers import as_not_negative, as_number, as_sample_time, whole_number
from hyst.control.block_constants import two_records
from hyst.control.drive_limits import Limits, limited_drive, stated, within
from hyst.control.repetitive.certificate import RepetitiveCertificate, certified, ordered_slopes
from hyst.control.repetitive.design import LARGEST_PERIOD, as_period, designed, taken_apart
from hyst.control.repetitive.filters import RepetitiveFilters
from hyst.control.repetitive.saved import SavedRepetitive
from hyst.errors import InputError
from hyst.operators import Operator
from hyst.operators.verdict import refuse_if_unfit

Array = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class RepetitiveController(SavedRepetitive):
    """Drive for a reference that repeats after N samples, better from period to period.

    ``v_k = y_ref,k + w_k``, ``w_k = sum_j Q_j s_{k-N+j}``, ``s_k = w_k + sum_j L_j e_{k+j}``,
    ``e = y_ref - y``, ``u_k = inverse(v_k)``.

    The first period teaches nothing, for what only a start makes must not be repeated; so in the
    first two the drive is that of the inverse alone. With limits or a rate the drive u_a is the
    nearest to u that may be; s_k then learns nothing that asks for more. A lost sample teaches
    nothing, and time goes on.

    ``design`` chooses Q and L and proves what they do. It is no operator, for it has two inputs.

    Parameters
    ----------
    period
        N, samples, whole, 2 to 2^23.
    smooth
        ``Q_0 .. Q_h``, shape (h + 1,); Q is symmetric.
    learn
        ``L_j``, j = lead - taps + 1 .. lead, shape (taps,), units of v for one of y.
    lead
        Samples that L looks ahead, 0 to taps - 1; ``h + lead < N``.
    dt
        Sample time, s, > 0.
    inverse
        Operator from v, the wanted output of the hysteresis, to the drive u; ``u = v`` if left out.
    u0
        Drive before the first sample, from which a rate counts; 0 if left out.
    limits
        Lowest and highest drive; none if left out.
    rate
        The most the drive moves in a second; any if left out.
    hysteresis
        Operator from u to v of which ``inverse`` is the exact inverse; where left out, the inverse
        of ``inverse``. With limits or a rate only.
    tolerance
        The most a reference may differ from that of a period ago, units of y; where it differs more
        the block forgets what it has learned and tells. Not compared if left out: then call
        ``reset()`` when the reference changes.
    wait
        Samples at the start, and after it has forgotten, that teach nothing; a period if left out.
    despite_verdict
        Take also an inverse of a model whose verdict is ``unfit``.

    Raises
    ------
    InputError
        If the period is not whole or shorter than the filters need, a number is not finite, or dt,
        inverse or limits are none that ``TrackingController`` takes.

    Source
    ------
    Hara et al. 1988, IEEE TAC 33 (7); Tomizuka et al. 1989, J. Dyn. Sys. Meas. Control 111.

    Examples
    --------
    >>> block = RepetitiveController(4, [1.0], [0.5], 0, dt=1e-3)
    >>> block.run([0.0, 1.0] * 6, np.zeros(12))[0].tolist()
    [0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.5, 0.0, 1.5]
    """

    period: int
    smooth: Array
    learn: Array
    lead: int
    dt: float
    inverse: Operator | None
    u0: float
    limits: Limits | None
    rate: float | None
    hysteresis: Operator | None
    tolerance: float | None
    wait: int
    forward: Operator | None

    def __init__(
        self,
        period: int,
        smooth: ArrayLike,
        learn: ArrayLike,
        lead: int,
        dt: float,
        inverse: Operator | None = None,
        *,
        u0: float = 0.0,
        limits: Limits | None = None,
        rate: float | None = None,
        hysteresis: Operator | None = None,
        tolerance: float | None = None,
        wait: int | None = None,
        despite_verdict: bool = False,
    ) -> None:
        time, samples = as_sample_time(dt), as_period(period)
        if inverse is not None:
            if not isinstance(inverse, Operator):
                raise InputError(f"inverse is {type(inverse).__name__}; give an operator or None")
            inverse.require_sample_time(time, "the controller")
            refuse_if_unfit(inverse.description.verdict, "no controller is made", despite_verdict)
        Q, L = as_constants(smooth, "smooth"), as_constants(learn, "learn")
        ahead = whole_number(lead, "lead", 0)
        _require_fitting(samples, Q, L, ahead)
        values: dict[str, Any] = {
            "period": samples,
            "smooth": Q,
            "learn": L,
            "lead": ahead,
            "dt": time,
            "inverse": inverse,
            "u0": as_number(u0, "u0"),
            **limited_drive(inverse, limits, rate, hysteresis, None, 0, time),
            "tolerance": None if tolerance is None else as_not_negative(tolerance, "tolerance"),
            "wait": samples if wait is None else whole_number(wait, "wait", 0, LARGEST_PERIOD),
        }
        values.pop("W")
        for name, value in values.items():
            object.__setattr__(self, name, value)

    @classmethod
    def design(
        cls,
        plant: Any,
        period: float,
        *,
        dt: float | None = None,
        bandwidth: float | None = None,
        uncertainty: Any = None,
        slopes: tuple[float, float] = (1.0, 1.0),
        delay: float = 0.0,
        gain: float = 1.0,
        inverse: Operator | None = None,
        **drive: Any,
    ) -> RepetitiveController:
        """Choose Q and L such that the error is proven to shrink from period to period.

        L is the FIR that inverts the linear plant by least squares where Q passes, and Q a low-pass
        with values between 0 and 1. What is proven is ``certificate``.

        Parameters
        ----------
        plant
            From the output of the hysteresis to y: as ``sampled_plant`` takes it. Or a model with
            hysteresis, whose inverse is then taken, and its linear dynamics as the plant.
        period
            N, samples; whole.
        dt
            Sample time, s; that of a sampled plant if left out.
        bandwidth
            Up to where errors are learned, rad/s. The widest band that is proven to leave 0.9 of
            the error a period or less, if left out; then an uncertainty must be given.
        uncertainty
            Weight of the multiplicative uncertainty of the plant, a number or a system.
        slopes
            Least and largest slope of hysteresis after inverse, as ``compensation.slope_range``
            gives; 1 and 1 for an exact inverse.
        delay
            s, from reading y to the drive that follows from it, and of the plant.
        gain
            Share of the error that is learned in a period, above 0 to 1: less of it averages noise.
        inverse
            Operator from v to u; of a model its own if left out.
        drive
            ``limits``, ``rate``, ``hysteresis``, ``u0``, ``tolerance``, ``wait`` and
            ``despite_verdict``, as the class takes them.

        Returns
        -------
        RepetitiveController

        Raises
        ------
        InputError
            If the plant cannot be read or does not come to rest, nothing says how well it is known,
            the period is not whole or too short, or no filters are proven.
        NotInvertibleError
            If the hysteresis of the model has no exact inverse.

        Examples
        --------
        >>> block = RepetitiveController.design(
        ...     ([4e5], [1.0, 40.0, 4e5]), period=200, dt=1e-3, uncertainty=0.1, delay=1e-3)
        >>> block.certificate(([4e5], [1.0, 40.0, 4e5]), 0.1, delay=1e-3).contraction < 0.9
        True
        """
        samples = as_period(period)
        linear, first = taken_apart(plant, inverse, dt)
        if dt is None and isinstance(plant, Operator):
            dt = plant.dt
        filters, proof = designed(linear, samples, dt, bandwidth, uncertainty, slopes, delay, gain)
        return cls(
            samples, filters.smooth, filters.learn, filters.lead, proof.plant.dt, first, **drive
        )

    @property
    def filters(self) -> RepetitiveFilters:
        """Q and L, with their values over frequency."""
        return RepetitiveFilters(self.period, self.smooth, self.learn, self.lead)

    @property
    def is_limited(self) -> bool:
        """Whether the drive has limits or a largest rate."""
        return self.limits is not None or self.rate is not None

    def certificate(
        self,
        plant: Any,
        uncertainty: Any = 0.0,
        *,
        slopes: tuple[float, float] = (1.0, 1.0),
        delay: float = 0.0,
    ) -> RepetitiveCertificate:
        """Tell what is proven of this block around a plant.

        Parameters
        ----------
        plant, uncertainty, slopes, delay
            As in ``design``.

        Raises
        ------
        InputError
            If one of them cannot be used.
        """
        linear, _ = taken_apart(plant, self.inverse, self.dt)
        return certified(self.filters, linear, self.dt, uncertainty, ordered_slopes(slopes), delay)

    def initial_state(self) -> Array:
        """Give the state before the first sample, a fresh array.

        Zeros of the memory, then that of the inverse; with limits also that of its inverse, and the
        last drive, which is the allowed one nearest to u0.
        """
        operators = (self.inverse, self.forward)
        memory = [each.initial_state() for each in operators if each is not None]
        last = [np.array([within(self.limits, self.u0)])] if self.is_limited else []
        return np.concatenate([np.zeros(self.compiled.memory_length), *memory, *last])

    def reset(self, state: ArrayLike) -> Array:
        """Give a state that has forgotten what it learned; inverse and drive stay what they are.

        Parameters
        ----------
        state
            Shape (m,), as ``run`` gives it. It is not changed.
        """
        memory = self._checked_state(state)
        memory[: self.compiled.memory_length] = 0.0
        return memory

    def run(
        self, y_ref: ArrayLike, y: ArrayLike, state: ArrayLike | None = None
    ) -> tuple[Array, Array]:
        """Give the drive for whole records of reference and output, and the state after them.

        Parameters
        ----------
        y_ref, y
            Shape (N,) each, finite, N >= 1: reference and measured output.
        state
            Shape (m,), float64; the initial state if left out. It is not changed.

        Returns
        -------
        u : numpy.ndarray
            Shape (N,).
        state : numpy.ndarray
            Shape (m,).

        Raises
        ------
        InputError
            If the records or the state cannot be used, or the drive overflows.
        """
        u, _, memory = self._ran(y_ref, y, state)
        return u, memory

    def applied(self, y_ref: ArrayLike, y: ArrayLike, state: ArrayLike | None = None) -> Array:
        """Give the v that belongs to the drive applied, for the records and the state of ``run``.

        Parameters
        ----------
        y_ref, y, state
            As in ``run``.

        Returns
        -------
        numpy.ndarray
            Shape (N,); without limits, or within them, the v that is wanted.
        """
        return self._ran(y_ref, y, state)[1]

    def stepper(self, state: ArrayLike | None = None) -> _engine.RepetitiveStepper:
        """Give a callable that takes one sample at a time, with the same numbers as ``run``.

        A sample in which y_ref or y is not finite repeats the last drive, at first 0, teaches
        nothing and raises ``fault``, which stays up until ``clear_fault()``.

        Parameters
        ----------
        state
            Shape (m,), float64; the initial state if left out. It is copied.

        Returns
        -------
        RepetitiveStepper
            ``step(y_ref, y) -> u``, with the live ``state``, ``reset()``, which forgets what is
            learned, ``fault`` and ``clear_fault()``, which also lowers ``limited``: whether a drive
            has been held at its limits, and ``changed``: whether the reference was another one.

        Raises
        ------
        InputError
            If ``state`` cannot be used.
        """
        return _engine.RepetitiveStepper(self.compiled, self._checked_state(state))

    def __repr__(self) -> str:
        return (
            f"RepetitiveController(period={self.period}, lead={self.lead}, dt={self.dt!r}, "
            f"inverse={self.inverse!r})"
        )

    @functools.cached_property
    def compiled(self) -> _engine.RepetitiveController:
        """The block in the engine."""
        chain = _engine.Chain(() if self.inverse is None else self.inverse.stages())
        filters = self.smooth.tolist(), self.learn.tolist()
        tolerance = -1.0 if self.tolerance is None else self.tolerance
        block = _engine.RepetitiveController(
            self.period, self.lead, self.wait, *filters, tolerance, chain
        )
        if self.is_limited:
            forward = _engine.Chain(() if self.forward is None else self.forward.stages())
            block.limit(forward, *stated(self.limits, self.rate, self.dt))
        return block

    def _ran(
        self, y_ref: ArrayLike, y: ArrayLike, state: ArrayLike | None
    ) -> tuple[Array, Array, Array]:
        signals, memory = two_records(y_ref, y), self._checked_state(state)
        u, v = np.empty_like(signals[0]), np.empty_like(signals[0])
        stopped = self.compiled.run(memory, *signals, u, v)
        if stopped >= 0:
            raise InputError(
                f"the drive overflows at sample {stopped}; what is learned grows from period to "
                "period, or the inputs are too large"
            )
        return u, v, memory

    def _checked_state(self, state: ArrayLike | None) -> Array:
        start = self.initial_state() if state is None else state
        memory: Array = as_state(start, self.compiled.state_length, None)[0]
        if self.is_limited:  # the last drive answers a first sample that is not finite
            memory[-1] = within(self.limits, float(memory[-1]))
        return memory


def _require_fitting(period: int, Q: Array, L: Array, lead: int) -> None:
    if Q.size == 0 or L.size == 0:
        raise InputError("smooth and learn need an entry each; give [1.0] for none")
    if lead >= L.size:
        raise InputError(
            f"lead is {lead}, and learn has {L.size} entries; begin learn with zeros so that it "
            f"has {lead + 1}"
        )
    if Q.size - 1 + lead >= period:
        raise InputError(
            f"the period is {period} samples; a filter of {Q.size - 1} samples to either side and "
            f"a lead of {lead} need at least {Q.size + lead}"
        )
