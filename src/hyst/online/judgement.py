"""What a guard found in its last window, all of it from one moment."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any, final

from hyst.checks.numbers import as_not_negative, as_positive
from hyst.errors import InputError


@final
@dataclass(frozen=True)
class Judgement:
    """A window that has ended, and what followed from it.

    Parameters
    ----------
    seconds
        How long it was.
    estimate, good
        Root mean square errors of the estimate and of the last good model in it, output units.
    usual
        That of the estimate in the window in which it was trusted last; None if there was none.
    trusted
        Whether commands come from the estimate since then, or from the last good model.
    restarted
        Whether the estimate was given up and started anew from the last good model at its end.
    doubts
        In how many windows in a row, this one included, errors of the estimate were no noise.
    bound
        Which bound stopped the estimate from what the samples asked for; empty if none did.
    """

    seconds: float
    estimate: float
    good: float
    usual: float | None
    trusted: bool
    restarted: bool
    doubts: int
    bound: str = ""

    def __str__(self) -> str:
        window = f"in the last window of {self.seconds:.4g} s"
        doubt = ""
        if self.doubts:
            windows = "window" if self.doubts == 1 else "windows"
            doubt = (
                f", doubted for {self.doubts} {windows}, since its errors follow each other as "
                "noise does not"
            )
        if self.trusted:
            return (
                f"commands come from the estimate{doubt}; {window} it missed the output by "
                f"{self.estimate:.3g} rms, the last good model by {self.good:.3g}"
            )
        doubt += "," if doubt else ""
        head = (
            f"commands come from the last good model, which missed the output by {self.good:.3g} "
            f"rms {window}"
        )
        if not self.restarted:
            return f"{head}; the estimate{doubt} missed it by {self.estimate:.3g}, not yet trusted"
        usual = "" if self.usual is None else f", {self.usual:.3g} when it was trusted last"
        if self.bound:
            usual += f", and ran to its bound ({self.bound})"
        return (
            f"{head}; the estimate{doubt} missed it by {self.estimate:.3g}{usual}, so it has just "
            "been restarted and nothing of it is judged yet"
        )

    def to_dict(self) -> dict[str, Any]:
        """Give plain numbers that ``from_dict`` understands."""
        return asdict(self)

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Judgement:
        """Rebuild it.

        Raises
        ------
        InputError
            If a number is out of range, or it says what no guard finds.
        """
        usual = data["usual"]
        found = cls(
            seconds=as_positive(data["seconds"], "seconds", "the length of a window"),
            estimate=as_not_negative(data["estimate"], "estimate"),
            good=as_not_negative(data["good"], "good"),
            usual=None if usual is None else as_not_negative(usual, "usual"),
            trusted=data["trusted"],
            restarted=data["restarted"],
            doubts=int(data["doubts"]),
            bound=str(data.get("bound", "")),
        )
        is_plain = isinstance(found.trusted, bool) and isinstance(found.restarted, bool)
        if not is_plain or (found.trusted and found.restarted) or found.doubts < 0:
            raise InputError("the saved judgement contradicts itself; save the inverse again")
        return found


def judged(
    seconds: float,
    squares: tuple[float, float],
    usual: float,
    outcome: tuple[bool, bool],
    doubts: int,
    bound: str,
) -> Judgement:
    """Make a judgement of mean squares.

    Parameters
    ----------
    seconds
        Length of the window.
    squares
        Mean square errors of the estimate and of the last good model.
    usual
        Mean square when the estimate was trusted last; infinite if it never was.
    outcome
        Whether it is trusted, and whether it was restarted.
    doubts
        Windows in a row without noise.
    bound
        That the estimate is on; empty if none.

    Returns
    -------
    Judgement
    """
    return Judgement(
        seconds=seconds,
        estimate=math.sqrt(squares[0]),
        good=math.sqrt(squares[1]),
        usual=math.sqrt(usual) if math.isfinite(usual) else None,
        trusted=outcome[0],
        restarted=outcome[1],
        doubts=doubts,
        bound=bound,
    )
