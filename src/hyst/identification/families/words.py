"""What people are told of a family."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Words:
    """What people are told of a family.

    Parameters
    ----------
    full_name
        As it stands in a sentence.
    equations
        In plain characters; ``{sign}`` stands for the sign of a falling output.
    explanations
        What the letters in the equations mean, in sentences.
    """

    full_name: str
    equations: tuple[str, ...]
    explanations: tuple[str, ...]
