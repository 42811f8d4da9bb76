"""Strict reading of a section of a TOML file: what is not asked for by name is refused."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.checks.numbers import as_number, as_positive, said, whole_number

if TYPE_CHECKING:
    from hyst.control import LinearSystem

Array = NDArray[np.float64]

_FORMS = "num and den, or zeros, poles and gain, or A, B, C and D"


class Section:
    """One table of a spec, with the names of the tables around it for messages.

    Parameters
    ----------
    data
        What the file has there.
    name
        What messages call it, for instance ``[weights] Wu``.
    """

    def __init__(self, data: Any, name: str) -> None:
        if not isinstance(data, dict):
            raise hyst.InputError(f"{name} is {said(data)}; give a table of entries")
        self._data: dict[str, Any] = data
        self._name = name
        self._known: set[str] = set()

    def has(self, key: str) -> bool:
        """Tell whether there is such an entry, which from now on is a known one."""
        self._known.add(key)
        return key in self._data

    def whole(self, key: str) -> Any:
        """Give an entry that must be there, as it is.

        Parameters
        ----------
        key
            Name of the entry.

        Raises
        ------
        InputError
            If it is not there.
        """
        if not self.has(key):
            raise hyst.InputError(f"{self._name} has no {key!r}; give it")
        return self._data[key]

    def section(self, key: str) -> Section:
        """Give a table inside this one, which must be there.

        Parameters
        ----------
        key
            Name of the entry.

        Raises
        ------
        InputError
            If it is not there, or is no table.
        """
        where = f"[{key}]" if self._name == "the spec" else f"{self._name} {key}"
        if not self.has(key):
            missing = where if self._name == "the spec" else repr(key)
            raise hyst.InputError(f"{self._name} has no {missing}; give it")
        return Section(self._data[key], where)

    def number(self, key: str, default: float | None = None, *, positive: bool = False) -> float:
        """Give a finite number, perhaps one that must be above 0.

        Parameters
        ----------
        key
            Name of the entry.
        default
            What it is if it is left out.
        positive
            Whether it must be above 0.

        Raises
        ------
        InputError
            If it is missing or none.
        """
        value = default if default is not None and not self.has(key) else self.whole(key)
        check = as_positive if positive else as_number
        return check(value, f"{self._name} {key}")

    def count(self, key: str, default: int | None = None) -> int:
        """Give a whole number, 0 or more.

        Parameters
        ----------
        key
            Name of the entry.
        default
            What it is if it is left out.

        Raises
        ------
        InputError
            If it is missing or none.
        """
        value = default if default is not None and not self.has(key) else self.whole(key)
        return whole_number(value, f"{self._name} {key}", 0)

    def text(self, key: str, default: str | None = None, choices: Sequence[str] = ()) -> str:
        """Give a text, one of some choices if there are any.

        Parameters
        ----------
        key
            Name of the entry.
        default
            What it is if it is left out.
        choices
            All that is allowed; anything if empty.

        Raises
        ------
        InputError
            If it is missing, no text or none of the choices.
        """
        value = default if default is not None and not self.has(key) else self.whole(key)
        if not isinstance(value, str) or (choices and value not in choices):
            wanted = f"one of {', '.join(choices)}" if choices else "a text"
            raise hyst.InputError(f"{self._name} {key} is {said(value)}; give {wanted}")
        return value

    def numbers(self, key: str, default: Sequence[float] | None = None) -> Array:
        """Give a list of finite numbers.

        Parameters
        ----------
        key
            Name of the entry.
        default
            What it is if it is left out.

        Raises
        ------
        InputError
            If it is missing or none.
        """
        value = default if default is not None and not self.has(key) else self.whole(key)
        return _array(value, f"{self._name} {key}", 1, "a list of numbers")

    def pairs(self, key: str) -> Array:
        """Give a list of pairs of finite numbers, shape (n, 2).

        Parameters
        ----------
        key
            Name of the entry.

        Raises
        ------
        InputError
            If it is missing or none.
        """
        array = _array(self.whole(key), f"{self._name} {key}", 2, "pairs as [[18.0, 1.0]]")
        if array.shape[0] == 0 or array.shape[1] != 2:
            raise hyst.InputError(
                f"{self._name} {key} has shape {array.shape}; give pairs as [[18.0, 1.0]]"
            )
        return array

    def matrix(self, key: str) -> Array:
        """Give a matrix; a list of numbers is a row.

        Parameters
        ----------
        key
            Name of the entry.

        Raises
        ------
        InputError
            If it is missing or none.
        """
        value = self.whole(key)
        flat = isinstance(value, list) and not any(isinstance(each, list) for each in value)
        dimensions = 1 if flat else 2
        return np.atleast_2d(
            _array(value, f"{self._name} {key}", dimensions, "rows of equal length")
        )

    def system(self) -> LinearSystem:
        """Read this table as a linear system in continuous time.

        Raises
        ------
        InputError
            If it has entries of no form of a system, or of several.
        """
        forms = {
            form: [key for key in form if self.has(key)]
            for form in (("num", "den"), ("zeros", "poles", "gain"), ("A", "B", "C", "D"))
        }
        given = [form for form, keys in forms.items() if keys]
        if len(given) != 1 or list(given[0]) != forms[given[0]]:
            found = [key for keys in forms.values() for key in keys]
            raise hyst.InputError(
                f"{self._name} has {', '.join(found) or 'none of these'}; give {_FORMS}"
            )
        self.done()
        if "num" in given[0]:
            return hyst.control.as_linear_system(
                (self.numbers("num"), self.numbers("den")), self._name
            )
        if "zeros" in given[0]:
            zeros, poles = self._roots("zeros"), self._roots("poles")
            num, den = self.number("gain") * np.poly(zeros), np.poly(poles)
            return hyst.control.as_linear_system(
                (np.atleast_1d(num), np.atleast_1d(den)), self._name
            )
        A, C, D = self.matrix("A"), self.matrix("C"), self.matrix("D")
        B = self.matrix("B").reshape(-1, 1)
        return hyst.control.as_linear_system((A, B, C, D), self._name)

    def _roots(self, key: str) -> NDArray[np.complex128]:
        """Real numbers, or pairs of real and imaginary part, each with its conjugate."""
        value = self.whole(key)
        where = f"{self._name} {key}"
        if not isinstance(value, list):
            raise hyst.InputError(f"{where} is {said(value)}; give a list")
        roots: list[complex] = []
        for each in value:
            if isinstance(each, list):
                re, im = _array(each, where, 1, "pairs [re, im]") if len(each) == 2 else (0.0, 0.0)
                if im == 0.0:
                    raise hyst.InputError(
                        f"{where} has {each}; give pairs [re, im] with im above 0"
                    )
                roots += [complex(re, im), complex(re, -im)]
            else:
                roots.append(complex(_array([each], where, 1, "numbers or pairs [re, im]")[0]))
        return np.array(roots, dtype=np.complex128)

    def done(self) -> None:
        """Refuse entries nobody has asked for.

        Raises
        ------
        InputError
            Naming the first, and the known one it resembles.
        """
        for key in self._data:
            if key not in self._known:
                near = difflib.get_close_matches(key, sorted(self._known), 1)
                hint = (
                    f"did you mean {near[0]!r}"
                    if near
                    else f"known: {', '.join(sorted(self._known))}"
                )
                raise hyst.InputError(f"{self._name} has an unknown entry {key!r}; {hint}")


def _array(value: Any, where: str, dimensions: int, wanted: str) -> Array:
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise hyst.InputError(f"{where} is {said(value)}; give {wanted}") from None
    if array.ndim != dimensions and array.size:
        raise hyst.InputError(f"{where} is {said(value)}; give {wanted}")
    if not np.isfinite(array).all():
        raise hyst.InputError(f"{where} holds a number that is not finite; give {wanted}")
    return array.reshape(-1) if dimensions == 1 else array
