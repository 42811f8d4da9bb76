"""A fleet's shape is estimated, kept in a file, and identifies devices from few samples."""

from __future__ import annotations

import json
import pickle
from pathlib import Path

import numpy as np
import pytest

import hyst
from hyst.errors import InputError, NotIdentifiableError
from hyst.fleet import SharedShape

TYPICAL = hyst.PrandtlIshlinskii([0.5, 0.4, 0.3], [0.08, 0.22, 0.5], p0=1.0)
NOISE = 0.01


def drive(samples: int) -> np.ndarray:
    phase = np.linspace(0.0, 5.0 * np.pi, samples)
    return np.sin(phase) * np.linspace(1.0, 0.4, samples)


def measured(device: hyst.Operator, samples: int, seed: int) -> hyst.Record:
    u = drive(samples)
    noise = NOISE * np.random.default_rng(seed).standard_normal(samples)
    return hyst.Record(u, device(u) + noise, dt=1e-3)


def of_gain(gain: float) -> hyst.Operator:
    return TYPICAL.in_units(1.0, gain)


def fleet(count: int = 24) -> list[hyst.Record]:
    gains = 1.0 + 0.05 * np.random.default_rng(3).standard_normal(count)
    return [measured(of_gain(gain), 300, seed) for seed, gain in enumerate(gains)]


@pytest.fixture(scope="module")
def shape() -> SharedShape:
    return SharedShape.estimate(TYPICAL, fleet())


def test_one_scatter_of_the_gain_is_found_as_one_direction(shape: SharedShape) -> None:
    gains = 1.0 + 0.05 * np.random.default_rng(3).standard_normal(24)
    assert max(shape.scatter, key=lambda name: shape.scatter[name]) == "gain"
    assert shape.scatter["gain"] == pytest.approx(np.std(gains, ddof=1), rel=0.15)
    assert sum(value for name, value in shape.scatter.items() if name != "gain") < 0.01


def test_two_hundred_samples_give_what_the_known_shape_would(shape: SharedShape) -> None:
    u = drive(3000)
    ratios = []
    for seed, gain in enumerate((0.92, 0.97, 1.0, 1.04, 1.09), start=100):
        found = shape.identify(measured(of_gain(gain), 200, seed))
        error = found.model(u) - of_gain(gain)(u)
        ratios.append(float(np.sqrt(np.mean(error**2))) / NOISE)
    # With everything but one gain known, an error of noise / sqrt(200) would be left: 0.07.
    assert np.sqrt(np.mean(np.square(ratios))) < 0.2


def test_file_gives_every_number_back(shape: SharedShape, tmp_path: Path) -> None:
    path = tmp_path / "shape.json"
    shape.save(path)
    again = SharedShape.load(path)
    assert again.to_dict() == shape.to_dict()
    assert json.loads(json.dumps(shape.to_dict())) == shape.to_dict()
    record = measured(of_gain(1.03), 200, 7)
    assert again.identify(record).model == shape.identify(record).model


def test_device_of_another_kind_is_told(shape: SharedShape) -> None:
    u = drive(200)
    found = shape.identify(hyst.Record(u, np.tanh(3.0 * u) * 2.0, dt=1e-3))
    assert found.verdict.level == "unfit"
    assert any("no device of this fleet" in each for each in found.verdict.sentences)
    assert found.probability < 1e-9


def test_devices_of_another_kind_and_broken_records_do_not_count() -> None:
    u = drive(300)
    spoilt = fleet()
    spoilt[4] = hyst.Record(u, 2.0 * np.tanh(3.0 * u), dt=1e-3)
    spoilt[9] = hyst.Record(u, np.ones(300), dt=1e-3)
    spoilt[17] = measured(of_gain(2.0), 300, 5)
    found = SharedShape.estimate(TYPICAL, spoilt)
    assert set(found.left_out) == {4, 9, 17}
    assert "constant" in found.left_out[9]
    assert found.scatter["gain"] < 0.07


def test_plain_model_gives_scales_and_offset_without_a_fleet() -> None:
    device = hyst.Affine(1.0, 0.3) @ TYPICAL.in_units(1.2, 0.8)
    u = 1.2 * drive(200)
    record = hyst.Record(u, device(u), dt=1e-3)
    found = SharedShape.of_model(TYPICAL).identify(record)
    assert np.abs(found.predict(u) - record.y).max() < 1e-8
    assert np.isnan(found.distance)


def test_noisier_sensor_is_told_and_no_other_kind(shape: SharedShape) -> None:
    u = drive(200)
    noise = 0.1 * np.random.default_rng(5).standard_normal(200)
    found = shape.identify(hyst.Record(u, TYPICAL(u) + noise, dt=1e-3))
    assert found.verdict.level == "fair"
    assert any("times as noisy" in each for each in found.verdict.sentences)


def test_shape_that_lacks_something_says_so() -> None:
    poor = SharedShape.estimate(hyst.PrandtlIshlinskii([0.8], [0.25], p0=1.2), fleet())
    found = poor.identify(measured(of_gain(1.0), 200, 8))
    assert found.verdict.level == "fair"
    assert any("The shape lacks" in each for each in found.verdict.sentences)


def test_result_goes_to_another_process(shape: SharedShape) -> None:
    record = measured(of_gain(1.02), 200, 9)
    found = shape.identify(record)
    there = pickle.loads(pickle.dumps(shape)).identify(record)
    assert pickle.loads(pickle.dumps(there)).to_dict() == found.to_dict()


def test_what_cannot_be_used_is_refused(shape: SharedShape) -> None:
    with pytest.raises(InputError, match="give an operator"):
        SharedShape.estimate("pi", fleet(6))  # type: ignore[arg-type]
    with pytest.raises(InputError, match="5 or more"):
        SharedShape.estimate(TYPICAL, fleet(4))
    with pytest.raises(InputError, match="no list of records"):
        SharedShape.estimate(TYPICAL, fleet(1)[0])  # type: ignore[arg-type]
    with pytest.raises(NotIdentifiableError, match="constant"):
        shape.identify(hyst.Record(drive(200), np.ones(200), dt=1e-3))
    with pytest.raises(InputError, match=r"give a hyst\.Record"):
        shape.identify([1.0, 2.0])  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"version": 2}, "this hyst reads version 1"),
        ({"basis": [[1.0]]}, "rows"),
        ({"spare": 1}, "unknown entry 'spare'"),
        ({"output_range": 0.0}, "output_range"),
        ({"left_out": {"one": "why"}}, "whole number"),
    ],
)
def test_damaged_files_are_refused(
    shape: SharedShape, change: dict[str, object], sentence: str
) -> None:
    with pytest.raises(InputError, match=sentence):
        SharedShape.from_dict(shape.to_dict() | change)


def test_covariance_that_is_none_is_refused(shape: SharedShape) -> None:
    data = shape.to_dict()
    data["population"]["covariance"][0][0] = -1.0
    with pytest.raises(InputError, match="negative eigenvalue"):
        SharedShape.from_dict(data)


def test_model_file_is_no_shape(tmp_path: Path) -> None:
    TYPICAL.save(tmp_path / "model.json")
    with pytest.raises(InputError, match="not a shared shape file"):
        SharedShape.load(tmp_path / "model.json")
