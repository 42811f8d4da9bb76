"""The measured piezo record: what a PI and a modified PI model must leave of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import hyst


@pytest.fixture(scope="module")
def piezo(measured_data: Path) -> hyst.Record:
    path = measured_data / "piezo-dbo" / "Model_Vi_Do.dat"
    return hyst.read_record(path, input=0, output=4, rate=200)


@pytest.mark.parametrize(("family", "most"), [("pi", 0.72), ("mpi", 0.45), ("gpi", 0.45)])
def test_training_error_in_percent_of_the_range_of_the_record(
    piezo: hyst.Record, family: str, most: float
) -> None:
    found = hyst.identify(piezo, family=family)
    # The piezo creeps by half a micrometre; a model of hysteresis can only be right beside that.
    left_in = found.metrics["training, disturbances left in"]
    assert left_in.rms_percent <= most
    assert found.metrics["training"].rms_percent < 0.9 * left_in.rms_percent
    error = found.predict(piezo.u) - piezo.y
    used = slice(found.used[0].start, found.used[0].stop)
    by_hand = 100.0 * np.sqrt(np.mean(error[used] ** 2)) / np.ptp(piezo.y)
    assert left_in.rms_percent == pytest.approx(by_hand, rel=1e-9)


@pytest.mark.parametrize("unit", [1.0, 1e-9, 1.7])
def test_a_damper_is_matched_in_any_unit(measured_data: Path, unit: float) -> None:
    """Its plays of opposite signs lie close together; left out alone, one cost a fifth of the fit.

    Three plays leave 9.6 % of the range and one 11.4 %.
    """
    path = measured_data / "mr-damper" / "ensaio.B.8.mat"
    measured = hyst.read_record(path, input="dist", output="forc", rate=100, repair=True)
    scaled = hyst.Record(unit * measured.u, measured.y, measured.dt)
    found = hyst.identify(scaled, family="gpi", plays=3)
    assert found.metrics["training"].rms_percent < 9.7


def test_the_delay_is_seen_at_the_turning_points(piezo: hyst.Record) -> None:
    """Averaged over the cycles the output turns three to four samples after the input."""
    cycles = slice(400, 400 + 38 * 200)
    u, y = (signal[cycles].reshape(38, 200).mean(axis=0) for signal in (piezo.u, piezo.y))
    # A parabola through 13 samples around each turning point gives it to a fraction of one.
    lags = []
    for sign in (1.0, -1.0):
        places = []
        for signal in (sign * u, sign * y):
            near = int(signal.argmax()) + np.arange(-6, 7)
            a, b, _ = np.polyfit(near, signal[near], 2)
            places.append(-b / (2.0 * a))
        lags.append(places[1] - places[0])
    found = hyst.identify(piezo, family="pi", plays=3)
    assert found.delay == round(float(np.mean(lags)))


def test_the_start_up_transient_is_left_out(piezo: hyst.Record) -> None:
    found = hyst.identify(piezo, family="pi", plays=3)
    assert 100 < found.used[0].start < 300


def test_a_model_of_the_first_half_predicts_the_second(piezo: hyst.Record) -> None:
    first, second = piezo.slice(0, 4000), piezo.slice(4000, len(piezo))
    found = hyst.identify(first, family="mpi", validation=second)
    assert found.metrics["validation, free offset"].rms_percent < 0.45


def test_the_inverse_undoes_the_model(piezo: hyst.Record) -> None:
    found = hyst.identify(piezo, family="mpi")
    y_ref = -100.0 + 15.0 * np.sin(np.linspace(0.0, 30.0, 3000))
    y = found.model(found.model.inverse()(y_ref))
    assert np.abs(y - y_ref).max() < 1e-12 * np.ptp(piezo.y) * 100
