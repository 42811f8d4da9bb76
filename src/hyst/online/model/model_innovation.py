"""Whether what an estimate of any family leaves unexplained can be noise."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from hyst.online.joint.innovation import Innovation

_NEGLIGIBLE = 1e-7


@final
@dataclass(frozen=True)
class ModelInnovation(Innovation):
    """Errors of the estimate along the last samples and all before, and whether they are noise.

    Parameters
    ----------
    regimes, neighbours
        Sums over regimes of the input, and over products of neighbours, over what noise exceeds in
        one of 10,000 records: above 1 it is none.
    samples
        How many are judged.

    Examples
    --------
    >>> ModelInnovation(0.1, 0.02, 5.0, 0, 0, regimes=0.4, neighbours=0.5, samples=900).consistent
    True
    >>> str(ModelInnovation(0.1, 0.1, 5.0, 0, 0, regimes=1.4, neighbours=0.5, samples=900))
    'errors of 0.1 rms follow the input (1.4 times what noise does), so model or estimate are wrong'
    """

    regimes: float = 0.0
    neighbours: float = 0.0
    samples: int = 0

    @property
    def consistent(self) -> bool:
        """Whether there are samples enough to tell, and errors are as noise, or negligible."""
        if self.samples == 0:
            return False
        negligible = self.rms <= _NEGLIGIBLE * self.loop_height
        return negligible or max(self.regimes, self.neighbours) <= 1.0

    def __str__(self) -> str:
        if self.samples == 0:
            return "too few samples to tell whether errors are noise"
        if self.consistent:
            if max(self.regimes, self.neighbours) > 1.0:
                return f"errors of {self.rms:.4g} rms, negligible"
            return f"errors of {self.rms:.4g} rms, as noise (correlation {self.correlation:.2f})"
        how = (
            f"follow the input ({self.regimes:.2g} times what noise does)"
            if self.regimes >= self.neighbours
            else f"follow each other (correlation {self.correlation:.2f})"
        )
        return f"errors of {self.rms:.4g} rms {how}, so model or estimate are wrong"
