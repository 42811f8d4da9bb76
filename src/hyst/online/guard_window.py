"""Over how long a guard compares errors: as given, or periods of the motion it sees."""

from __future__ import annotations

import math
from typing import Any, final

from hyst.checks.numbers import as_positive
from hyst.online.period_watch import PeriodWatch

# Fewer samples than that tell too little about a mean square.
_LEAST_SAMPLES = 50
# A motion that has not turned twice by then is not waited for.
_MOST_SAMPLES = 10_000


@final
class GuardWindow:
    """Chooses windows of whole periods, or watches whether those that are given are long enough.

    Parameters
    ----------
    seconds
        As given; None to choose.
    dt
        Sample time, seconds.

    Raises
    ------
    InputError
        If the window is not a number above 0.
    """

    def __init__(self, seconds: float | None, dt: float) -> None:
        self.given = None if seconds is None else as_positive(seconds, "window", "seconds")
        self.watch = PeriodWatch()
        self._dt = dt

    @property
    def samples(self) -> float:
        """How many samples the present window has; infinite while that is not known."""
        if self.given is not None:
            return self.given / self._dt
        if self.watch.longest is not None:
            return float(self._periods * self.watch.longest)
        return float(_MOST_SAMPLES) if self.watch.samples >= _MOST_SAMPLES else math.inf

    @property
    def seconds(self) -> float | None:
        """The same in seconds; None while that is not known."""
        if self.given is not None:
            return self.given
        return self.samples * self._dt if math.isfinite(self.samples) else None

    def __str__(self) -> str:
        period = None if self.watch.longest is None else self.watch.longest * self._dt
        if self.given is not None:
            if period is None or period <= self.given * (1.0 + 1e-9):
                return f"windows of {self.given:.4g} s, as given"
            return (
                f"windows of {self.given:.4g} s, as given, are shorter than a period of the "
                f"motion, {period:.4g} s, so that parts of it are compared; leave the window out"
            )
        if period is not None:
            many = "a period" if self._periods == 1 else f"{self._periods} periods"
            return f"windows of {self.seconds:.4g} s, {many} of the motion"
        if self.seconds is not None:
            return f"windows of {self.seconds:.4g} s, since the motion has not turned twice"
        return "the window waits for a period of the motion"

    def saved(self) -> dict[str, Any]:
        """Give plain numbers from which ``restored`` goes on."""
        return self.watch.numbers()

    def restored(self, numbers: dict[str, Any]) -> None:
        """Go on from what ``saved`` gave."""
        self.watch = PeriodWatch.from_numbers(numbers)

    @property
    def _periods(self) -> int:
        longest = self.watch.longest
        return 1 if longest is None else max(1, math.ceil(_LEAST_SAMPLES / longest))
