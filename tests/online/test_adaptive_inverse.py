"""The inverse that follows the estimate."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hyst
from hyst import _engine
from hyst.online import AdaptiveInverse, JointEstimator, ScaleEstimator
from online.plants import DT, P, R

P0 = 0.3


def drifting(samples: int) -> tuple[np.ndarray, np.ndarray]:
    """Weight 3 and radius 4 grow by 30 %."""
    p, r = np.tile(P, (samples, 1)), np.tile(R, (samples, 1))
    growth = 1.0 + 0.3 * np.arange(samples) / samples
    p[:, 2] *= growth
    r[:, 3] *= growth
    return p, r


def test_tracks_a_drift_five_times_better_than_the_frozen_inverse() -> None:
    samples = 60_000
    p, r = drifting(samples)
    y_ref = 50.0 * np.sin(2 * np.pi * np.arange(samples) * DT)
    start = hyst.PrandtlIshlinskii(P, R, P0)
    noise = float(np.std(y_ref)) * 10.0 ** (-30.0 / 20.0)
    scatter = noise * np.random.default_rng(0).standard_normal(samples)
    estimator = JointEstimator(start, dt=DT, memory=5.0, radius_spread=0.3, noise=noise)
    inverse, frozen = AdaptiveInverse(estimator, window=2.0), start.inverse().stepper()
    errors = np.zeros((2, samples))
    z = np.zeros((2, 5))
    for k in range(samples):
        for way, u in enumerate((inverse.command(y_ref[k]), frozen(y_ref[k]))):
            z[way] = np.clip(z[way], u - r[k], u + r[k])
            y = P0 * u + float(p[k] @ z[way])
            errors[way, k] = y - y_ref[k]
            if way == 0:
                inverse.update(u, y + scatter[k])
    adaptive, fixed = np.sqrt(np.mean(errors[:, samples // 6 :] ** 2, axis=1))
    assert adaptive < fixed / 5.0


def test_command_and_model_belong_together() -> None:
    rng = np.random.default_rng(3)
    estimator = JointEstimator(
        hyst.GeneralizedPrandtlIshlinskii(
            hyst.DeadZone([1.0, -0.3, 0.4], [0.0, 1.0, -1.5]),
            hyst.PrandtlIshlinskii([0.5, 0.3], [0.5, 1.2], 1.0),
        ),
        estimate_maps=True,
        least_slope=0.1,
    )
    for _ in range(300):
        estimator.update(rng.normal(0.0, 3.0), rng.normal(0.0, 5.0))
        # The model carries the estimator's memory: one step of its own inverse is the command.
        y_ref = rng.normal(0.0, 5.0)
        u = estimator.command(y_ref)
        assert estimator.model([u])[0] == pytest.approx(y_ref, abs=1e-7)
        assert estimator.model.inverse()([y_ref])[0] == pytest.approx(u, rel=1e-6, abs=1e-6)


def test_a_broken_sensor_makes_it_fall_back_to_the_last_good_model() -> None:
    start = hyst.PrandtlIshlinskii(P, R, P0)
    plant = start.stepper()
    inverse = AdaptiveInverse(JointEstimator(start, dt=DT, memory=0.2), window=1.0)
    y_ref = 50.0 * np.sin(2 * np.pi * np.arange(12_000) * DT)
    rng = np.random.default_rng(0)
    worst = 0.0
    for k, wanted in enumerate(y_ref):
        u = inverse.command(wanted)
        y = plant(u)
        measured = y if k < 4000 else rng.normal(0.0, 100.0) if k < 8000 else y
        inverse.update(u, measured)
        worst = max(worst, abs(y - wanted)) if k > 11_000 else worst
    # 3 s after the repair; the amplitude is 50.
    assert worst < 1.0
    assert inverse.fallbacks >= 4
    assert inverse.trusts_estimate
    assert inverse.good_model.is_invertible()


def test_saved_and_restored_it_continues_with_the_same_bits(tmp_path: Path) -> None:
    start = hyst.PrandtlIshlinskii(P, R, P0)
    y_ref = 50.0 * np.sin(2 * np.pi * np.arange(6000) * DT)
    scatter = np.random.default_rng(1).normal(0.0, 1.0, y_ref.size)
    # A sensor broken for a while, so that the guard has fallen back when it is saved.
    scatter[1000:2600] *= 100.0
    truth = hyst.PrandtlIshlinskii(1.1 * P, 0.9 * R, P0)
    inverse = AdaptiveInverse(JointEstimator(start, dt=DT, memory=0.5), window=0.5)
    plant = truth.stepper()
    for k in range(2500):
        u = inverse.command(y_ref[k])
        inverse.update(u, plant(u) + scatter[k])
    inverse.save(tmp_path / "inverse.json")
    restored = hyst.load(tmp_path / "inverse.json")
    assert isinstance(restored, AdaptiveInverse)
    assert not restored.trusts_estimate
    assert restored.fallbacks == inverse.fallbacks > 0
    copy = truth.stepper(plant.state)
    commands = np.zeros((2, y_ref.size))
    for k in range(2500, y_ref.size):
        for way, (each, follows) in enumerate(((inverse, plant), (restored, copy))):
            u = each.command(y_ref[k])
            commands[way, k] = u
            each.update(u, follows(u) + scatter[k])
    assert commands[0].tobytes() == commands[1].tobytes()
    assert restored.model == inverse.model
    assert restored.good_model == inverse.good_model
    assert restored.status == inverse.status


def test_a_saved_inverse_that_cannot_be_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "inverse.json"
    AdaptiveInverse(JointEstimator(hyst.PrandtlIshlinskii(P, R, P0), dt=DT), window=1.0).save(path)
    content = json.loads(path.read_text())
    for changes, message in (
        ({"state": [-1.0, *content["state"][1:]]}, "counts out of range"),
        ({"state": [1.0]}, "1 entries"),
        ({"settings": {**content["settings"], "window": -1.0}}, "window is -1.0"),
        ({"settings": {**content["settings"], "good": 5}}, "entry 'kind'"),
        ({"settings": {}}, "damaged"),
    ):
        path.write_text(json.dumps({**content, **changes}))
        with pytest.raises(hyst.InputError, match=message):
            hyst.load(path)


def test_an_estimate_in_doubt_does_not_become_the_last_good_model() -> None:
    # Plays cannot make this plant, so what is left is no noise; the guard counts and says so.
    start = hyst.PrandtlIshlinskii(P, R, P0)
    inverse = AdaptiveInverse(JointEstimator(start, dt=DT, memory=1.0), window=1.0)
    plant = start.stepper()
    for k in range(6000):
        u = inverse.command(50.0 * np.sin(2 * np.pi * k * DT))
        w = plant(u)
        inverse.update(u, w + 1e-3 * w**2)
    assert inverse.doubts == 6
    assert "doubted for 6 windows" in inverse.status
    # A plant of plays leaves nothing to doubt.
    for k in range(6000, 11_000):
        u = inverse.command(50.0 * np.sin(2 * np.pi * k * DT))
        inverse.update(u, plant(u))
    assert inverse.doubts == 0
    assert "doubted" not in inverse.status


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"window": 1.0, "margin": "a"}, "margin is 'a'"),
        ({"window": 1.0, "margin": 1.0}, "margin is 1.0; give a ratio above 1"),
        ({"window": "a"}, "window is 'a'"),
        ({"window": 0.0}, "window is 0.0"),
    ],
)
def test_arguments_that_make_no_sense(options: dict[str, Any], message: str) -> None:
    with pytest.raises(hyst.InputError, match=message):
        AdaptiveInverse(JointEstimator(hyst.PrandtlIshlinskii(P, R, P0)), **options)
    with pytest.raises(hyst.InputError, match="give a JointEstimator, a ScaleEstimator"):
        AdaptiveInverse(5, window=1.0)  # type: ignore[arg-type]


def test_engine_runs_a_record_to_the_same_bits() -> None:
    u = 30.0 * np.sin(np.arange(3000) / 100.0)
    y = hyst.PrandtlIshlinskii(P, R, P0)(u)
    by_sample = JointEstimator(hyst.PrandtlIshlinskii(P, 1.2 * R, P0))
    by_record = JointEstimator(hyst.PrandtlIshlinskii(P, 1.2 * R, P0))
    for u_k, y_k in zip(u, y, strict=True):
        by_sample.update(u_k, y_k)
    trajectory = by_record.run(hyst.Record(u, y, 1.0), every=100)
    places = _engine.JointEstimation(5, [1.0] * 12, [], [], 1.0, 2.0).places()
    assert by_sample.state[: places["psi"]].tobytes() == by_record.state[: places["psi"]].tobytes()
    assert trajectory.values[-1].tobytes() == by_record.parameters.tobytes()
    assert trajectory.standard_errors[-1] == pytest.approx(by_record.standard_errors, rel=1e-9)
    assert trajectory.of("r[5]").size == 30


def test_started_anew_a_scale_counts_samples_from_there_on() -> None:
    model = hyst.BoucWen(0.6, 0.35, 0.12, 0.06)
    u = 6.0 * np.sin(np.arange(400) / 16.0)
    estimator = ScaleEstimator(model)
    estimator.run(hyst.Record(u, model(u), 1.0))
    estimator.restart()
    assert "400 samples" not in str(estimator.knowledge)


@pytest.mark.parametrize("gain", [0.0, -1.0])
def test_a_sensor_that_dies_or_turns_round_moves_no_command(gain: float) -> None:
    plant = hyst.PrandtlIshlinskii([0.5, 0.3], [1.0, 2.0], 1.0)
    inverse = AdaptiveInverse(hyst.online.ScaleEstimator(plant, memory=300), window=400)
    rng = np.random.default_rng(4)
    actuator, frozen = plant.stepper(), plant.inverse().stepper()
    worst = 0.0
    for k in range(8000):
        y_ref = 4.0 * math.sin(k / 30.0)
        u, alone = inverse.command(y_ref), frozen(y_ref)
        worst = max(worst, abs(u - alone)) if k >= 3600 else 0.0
        y = actuator(u)
        inverse.update(u, (gain if k > 3000 else 1.0) * y + 0.01 * rng.standard_normal())
    assert not inverse.trusts_estimate
    assert "ran to its bound (least)" in inverse.status
    # 3 % of the range: commands are those of a model from before.
    assert worst < 0.15
