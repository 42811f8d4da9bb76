"""Templates with places as ``@{name}``: C has no such text, and CMake's are ``${name}``."""

from __future__ import annotations

import re
from pathlib import Path

_FOLDER = Path(__file__).resolve().parents[1] / "templates"
_PLACE = re.compile(r"@\{(\w+)\}")


def filled(template: str, values: dict[str, str]) -> str:
    """Fill a template.

    Parameters
    ----------
    template
        Its file in ``templates``, without ``.in``.
    values
        What stands at every place; one that is not there is a KeyError.

    Returns
    -------
    str
    """
    with_places = _FOLDER / f"{template}.in"
    file = with_places if with_places.exists() else _FOLDER / template
    text = file.read_text(encoding="utf-8")
    return _PLACE.sub(lambda place: values[place[1]], text)


def indented(text: str, by: int = 4) -> str:
    """Give lines moved to the right, without the last line feed.

    Parameters
    ----------
    text
        Lines.
    by
        Spaces.

    Returns
    -------
    str
    """
    space = " " * by
    return "\n".join(space + line if line else line for line in text.rstrip("\n").split("\n"))
