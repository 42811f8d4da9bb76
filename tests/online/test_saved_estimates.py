"""Joint estimators that are saved, restored and continued, and files that none can have written."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import hyst
from hyst.online import JointEstimator
from online.plants import DT, FIVE_PLAYS, P, R, record, sine


def test_saved_and_restored_it_continues_with_the_same_bits(tmp_path: Path) -> None:
    u = sine(2.0)
    y = FIVE_PLAYS(u) + 0.1 * np.random.default_rng(2).standard_normal(u.size)
    whole = JointEstimator(hyst.PrandtlIshlinskii(1.2 * P, 0.8 * R), dt=DT, memory=10.0)
    whole.run(record(u, y))
    part = JointEstimator(hyst.PrandtlIshlinskii(1.2 * P, 0.8 * R), dt=DT, memory=10.0)
    part.run(record(u[:777], y[:777]))
    part.save(tmp_path / "estimator.json")
    restored = hyst.load(tmp_path / "estimator.json")
    assert isinstance(restored, JointEstimator)
    for u_k, y_k in zip(u[777:], y[777:], strict=True):
        restored.update(u_k, y_k)
    assert restored.parameters.tobytes() == whole.parameters.tobytes()
    assert restored.covariance.tobytes() == whole.covariance.tobytes()
    assert restored.model == whole.model


def test_an_overflow_does_not_keep_it_from_being_saved(tmp_path: Path) -> None:
    estimator = JointEstimator(FIVE_PLAYS, least_slope=1e-3)
    u = sine(1.0)
    for u_k in (*u[:300], 1e300, -1e308):
        estimator.update(u_k, 2.0 * u_k)
    assert estimator.counts["refused"] > 0
    estimator.save(tmp_path / "estimator.json")
    restored = hyst.load(tmp_path / "estimator.json")
    assert isinstance(restored, JointEstimator)
    for u_k in u[300:]:
        for each in (estimator, restored):
            each.update(u_k, 2.0 * u_k)
    assert restored.state.tolist() == estimator.state.tolist()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"p0": 0.0}, "p0 = 0, outside"),
        ({"p0": -0.1}, "p0 = -0.1, outside"),
        # 0.2 + 0.3 - 0.6 is below 0, though the weights up to p[5] sum to 1.2 again.
        ({"p0": 0.2, "p[2]": -0.6}, r"up to p\[2\] = -0.1, outside"),
        ({"p[5]": 1e9}, r"up to p\[5\] = 1e\+09, outside"),
        ({"r[1]": -0.4}, r"r\[1\] = -0.4 below 0"),
        ({"r[3]": 0.5}, r"r\[3\] = 0.5 below r\[2\] = 1"),
        ({"r[5]": 1e9}, r"r\[5\] = 1e\+09 above most_radius"),
        ({"front[2]": -2.0}, "cannot be inverted"),
        ({"front[1]": -1.0, "front[2]": -0.2}, "front map that falls"),
    ],
)
def test_a_saved_estimate_that_cannot_be_inverted_is_refused(
    changes: dict[str, float], message: str, tmp_path: Path
) -> None:
    path = tmp_path / "estimator.json"
    start = hyst.PrandtlIshlinskii(P, R, 0.2) @ hyst.DeadZone([1.0, 0.2], [0.0, 5.0])
    estimator = JointEstimator(start)
    estimator.save(path)
    content = json.loads(path.read_text())
    first = content["state"].index(0.2)
    assert content["state"][first : first + 6] == [0.2, *P]
    hyst.load(path)
    for name, value in changes.items():
        content["state"][first + estimator.names.index(name)] = value
    path.write_text(json.dumps(content))
    with pytest.raises(hyst.InputError, match=message) as refused:
        hyst.load(path)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("place", "value", "message"),
    [
        ("d", -1.0, "the variance -1"),
        ("z", 50.0, "play 1 farther"),
        ("side", 0.5, "plays on no side"),
        ("age", -3.0, "ages out of range"),
        ("scalars", 7.0, "at stage 7"),
        ("length", 1.0, "entries"),
        ("skipped", -2.0, "counts below 0"),
        ("noise", 0.0, "noise variance 0"),
    ],
)
def test_a_saved_state_that_none_can_have_reached_is_refused(
    place: str, value: float, message: str, tmp_path: Path
) -> None:
    path = tmp_path / "estimator.json"
    estimator = JointEstimator(FIVE_PLAYS, dt=DT)
    u = sine(0.4)
    estimator.run(record(u, FIVE_PLAYS(u)))
    estimator.save(path)
    hyst.load(path)
    content = json.loads(path.read_text())
    at = {**estimator._at, "noise": 2, "skipped": 6}
    if place == "length":
        content["state"].append(value)
    else:
        content["state"][at[place]] = value
    path.write_text(json.dumps(content))
    with pytest.raises(hyst.InputError, match=message):
        hyst.load(path)


def test_restarted_saved_and_restored_it_restarts_from_the_same(tmp_path: Path) -> None:
    u = sine(1.0)
    y = FIVE_PLAYS(u)
    estimator = JointEstimator(hyst.PrandtlIshlinskii(1.2 * P, R), dt=DT)
    estimator.run(record(u, y))
    estimator.restart(hyst.PrandtlIshlinskii(0.9 * P, 1.1 * R))
    estimator.save(tmp_path / "estimator.json")
    restored = hyst.load(tmp_path / "estimator.json")
    assert isinstance(restored, JointEstimator)
    for each in (estimator, restored):
        each.restart()
        each.run(record(u, y))
    assert restored.state.tobytes() == estimator.state.tobytes()


@pytest.mark.parametrize(
    "other",
    [
        hyst.PrandtlIshlinskii([0.5, 0.1], [1.0, 2.0], 1.0),
        hyst.Affine(2.0, 0.0) @ FIVE_PLAYS,
        FIVE_PLAYS @ hyst.Affine(2.0, 0.0),
        FIVE_PLAYS @ hyst.DeadZone([1.0, 0.2], [0.0, 5.0]),
    ],
)
def test_it_does_not_restart_from_a_model_of_another_kind(other: hyst.operators.Operator) -> None:
    estimator = JointEstimator(FIVE_PLAYS, dt=DT)
    before = estimator.state.copy()
    with pytest.raises(hyst.InputError, match="other plays, thresholds or gains"):
        estimator.restart(other)
    assert estimator.state.tobytes() == before.tobytes()


def test_no_estimate_on_its_bounds_is_taken_for_tampered(tmp_path: Path) -> None:
    # Outputs that fit no model of plays push weights and radii to their bounds again and again.
    rng = np.random.default_rng(7)
    estimator = JointEstimator(FIVE_PLAYS, memory=50.0, most_radius=5.0, most_slope=3.0)
    on_bounds = 0
    for _ in range(100):
        u = 10.0 * rng.standard_normal(20)
        estimator.run(hyst.Record(u, rng.standard_normal() * 20.0 * u, 1.0))
        estimator.save(tmp_path / "estimator.json")
        restored = hyst.load(tmp_path / "estimator.json")
        slopes = np.cumsum(estimator.parameters[:6])
        on_bounds += bool(np.isclose([slopes.min(), slopes.max()], [2.1e-6, 3.0]).any())
        assert restored.state.tobytes() == estimator.state.tobytes()
    # Else the test would show nothing.
    assert on_bounds > 5


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("not json", "not JSON"),
        ('{"format": "x"}', "not a model file"),
        ('{"format": "hyst estimator", "version": 9}', "version 9"),
        ('{"format": "hyst estimator", "version": 2, "kind": "joint"}', "'settings' is missing"),
        (
            '{"format": "hyst estimator", "version": 1, "kind": "joint"}',
            "version 1 of the estimator",
        ),
        (
            '{"format": "hyst estimator", "version": 2, "kind": "joint", "settings": "x", '
            '"state": []}',
            "damaged",
        ),
    ],
)
def test_files_that_are_no_estimators(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "estimator.json"
    path.write_text(text)
    with pytest.raises(hyst.InputError, match=message):
        hyst.load(path)
