"""How far a model can be trusted, in one word and some sentences."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, final, get_args

from hyst.errors import InputError
from hyst.operators.plain_data import as_text

Level = Literal["good", "fair", "unfit"]
LEVELS: tuple[Level, ...] = get_args(Level)
UNFIT: Level = "unfit"


@final
@dataclass(frozen=True)
class Verdict:
    """How far an identified model can be trusted.

    Parameters
    ----------
    level
        ``"good"``: what the model leaves is the record's own noise. ``"fair"``: something is left
        that has a name. ``"unfit"``: no command should come from it.
    sentences
        Why, the reason for the level first; what is left, with its size; what to do.

    Raises
    ------
    InputError
        If the level is another one, there is no sentence, or one is no text.

    Examples
    --------
    >>> Verdict("good", ("What is left is the record's own noise.",)).level
    'good'
    """

    level: Level
    sentences: tuple[str, ...]

    def __post_init__(self) -> None:
        if self.level not in LEVELS:
            raise InputError(f"the level of a verdict is {self.level!r}; it is one of {LEVELS}")
        if not isinstance(self.sentences, tuple) or not self.sentences:
            raise InputError("a verdict needs its sentences, as a tuple of texts")
        told = tuple(as_text("a sentence of the verdict", each) for each in self.sentences)
        object.__setattr__(self, "sentences", told)

    def told(self) -> str:
        """Give level and sentences for people, a line a sentence."""
        return f"verdict: {self.level} - " + "\n  ".join(self.sentences)

    def to_dict(self) -> dict[str, Any]:
        """Give level and sentences as plain text."""
        return {"level": self.level, "sentences": list(self.sentences)}

    @classmethod
    def from_dict(cls, data: Any) -> Verdict:
        """Rebuild a verdict from ``to_dict()``.

        Parameters
        ----------
        data
            What it gave, or the same read from a file.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        if not isinstance(data, Mapping) or set(data) != {"level", "sentences"}:
            raise InputError("a verdict has the entries 'level' and 'sentences' and no others")
        if not isinstance(data["sentences"], list | tuple):
            raise InputError("the sentences of a verdict are a list of texts")
        return cls(data["level"], tuple(data["sentences"]))


def refuse_if_unfit(verdict: Verdict | None, what: str, despite_verdict: bool) -> None:
    """Refuse to make what moves an actuator of a model that no command should come from.

    Parameters
    ----------
    verdict
        Of the model; None if it was not judged.
    what
        What would be made, as ``"no command is made"``.
    despite_verdict
        Whether the user wants it nevertheless.

    Raises
    ------
    InputError
        If the verdict is ``"unfit"`` and the user does not.
    """
    if despite_verdict or verdict is None or verdict.level != UNFIT:
        return
    reason = verdict.sentences[0].rstrip(".")
    raise InputError(
        f"{what}, for the verdict on the model is {UNFIT}: {reason}; record and identify anew "
        "(hyst diagnose says what the record lacks), or go on at your own risk with "
        "--despite-verdict (despite_verdict=True in Python)"
    )
