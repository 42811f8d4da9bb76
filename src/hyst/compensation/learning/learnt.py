"""What repetitions have shown of the plant: its linear part, how sure that is, and the noise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.compensation.learning.linear_fit import (
    Pair,
    doubt_of,
    fit_linear_part,
    gain_over,
)
from hyst.compensation.learning.linear_part import LinearPart
from hyst.compensation.learning.robust_step import Step, robust_step

Array = NDArray[np.float64]

_MOST_PAIRS = 6


@dataclass(frozen=True, eq=False)
class Learnt:
    """Linear part and doubt, and the pairs they are from.

    Parameters
    ----------
    linear
        The plant behind the model's inverse, as far as it is linear.
    doubt
        Frequencies, cycles a sample, and relative standard errors; nothing known: empty.
    pairs
        Told and measured, of whole repetitions and of differences between two.
    """

    linear: LinearPart = field(default_factory=LinearPart.one)
    doubt: tuple[Array, Array] = field(default_factory=lambda: (np.zeros(1), np.full(1, 1e6)))
    pairs: tuple[Pair, ...] = ()

    def taught(
        self,
        whole: Pair,
        changes: Sequence[Pair],
        noise: float,
        delays: tuple[int, ...],
        doubted: bool = False,
    ) -> Learnt:
        """Give what is known with one more repetition.

        Parameters
        ----------
        whole
            The repetition itself.
        changes
            What it has changed of others.
        noise
            Rms of what does not repeat.
        delays
            To try, samples.
        doubted
            Whether what was known may be false.
        """
        kept = tuple(each for each in (*self.pairs, *changes))[-_MOST_PAIRS:]
        used = [whole, *kept] if len(kept) < 1 else list(kept)
        score, linear = fit_linear_part(used, noise, delays)
        doubt = doubt_of(used, linear, noise)
        if self.linear.order:
            known = [Pair(self.output(each.v, False), each.y) for each in used]
            again, gain = gain_over(known, noise)
            # A mode that was seen is not forgotten for one that a larger hysteresis hides.
            if again < score or (not linear.order and not doubted):
                linear = self.linear.scaled(gain)
                own = doubt_of(used, linear, noise)
                doubt = own[0], np.minimum(own[1], np.interp(own[0], *self.doubt))
        return Learnt(linear, doubt, kept)

    def rescaled(self, gain: float) -> Learnt:
        """Give the same of a plant whose gain has changed."""
        pairs = tuple(Pair(each.v, gain * each.y) for each in self.pairs)
        return replace(self, linear=self.linear.scaled(gain), pairs=pairs)

    def without_pairs(self) -> Learnt:
        """Give the same for a motion of another length."""
        return replace(self, pairs=())

    def step(self, error: Array, noise: float, gain: float, periodic: bool) -> Step:
        """Give the change that an error asks for.

        Parameters
        ----------
        error, noise, gain, periodic
            As of ``robust_step``.
        """
        return robust_step(error, self.linear, self.doubt, noise, gain, periodic)

    def output(self, v: Array, periodic: bool) -> Array:
        """Give what the linear part makes of v, shape (N,).

        Parameters
        ----------
        v
            Shape (N,).
        periodic
            Whether it goes on at its end as at its beginning.
        """
        own = v - v[0]
        ends = np.zeros(0) if periodic else _led_back(own)
        whole = np.concatenate([own, ends])
        response = self.linear.at(np.fft.rfftfreq(whole.size))
        made = np.fft.irfft(response * np.fft.rfft(whole), whole.size)[: v.size]
        return np.asarray(made + v[0] * float(self.linear.at([0.0]).real[0]))

    def to_dict(self) -> dict[str, Any]:
        """Give plain numbers."""
        return {
            "linear": self.linear.to_dict(),
            "doubt": [each.tolist() for each in self.doubt],
            "pairs": [[each.v.tolist(), each.y.tolist()] for each in self.pairs],
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Learnt:
        """Rebuild it from ``to_dict()``.

        Parameters
        ----------
        data
            What it gave.
        """
        frequency, size = (np.array(each, dtype=np.float64) for each in data["doubt"])
        pairs = tuple(
            Pair(np.array(v, dtype=float), np.array(y, dtype=float)) for v, y in data["pairs"]
        )
        return cls(LinearPart.from_dict(data["linear"]), (frequency, size), pairs)


def _led_back(own: Array) -> Array:
    """Hold the last level, and lead it back to the first."""
    fade = 0.5 + 0.5 * np.cos(np.pi * (np.arange(own.size) + 1.0) / (own.size + 1.0))
    return np.asarray(own[-1] * fade)
