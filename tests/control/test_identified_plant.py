"""Plant, hysteresis, sample time and delay from what was identified, in memory and in a file."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from identified_cases import DT, PI, G, W, drive, found

import hyst
from hyst.control import (
    TrackingController,
    as_linear_system,
    identified_plant,
    sampled_plant,
    simulate_closed_loop,
)
from hyst.models import Delay, LinearDynamics

F = np.array([5.0, 60.0, 120.0, 300.0, 900.0])


def test_a_result_its_model_and_its_file_give_the_same_plant(tmp_path: Path) -> None:
    identified = found()
    identified.model.save(tmp_path / "model.json")
    plants = [
        identified_plant(each)
        for each in (
            identified,
            identified.model,
            tmp_path / "model.json",
            f"{tmp_path}/model.json",
        )
    ]
    for each in plants:
        assert each.dynamics == identified.dynamics
        assert each.hysteresis == identified.hysteresis
        assert each.errors == plants[0].errors is not None
        assert (each.dt, each.delay) == (DT, 2 * DT)
        assert each.hysteresis.description.verdict == identified.verdict
        assert each.hysteresis.description.input_high == identified.description.input_high
        assert each.hysteresis.description.output_high is None  # of v nothing was measured
    assert plants[0].gain == pytest.approx(1.0, abs=1e-6)


def test_plant_behind_hysteresis_is_the_model() -> None:
    plant, u = identified_plant(found()), drive()[:500]
    v = plant.hysteresis(u)
    # The loop opened: v is the drive of the linear system, sample by sample.
    x, y = np.zeros((plant.system.order, 1)), []
    for each in v:
        y.append(float((plant.system.C @ x + plant.system.D * each)[0, 0]))
        x = plant.system.A @ x + plant.system.B * each
    np.testing.assert_allclose(y, found().model(u), rtol=1e-9, atol=1e-9 * np.ptp(u))


def test_the_plant_goes_wherever_a_linear_system_goes() -> None:
    plant = identified_plant(G @ PI)
    assert as_linear_system(plant) is plant.system
    assert sampled_plant(plant, DT).system.order == 4
    block = TrackingController.from_continuous(([20.0], [1.0, 0.0]), DT)
    loop = simulate_closed_loop(
        np.ones(200), DT, plant=plant, controller=block, hysteresis=plant.hysteresis
    )
    assert loop.diverged_at is None


def test_the_continuous_form_has_the_same_samples() -> None:
    plant = identified_plant(G @ PI)
    late = plant.continuous_plant()
    assert late.delay == pytest.approx(2 * DT, rel=1e-9)
    np.testing.assert_allclose(late.num, [W * W], rtol=1e-6)
    again = LinearDynamics.from_continuous(late.num, late.den, DT, late.delay / DT)
    np.testing.assert_allclose(again.frequency_response(F), G.frequency_response(F), rtol=1e-6)


@pytest.mark.parametrize("seed", range(3))
def test_zeros_far_beyond_half_the_rate_become_the_dead_time_they_are(seed: int) -> None:
    plant = identified_plant(found(seed, (2.0, 300.0)))
    assert plant.continuous is not None
    assert np.abs(plant.continuous.zeros()).min() > 3.0 * np.pi / DT  # noise made one
    simple = plant.continuous_plant()
    assert simple.zeros().size == 0
    off = simple.frequency_response(F) / plant.continuous.frequency_response(F) - 1.0
    # (w/a)^2 with a beyond three times half the rate, by Taylor: half of it is the bound.
    assert np.all(np.abs(off) < 0.5 * (F * DT * 2.0 / 3.0) ** 2)


def test_a_near_zero_in_the_right_half_plane_is_told_by_name() -> None:
    late = LinearDynamics.from_continuous([-W, W * W], [1.0, 0.1 * W, W * W], DT)
    plant = identified_plant(late @ PI)
    assert "nonminimum phase: zero 1.4" in plant.notes[0]  # exp(w dt) = 1.458
    with pytest.raises(hyst.InputError, match=rf"nonminimum phase.*zero at {W:.4g} 1/s"):
        plant.continuous_plant()


def test_a_plant_without_continuous_form_says_why() -> None:
    alternating = LinearDynamics.from_transfer_function([1.5], [1.0, 0.5], DT)
    plant = identified_plant(alternating @ PI)
    assert plant.continuous is None
    with pytest.raises(hyst.InputError, match=r"no continuous form.*negative real axis"):
        plant.continuous_plant()


@pytest.mark.parametrize("samples", [1.0, 0.25, 2.5])
def test_a_delay_beside_the_model_is_of_the_plant(samples: float) -> None:
    about = hyst.ModelDescription(dt=DT, delay=samples)
    plant = identified_plant((G @ PI).with_description(about))
    z = np.exp(2j * np.pi * F * DT)
    part = samples % 1.0
    by_hand = ((1.0 - part) + part / z) / z ** int(samples) * G.frequency_response(F)
    np.testing.assert_allclose(plant.dynamics.frequency_response(F), by_hand, rtol=1e-9)
    assert plant.hysteresis.description.delay == 0


def test_dynamics_and_delays_one_after_the_other_are_one_plant() -> None:
    second = LinearDynamics.from_transfer_function([0.2, 0.1], [1.0, -0.7], DT, 1)
    plant = identified_plant(Delay(1.5, DT) @ second @ G @ PI)
    z = np.exp(2j * np.pi * F * DT)
    by_hand = G.frequency_response(F) * second.frequency_response(F) * (0.5 + 0.5 / z) / z
    np.testing.assert_allclose(plant.dynamics.frequency_response(F), by_hand, rtol=1e-9)
    assert plant.hysteresis == PI


def test_dynamics_without_hysteresis_have_a_gain_of_one_in_front() -> None:
    plant = identified_plant(G)
    assert plant.dynamics == G
    assert plant.hysteresis(np.array([1.5, -2.0])).tolist() == [1.5, -2.0]


@pytest.mark.parametrize(
    ("source", "told"),
    [
        (PI, "holds no dynamics behind a hysteresis"),
        (PI @ G, "holds no dynamics behind a hysteresis"),
        (G @ PI @ G, "dynamics of 2 states before or amid its hysteresis"),
        (
            LinearDynamics.from_transfer_function([0.1], [1.0, -1.1], DT) @ PI,
            r"not stable: pole 1\.1 in the plane of z, of modulus 1\.1",
        ),
        (
            (G @ PI).with_description(hyst.ModelDescription(delay=-0.7)),
            r"0\.7 samples ahead of the input",
        ),
        (
            (G @ PI).with_description(hyst.ModelDescription(dt=1e-3)),
            r"dt = 0\.0005 s and a record of 0\.001 s",
        ),
        (3, "the plant is a int"),
        ("nowhere.json", "nowhere.json: cannot be read"),
    ],
)
def test_what_holds_no_plant_is_refused_by_name(source: Any, told: str) -> None:
    with pytest.raises(hyst.InputError, match=told):
        identified_plant(source)


def test_files_of_other_things_are_refused(tmp_path: Path) -> None:
    block = hyst.control.TrackingController.from_continuous(([1.0], [1.0, 0.0]), DT)
    block.save(tmp_path / "controller.json")
    with pytest.raises(hyst.InputError, match="holds a tracking-controller"):
        identified_plant(tmp_path / "controller.json")


def test_files_of_before_have_a_plant_and_no_errors(tmp_path: Path) -> None:
    about = replace(found().model.description, dynamics_errors=None)
    path = tmp_path / "model.json"
    found().model.with_description(about).save(path)
    content = json.loads(path.read_text(encoding="utf-8"))
    assert content["version"] == 3  # as before there were errors of dynamics
    plant = identified_plant(path)
    assert plant.errors is None
    assert plant.dynamics == found().dynamics
    with pytest.raises(hyst.InputError, match="does not tell how well its dynamics are known"):
        hyst.control.identification_weight(plant)


def test_errors_of_dynamics_need_the_version_that_has_them(tmp_path: Path) -> None:
    path = tmp_path / "model.json"
    found().model.save(path)
    content = json.loads(path.read_text(encoding="utf-8"))
    assert content["version"] == 4
    path.write_text(json.dumps(content | {"version": 3}), encoding="utf-8")
    with pytest.raises(hyst.InputError, match="unknown entry 'dynamics_errors'"):
        identified_plant(path)


def test_errors_of_dynamics_are_not_those_of_an_inverse_or_of_other_constants() -> None:
    about = found().model.description
    assert about.dynamics_errors is not None
    assert about.of_inverse().dynamics_errors is None
    assert about.of_other_constants().dynamics_errors is None
    assert about.of_estimate().dynamics_errors is None
