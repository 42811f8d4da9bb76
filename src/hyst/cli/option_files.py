"""Options of families that are files: what is known already."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import hyst

FILE = "FILE"
"""What stands for the value of such an option in the help."""


def opened(text: str, said: str) -> Any:
    """Read the file that an option names: a model, or columns of a frequency response.

    Parameters
    ----------
    text
        The path.
    said
        The option as it is typed.

    Raises
    ------
    InputError
        If it is neither.
    """
    try:
        if Path(text).suffix.lower() == ".json":
            return hyst.load(text)
        return hyst.read_frequency_response(text)
    except hyst.InputError as error:
        raise hyst.InputError(f"{said}: {error}") from None
