"""The simulated stage and the story told on it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import cont2discrete

import hyst
from hyst.cli import main
from hyst.demo import BANNER, SimulatedStage, Story, tell
from hyst.demo.stage import _resonance
from hyst.demo.trajectories import staircase_and_sines, through


def test_the_resonance_is_the_sampled_second_order_system() -> None:
    w, damping, dt = 2.0 * np.pi * 150.0, 0.03, 1e-3
    numerator, denominator, _ = cont2discrete(([w**2], [1.0, 2.0 * damping * w, w**2]), dt, "zoh")
    ours = _resonance(150.0, damping, dt)
    # Both evaluate the same exponentials of numbers of order one.
    np.testing.assert_allclose(ours[0], np.ravel(numerator), atol=1e-13)
    np.testing.assert_allclose(ours[1], denominator, atol=1e-13)


def test_the_stage_has_asymmetric_hysteresis_with_minor_loops() -> None:
    stage = SimulatedStage()
    slow = through([0.0, 100.0, 0.0, 100.0, 40.0, 60.0, 40.0], 20.0, stage.dt)
    x = stage.position(slow)
    turns = np.flatnonzero(np.diff(np.sign(np.diff(slow))) != 0) + 1
    falling, rising = slice(turns[0], turns[1]), slice(turns[1], turns[2])

    def at(u: float, branch: slice) -> float:
        order = np.argsort(slow[branch])
        return float(np.interp(u, slow[branch][order], x[branch][order]))

    stroke = np.ptp(x)
    widths = [at(u, falling) - at(u, rising) for u in (10.0, 50.0, 90.0)]
    assert min(widths) > 0.02 * stroke
    # A loop of plays alone is the same upside down; the cubic makes its two ends differ.
    assert widths[2] > 1.2 * widths[0]
    assert 0.0 < np.ptp(x[turns[-1] :]) < 0.35 * stroke


def test_the_stage_rests_rings_and_forgets_nothing() -> None:
    stage = SimulatedStage()
    rest = SimulatedStage(creep=0.0).position(np.full(500, 50.0))
    assert np.ptp(rest) < 1e-9
    kicked = stage.position(np.concatenate([np.full(10, 50.0), np.full(500, 60.0)]))
    # Overshoot of a step with damping 0.03: exp(-pi 0.03) = 91 % of it, less by sampling.
    assert kicked.max() - kicked[-1] > 0.5 * (kicked[-1] - kicked[0])
    swept = stage.position(np.full(5, 50.0), history=np.array([0.0, 100.0]))
    assert swept[0] > rest[0] + 0.5


def test_the_sensor_counts_and_repeats_itself() -> None:
    stage = SimulatedStage()
    x = np.linspace(0.0, 50.0, 1000)
    y = stage.measure(x)
    assert np.array_equal(y, stage.measure(x))
    assert np.array_equal(np.round(y / stage.count), y / stage.count)
    # Standard deviation of 1000 samples of noise: within 10 % of the true one.
    assert (y - x).std() == pytest.approx(stage.noise, rel=0.1)


def test_drives_turn_where_they_should_and_nowhere_else() -> None:
    levels = [0.0, 10.0, -5.0, 3.0]
    u = through(levels, 100.0, 1e-3)
    assert u[hyst.signals.reversals(u)].tolist() == [10.0, -5.0]
    assert (u[0], u[-1]) == (0.0, 3.0)
    # Half a cosine is at most pi/2 times as fast as its mean, and rounding adds a sample's worth.
    assert np.abs(np.diff(u)).max() < 1.02 * np.pi / 2.0 * 0.1
    y = staircase_and_sines(8.0, 48.0, 1e-3)
    assert (y.min(), y.max()) == (8.0, 48.0)
    assert np.abs(np.diff(y)).max() < 0.01 * 40.0


@pytest.fixture(scope="module")
def story() -> Story:
    return tell()


def test_compensation_is_worth_it(story: Story) -> None:
    plain, compensated = story.tracking
    assert plain.metrics.rms_percent > 2.0
    assert compensated.metrics.rms_percent < 0.12
    # Followed to the noise of its sensor, with no sensor in the loop.
    assert compensated.metrics.rms < 2.0 * SimulatedStage().noise
    assert story.improvement == plain.metrics.rms / compensated.metrics.rms
    assert story.improvement > 30.0
    # The model follows exactly; what is left is what the stage has and the model has not.
    assert story.compensation.max_abs < 1e-9 * np.ptp(story.y_ref)


def test_the_numbers_are_those_of_the_true_position(story: Story) -> None:
    stage = SimulatedStage()
    for each in story.tracking:
        y = stage.position(each.u, story.history)
        assert np.array_equal(y, each.y)
        assert each.metrics.rms == pytest.approx(np.sqrt(np.mean((y - story.y_ref) ** 2)), rel=1e-9)
        assert 0.0 <= each.u.min() <= each.u.max() <= 100.0


def test_the_stage_creeps_and_lags_and_the_model_knows(story: Story) -> None:
    stage = SimulatedStage()
    held = stage.position(np.full(1000, 60.0))
    # A step of 60 V goes on by the share per decade: from 0.05 s to 0.5 s one of them.
    early, late = held[round(0.05 / stage.dt)], held[round(0.5 / stage.dt)]
    assert (late - early) / held[-1] == pytest.approx(stage.creep, rel=0.35)
    [creep] = [part for part in story.identified.model.parts if part.kind == "creep"]
    assert creep.weights.size >= 2
    motion = {each.name: each.rms for each in story.identified.motion}
    assert motion["creep"] > 5.0 * motion["noise"]
    # The amplifier's lag, and what holding a command and its frame take.
    low, high = story.identified.delay_interval
    assert 0.0 < low < high < 2.0


def test_the_model_is_no_copy_of_the_stage(story: Story) -> None:
    assert len(story.identified.candidates) > 4
    assert story.identified.metrics["validation"].rms > 1.2 * SimulatedStage().noise
    assert story.identified.metrics["validation"].rms_percent < 0.3
    assert "simulated" in story.training.notes[0]


def test_the_verb_tells_it_all_and_what_it_suggests_works(
    story: Story,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr("hyst.demo.tell", lambda **_: story)
    monkeypatch.chdir(tmp_path)
    assert main(["demo"]) == 0
    shown = capsys.readouterr().out
    assert shown.startswith(BANNER)
    assert f"{story.tracking[0].metrics.rms:.4f}" in shown
    assert f"{story.tracking[1].metrics.rms:.4f}" in shown
    page = (tmp_path / "demo" / "report.html").read_text(encoding="utf-8")
    assert BANNER in page
    assert page.count("<figure") == 5
    assert json.loads((tmp_path / "demo" / "metrics.json").read_text())["family"]
    command = hyst.io.read_column(tmp_path / "demo" / "command.csv", "command")[0]
    suggested = [line.split()[1:] for line in shown.splitlines() if line.startswith("  hyst ")]
    assert [words[0] for words in suggested] == ["identify", "compensate"]
    assert main([*suggested[0], "--family", "linear"]) == 0
    assert main(suggested[1]) == 0
    again = hyst.io.read_column(tmp_path / "demo" / "command.csv", "command")[0]
    np.testing.assert_allclose(again, command, atol=1e-9)


def test_the_verb_refuses_a_folder_that_cannot_be(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "no").write_text("a file")
    assert main(["demo", "-o", str(tmp_path / "no" / "demo")]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert [each.name for each in tmp_path.iterdir()] == ["no"]
