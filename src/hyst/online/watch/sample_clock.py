"""Where samples belong in time: what is missing between rows, repeated, or stamped backwards."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError

Array = NDArray[np.float64]

SLOT = np.dtype(
    [
        ("time", "f8"),
        ("u", "f8"),
        ("y", "f8"),
        ("step", "f8"),
        ("lost", "i8"),
        ("repeated", "i8"),
        ("unreadable", "?"),
        ("backwards", "?"),
        ("gap", "?"),
    ]
)
"""One sample time: when (s), what was measured (NaN: unknown), the time since the row before as it
was stamped (NaN: unknown), how many lost samples this stands for, how many repeated rows were
dropped before it, and whether its line could not be read, its stamp fell or leapt, or an unknown
time passed before it."""
Slots = np.ndarray

# More lost samples in a row are one long gap, of which nothing is known.
LONGEST_GAP = 1000
# Stamps this much of a sample late are a lost sample; what they are early or late fades.
_LATE, _FADES = 0.6, 0.9
_COARSE = 0.2
# A stamp that is later than so many samples is wrong.
_MOST_LOST = 1e9
# Where most of so many steps are another one, the rate is another one and nothing was lost.
_RECENT, _OTHER = 32, 1.05


class SampleClock:
    """Turn rows into an unbroken sequence of sample times.

    Parameters
    ----------
    dt
        Sample time, s.
    has_stamps
        Whether rows carry their time; else each row is one sample.
    resolution
        Steps in which stamps count, s, where several rows share a stamp; else 0.

    Examples
    --------
    >>> clock = SampleClock(0.1, has_stamps=True)
    >>> one, none = np.ones(4), np.zeros(4, dtype=bool)
    >>> clock.take(one, one, np.array([5.0, 5.1, 5.3, 5.4]), none)["lost"]
    array([0, 0, 1, 0, 0])
    """

    def __init__(self, dt: float, has_stamps: bool, resolution: float = 0.0) -> None:
        self._dt, self._has_stamps, self._resolution = dt, has_stamps, resolution
        self._usual = dt
        self._recent: list[float] = []  # cleared whenever it is full
        self._now = -dt
        self._stamp = math.nan
        self._late = 0.0
        self._unstamped = 0
        self._repeated = 0
        self._is_broken = False

    def break_off(self) -> None:
        """Say that an unknown time passes before the next row, as where another file begins."""
        self._is_broken, self._stamp, self._late, self._unstamped = True, math.nan, 0.0, 0

    def take(self, u: Array, y: Array, time: Array, unreadable: NDArray[np.bool_]) -> Slots:
        """Take in rows.

        Parameters
        ----------
        u, y, time
            Shape (N,), NaN where unknown.
        unreadable
            Shape (N,).

        Returns
        -------
        numpy.ndarray
            Of ``SLOT``; more than N where samples were lost, fewer where rows were repeated.
        """
        lost, kept = [], []
        columns: dict[str, list[float]] = {"time": [], "step": [], "repeated": []}
        flags: dict[str, list[bool]] = {"backwards": [], "gap": []}
        for stamp in time.tolist() if self._has_stamps else [math.nan] * u.size:
            missing, step, is_backwards = self._advance(stamp)
            if missing < 0:
                self._repeated += 1
                kept.append(False)
                continue
            lost.append(missing)
            kept.append(True)
            columns["time"].append(self._now)
            columns["step"].append(step)
            columns["repeated"].append(self._repeated)
            flags["backwards"].append(is_backwards)
            flags["gap"].append(is_backwards or self._is_broken)
            self._repeated, self._is_broken = 0, False
        slots = np.zeros(len(lost), dtype=SLOT)
        rows = np.array(kept, dtype=np.bool_)
        for name, values in (*columns.items(), *flags.items()):
            slots[name] = values
        slots["u"], slots["y"], slots["unreadable"] = u[rows], y[rows], unreadable[rows]
        return self._with_lost(slots, np.array(lost, dtype=np.int64))

    def _advance(self, stamp: float) -> tuple[int, float, bool]:
        """Go to the next row: samples lost before it (-1: it is repeated), step, backwards."""
        if math.isnan(stamp):
            self._now += self._dt
            self._unstamped += 1
            return 0, math.nan, False
        step = stamp - self._stamp
        is_jump = step < 0.0 or step > _MOST_LOST * self._dt
        if math.isnan(step) or is_jump:
            self._now += self._dt
            self._stamp, self._late, self._unstamped = stamp, 0.0, 0
            return 0, math.nan, is_jump
        if step == 0.0 and self._resolution == 0.0:
            return -1, step, False
        rows = 1 + self._unstamped
        self._note(step / rows)
        self._late += step / self._usual - rows
        coarse = self._resolution / self._usual
        missing = round(self._late) if self._late > _LATE + coarse else 0
        self._late = max(_FADES * (self._late - missing), -0.5 - coarse)
        self._now += step - self._unstamped * self._dt
        self._stamp, self._unstamped = stamp, 0
        return missing, step / rows, False

    def _note(self, step: float) -> None:
        """Look now and then whether samples come at another rate."""
        self._recent.append(step)
        if self._resolution > 0.0 or len(self._recent) < _RECENT:
            return
        middle = sorted(self._recent)[_RECENT // 2]
        near = [step for step in self._recent if abs(step - middle) < 0.5 * middle]
        self._recent.clear()
        mean = sum(near) / len(near)
        usual = self._dt if 1.0 / _OTHER < mean / self._dt < _OTHER else mean
        if usual != self._usual:
            self._late = 0.0
        self._usual = usual

    def _with_lost(self, slots: Slots, lost: NDArray[np.int64]) -> Slots:
        """Put in what was lost, a long gap as one."""
        if not lost.any():
            return slots
        is_long = lost > LONGEST_GAP
        counts = np.where(is_long, 1, lost)
        rows = np.arange(slots.size) + np.cumsum(counts)
        whole = np.zeros(slots.size + int(counts.sum()), dtype=SLOT)
        for name in ("u", "y", "step"):
            whole[name] = math.nan
        whole["lost"] = 1
        whole[rows] = slots
        whole["lost"][rows - 1] = np.where(is_long, lost, whole["lost"][rows - 1])
        whole["gap"][rows] |= is_long
        missing = np.ones(whole.size, dtype=np.bool_)
        missing[rows] = False
        # A lost sample is late by whole steps before the row that was found.
        after = np.searchsorted(rows, np.flatnonzero(missing))
        early = rows[after] - np.flatnonzero(missing)
        whole["time"][missing] = slots["time"][after] - self._dt * early
        return whole


def sample_time_of(stamps: Array) -> tuple[float, float]:
    """Find the sample time of stamps, and the steps they count in where rows share a stamp.

    Parameters
    ----------
    stamps
        Shape (N,), s; NaN where there is none.

    Returns
    -------
    dt, resolution : float
        Seconds.

    Raises
    ------
    InputError
        If fewer than two stamps rise.

    Examples
    --------
    >>> dt, resolution = sample_time_of(np.array([0.0, 0.1, 0.2, 0.4, 0.5]))
    >>> round(dt, 9), resolution
    (0.1, 0.0)
    """
    steps = np.diff(stamps[np.isfinite(stamps)])
    rising = steps[steps > 0.0]
    if not rising.size:
        raise InputError("the time column does not rise, so it tells no sample time; give --rate")
    if np.mean(steps == 0.0) > _COARSE:
        good = steps[steps >= 0.0]
        return float(good.sum() / good.size), float(rising.min())
    middle = float(np.median(rising))
    usual = rising[np.abs(rising - middle) < 0.5 * middle]
    return float(usual.mean()), 0.0
