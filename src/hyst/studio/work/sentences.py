"""Whatever goes wrong, as one sentence for the page."""

from __future__ import annotations

from hyst.errors import HystError

# Options of Python that messages name, and what they are called on the page.
_ON_THE_PAGE = (
    ("repair=True", "the box “Repair”"),
    ("the option repair", "the box “Repair”"),
    ("the option resample", "the box “Bring to one raster”"),
    ("choose one with table", "choose one with “Number of the table”"),
    ("resample=True", "the box “Bring to one raster”"),
    (
        "give output_time and resample",
        "call it “output's time” and tick “Bring to one raster”",
    ),
    ("time_unit=", "the unit of time "),
)


def sentence_of(error: BaseException) -> str:
    """Say what went wrong.

    Parameters
    ----------
    error
        Any.

    Returns
    -------
    str
        One sentence without line breaks.
    """
    if isinstance(error, HystError):
        text = " ".join(str(error).split())
        for option, called in _ON_THE_PAGE:
            text = text.replace(option, called)
        return text
    if isinstance(error, OSError):
        return " ".join(str(error).split())
    if isinstance(error, MemoryError):
        return "the memory does not suffice; choose a shorter record"
    what = f"{type(error).__name__}: {error}"
    return f"hyst itself failed, {' '.join(what.split())[:300]}; report it with the file"
