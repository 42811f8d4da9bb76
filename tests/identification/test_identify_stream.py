"""A record in a file: the fit of all its samples, from sums over chunks."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray

import hyst
from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.stream import identify_stream, survey
from hyst.signals import RecordStream

Array = NDArray[np.float64]
TRUE = hyst.PrandtlIshlinskii([0.5, 0.3, 0.2], [0.1, 0.3, 0.6], 1.0)


@dataclass(frozen=True, eq=False)
class Arrays:
    """A stream over arrays."""

    u: Array
    y: Array
    dt: float = 1e-3
    u_unit: str = "V"
    y_unit: str = "um"

    def __len__(self) -> int:
        return self.u.size

    def chunks(self, samples: int) -> Iterator[tuple[Array, Array]]:
        for first in range(0, self.u.size, samples):
            rows = slice(first, first + samples)
            yield self.u[rows].copy(), self.y[rows].copy()


def stream(samples: int, late: int = 0, seed: int = 0) -> Arrays:
    t = 1e-3 * np.arange(samples)
    u = (1.0 - 0.6 * np.sin(np.pi * t / t[-1]) ** 2) * np.sin(2.0 * np.pi * 3.0 * t)
    y = np.concatenate([np.zeros(late), TRUE(u)])[:samples] + 0.3
    return Arrays(u, y + 0.01 * np.random.default_rng(seed).standard_normal(samples))


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(survey, "PART", 6000)
    monkeypatch.setattr(survey, "CHUNK", 1000)


ASKED = {"family": "pi", "plays": 3, "creep": None, "drift": False}


@pytest.mark.usefixtures("small")
@pytest.mark.parametrize("late", [0, 3])
def test_it_is_the_fit_of_the_same_record_in_memory(late: int) -> None:
    given = stream(30_500, late)
    found = hyst.identify(given, delay=late, **ASKED)
    record = hyst.Record(given.u, given.y, given.dt, input_unit="V", output_unit="um")
    whole = hyst.identify(record, delay=late, **ASKED)
    apart = np.abs(found.parameter_values - whole.parameter_values)
    # Both end within a small part of a standard error.
    assert (apart <= 0.2 * whole.standard_errors).all()
    np.testing.assert_allclose(found.standard_errors, whole.standard_errors, rtol=0.05)
    for name in ("training", "training, free offset"):
        told, known = found.metrics[name], whole.metrics[name]
        assert told.rms == pytest.approx(known.rms, rel=1e-4)
        assert told.max_abs == pytest.approx(known.max_abs, rel=1e-2)
        assert told.samples == known.samples
        assert told.nrmse_fit_percent == pytest.approx(known.nrmse_fit_percent, abs=0.1)
    assert found.used == whole.used
    assert found.description.provenance is not None
    assert whole.description.provenance is not None
    known_hash = whole.description.provenance.data_sha256
    assert found.description.provenance.data_sha256 == known_hash
    assert "of all 30500" in found.undetermined[0]


@pytest.mark.usefixtures("small")
def test_a_record_that_fits_into_the_part_is_read_whole() -> None:
    given = stream(5000)
    record = hyst.Record(given.u, given.y, given.dt, input_unit="V", output_unit="um")
    found = hyst.identify(given, delay=0, **ASKED)
    whole = hyst.identify(record, delay=0, **ASKED)
    assert found.parameter_values.tolist() == whole.parameter_values.tolist()


@pytest.mark.usefixtures("small")
@pytest.mark.parametrize(("signal", "name"), [("u", "input"), ("y", "output")])
def test_a_sample_that_is_none_is_named_however_far_in(signal: str, name: str) -> None:
    given = stream(20_000)
    getattr(given, signal)[17_321] = np.nan
    with pytest.raises(InputError, match=f"sample 17321 of the {name} is nan"):
        hyst.identify(given, delay=0, **ASKED)


@pytest.mark.usefixtures("small")
def test_a_part_that_shows_little_makes_the_verdict_say_so() -> None:
    t = 1e-3 * np.arange(40_000)
    u = t / t[-1] * np.sin(2.0 * np.pi * 3.0 * t) + np.linspace(0.0, 4.0, t.size)
    noise = 0.01 * np.random.default_rng(0).standard_normal(t.size)
    found = hyst.identify(Arrays(u, TRUE(u) + noise), delay=0, **ASKED)
    assert found.verdict.level != "good"
    assert "of the input's range" in found.verdict.sentences[0]


@pytest.mark.usefixtures("small")
def test_what_a_file_cannot_serve_is_refused() -> None:
    given = stream(30_000)
    with pytest.raises(NotIdentifiableError, match="depends on the rate"):
        hyst.identify(given, family="rdpi", plays=1, delay=0, creep=None, drift=False)
    given.u[:] = 1.0
    with pytest.raises(NotIdentifiableError, match="the input is constant"):
        hyst.identify(given, delay=0, **ASKED)


@pytest.mark.usefixtures("small")
def test_a_record_that_is_not_all_there_is_refused() -> None:
    class Short(Arrays):
        def chunks(self, samples: int) -> Iterator[tuple[Array, Array]]:
            yield from itertools.islice(super().chunks(samples), 11)

    class Once(Arrays):
        def chunks(self, samples: int) -> Iterator[tuple[Array, Array]]:
            whole = super().chunks(samples)
            yield from itertools.islice(whole, None if asked.append(0) or len(asked) == 1 else 17)

    class Uneven(Arrays):
        def chunks(self, samples: int) -> Iterator[tuple[Array, Array]]:
            for number, (u, y) in enumerate(super().chunks(samples)):
                yield u, y[1:] if number == 7 else y

    given, asked = stream(20_000), list[int]()
    with pytest.raises(InputError, match="has 20000 samples, but 11000 were read"):
        hyst.identify(Short(given.u, given.y), delay=0, **ASKED)
    with pytest.raises(InputError, match="has 20000 samples, but 17000 were read"):
        hyst.identify(Once(given.u, given.y), delay=0, **ASKED)
    with pytest.raises(InputError, match="from sample 7000 on, 1000 samples of the input were"):
        hyst.identify(Uneven(given.u, given.y), delay=0, **ASKED)


@pytest.mark.usefixtures("small")
def test_a_fit_that_is_ended_tells_what_was_left_to_go(monkeypatch: pytest.MonkeyPatch) -> None:
    given = stream(30_000)
    whole = hyst.identify(given, delay=0, **ASKED)
    monkeypatch.setattr(identify_stream, "MOST_STEPS", 0)
    ended = hyst.identify(given, delay=0, **ASKED)
    assert whole.status == "converged"
    assert ended.status == "iteration limit"
    assert ended.verdict.level == "fair"
    assert any("a further one moves constants by up to" in each for each in ended.undetermined)
    # One Gauss-Newton step from the fit to a fifth of the samples goes nearly all the way.
    moved = np.abs(whole.parameter_values - ended.parameter_values)
    assert (moved <= 1.1 * ended.standard_errors).all()
    assert (ended.standard_errors > 1.2 * whole.standard_errors).any()


@pytest.mark.usefixtures("small")
def test_more_samples_never_hurt() -> None:
    u = 0.9 * np.sin(np.linspace(0.0, 40.0, 4000)) * np.linspace(1.0, 0.2, 4000)
    errors = {samples: list[float]() for samples in (7_500, 30_000, 120_000)}
    for seed in range(3):
        for samples, each in errors.items():
            found = hyst.identify(stream(samples, seed=seed), delay=0, **ASKED)
            each.append(float(np.std(found.model(u) - TRUE(u))))
    least, middle, most = (np.mean(np.square(each)) for each in errors.values())
    assert middle < least
    assert most < middle


def test_arrays_are_a_stream_and_a_record_is_none() -> None:
    assert isinstance(stream(10), RecordStream)
    assert not isinstance(hyst.Record([0.0, 1.0], [0.0, 1.0], 1.0), RecordStream)
    assert identify_stream.MOST_STEPS > 0
