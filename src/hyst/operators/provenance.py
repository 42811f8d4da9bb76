"""Where the numbers of a model come from: data, options, versions, date and command."""

from __future__ import annotations

import hashlib
import inspect
import platform
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from datetime import UTC, datetime, timedelta
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst._typed_command import typed_command
from hyst.errors import InputError
from hyst.operators.plain_data import as_mapping, as_plain, as_text


class Sampled(Protocol):
    """What has an input and an output, sampled; a record."""

    @property
    def u(self) -> NDArray[np.float64]:
        """Input, shape (N,)."""

    @property
    def y(self) -> NDArray[np.float64]:
        """Output, shape (N,)."""

    @property
    def dt(self) -> float:
        """Sample time, seconds."""


@dataclass(frozen=True)
class Provenance:
    """How a model came about, so that it can be made again.

    Two runs of the same command on the same data, with the same versions, differ in ``date`` only.

    Parameters
    ----------
    date
        When, ISO 8601 in UTC, as ``2026-01-31T12:00:00+00:00``.
    data_sha256
        ``data_hash`` of the records, 64 hexadecimal digits.
    versions
        Versions by name: hyst, numpy, scipy, python.
    options
        What was asked for otherwise than by default, by name: values of JSON.
    command
        As it was typed; empty if it was Python.

    Raises
    ------
    InputError
        If an entry is of another kind, or a number in the options is not finite.
    """

    date: str
    data_sha256: str
    versions: Mapping[str, str] = field(hash=False)
    options: Mapping[str, Any] = field(hash=False)
    command: str = ""

    def __post_init__(self) -> None:
        for name, check in _CHECKS.items():
            object.__setattr__(self, name, check(name, getattr(self, name)))

    def to_dict(self) -> dict[str, Any]:
        """Give all entries as values of JSON."""
        return asdict(self)

    @classmethod
    def from_dict(cls, data: Any) -> Provenance:
        """Rebuild it from ``to_dict()``.

        Parameters
        ----------
        data
            What ``to_dict()`` gave, or the same read from a file.

        Raises
        ------
        InputError
            If an entry is missing, unknown or of another kind.
        """
        given = as_mapping("provenance", data)
        known = [each.name for each in fields(cls)]
        for key in given:
            if key not in known:
                raise InputError(f"unknown entry {key!r} in 'provenance'")
        for key in known[:4]:
            if key not in given:
                raise InputError(f"the entry {key!r} is missing in 'provenance'")
        return cls(**given)


def data_hash(records: Sequence[Sampled]) -> str:
    """Give the SHA-256 of the data: for each record the bytes of u, of y and of dt.

    Parameters
    ----------
    records
        Each with ``u``, ``y`` and ``dt``; taken as little-endian float64 on every machine.

    Returns
    -------
    str
        64 hexadecimal digits.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> empty = SimpleNamespace(u=np.zeros(0), y=np.zeros(0), dt=0.0)
    >>> data_hash([empty]) == hashlib.sha256(bytes(8)).hexdigest()
    True
    """
    total = hashlib.sha256()
    for record in records:
        for each in (record.u, record.y, record.dt):
            total.update(np.ascontiguousarray(each, dtype="<f8").tobytes())
    return total.hexdigest()


def provenance(records: Sequence[Sampled], options: Mapping[str, Any]) -> Provenance:
    """Say where a model comes from that is being made now.

    Parameters
    ----------
    records
        What it is identified from.
    options
        What was asked for; what JSON cannot hold is kept as text.

    Returns
    -------
    Provenance

    """
    import scipy  # slow, and not needed to read a file

    return Provenance(
        date=datetime.now(UTC).isoformat(timespec="seconds"),
        data_sha256=data_hash(records),
        versions={
            "hyst": hyst.__version__,
            "numpy": np.__version__,
            "scipy": scipy.__version__,
            "python": platform.python_version(),
        },
        options={name: _kept(value) for name, value in options.items()},
        command=typed_command(),
    )


def options_asked(function: Callable[..., Any], given: Mapping[str, Any]) -> dict[str, Any]:
    """Give the keyword arguments of a call that differ from their defaults.

    Parameters
    ----------
    function
        The function that was called.
    given
        Its arguments by name; what the function has no default for is left out, and so are
        functions and what is empty by default.

    Returns
    -------
    dict
    """
    asked = {}
    for name, parameter in inspect.signature(function).parameters.items():
        value, default = given.get(name), parameter.default
        if default in (inspect.Parameter.empty, ()) or callable(value):
            continue
        if type(value) is not type(default) or value != default:
            asked[name] = value
    return asked


def _kept(value: Any) -> Any:
    """Give an option as JSON has it; as text what JSON has not, as infinity."""
    try:
        return as_plain("an option", value)
    except InputError:
        return repr(value)


def _as_date(name: str, value: Any) -> str:
    text = as_text(name, value)
    try:
        offset = datetime.fromisoformat(text).utcoffset()
    except ValueError:
        offset = None
    if offset != timedelta(0):
        raise InputError(f"{name} is {text!r}; give a date in UTC, as 2026-01-31T12:00:00+00:00")
    return text


def _as_sha256(name: str, value: Any) -> str:
    text = as_text(name, value)
    if not re.fullmatch("[0-9a-f]{64}", text):
        raise InputError(f"{name} is {text!r}; give 64 hexadecimal digits")
    return text


def _as_texts(name: str, value: Any) -> dict[str, str]:
    return {key: as_text(f"{name}.{key}", each) for key, each in as_mapping(name, value).items()}


def _as_options(name: str, value: Any) -> dict[str, Any]:
    return {key: as_plain(f"{name}.{key}", each) for key, each in as_mapping(name, value).items()}


_CHECKS: dict[str, Callable[[str, Any], Any]] = {
    "date": _as_date,
    "data_sha256": _as_sha256,
    "versions": _as_texts,
    "options": _as_options,
    "command": as_text,
}
