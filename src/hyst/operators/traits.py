"""What may be relied on of an operator."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Traits:
    """Properties an operator declares; contract tests hold every operator to them.

    Parameters
    ----------
    memoryless
        The output depends on the present input alone.
    rate_independent
        Passing the same values at another speed, or repeating samples, changes nothing else.
    return_point_memory
        An input that returns to an earlier extremum finds the output it left there, and goes on as
        if the excursion had not been (wiping out).
    congruent_loops
        Loops between the same two input values have the same shape wherever they start.
    monotone
        While the input rises, from any state an input can have left, the output does not fall.
    invertible
        ``inverse()`` gives an exact inverse.
    """

    memoryless: bool
    rate_independent: bool
    return_point_memory: bool
    congruent_loops: bool
    monotone: bool
    invertible: bool
