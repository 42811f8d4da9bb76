"""What the numbers of a model mean, how good they are, and where they come from."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from typing import Any, ClassVar, Self, final

from hyst.errors import InputError
from hyst.operators.driver.driver import Driver
from hyst.operators.dynamics_errors import DynamicsErrors
from hyst.operators.plain_data import (
    as_finite,
    as_finite_or_none,
    as_finite_pair_or_none,
    as_mapping,
    as_number,
    as_text,
)
from hyst.operators.provenance import Provenance
from hyst.operators.verdict import UNFIT, Verdict

ERRORS = ("rms", "rms_percent", "max_abs")


@final
@dataclass(frozen=True)
class ModelDescription:
    """What the numbers of a model mean; kept in the model file beside the model.

    Parameters
    ----------
    input_name, output_name
        Names of the signals.
    input_unit, output_unit
        Their units, as text.
    input_low, input_high, output_low, output_high
        Ranges of the record the model was identified from, if it was.
    dt
        Sample time of that record in seconds.
    delay
        Samples by which the measured output lagged the model's output in that record; may be a
        fraction, and is negative where the output was ahead of the input, which no actuator is. The
        model itself has no delay, so that it has an exact inverse.
    family
        Family the model was identified in.
    errors
        How good the model is, by record: ``training``, ``validation``, ... Each has ``rms`` and
        ``max_abs`` in output units, and ``rms_percent`` of the output's range. Those of an inverse
        are of the model that it inverts, whose output is the inverse's input.
    provenance
        Where the model comes from, if it was identified.
    verdict
        How far the model can be trusted, if that was judged.
    delay_interval
        Lowest and highest delay that the records do not exclude, samples.
    smallest_swing
        Least way of the input between two turns in the records, input units: of smaller loops they
        show nothing.
    dynamics_errors
        How well linear dynamics behind a hysteresis are known, if they were identified.
    driver
        Which volts the codes of the drive's converter give, if the record's input was in codes.
    is_inverse
        Whether the output is the drive of an actuator and the input what it shall do; None where
        that is not known, as of files before version 5 that do not show it.

    Raises
    ------
    InputError
        If a name or unit is no text, a number is not finite, dt or the swing is not positive, a
        range is upside down, an error has another name, or a structure is of another kind.
    """

    input_name: str = "u"
    output_name: str = "y"
    input_unit: str = ""
    output_unit: str = ""
    input_low: float | None = None
    input_high: float | None = None
    output_low: float | None = None
    output_high: float | None = None
    dt: float | None = None
    delay: float = 0
    family: str = ""
    errors: Mapping[str, Mapping[str, float]] = field(default_factory=dict, hash=False)
    provenance: Provenance | None = None
    verdict: Verdict | None = None
    delay_interval: tuple[float, float] | None = None
    smallest_swing: float | None = None
    dynamics_errors: DynamicsErrors | None = None
    driver: Driver | None = None
    is_inverse: bool | None = False

    # Of the file format: entries that files of a version may have are those of it and before.
    ADDED: ClassVar[dict[str, int]] = {
        "errors": 2,
        "provenance": 2,
        "verdict": 3,
        "delay_interval": 3,
        "smallest_swing": 3,
        "dynamics_errors": 4,
        "driver": 5,
        "is_inverse": 5,
    }

    def __post_init__(self) -> None:
        for each in fields(self):
            value = _CHECKS[each.name](each.name, getattr(self, each.name))
            object.__setattr__(self, each.name, value)
        if self.dt is not None and self.dt <= 0.0:
            raise InputError(f"dt is {self.dt}; give a sample time above 0, in seconds")
        if self.smallest_swing is not None and self.smallest_swing <= 0.0:
            raise InputError(f"smallest_swing is {self.smallest_swing}; give a way above 0")
        for signal in ("input", "output"):
            low, high = getattr(self, f"{signal}_low"), getattr(self, f"{signal}_high")
            if low is not None and high is not None and low > high:
                raise InputError(
                    f"{signal}_low is {low} and {signal}_high is {high}; give the lower end first"
                )

    @property
    def version(self) -> int:
        """The first version of a description that has all entries given here, at least 3."""
        given = [name for name in self.to_dict() if name in self.ADDED]
        return max([_ANY_DELAY, *(self.ADDED[name] for name in given)])

    @property
    def _could_be_either(self) -> bool:
        """Whether it fits a model as well as an inverse: ranges, but no swing, which inverses lack.

        Before version 5 inverses were written so, too.
        """
        ranges = (self.input_low, self.input_high, self.output_low, self.output_high)
        return self.smallest_swing is None and any(each is not None for each in ranges)

    @property
    def is_unfit(self) -> bool:
        """Whether no command should come from the model, because its verdict says so."""
        return self.verdict is not None and self.verdict.level == UNFIT

    def to_dict(self) -> dict[str, Any]:
        """Give what there is to say as values of JSON; what is not known is left out."""
        plain = asdict(self)
        for name in ("verdict", "dynamics_errors", "driver"):
            given = getattr(self, name)
            plain[name] = None if given is None else given.to_dict()
        if self.delay_interval is not None:
            plain["delay_interval"] = list(self.delay_interval)
        if self.is_inverse is False and not self._could_be_either:
            del plain["is_inverse"]
        return {key: value for key, value in plain.items() if value not in (None, {})}

    @classmethod
    def from_dict(cls, data: Any, version: int = 5) -> ModelDescription:
        """Rebuild a description from ``to_dict()``.

        Parameters
        ----------
        data
            What ``to_dict()`` gave, or the same read from a file.
        version
            Of the description: 1 has neither errors nor provenance, 2 neither verdict nor what
            records leave open, and both know whole delays from 0 only; 3 has no errors of
            dynamics, 4 no driver and not what is an inverse.

        Raises
        ------
        InputError
            If an entry is unknown, null or not allowed.
        """
        if not isinstance(data, dict):
            raise InputError("'description' must be an object")
        known = {each.name for each in fields(cls) if cls.ADDED.get(each.name, 1) <= version}
        for key, value in data.items():
            if key not in known:
                raise InputError(
                    f"unknown entry {key!r} in 'description'; remove it or update hyst"
                )
            if value is None:
                raise InputError(f"{key!r} in 'description' is null; leave the entry out")
        try:
            about = cls(**data)
        except InputError as error:
            raise InputError(f"in 'description', {error}") from None
        if "is_inverse" not in data and about._could_be_either:
            about = replace(about, is_inverse=None)
        if version < _ANY_DELAY and (about.delay < 0 or not isinstance(about.delay, int)):
            raise InputError(
                f"in 'description', delay is {about.delay}; in files of this version it is a whole "
                "number of samples, 0 or more"
            )
        return about

    def of_inverse(self) -> ModelDescription:
        """Give that of the inverse: input and output change places, without swing.

        The errors stay those of the model: the inverse has none of its own but the rounding.

        The verdict stays, for the inverse of a model that is not fit is not fit either. Where
        nothing is known of the signals, all that is said is that it is an inverse.
        """
        if replace(self, is_inverse=False) == _NOTHING_SAID:
            return replace(self, is_inverse=not self.is_inverse)
        return replace(
            self,
            input_name=self.output_name,
            input_unit=self.output_unit,
            input_low=self.output_low,
            input_high=self.output_high,
            output_name=self.input_name,
            output_unit=self.input_unit,
            output_low=self.input_low,
            output_high=self.input_high,
            smallest_swing=None,
            dynamics_errors=None,
            is_inverse=not self.is_inverse,
        )

    def of_other_constants(self) -> ModelDescription:
        """Give what still holds when the constants change: no errors, origin or verdict."""
        return replace(self, errors={}, provenance=None, verdict=None, dynamics_errors=None)

    def of_estimate(self) -> ModelDescription:
        """Give what holds of an estimate that starts here: where this is unfit, its shape stays so.

        Estimation changes constants. What is unfit of a model is its shape, which it does not.
        """
        return replace(self.of_other_constants(), verdict=self.verdict if self.is_unfit else None)


class Described:
    """What is frozen and carries a description, which is no part of what it equals."""

    @final
    @property
    def description(self) -> ModelDescription:
        """What the numbers mean; nothing but defaults if that is not known."""
        about: ModelDescription = vars(self).get(_CARRIED, _NOTHING_SAID)
        return about

    @final
    def with_description(self, description: ModelDescription) -> Self:
        """Give the same thing with another description.

        Parameters
        ----------
        description
            What the numbers mean.

        Raises
        ------
        InputError
            If it is something else.
        """
        other = object.__new__(type(self))
        vars(other).update(vars(self), **{_CARRIED: as_description(description)})
        return other

    def _carried(self) -> dict[str, ModelDescription]:
        """Give what pickling has to keep beside the constants."""
        return {name: about for name, about in vars(self).items() if name == _CARRIED}


def errors_of(metrics: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """Give the errors that a description keeps of ``metrics`` by record; finite ones only."""
    return {
        record: {
            name: value for name in ERRORS if math.isfinite(value := float(getattr(each, name)))
        }
        for record, each in metrics.items()
    }


def as_description(description: ModelDescription) -> ModelDescription:
    """Give a description as it is.

    Raises
    ------
    InputError
        If it is something else.
    """
    if not isinstance(description, ModelDescription):
        raise InputError(
            f"the description is a {type(description).__name__}; give a ModelDescription"
        )
    return description


def _as_errors(name: str, value: Any) -> dict[str, dict[str, float]]:
    checked = {}
    for record, figures in as_mapping(name, value).items():
        given = as_mapping(f"{name} of {record!r}", figures)
        for key in given:
            if key not in ERRORS:
                known = ", ".join(ERRORS)
                raise InputError(f"unknown error {key!r} of {record!r} in {name}; give {known}")
        checked[record] = {
            key: as_finite(f"{key} of {record!r} in {name}", each) for key, each in given.items()
        }
    return checked


def _as_provenance(name: str, value: Any) -> Provenance | None:
    return value if value is None or isinstance(value, Provenance) else Provenance.from_dict(value)


def _as_verdict(name: str, value: Any) -> Verdict | None:
    return value if value is None or isinstance(value, Verdict) else Verdict.from_dict(value)


def _as_dynamics_errors(name: str, value: Any) -> DynamicsErrors | None:
    known = value is None or isinstance(value, DynamicsErrors)
    return value if known else DynamicsErrors.from_dict(value)


def _as_driver(name: str, value: Any) -> Driver | None:
    return value if value is None or isinstance(value, Driver) else Driver.from_dict(value)


def _as_yes_or_no(name: str, value: Any) -> bool | None:
    if value is not None and not isinstance(value, bool):
        raise InputError(f"{name} is {value!r}; give true or false")
    return value


# How each entry is checked; one that has a structure gives back what is plain and its own.
_CHECKS: dict[str, Callable[[str, Any], Any]] = {
    **dict.fromkeys(("input_name", "output_name", "input_unit", "output_unit", "family"), as_text),
    **dict.fromkeys(("input_low", "input_high", "output_low", "output_high"), as_finite_or_none),
    "dt": as_finite_or_none,
    "delay": as_number,
    "errors": _as_errors,
    "provenance": _as_provenance,
    "verdict": _as_verdict,
    "delay_interval": as_finite_pair_or_none,
    "smallest_swing": as_finite_or_none,
    "dynamics_errors": _as_dynamics_errors,
    "driver": _as_driver,
    "is_inverse": _as_yes_or_no,
}
_ANY_DELAY = 3  # the version from which on a delay may be a fraction or negative
_NOTHING_SAID = ModelDescription()
_CARRIED = "_description"
