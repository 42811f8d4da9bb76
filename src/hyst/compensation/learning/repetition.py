"""What one repetition has been."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False, repr=False)
class Repetition:
    """A motion that was made and measured.

    Parameters
    ----------
    number
        From 1 on: the first one has the model's inverse as its command.
    command
        The input that was applied, shape (N,).
    y_measured
        The output, shape (N,).
    error_rms, error_largest
        Of wanted minus measured, the noise of the sensor in it, output units.
    noise
        Rms of what does not repeat, as given or estimated up to here, output units.
    gain
        Share of the correction that was made after it.
    note
        What was seen in it and done after it, in sentences.
    """

    number: int
    command: Array
    y_measured: Array
    error_rms: float
    error_largest: float
    noise: float
    gain: float
    note: str

    def __repr__(self) -> str:
        return (
            f"Repetition({self.number}, error {self.error_rms:.4g} rms, "
            f"{self.error_largest:.4g} at most, noise {self.noise:.3g})"
        )

    def to_dict(self) -> dict[str, Any]:
        """Give plain numbers and text."""
        return {
            name: value.tolist() if isinstance(value, np.ndarray) else value
            for name, value in vars(self).items()
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Repetition:
        """Rebuild it from ``to_dict()``.

        Parameters
        ----------
        data
            What it gave.
        """
        own = dict(data)
        for name in ("command", "y_measured"):
            own[name] = np.array(own[name], dtype=np.float64)
        return cls(**own)
