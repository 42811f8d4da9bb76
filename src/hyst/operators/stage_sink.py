"""What an operator hands its stages to: the engine's chain, or a recorder that exports them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol


class StageSink(Protocol):
    """Takes the stages of an operator in the order the signal passes them.

    ``hyst._engine.Chain`` runs them; ``hyst.export`` writes them down as C. Constants are those of
    the operators, in their units; what the core derives from them is the sink's own business.
    """

    def add_affine(self, gain: float, offset: float) -> None:
        """Add ``y = gain u + offset``."""

    def add_play(self, r: float) -> None:
        """Add a play of threshold ``r``."""

    def add_stop(self, r: float) -> None:
        """Add a stop of threshold ``r``."""

    def add_dead_zone(
        self, weights: Sequence[float], thresholds: Sequence[float], by_direction: bool
    ) -> None:
        """Add dead zones of ``weights`` and ``thresholds``, two-sided or ``by_direction``."""

    def add_pi(self, p0: float, p: Sequence[float], r: Sequence[float]) -> None:
        """Add ``p0 u`` and plays of weights ``p`` and thresholds ``r``."""

    def add_rate_dependent_pi(
        self,
        p0: float,
        p: Sequence[float],
        r: Sequence[float],
        beta: float,
        powers: Sequence[float],
        slopes: Sequence[float],
        knees: Sequence[float],
        dt: float,
    ) -> None:
        """Add plays as ``p0``, ``p``, ``r`` whose thresholds grow with the rate.

        For a rate of x units per second the growth is ``beta x``, ``powers`` times x^2, x^3, ..,
        and for every one of ``slopes`` and ``knees`` slope max(x - knee, 0); ``dt`` is the sample
        time, seconds.
        """

    def add_state_space(
        self, delay: int, a: Sequence[float], b: Sequence[float], c: Sequence[float], d: float
    ) -> None:
        """Add a state space of ``a`` (column after column), ``b``, ``c``, ``d`` and a ``delay``."""

    def add_sections(self, coefficients: Sequence[float]) -> None:
        """Add sections with five ``coefficients`` each: b0 b1 b2 a1 a2."""

    def add_masing(
        self,
        curve: str,
        constants: Sequence[float],
        least_slope: float,
        inverse: bool,
        last_reversal: bool,
        depth: int,
        dead_band: float,
    ) -> None:
        """Add a loading curve with memory of reversals.

        ``curve`` is "power-law" (``constants`` c1 c2 c3), "plays" (p0 p_1.. r_1..) or "polynomial"
        (a_1 .. a_n, nowhere less steep than ``least_slope``); ``inverse``, ``last_reversal``,
        ``depth`` and ``dead_band`` are those of core/include/hyst/masing.h.
        """

    def add_memory_element(
        self,
        function: str,
        knots: Sequence[float],
        constants: Sequence[float],
        inverse: bool,
        absolute: bool,
        is_reset: bool,
        reset_to: float,
        dt: float,
    ) -> None:
        """Add a memory element.

        ``function`` is "power-law" (``constants`` c1 c2 c3), "polynomial" (a_0 .. a_n) or "table"
        (values at ``knots``); ``inverse``, ``absolute``, ``is_reset``, ``reset_to`` and ``dt`` are
        those of core/include/hyst/memory_element.h.
        """
