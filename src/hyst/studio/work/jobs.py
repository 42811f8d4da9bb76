"""The work that loads figures and exports, which nothing else of the studio needs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from hyst.studio.work.commands import Session
from hyst.studio.work.reference import Reference


@dataclass(frozen=True)
class Place:
    """Where a session is and goes.

    Parameters
    ----------
    record
        The record's file.
    folder
        To write.
    """

    record: Path
    folder: Path


@dataclass(frozen=True)
class Saved:
    """What was written.

    Parameters
    ----------
    files
        As paths from the folder.
    refusals
        Sentences about code that cannot be exported.
    """

    files: tuple[str, ...]
    refusals: tuple[str, ...]


def save(
    place: Place, session: Session, reference: Reference | None, tell: Callable[..., None]
) -> Saved:
    """Write a session as a folder.

    Parameters
    ----------
    place, session, reference
        As of ``write_session``.
    tell
        Not told anything.

    Raises
    ------
    InputError
        As ``write_session``.
    """
    from hyst.studio.work.saving import write_session  # takes a second

    return write_session(place, session, reference)
