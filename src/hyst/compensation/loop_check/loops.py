"""The loops of records behind the dynamics, and what is to be said of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.compensation.loop_check.chosen_inverse import ChosenInverse
from hyst.compensation.loop_check.rate_test import RateTest, RepeatedLoop
from hyst.compensation.loop_check.words import (
    sentence_of_differences,
    sentence_of_test,
    why_no_test,
)
from hyst.operators import Operator
from hyst.signals import Metrics, Record, error_metrics

Array = NDArray[np.float64]

FAR_OFF = 8.0
"""% of range beside noise: a hysteresis that misses its loop by more describes nothing."""


@dataclass(frozen=True, eq=False)
class LoopOfRecord:
    """The loop of one record.

    Parameters
    ----------
    name
        Of the record.
    record
        Input and output.
    v
        Shape (N,): what drives the dynamics, from the output by their inverse, units of it.
    modelled
        Shape (N,): the same from the input, by the hysteresis of the model.
    valid
        Samples of ``v`` that depend on measured ones only.
    noise
        Standard deviation of single samples of ``v``: what does not repeat where the input does,
        else that of white noise as the output has it.
    seen_through
        The inverse, and its band.
    repeats
        Rms of what repeats of ``v - modelled``, where the input does; None elsewhere.
    """

    name: str
    record: Record
    v: Array
    modelled: Array
    valid: slice
    noise: float
    seen_through: ChosenInverse
    repeats: float | None = None

    @property
    def band(self) -> float:
        """Half-width of the band in which noise keeps ``v``, two standard deviations."""
        return 2.0 * self.noise

    @property
    def metrics(self) -> Metrics:
        """Errors of the model's hysteresis, the mean taken out, percent of the range of v by it."""
        v, modelled = self.v[self.valid], self.modelled[self.valid]
        return error_metrics(modelled, v, free_offset=True)

    @property
    def offset(self) -> float:
        """Mean of v minus that of the model."""
        return self.metrics.bias

    @property
    def beside_noise_percent(self) -> float:
        """Rms of the difference that is no noise, % of range."""
        errors = self.metrics
        beside = self.repeats
        if beside is None:
            beside = max(errors.rms**2 - self.noise**2, 0.0) ** 0.5
        return 100.0 * beside / errors.output_range


@dataclass(frozen=True, eq=False, repr=False)
class LoopsBehind:
    """Loops behind the dynamics of a model, and whether they depend on the frequency.

    Parameters
    ----------
    model
        Whose dynamics were inverted.
    loops
        One a record.
    repeated
        One a stretch in which the input repeats, record by record.
    tests
        One for each amplitude and offset that was run at several frequencies; none if none was.
    level
        Chance of a false alarm, of all tests together.
    tolerance
        % of range, by which loops may differ.
    rate_independent_model
        Whether the hysteresis of the model does not depend on the rate.
    """

    model: Operator
    loops: tuple[LoopOfRecord, ...]
    repeated: tuple[RepeatedLoop, ...]
    tests: tuple[RateTest, ...]
    level: float
    tolerance: float
    rate_independent_model: bool

    def __repr__(self) -> str:
        frequencies = ", ".join(f"{each.frequency:.4g}" for each in self.repeated) or "none"
        return f"LoopsBehind({len(self.loops)} records, Hz: {frequencies}, p = {self.p_value})"

    @property
    def p_value(self) -> float | None:
        """Chance of differences as large by noise alone, at most; None if nothing was compared."""
        if not self.tests:
            return None
        return min(1.0, len(self.tests) * min(each.found.p_value for each in self.tests))

    @property
    def coincide(self) -> bool | None:
        """Whether loops of all frequencies are one; None if nothing was compared."""
        return all(each.holds for each in self.tests) if self.tests else None

    @property
    def far_off(self) -> tuple[LoopOfRecord, ...]:
        """Loops that the model's hysteresis misses by more than ``FAR_OFF`` beside noise."""
        return tuple(each for each in self.loops if each.beside_noise_percent > FAR_OFF)

    @property
    def holds(self) -> bool:
        """Whether nothing here speaks against the model."""
        return self.coincide is not False and not self.far_off

    @property
    def notes(self) -> tuple[str, ...]:
        """What is to be known of how the loops were seen, in sentences."""
        found = [
            f"record {each.name}: {each.seen_through.note}"
            for each in self.loops
            if each.seen_through.note
        ]
        late = self.model.description.delay
        if late != max(round(late), 0):
            found.append(
                f"the model's record was {late:.4g} samples late, and whole ones only are taken "
                "back; the delay below counts the rest"
            )
        return tuple(found)

    def sentences(self) -> tuple[str, ...]:
        """Say whether the loops coincide, what it looks like if not, and how well the model fits.

        Returns
        -------
        tuple of str
        """
        told = [
            sentence_of_test(each, self.level, self.tolerance, self.rate_independent_model)
            for each in self.tests
        ]
        if not told:
            told.append(why_no_test(self.repeated, len(self.loops)))
        told.append(sentence_of_differences(self.loops, self.far_off, FAR_OFF))
        return tuple(told)

    def summary(self) -> str:
        """Give what is to be said, a line each.

        Returns
        -------
        str
        """
        return "\n".join(self.sentences() + self.notes)

    def to_dict(self) -> dict[str, Any]:
        """Give all numbers as values of JSON.

        Returns
        -------
        dict
        """
        return {
            "holds": self.holds,
            "coincide": self.coincide,
            "p_value": self.p_value,
            "level": self.level,
            "tolerance_percent": self.tolerance,
            "rate_independent_model": self.rate_independent_model,
            "sentences": list(self.sentences()),
            "notes": list(self.notes),
            "records": [_loop_as_dict(each) for each in self.loops],
            "repeated": [_repeated_as_dict(each) for each in self.repeated],
            "tests": [_test_as_dict(each, self.repeated) for each in self.tests],
        }


