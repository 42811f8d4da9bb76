"""What any scheduler does: work off jobs in a bounded number, and give what each came to."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

Job = tuple[str, Any]
"""A name, and the argument of the function."""

Work = Callable[[Any], Any]

AHEAD = 4
"""Jobs for each worker that wait with their data: more would only fill the memory."""


@dataclass(frozen=True, eq=False)
class Done:
    """What a job came to.

    Parameters
    ----------
    name
        Of the job.
    value
        What the function gave; None if it could not be run.
    failure
        Why it could not be run; empty where it was.
    """

    name: str
    value: Any
    failure: str = ""


Run = Callable[[Work, Iterable[Job]], Iterator[Done]]
"""A scheduler: gives what each job came to, in the order in which they end."""
