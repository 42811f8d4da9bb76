"""The block a target runs: feedback controller, disturbance observer and inverse in one."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.checks.arrays import as_constants, as_state
from hyst.checks.numbers import as_number, as_sample_time
from hyst.control.anti_windup import anti_windup
from hyst.control.block_constants import as_entries, as_matrix, refuse_overflow_at, two_records
from hyst.control.controller_parts import disturbance_observer_of, feedback_controller, joined
from hyst.control.discretization import Method, discretize
from hyst.control.drive_limits import Limits, limited_drive, stated, within
from hyst.control.feedback.feedforward import with_feedforward
from hyst.control.linear_system import LinearSystem
from hyst.control.watched_block import WatchedBlock, in_engine
from hyst.errors import InputError
from hyst.operators import Operator
from hyst.operators.verdict import refuse_if_unfit

Array = NDArray[np.float64]

_LARGEST_ORDER = 64  # HYST_LARGEST_ORDER of the core


@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class TrackingController(WatchedBlock):
    """Drive from reference and measured output, sample by sample.

    ``v_k = C x_k + D [y_ref_k, y_k]``, ``x_{k+1} = A x_k + B [y_ref_k, y_k]``,
    ``u_k = inverse(v_k)``. The estimate of the disturbance, which is already taken off in v, is
    ``d_hat_k = E x_k + F [y_ref_k, y_k]``; it is for looking at and is not exported.

    With ``limits`` or a ``rate`` the drive u_a is the nearest to u that may be, v_a the v that
    belongs to it, and ``x_{k+1}`` and ``d_hat_k`` take ``W (v_a - v)`` and ``G (v_a - v)`` more.

    It is no operator, for it has two inputs. ``from_continuous`` makes it from a design.

    Parameters
    ----------
    A
        Shape (n, n), n <= 64.
    B
        Shape (n, 2): columns of y_ref and of y.
    C
        Shape (n,).
    D
        Shape (2,): of y_ref and of y.
    dt
        Sample time, s, > 0.
    inverse
        Operator from v, the wanted output of the hysteresis, to the drive u; ``u = v`` if left out.
    E, F
        Shapes (n,) and (2,), or neither.
    x0
        Shape (n,), state before the first sample; zeros if left out.
    u0
        Drive before the first sample, from which a rate counts; 0 if left out.
    limits
        Lowest and highest drive; none if left out.
    rate
        The most the drive moves in a second; any if left out.
    hysteresis
        Operator from u to v of which ``inverse`` is the exact inverse; where left out, the inverse
        of ``inverse``. Needed with limits or a rate only.
    W, G
        Shape (n,), and a number: with limits or a rate W must be given; G belongs to E and F.
    despite_verdict
        Take also an inverse of a model whose verdict is ``unfit``.

    Raises
    ------
    InputError
        If shapes do not fit, a number is not finite, n is above 64, dt is not above 0, the inverse
        is no operator, has another dt or is of a model whose verdict is ``unfit``, limits do not
        ascend, or there is no operator of which the inverse is the exact inverse.

    Source
    ------
    S1 Fig. 2 and eq. 32.

    Examples
    --------
    >>> hold = TrackingController([[1.0]], [[1.0, -1.0]], [0.5], [2.0, -2.0], dt=1e-3)
    >>> hold.run([1.0, 1.0], [0.0, 0.5])[0].tolist()
    [2.0, 1.5]
    """

    A: Array
    B: Array
    C: Array
    D: Array
    dt: float
    inverse: Operator | None
    E: Array | None
    F: Array | None
    x0: Array
    u0: float
    limits: Limits | None
    rate: float | None
    hysteresis: Operator | None
    W: Array | None
    G: float
    forward: Operator | None

    def __init__(
        self,
        A: ArrayLike,
        B: ArrayLike,
        C: ArrayLike,
        D: ArrayLike,
        dt: float,
        inverse: Operator | None = None,
        *,
        E: ArrayLike | None = None,
        F: ArrayLike | None = None,
        x0: ArrayLike | None = None,
        u0: float = 0.0,
        limits: Limits | None = None,
        rate: float | None = None,
        hysteresis: Operator | None = None,
        W: ArrayLike | None = None,
        G: float = 0.0,
        despite_verdict: bool = False,
    ) -> None:
        c = as_constants(C, "C")
        n, time = c.size, as_sample_time(dt)
        if n > _LARGEST_ORDER:
            raise InputError(f"the controller has {n} states; at most {_LARGEST_ORDER} can be run")
        if (E is None) != (F is None):
            raise InputError("E and F belong together; give both or neither")
        if inverse is not None:
            if not isinstance(inverse, Operator):
                raise InputError(f"inverse is {type(inverse).__name__}; give an operator or None")
            inverse.require_sample_time(time, "the controller")
            refuse_if_unfit(inverse.description.verdict, "no controller is made", despite_verdict)
        values: dict[str, Any] = {
            "A": as_matrix(A, (n, n), "A"),
            "B": as_matrix(B, (n, 2), "B"),
            "C": c,
            "D": as_entries(D, 2, "D"),
            "dt": time,
            "inverse": inverse,
            "E": None if E is None else as_entries(E, n, "E"),
            "F": None if F is None else as_entries(F, 2, "F"),
            "x0": as_entries(np.zeros(n) if x0 is None else x0, n, "x0"),
            "u0": as_number(u0, "u0"),
            **limited_drive(inverse, limits, rate, hysteresis, W, n, time),
            "G": as_number(G, "G"),
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)

    @classmethod
    def from_continuous(
        cls,
        controller: Any,
        dt: float,
        *,
        observer: Any = None,
        inverse: Operator | None = None,
        method: Method = "tustin",
        limits: Limits | None = None,
        rate: float | None = None,
        hysteresis: Operator | None = None,
        feedforward: Any = None,
        plant: Any = None,
        despite_verdict: bool = False,
    ) -> TrackingController:
        """Sample a design in continuous time.

        Controller and observer are sampled each by itself, and then joined:
        ``v = F(z) y_ref + C(z)(y_ref - y) - d_hat``, where the observer's feedthrough from v,
        which ``"tustin"`` gives it, is solved for.

        Parameters
        ----------
        controller
            C(s), from the tracking error to v: a system of python-control, a LinearSystem, a pair
            (num, den), matrices (A, B, C, D), a number, or what ``design_controller`` gave.
        dt
            Sample time, s, > 0.
        observer
            Disturbance observer with inputs (v, y) and output d_hat, in one of these forms, or a
            design that has it as ``observer``; none if left out.
        inverse
            Operator from v to u; ``u = v`` if left out.
        method
            How they are sampled: ``"tustin"`` or ``"zoh"``.
        limits, rate, hysteresis
            Of the drive, as the class takes them. Neither C nor the observer then winds up: W and
            G are those of ``anti_windup``.
        feedforward
            F, from the reference to v: True is the static ``1 / Pn(0)``; or a stable system, such
            as ``reference_feedforward`` gives; none if left out. It changes no pole of the loop.
        plant
            Pn, of which ``feedforward=True`` takes the static gain; left out, that of a designed
            controller or observer, or a gain of 1.
        despite_verdict
            Take also an inverse of a model whose verdict is ``unfit``.

        Returns
        -------
        TrackingController

        Raises
        ------
        InputError
            If a block cannot be read, is improper, has other inputs or outputs or another sample
            time, the observer is unstable, the inverse is of a model whose verdict is ``unfit``, or
            limits cannot be used.

        Examples
        --------
        >>> pi = TrackingController.from_continuous(([4.0, 8.0], [1.0, 0.0]), dt=1e-3)
        >>> round(pi.stepper()(1.0, 0.0), 6)
        4.004
        """
        parts = feedback_controller(controller), disturbance_observer_of(observer)
        blocks = discretize(parts[0], dt, method), discretize(parts[1], dt, method)
        steered = with_feedforward(blocks[0], feedforward, method, plant, (controller, observer))
        whole = joined(steered, blocks[1])
        is_limited = limits is not None or rate is not None
        W, G = anti_windup(_from_reference(steered), blocks[1]) if is_limited else (None, 0.0)
        return cls(
            whole.A,
            whole.B,
            whole.C[0],
            whole.D[0],
            dt,
            inverse,
            E=whole.C[1],
            F=whole.D[1],
            limits=limits,
            rate=rate,
            hysteresis=hysteresis,
            W=W,
            G=G,
            despite_verdict=despite_verdict,
        )

    @property
    def order(self) -> int:
        """Number of states of the linear part, n."""
        return int(self.C.size)

    @property
    def is_limited(self) -> bool:
        """Whether the drive has limits or a largest rate."""
        return self.limits is not None or self.rate is not None

    def initial_state(self) -> Array:
        """Give the state before the first sample, a fresh array.

        x0, then that of the inverse; with limits also that of its inverse, and the last drive,
        which is the allowed one nearest to u0.
        """
        operators = (self.inverse, self.forward)
        memory = [each.initial_state() for each in operators if each is not None]
        last = [np.array([within(self.limits, self.u0)])] if self.is_limited else []
        return np.concatenate([self.x0, *memory, *last])

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
        signals, memory = two_records(y_ref, y), self._checked_state(state)
        u = np.empty_like(signals[0])
        refuse_overflow_at(self.compiled.run(memory, *signals, u))
        return u, memory

    def stepper(self, state: ArrayLike | None = None) -> _engine.TrackingStepper:
        """Give a callable that takes one sample at a time, with the same numbers as ``run``.

        A sample in which y_ref or y is not finite repeats the last drive, at first 0, leaves the
        state as it is and raises ``fault``, which stays up until ``clear_fault()``.

        Parameters
        ----------
        state
            Shape (m,), float64; the initial state if left out. It is copied.

        Returns
        -------
        TrackingStepper
            ``step(y_ref, y) -> u``, with the live ``state``, ``fault`` and ``clear_fault()``, which
            also lowers ``limited``: whether a drive since then has been held at its limits.

        Raises
        ------
        InputError
            If ``state`` cannot be used.
        """
        return _engine.TrackingStepper(self.compiled, self._checked_state(state))

    def __repr__(self) -> str:
        return f"TrackingController(order={self.order}, dt={self.dt!r}, inverse={self.inverse!r})"

    @functools.cached_property
    def compiled(self) -> _engine.TrackingController:
        """The block in the engine."""
        chain = _engine.Chain(() if self.inverse is None else self.inverse.stages())
        block = in_engine(self.A, self.B, self.C, self.D, chain)
        if self.W is not None:
            forward = _engine.Chain(() if self.forward is None else self.forward.stages())
            block.limit(self.W.tolist(), forward, *stated(self.limits, self.rate, self.dt))
        return block

    def _checked_state(self, state: ArrayLike | None) -> Array:
        start = self.initial_state() if state is None else state
        memory: Array = as_state(start, self.compiled.state_length, None)[0]
        if self.is_limited:  # the last drive answers a first sample that is not finite
            memory[-1] = within(self.limits, float(memory[-1]))
        return memory


def _from_reference(controller: LinearSystem) -> LinearSystem:
    """Keep of a controller its way from the reference."""
    return LinearSystem(
        controller.A, controller.B[:, :1], controller.C, controller.D[:, :1], controller.dt
    )
