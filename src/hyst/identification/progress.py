"""What an identification says of itself on its way, and how much of the way is behind it."""

from __future__ import annotations

from collections.abc import Callable

PLACES = {
    "diagnosis": 0.0,
    "delay": 0.05,
    "final fit": 0.7,
    "final fit: all samples": 0.8,
    "lag": 0.85,
    "creep": 0.88,
    "creep: all constants together": 0.92,
    "verdict": 0.95,
}
"""Where steps are said to lie on the way, by their words or those before a colon."""

FAMILIES, RESERVE = (0.1, 0.6), (0.6, 0.7)
"""Shares between which families are compared, and those in reserve."""


class Step(str):
    """Words for what begins, which are a string, with the share of the way that is behind.

    Attributes
    ----------
    share : float
        0 to 1, and never less than of the step before. It counts stages, families and sizes, not
        time, which nobody knows beforehand: the largest models of the last family take longest.

    Examples
    --------
    >>> step = Step("delay", 0.05)
    >>> step, step.share
    ('delay', 0.05)
    """

    __slots__ = ("share",)

    share: float

    def __new__(cls, words: str, share: float) -> Step:
        """Put words and share together."""
        step = super().__new__(cls, words)
        step.share = share
        return step

    def __reduce__(self) -> tuple[type[Step], tuple[str, float]]:
        return Step, (str(self), self.share)


def silent(_: str) -> None:
    """Report progress to nobody."""


class Progress:
    """Tells a caller each step before it is made; what the caller raises ends the search.

    Parameters
    ----------
    tell
        Told the steps.
    begin, end
        Shares of the caller's way between which all steps lie.
    before
        Words before those of each step.
    """

    def __init__(
        self,
        tell: Callable[[Step], object] = silent,
        begin: float = 0.0,
        end: float = 1.0,
        before: str = "",
    ) -> None:
        self._tell, self._begin, self._end, self._before = tell, begin, end, before
        self._reached = begin

    def __call__(self, words: str, share: float | None = None) -> None:
        """Tell a step; without a share and a place of its own it lies where the last one did."""
        if share is None:
            placed = PLACES.get(words, PLACES.get(words.partition(":")[0]))
            share = words.share if isinstance(words, Step) else placed
        if share is not None:
            self._reached = max(self._reached, self._begin + (self._end - self._begin) * share)
        self._tell(Step(self._before + words, self._reached))

    def part(self, begin: float, end: float, before: str = "") -> Progress:
        """Give the progress of one part of what this one tells of.

        Parameters
        ----------
        begin, end
            Shares between which the part lies.
        before
            Words before those of its steps.
        """
        return Progress(self, begin, end, before)
