"""An option of a family: its default, what it may be, and how it is said on the command line."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import said
from hyst.checks.numbers import whole_number as as_whole_number
from hyst.errors import InputError

AUTO = "auto"


@dataclass(frozen=True)
class Option:
    """What a family lets its user choose.

    Parameters
    ----------
    check
        Takes a value and the option's name; gives it in its final form or raises InputError.
    help
        One sentence for the command line, without the names of the families.
    read
        Takes the text of the command line and the option's name; gives the value to check. What it
        cannot read it gives as it is, to be refused with the rest.
    metavar
        What stands for the value in the help.
    typed
        The name on the command line without its dashes, where that of the field is taken there.
    """

    check: Callable[[Any, str], Any]
    help: str
    read: Callable[[str, str], Any]
    metavar: str
    typed: str = ""


def option(default: Any, what: Option) -> Any:
    """Give the field of a family for an option.

    Parameters
    ----------
    default
        Its default.
    what
        The option.
    """
    return field(default=default, metadata={"option": what})


def whole_number_or_auto(least: int, most: int, help: str) -> Option:
    """Give an option that is a count or ``"auto"``.

    Parameters
    ----------
    least, most
        Ends of the range.
    help
        One sentence.
    """

    def check(value: Any, name: str) -> Any:
        if isinstance(value, str) and value == AUTO:
            return AUTO
        return as_whole_number(value, name, least, most, ", or 'auto'")

    return Option(check, help, read_whole, "N|auto")


def whole_number(least: int, most: int, help: str) -> Option:
    """Give an option that is a count.

    Parameters
    ----------
    least, most
        Ends of the range.
    help
        One sentence.
    """

    def check(value: Any, name: str) -> int:
        return as_whole_number(value, name, least, most)

    return Option(check, help, read_whole, "N")


def choice(choices: tuple[str, ...], help: str, typed: str = "") -> Option:
    """Give an option that is one of a few words.

    Parameters
    ----------
    choices
        The words.
    help
        One sentence.
    typed
        As of ``Option``.
    """

    def check(value: Any, name: str) -> str:
        if not isinstance(value, str) or value not in choices:
            raise InputError(f"{name} is {value!r}; choose one of {', '.join(choices)}")
        return value

    return Option(check, help, lambda text, _: text, "|".join(choices), typed)


def as_numbers(values: Any, name: str, what: str, least: float = -np.inf) -> NDArray[np.float64]:
    """Check a list of numbers, or one; texts and truth values are none.

    Parameters
    ----------
    values, name
        What was given, and the option's name.
    what
        What messages ask for, as "a list of numbers".
    least
        The smallest that is allowed.

    Returns
    -------
    numpy.ndarray
        Shape (n,), in the order given.

    Raises
    ------
    InputError
        If it is something else, empty, or one is not finite or too small.
    """
    try:
        given = np.asarray(values)
    except ValueError:  # lists of lists of several lengths
        given = np.asarray(None)
    truths = isinstance(values, list | tuple) and any(isinstance(each, bool) for each in values)
    if given.dtype.kind in "fiu" and given.ndim <= 1 and given.size and not truths:
        numbers = given.astype(np.float64).reshape(-1)
        if np.isfinite(numbers).all() and numbers.min() >= least:
            return numbers
    raise InputError(f"{name} is {said(values)}; give {what}")


def read_numbers(text: str, name: str) -> Any:
    """Read numbers with commas between them.

    Parameters
    ----------
    text, name
        What was typed, and the option's name.

    Raises
    ------
    InputError
        If it is something else.
    """
    try:
        return [float(each) for each in text.split(",")]
    except ValueError:
        raise InputError(
            f"{name} is {text!r}; give numbers with commas between them, as 0,3.6"
        ) from None


def read_number(text: str, name: str) -> float:
    """Read one number.

    Parameters
    ----------
    text, name
        What was typed, and the option's name.

    Raises
    ------
    InputError
        If it is something else.
    """
    try:
        return float(text)
    except ValueError:
        raise InputError(f"{name} is {text!r}; give a number") from None


def read_whole(text: str, _: str) -> int | str:
    """Read a whole number; what is none, as a word, is given as it is.

    Parameters
    ----------
    text
        What was typed.
    """
    try:
        return int(text)
    except ValueError:
        return text


def as_text(text: str, _: str) -> str:
    """Give what was typed as it is, as the name of a file that the command line opens.

    Parameters
    ----------
    text
        What was typed.
    """
    return text
