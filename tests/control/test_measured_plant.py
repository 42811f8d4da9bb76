"""A plant from a measured frequency response: with its delay and gain, as a design takes it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import control
import hyst
from hyst.cli.observer.spec import read_spec
from hyst.control import (
    TrackingController,
    design_sampled_q_filter,
    measured_plant,
    sampled_certificate,
    uncertainty_weight,
)
from hyst.errors import InputError, NotIdentifiableError
from hyst.signals import MeasuredResponse

DT, W = 1e-3, 2.0 * np.pi * 80.0
STAGE = hyst.LinearDynamics.from_continuous([W * W], [1.0, 0.1 * W, W * W], DT, delay=2)
F = np.geomspace(1.0, 480.0, 120)
# Of the input's unit: a slope of 2.5 of the hysteresis, and half a per cent of noise.
NOISE = 0.005 * np.random.default_rng(5).normal(size=(2, F.size))
RESPONSE = MeasuredResponse(F, 2.5 * STAGE.frequency_response(F) * (1.0 + NOISE[0] + 1j * NOISE[1]))


def test_the_plant_is_that_of_the_response_with_the_gain_asked_for() -> None:
    found = measured_plant(RESPONSE, DT, 1.0)
    assert found.dt == DT
    assert found.measured_gain == pytest.approx(2.5, rel=0.01)
    assert found.error < 0.02
    z = np.exp(2j * np.pi * F * DT)
    ours, true = found.system.response(z)[:, 0, 0], STAGE.frequency_response(F)
    # Noise of half a per cent at 120 frequencies, six numbers.
    assert np.abs(ours / true - 1.0).max() < 0.03
    as_measured = measured_plant(RESPONSE, DT)
    assert as_measured.measured_gain == found.measured_gain
    of_control = control.frd(RESPONSE.response, 2.0 * np.pi * F)
    same = measured_plant(of_control, DT, 1.0)
    np.testing.assert_allclose(same.system.response(z), found.system.response(z), rtol=1e-6)


def test_a_block_for_it_is_certified_around_the_true_plant() -> None:
    plant = measured_plant(RESPONSE, DT, 1.0)
    Wu = uncertainty_weight(plant.system, [RESPONSE], matched_at=1.0).system
    controller, Wp = ([15.0], [1.0, 0.0]), ([0.4, 4.0], [1.0, 0.1])
    design = design_sampled_q_filter(plant.system, controller, Wu, Wp, DT)
    block = TrackingController.from_continuous(controller, DT, observer=design)
    assert sampled_certificate(block, plant.system, Wu, Wp).robustly_stable
    # What it promises for plants within Wu holds for the true one.
    assert abs(hyst.control.closed_loop_poles(STAGE, block)[0]) < 1.0


def test_a_spec_names_the_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = np.column_stack([F, np.abs(RESPONSE.response), np.degrees(np.angle(RESPONSE.response))])
    header = "frequency [Hz],magnitude,phase [deg]"
    np.savetxt(tmp_path / "frf.csv", rows, delimiter=",", header=header, comments="", fmt="%.17g")
    (tmp_path / "spec.toml").write_text(
        """
        [plant]
        response = "frf.csv"
        [controller]
        num = [15.0]
        den = [1.0, 0.0]
        [weights]
        Wu = { responses = ["frf.csv"], matched_at = 1.0 }
        Wp = { num = [0.4, 4.0], den = [1.0, 0.1] }
        [internal_model]
        kind = "integrator"
        [hysteresis]
        p0 = 2.0
        p = [0.5]
        r = [1.0]
        [inverse]
        kind = "exact"
        [reference]
        sines = [[5.0, 2.0]]
        duration = 1.0
        [simulation]
        [filter]
        dt = 1e-3
        """,
        encoding="utf-8",
    )
    spec = read_spec(tmp_path / "spec.toml")
    assert spec.plant.dt == DT
    assert spec.design.time == "discrete"
    gain = spec.plant.response(np.ones(1, dtype=complex))[0, 0, 0].real
    assert gain == pytest.approx(1.0, rel=1e-9)
    assert "as measured, is 1" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ((STAGE, DT), "the response is LinearDynamics"),
        ((RESPONSE, 0.0), "dt is 0"),
        ((RESPONSE, DT, 0.0), "is to have 0; leave gain out"),
    ],
)
def test_refused(given: tuple[object, ...], says: str) -> None:
    with pytest.raises(InputError, match=says):
        measured_plant(*given)  # type: ignore[arg-type]


def test_noise_is_no_plant() -> None:
    rng = np.random.default_rng(1)
    noise = MeasuredResponse(F, rng.normal(size=F.size) + 1j * rng.normal(size=F.size))
    with pytest.raises(NotIdentifiableError, match="no order up to 12"):
        measured_plant(noise, DT)
