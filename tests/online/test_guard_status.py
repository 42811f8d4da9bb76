"""The guard of any estimator: what it says, over which windows, and what it saves."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hyst
from hyst.online import AdaptiveInverse, JointEstimator, ScaleEstimator
from online.plants import DT, P, R
from reference.examples import EXAMPLES

P0 = 0.3
_NUMBER = r"(\d[\d.]*(?:e[+-]\d+)?)"


def parsed(status: str) -> dict[str, Any]:
    """Read what a status says; what it says twice it must say alike."""
    trusted = re.match(
        r"commands come from the estimate(?:, doubted .* does not)?; in the last window of \S+ s "
        rf"it missed the output by {_NUMBER} rms, the last good model by {_NUMBER};",
        status,
    )
    fallen = re.match(
        rf"commands come from the last good model, which missed the output by {_NUMBER} rms in the "
        rf"last window of \S+ s; the estimate(?:, doubted .* does not,)? missed it by {_NUMBER},",
        status,
    )
    first = re.match(r"commands come from the (estimate); nothing is judged yet; ", status)
    assert sum(each is not None for each in (trusted, fallen, first)) == 1, status
    numbers = None
    if trusted is not None:
        numbers = float(trusted.group(1)), float(trusted.group(2))
    if fallen is not None:
        numbers = float(fallen.group(2)), float(fallen.group(1))
    doubted = re.findall(r"doubted for (\d+) window", status)
    return {
        "trusts": fallen is None,
        "numbers": numbers,
        "doubts": int(doubted[0]) if doubted else 0,
        "restarted": "just been restarted" in status,
        "waits": "not yet trusted" in status,
    }


@pytest.mark.parametrize("seed", range(12))
def test_the_status_never_says_two_things_that_contradict_each_other(seed: int) -> None:
    rng = np.random.default_rng(seed)
    model = hyst.PrandtlIshlinskii([0.5, 0.3], [1.0, 2.0], 1.0)
    estimator = (JointEstimator, ScaleEstimator)[seed % 2](model, dt=DT, memory=0.3)
    inverse = AdaptiveInverse(estimator, window=None if seed % 3 == 0 else 0.1)
    plant, gain, noise, lost = model.stepper(), 1.0, 0.0, False
    errors, ended, said = [], 0, set()
    for k in range(3000):
        if k % 150 == 0:  # a new piece: good, drifted, noisy, broken, upside down, stuck or lost
            gain = float(rng.choice([1.0, 1.0, 1.3, 0.6, -1.0, 0.0]))
            noise = float(rng.choice([0.0, 0.0, 0.05, 30.0]))
            lost = bool(rng.uniform() < 0.1)
        u = inverse.command(5.0 * math.sin(2.0 * math.pi * k / 50.0))
        y = gain * plant(u) + noise * rng.standard_normal()
        judgement, fallbacks, trusted = (
            inverse.judgement,
            inverse.fallbacks,
            inverse.trusts_estimate,
        )
        inverse.update(u, math.nan if lost else y)
        told = parsed(inverse.status)
        said.add((told["trusts"], told["restarted"]))
        assert told["trusts"] == inverse.trusts_estimate
        assert told["doubts"] == inverse.doubts
        # Restarted is what only a guard that has fallen back can be, and then it does not wait.
        assert told["restarted"] + told["waits"] == (not told["trusts"])
        if not lost:
            errors.append(inverse.error)  # of the model that was trusted, before it learnt
        if inverse.judgement is judgement:
            # While nothing is judged nothing else is said.
            assert (inverse.fallbacks, inverse.trusts_estimate) == (fallbacks, trusted)
            continue
        ended += 1
        assert told["restarted"] == (inverse.fallbacks == fallbacks + 1)
        # What it says the trusted one missed by in this window is that, to the three digits told.
        rms = float(np.sqrt(np.mean(np.square(errors))))
        assert told["numbers"] is not None
        assert told["numbers"][0 if trusted else 1] == pytest.approx(rms, rel=6e-3, abs=1e-300)
        errors = []
    assert ended >= 20
    assert len(said) >= 2  # it was trusted, and it was restarted


def test_a_gain_that_drifts_leaves_a_status_that_can_be_true() -> None:
    # The model is of another kind than the plant; the guard falls back while it drifts.
    truth = hyst.BoucWen(0.6, 0.35, 0.12, 0.06, h=-1.0)
    t = np.arange(12_000) * DT
    drive = 9.0 * np.sin(2.0 * np.pi * t[:3000])
    start = hyst.identify(hyst.Record(drive, truth(drive), DT), family="pi", plays=6).model
    inverse = AdaptiveInverse(JointEstimator(start, dt=DT, memory=2.0))
    plant, errors = truth.stepper(), np.zeros((2, t.size))
    frozen = start.inverse().stepper()
    other = truth.stepper()
    rng = np.random.default_rng(0)
    for k, y_ref in enumerate(3.0 * np.sin(2.0 * np.pi * t)):
        gain = 1.0 - 0.3 * k / t.size
        u = inverse.command(y_ref)
        y = gain * plant(u)
        errors[:, k] = y - y_ref, gain * other(frozen(y_ref)) - y_ref
        inverse.update(u, y + 0.01 * rng.standard_normal())
        assert "errors of 0 rms" not in inverse.status
    adaptive, fixed = np.sqrt(np.mean(errors[:, 4000:] ** 2, axis=1))
    # The gain is 20 percent off in the mean; six plays leave some 2 percent of such a plant.
    assert adaptive < fixed / 3.0
    # Left out, the window is the period of what is tracked, and told.
    assert inverse.window == pytest.approx(1.0, abs=2 * DT)
    assert "windows of 1 s, a period of the motion" in inverse.status


@pytest.mark.parametrize("name", ["bouc-wen", "preisach", "jiles-atherton", "inverse creep"])
def test_any_family_is_guarded(name: str, tmp_path: Path) -> None:
    model = EXAMPLES[name]
    dt = model.dt or DT
    inverse = AdaptiveInverse(ScaleEstimator(model, dt=dt, memory=100 * dt))
    plant = model.stepper()
    w = model(3.0 * np.sin(2.0 * np.pi * np.arange(400) / 80.0))
    middle, half = (w.max() + w.min()) / 2.0, 0.3 * float(np.ptp(w))
    errors = np.zeros(3000)
    for k in range(errors.size):
        y_ref = middle + half * math.sin(2.0 * math.pi * k / 80.0)
        u = inverse.command(y_ref)
        y = (1.0 - 0.3 * k / errors.size) * plant(u)
        inverse.update(u, y)
        errors[k] = y - y_ref
        if k == 2000:
            inverse.save(tmp_path / "guard.json")
            inverse = hyst.load(tmp_path / "guard.json")
    # 0.7 of the gain at the end: frozen the error would be 0.3 half; the lag is 100 samples' drift.
    assert np.abs(errors[-80:]).max() < 0.05 * half + 0.02 * abs(middle)
    assert inverse.window == pytest.approx(80 * dt)


@pytest.mark.parametrize("name", ["butterfly", "rate-dependent"])
def test_what_has_no_inverse_is_refused_with_the_reason(name: str) -> None:
    with pytest.raises(hyst.NotInvertibleError, match="but the estimate goes on"):
        AdaptiveInverse(ScaleEstimator(EXAMPLES[name]))


def test_a_lost_output_leaves_the_memory_of_the_input() -> None:
    start = hyst.BoucWen(0.6, 0.35, 0.12, 0.06, h=-1.0)
    for estimator in (ScaleEstimator(start), JointEstimator(hyst.PrandtlIshlinskii(P, R, P0))):
        inverse = AdaptiveInverse(estimator)
        plant = estimator.model.stepper()
        for k in range(1500):
            u = inverse.command(5.0 * math.sin(k / 40.0))
            y = plant(u)
            inverse.update(u, math.nan if 400 < k < 700 else y)
        assert inverse.estimator.counts["skipped"] == 299
        # The plant is the model, so a memory that is right leaves nothing but rounding.
        assert abs(inverse.error) < 1e-9


def test_windows_that_are_too_short_are_told() -> None:
    inverse = AdaptiveInverse(ScaleEstimator(hyst.PrandtlIshlinskii(P, R, P0), dt=DT), window=0.1)
    assert "windows of 0.1 s, as given" in inverse.status
    for k in range(4000):
        inverse.update(5.0 * math.sin(2.0 * math.pi * k / 1000.0), 0.0)
    assert "shorter than a period of the motion, 1 s" in inverse.status


@pytest.mark.parametrize(
    ("signal", "period"),
    [
        (lambda k: np.sin(2.0 * np.pi * k / 100.0 + 1.0), 100),
        (lambda k: 3.0 + np.abs((k / 200.0) % 1.0 - 0.5), 200),
        # An inner loop or a ripple is no period of the motion.
        (lambda k: np.sin(2.0 * np.pi * k / 600.0) + 0.5 * np.sin(2.0 * np.pi * k / 100.0), 600),
        # One that becomes smaller and slower is found again.
        (lambda k: np.where(k < 1500, np.sin(k / 16.0), 0.05 * np.sin(2 * np.pi * k / 300.0)), 300),
    ],
)
def test_the_window_is_a_period_of_the_motion(
    signal: Callable[[np.ndarray], np.ndarray], period: int
) -> None:
    inverse = AdaptiveInverse(ScaleEstimator(hyst.PrandtlIshlinskii(P, R, P0), dt=DT))
    assert inverse.window is None
    assert "waits for a period" in inverse.status
    for u in signal(np.arange(4000)).tolist():
        inverse.update(u, u)
    # A turn is where the largest sample is, which is one off at most.
    assert inverse.window == pytest.approx(period * DT, abs=1.5 * DT)


def test_a_motion_that_never_turns_is_not_waited_for() -> None:
    inverse = AdaptiveInverse(ScaleEstimator(hyst.PrandtlIshlinskii(P, R, P0), dt=DT))
    for k in range(10_001):
        inverse.update(1e-3 * k, 1e-3 * k)
    assert inverse.window == pytest.approx(10.0)
    assert "has not turned twice" in inverse.status
    assert inverse.judgement is not None


def test_a_file_of_before_there_were_other_estimators_is_read(tmp_path: Path) -> None:
    start = hyst.PrandtlIshlinskii(P, R, P0)
    inverse = AdaptiveInverse(JointEstimator(start, dt=DT, memory=0.5), window=0.5)
    plant = start.stepper()
    for k in range(1300):
        u = inverse.command(20.0 * math.sin(k / 50.0))
        inverse.update(u, 1.1 * plant(u))
    path = tmp_path / "inverse.json"
    inverse.save(path)
    content = json.loads(path.read_text())
    for name in ("motion", "judgement", "y_ref"):
        del content["settings"][name]
    for name in ("estimator", "fallback"):
        del content["settings"][name]["kind"]
    path.write_text(json.dumps(content))
    old = hyst.load(path)
    assert old.command(3.0) == inverse.command(3.0)
    assert "nothing is judged yet" in old.status
    assert old.window == 0.5


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"trusted": False}, "contradicts the guard"),
        ({"restarted": True}, "contradicts itself"),
        ({"estimate": -1.0}, "estimate is -1"),
        ({"doubts": -1}, "contradicts itself"),
    ],
)
def test_a_saved_judgement_that_cannot_be_is_refused(
    changes: dict[str, Any], message: str, tmp_path: Path
) -> None:
    start = hyst.PrandtlIshlinskii(P, R, P0)
    inverse = AdaptiveInverse(ScaleEstimator(start, dt=DT), window=0.1)
    for k in range(300):
        inverse.update(20.0 * math.sin(k / 50.0), 1.0)
    path = tmp_path / "inverse.json"
    inverse.save(path)
    content = json.loads(path.read_text())
    content["settings"]["judgement"] |= {"trusted": True, "restarted": False} | changes
    content["state"][4] = 1.0
    path.write_text(json.dumps(content))
    with pytest.raises(hyst.InputError, match=message):
        hyst.load(path)