def _loop_as_dict(loop: LoopOfRecord) -> dict[str, Any]:
    errors, inverse = loop.metrics, loop.seen_through.inverse
    return {
        "name": loop.name,
        "samples": len(loop.record),
        "valid": [loop.valid.start, loop.valid.stop],
        "rms": errors.rms,
        "rms_percent": errors.rms_percent,
        "max_abs": errors.max_abs,
        "max_percent": errors.max_percent,
        "offset": errors.bias,
        "range": errors.output_range,
        "noise": loop.noise,
        "band": loop.band,
        "beside_noise_percent": loop.beside_noise_percent,
        "inverse": {
            "band": loop.seen_through.band,
            "preview": inverse.preview,
            "memory": inverse.memory,
            "noise_gain": inverse.noise_gain,
        },
    }


def _repeated_as_dict(loop: RepeatedLoop) -> dict[str, Any]:
    ratio, cycles, shape = loop.ratio, loop.cycles, loop.shape
    return {
        "record": loop.record,
        "samples": [cycles.start, cycles.stop],
        "frequency": cycles.frequency,
        "cycles": cycles.cycles,
        "is_sine": cycles.is_sine,
        "input_low": cycles.low,
        "input_high": cycles.high,
        "gain_by_model": abs(ratio) if np.isfinite(ratio) else None,
        "phase_by_model": float(np.angle(ratio)) if np.isfinite(ratio) else None,
        "area": loop.area,
        "area_standard_error": loop.area_standard_error,
        "modelled_area": loop.modelled_area,
        "harmonics": shape.seen.tolist(),
        "modelled_harmonics": shape.modelled.tolist(),
        "standard_errors": np.sqrt(shape.variance).tolist(),
        "degrees_of_freedom": shape.freedom,
    }


def _test_as_dict(test: RateTest, repeated: tuple[RepeatedLoop, ...]) -> dict[str, Any]:
    places = [(each.record, each.cycles.start) for each in repeated]
    return {
        "loops": [places.index((each.record, each.cycles.start)) for each in test.loops],
        "cause": test.cause,
        "p_value": test.found.p_value,
        "p_values": test.found.p_values.tolist(),
        "distance": test.found.distance,
        "distance_percent": test.distance_percent,
        "delay": test.delay,
        "p_value_without_delay": test.without_delay.p_value,
        "distance_without_delay": test.without_delay.distance,
    }
