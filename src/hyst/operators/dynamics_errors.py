"""How well the linear dynamics of a model are known, over frequency, and its hysteresis' slope."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, final

from hyst.errors import InputError
from hyst.operators.plain_data import as_finite, as_finite_or_none

_ENTRIES = ("frequency", "standard_error", "missing", "bands")
_SLOPE = "slope_error"


@final
@dataclass(frozen=True)
class DynamicsErrors:
    """How well the dynamics G behind a hysteresis are known; kept in the model file.

    Parameters
    ----------
    frequency
        Hz, ascending, above 0.
    standard_error
        Root of the mean square of ``|P / G - 1|`` at each frequency, P the true dynamics, as the
        noise of the records leaves it: from the covariance of the fit.
    missing
        By how much ``P / G`` visibly differs from 1 over the records themselves, as a share: what
        the model lacks. 0 where the records do not show it to be wrong.
    bands
        Lowest and highest frequency of each band that the drive shows, Hz; elsewhere G is an
        extrapolation, whatever its errors.
    slope_error
        Largest relative standard error of the slope of the hysteresis over its drive, which is what
        an exact inverse leaves of a slope of 1; None where it is not known.

    Raises
    ------
    InputError
        If the lists differ in length, frequencies do not ascend from above 0, an error is below 0,
        or a band is upside down.
    """

    frequency: tuple[float, ...]
    standard_error: tuple[float, ...]
    missing: tuple[float, ...]
    bands: tuple[tuple[float, float], ...]
    slope_error: float | None = None

    def __post_init__(self) -> None:
        for name in ("frequency", "standard_error", "missing"):
            object.__setattr__(self, name, _numbers(name, getattr(self, name)))
        given: Any = self.bands
        if isinstance(given, str) or not isinstance(given, Sequence):
            raise InputError(f"bands is {given!r}; give pairs of frequencies")
        bands = tuple(_numbers("a band", each) for each in given)
        object.__setattr__(self, "bands", bands)
        if not len(self.frequency) == len(self.standard_error) == len(self.missing):
            raise InputError(
                f"there are {len(self.frequency)} frequencies, {len(self.standard_error)} standard "
                f"errors and {len(self.missing)} shares that are missing; give one of each"
            )
        steps = zip((0.0, *self.frequency), self.frequency, strict=False)
        if any(after <= before for before, after in steps):
            raise InputError("the frequencies do not ascend from above 0; put them in order")
        slope = as_finite_or_none("slope_error", self.slope_error)
        if min((*self.standard_error, *self.missing, slope or 0.0)) < 0.0:
            raise InputError("an error is below 0; give 0 or more")
        if any(len(each) != 2 or each[0] > each[1] for each in bands):
            raise InputError("a band is no pair of frequencies, the lower one first")

    def to_dict(self) -> dict[str, Any]:
        """Give all entries as values of JSON."""
        plain: dict[str, Any] = {name: list(getattr(self, name)) for name in _ENTRIES[:3]}
        plain["bands"] = [list(each) for each in self.bands]
        return plain if self.slope_error is None else {**plain, _SLOPE: self.slope_error}

    @classmethod
    def from_dict(cls, data: Any) -> DynamicsErrors:
        """Rebuild it from ``to_dict()``.

        Parameters
        ----------
        data
            What it gave, or the same read from a file.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        if not isinstance(data, Mapping) or set(data) - {_SLOPE} != set(_ENTRIES):
            raise InputError(
                f"errors of dynamics have the entries {', '.join(_ENTRIES)}, perhaps {_SLOPE}, and "
                "no others"
            )
        return cls(**data)


def _numbers(name: str, values: Any) -> tuple[float, ...]:
    if isinstance(values, str) or not isinstance(values, Sequence):
        raise InputError(f"{name} is {values!r}; give a list of numbers")
    return tuple(as_finite(f"a number in {name}", each) for each in values)
