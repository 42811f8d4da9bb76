"""How learning stands: its states, and a sentence about them."""

from __future__ import annotations

from collections.abc import Sequence

from hyst.compensation.learning.repetition import Repetition

LEARNING, AT_THE_NOISE, SETTLED, DIVERGED = "learning", "at the noise", "settled", "diverged"


def status_of(state: str, history: Sequence[Repetition], best: int | None, held: int) -> str:
    """Say how learning stands.

    Parameters
    ----------
    state
        One of those above.
    history
        All repetitions.
    best
        Number of the best one.
    held
        Samples of the command that are held at a limit.
    """
    limits = f"; {held} samples of the command are held at a limit" if held else ""
    if not history or best is None:
        return f"nothing measured yet: the command is the model's inverse{limits}"
    last, first = history[-1], history[0]
    count = f"{len(history)} repetition{'s' if len(history) > 1 else ''}"
    told = f"{state} after {count}: error {last.error_rms:.4g} rms"
    told += f", at first {first.error_rms:.4g}, noise {last.noise:.3g}"
    if best != last.number:
        told += f", best {history[best - 1].error_rms:.4g} in repetition {best}"
    if state == DIVERGED:
        told += "; the best command is kept, look at model and plant and reset"
    return told + limits
