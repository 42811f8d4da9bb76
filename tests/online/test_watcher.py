"""A watch over simulated actuators: gaps, drift, faults of sensors, and no alarm without."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray

import hyst
from hyst.models import BoucWen, Creep, PrandtlIshlinskii, Preisach, RambergOsgood
from hyst.online.choice import estimator_for
from hyst.online.watch.delay_line import DelayLine
from hyst.online.watch.limits import Limits
from hyst.online.watch.sample_clock import SLOT, SampleClock, sample_time_of
from hyst.online.watch.tracker import Tracker
from hyst.online.watch.watcher import Watcher
from hyst.online.watch.window import Window
from hyst.operators import ModelDescription, Operator

Array = NDArray[np.float64]

DT, NOISE = 1e-3, 0.01
PLAYS = PrandtlIshlinskii(p=[0.5, 0.3], r=[0.4, 1.1], p0=1.0)


def told(model: Operator, u: Array, y: Array, error: float = NOISE) -> Operator:
    """The model with what an identification writes about its record."""
    errors = {"training": {"rms": error}} if error else {}
    about = ModelDescription(
        input_low=float(u.min()),
        input_high=float(u.max()),
        output_low=float(y.min()),
        output_high=float(y.max()),
        errors=errors,
    )
    return model.with_description(about)


@dataclass
class Bench:
    """A stage that is driven by a sine and measured with noise."""

    seconds: float = 20.0
    seed: int = 0

    def __post_init__(self) -> None:
        self.t = np.arange(round(self.seconds / DT)) * DT
        self.u = 3.0 * np.sin(2.0 * math.pi * 2.3 * self.t)
        self.true = PLAYS(self.u)
        self.y = self.true + np.random.default_rng(self.seed).normal(0.0, NOISE, self.t.size)
        self.model = told(PLAYS, self.u, self.true)

    def windows(
        self, u: Array | None = None, y: Array | None = None, **how: object
    ) -> list[Window]:
        return watched(self.model, self.u if u is None else u, self.y if y is None else y, **how)


def watched(
    model: Operator,
    u: Array,
    y: Array,
    t: Array | None = None,
    only: str = "",
    samples: int = 250,
    cut: int = 10**6,
    limits: Limits = Limits(),  # noqa: B008
) -> list[Window]:
    estimator = estimator_for(model, dt=DT, memory=10.0, spread=0.3, only=[only] if only else [])
    watch = Watcher(estimator, model, samples, limits, told_every=20)
    clock = SampleClock(DT, t is not None)
    windows = []
    stamps = np.full(u.size, np.nan) if t is None else t
    for k in range(0, u.size, cut):
        part = slice(k, k + cut)
        readable = np.zeros(u[part].size, dtype=bool)
        windows += watch.take(clock.take(u[part], y[part], stamps[part], readable))
    return [*windows, *watch.finish()]


def started(windows: list[Window]) -> dict[str, float]:
    """The alarms and when each started first."""
    found: dict[str, float] = {}
    for each in windows:
        for event in each.events:
            if event.starts:
                found.setdefault(event.name, event.time)
    return found


@pytest.mark.parametrize("only", ["", "scale"])
def test_an_undisturbed_actuator_raises_no_alarm(only: str) -> None:
    """20 runs of 10 s: none in 800 windows, so fewer than one in 260 at 95 % confidence."""
    names = [name for seed in range(10) for name in started(Bench(10.0, seed).windows(only=only))]
    assert names == []


def test_without_stated_errors_and_ranges_the_first_windows_tell_what_is_usual() -> None:
    bench = Bench()
    windows = watched(PLAYS, bench.u, bench.y)
    assert started(windows) == {}
    later = watched(PLAYS, bench.u, bench.y + 0.2 * (bench.t > 12.0))
    assert started(later)["model error"] == pytest.approx(12.5, abs=0.26)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("only", ["", "scale"])
def test_a_gain_that_drifts_is_told_and_followed(seed: int, only: str) -> None:
    bench = Bench(30.0, seed)
    gain = 1.0 + 0.2 * np.clip((bench.t - 5.0) / 20.0, 0.0, 1.0)
    y = gain * bench.true + bench.y - bench.true
    windows = bench.windows(y=y, only=only)
    found = started(windows)
    # The error passes its limit once the gain is off by 2 sqrt(3) noises over the output's rms.
    rms = float(np.sqrt(np.mean(bench.true**2)))
    expected = 5.0 + 20.0 / 0.2 * math.sqrt(3.0) * NOISE / rms
    assert found["model error"] == pytest.approx(expected, abs=1.0)
    assert 5.0 < found["drift"] < 30.0
    assert "drift" in windows[-1].active
    # The scale's past fades with 10 s, and the gain stood still for 5 s.
    assert windows[-1].parameters[0] == pytest.approx(1.2, abs=0.05 if only else 0.02)


def test_windows_do_not_depend_on_how_samples_come() -> None:
    bench = Bench(5.0)
    u, y, t = (np.delete(each, slice(1200, 1260)) for each in (bench.u, bench.y, bench.t))
    whole = bench.windows(u, y, t=t)
    for cut in (1, 37, 999):
        parts = bench.windows(u, y, t=t, cut=cut)
        assert [each.parameters.tobytes() for each in parts] == [
            each.parameters.tobytes() for each in whole
        ]
        assert [each.events for each in parts] == [each.events for each in whole]


ACTUATORS = {
    "plays": PrandtlIshlinskii(p=[0.3, 0.4, 0.5], r=[0.3, 0.9, 1.9], p0=1.0),
    "bouc-wen": BoucWen(0.6, 0.35, 0.12, 0.06),
    "creep": Creep([0.2], [0.3], 1e-3) @ PrandtlIshlinskii(p=[0.5], r=[0.8], p0=1.0),
    "preisach": Preisach(
        np.tril(np.random.default_rng(3).uniform(0.05, 0.3, (5, 5))), np.linspace(-3.0, 3.0, 6)
    ),
    "ramberg-osgood": RambergOsgood(1.0, 0.02, 3),
}


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("name", ACTUATORS)
def test_what_is_judged_has_the_right_memory(name: str, seed: int) -> None:
    """Without noise and with the true model every error that is told is that of the memory."""
    rng = np.random.default_rng(seed)
    t = np.arange(12_000) * DT
    strokes = 3.0 * np.sin(2.0 * math.pi * 1.1 * t)
    u = strokes * rng.uniform(0.2, 1.0, 14)[(t * 1.1).astype(int)]
    whole = ((t > 2.0) & (t < 3.0)) | (t > 10.0)
    u[whole] = strokes[whole]
    operator = ACTUATORS[name]
    # The actuator has a past that nobody knows.
    y = operator.run(u, operator.run(rng.uniform(-3.0, 3.0, 40))[1])[0]
    model = told(operator, np.array([-3.0, 3.0]), y, error=0.0)
    tracker = Tracker(estimator_for(model, dt=DT, only=["scale"]), model, False, 0.0)
    kept = np.ones(u.size, dtype=bool)
    for first in rng.integers(100, u.size - 3500, 6):
        kept[first : first + rng.choice([1, 3, 40, 300, 1500])] = False
    clock = SampleClock(DT, True)
    slots = clock.take(u[kept], y[kept], t[kept], np.zeros(int(kept.sum()), dtype=bool))
    found = tracker.take(slots)
    judged = np.isfinite(found.model_error)
    assert judged.any()
    assert not judged[0]
    # Both memories agree to a thousandth of a sweep's output, so each is within two of the truth.
    assert np.abs(found.model_error[judged]).max() <= 2e-3 * np.ptp(y)


def test_a_memory_that_is_never_wiped_out_is_told_and_nothing_learnt() -> None:
    bench = Bench(5.0)
    small = 0.1 * bench.u
    windows = bench.windows(u=small, y=PLAYS(small) + 0.3)
    assert {"memory unknown", "nothing learnt"} <= set(windows[-1].active)
    assert windows[-1].counts["learnt"] == 0
    assert windows[-1].paused == "the memory is not known"
    assert math.isnan(windows[-1].model_error)


def test_lost_samples_are_counted_and_learning_waits_for_a_turn() -> None:
    bench = Bench()
    kept = np.ones(bench.t.size, dtype=bool)
    kept[5000:5400] = False
    kept[12_000:14_500] = False
    windows = bench.windows(bench.u[kept], bench.y[kept], t=bench.t[kept])
    assert windows[-1].counts["samples lost"] == 2900
    assert windows[-1].counts["samples"] == bench.t.size - 2900
    # A stroke has 435 samples; at most two pass before the memory is known, after each gap and at
    # the start.
    assert bench.t.size - 2900 - 3 * 870 <= windows[-1].counts["learnt"] < bench.t.size - 2900
    assert set(started(windows)) == {"samples lost"}
    assert windows[-1].active == ()
    np.testing.assert_allclose(windows[-1].parameters[0], 1.0, atol=0.01)


def test_a_sample_lost_in_slow_motion_does_not_stop_learning() -> None:
    """One of 1000 samples a stroke: the input can have gone nowhere that matters meanwhile."""
    t = np.arange(20_000) * DT
    u = 3.0 * np.sin(2.0 * math.pi * 0.5 * t)
    y = PLAYS(u)
    kept = np.ones(t.size, dtype=bool)
    kept[6000::200] = False
    model = told(PLAYS, u, y, error=0.05)
    windows = watched(model, u[kept], y[kept], t[kept])
    learnt = windows[-1].counts["learnt"] - windows[23].counts["learnt"]
    assert windows[-1].counts["samples lost"] == 70
    assert learnt > 0.95 * (t.size - 6000)


@pytest.mark.parametrize("level", [0.4, -1.7])
def test_a_stuck_output_is_told_and_not_learnt(level: float) -> None:
    bench = Bench()
    y = bench.y.copy()
    y[8000:11_000] = level
    windows = bench.windows(y=y)
    found = started(windows)
    assert set(found) == {"output stuck", "nothing learnt"}
    assert found["output stuck"] == pytest.approx(8.25, abs=0.26)
    assert "output stuck" not in windows[-1].active
    np.testing.assert_allclose(windows[-1].parameters[:3], [1.0, 0.5, 0.3], atol=0.02)


def test_a_saturated_output_is_told_and_not_learnt() -> None:
    bench = Bench()
    windows = bench.windows(y=np.minimum(bench.y, 3.5))
    assert "output saturated" in windows[-1].active
    np.testing.assert_allclose(windows[-1].parameters[:3], [1.0, 0.5, 0.3], atol=0.02)


def test_a_coarse_sensor_is_not_stuck() -> None:
    bench = Bench()
    steps = 0.25  # an eighteenth of the range: runs of up to 50 equal samples at the turns
    y = np.round(bench.true / steps) * steps
    windows = watched(told(PLAYS, bench.u, bench.true, error=0.1), bench.u, y)
    assert not {"output stuck", "output saturated"} & set(started(windows))


def test_values_that_are_no_measurements_are_counted_and_left() -> None:
    bench = Bench()
    u, y = bench.u.copy(), bench.y.copy()
    y[[4000, 4001, 9000]] = [math.nan, math.inf, 9.9e37]
    u[[6000, 6001]] = [math.nan, -9.9e37]
    windows = bench.windows(u, y)
    assert windows[-1].counts["no number"] == 5
    assert set(started(windows)) == {"no number"}
    np.testing.assert_allclose(windows[-1].parameters[0], 1.0, atol=0.01)


def test_a_clock_that_goes_back_or_repeats() -> None:
    bench = Bench()
    t = np.where(bench.t >= 10.0, bench.t - 7.0, bench.t)
    windows = bench.windows(t=t)
    assert windows[-1].counts["clock"] == 1
    assert started(windows)["clock"] == pytest.approx(10.25, abs=0.26)
    assert windows[-1].time == pytest.approx(bench.t[-1], abs=DT)
    twice = [np.repeat(each, 1 + (np.arange(each.size) == 3000)) for each in (bench.u, bench.y)]
    repeated = np.repeat(bench.t, 1 + (np.arange(bench.t.size) == 3000))
    windows = bench.windows(*twice, t=repeated)
    assert windows[-1].counts["clock"] == 1
    assert windows[-1].counts["samples"] == bench.t.size


@pytest.mark.parametrize("wild", [9e99, 1e15, -1e15])
def test_a_wild_stamp_is_told_and_costs_a_turn(wild: float) -> None:
    bench = Bench()
    t = bench.t.copy()
    t[9000] = wild
    windows = bench.windows(t=t)
    assert windows[-1].counts["clock"] == 2  # there and back
    assert windows[-1].counts["samples"] == t.size
    assert windows[-1].counts["learnt"] > t.size - 2000
    assert set(started(windows)) <= {"clock", "samples lost"}


@pytest.mark.parametrize("factor", [0.5, 1.1, 1.5, 3.0])
def test_another_rate_is_told_and_is_no_loss(factor: float) -> None:
    bench = Bench(10.0)
    windows = bench.windows(t=factor * bench.t)
    assert "sample time" in windows[-1].active
    # Until it is seen that most steps are so.
    assert windows[-1].counts["samples lost"] <= 70


def test_sampled_models_learn_nothing_at_another_rate() -> None:
    operator = ACTUATORS["creep"]
    t = np.arange(10_000) * DT
    u = 3.0 * np.sin(2.0 * math.pi * 2.3 * t)
    y = operator(u)
    windows = watched(told(operator, u, y), u, y, t=1.5 * t, only="scale")
    assert windows[-1].counts["learnt"] <= 250
    assert windows[-1].paused == "the sample time is another one"


def test_an_input_beyond_what_the_model_knows_is_told() -> None:
    bench = Bench()
    u = np.where(bench.t > 10.0, 1.3, 1.0) * bench.u
    windows = bench.windows(u=u, y=PLAYS(u))
    assert started(windows)["input range"] == pytest.approx(10.25, abs=0.26)


def test_an_overflow_is_told_and_leaves_the_estimate_alone() -> None:
    t = np.arange(4000) * DT
    u = np.sin(2.0 * math.pi * 2.3 * t)
    model = RambergOsgood(1.0, 0.02, 21)
    y = model(u)
    wild = u.copy()
    wild[2000] = 1e19  # to the power of 21 it is beyond all doubles
    windows = watched(model, wild, y, only="scale")
    assert windows[-1].counts["overflow"] > 0
    assert started(windows)["overflow"] == pytest.approx(2.25, abs=0.26)
    np.testing.assert_allclose(windows[-1].parameters[0], 1.0, atol=0.01)


def test_stamps_that_jitter_or_are_rounded_lose_nothing() -> None:
    rng = np.random.default_rng(0)
    t = np.arange(5000) * DT
    one = np.ones(t.size)
    for stamps in (t + rng.uniform(-0.2, 0.2, t.size) * DT, np.floor(t / 4e-3) * 4e-3, t + 1e9):
        dt, resolution = sample_time_of(stamps[:200])
        assert dt == pytest.approx(DT, rel=0.02)
        slots = SampleClock(dt, True, resolution).take(one, one, stamps, one < 0.0)
        assert slots["lost"].sum() == 0
        assert slots.size == t.size


@pytest.mark.parametrize("seed", range(5))
def test_every_lost_sample_is_counted_between_stamps_that_jitter(seed: int) -> None:
    rng = np.random.default_rng(seed)
    t = np.arange(5000) * DT
    kept = rng.uniform(size=t.size) > 0.02
    kept[[0, -1]] = True
    stamps = (t + rng.uniform(-0.15, 0.15, t.size) * DT)[kept]
    one = np.ones(stamps.size)
    slots = SampleClock(DT, True).take(one, one, stamps, one < 0.0)
    assert slots["lost"].sum() == np.count_nonzero(~kept)
    np.testing.assert_array_equal(slots["lost"] == 0, kept)


def test_stamps_that_do_not_rise_are_refused() -> None:
    with pytest.raises(hyst.InputError, match="does not rise"):
        sample_time_of(np.zeros(50))


@pytest.mark.parametrize("delay", [0, 2, -3, 0.3, 2.6, -1.4])
def test_a_delay_is_taken_back_wherever_samples_are_cut(delay: float) -> None:
    u = np.sin(np.arange(400) / 20.0)
    slots = np.zeros(u.size, dtype=SLOT)
    slots["u"] = u
    # What the output of a model with this delay would be, so that both sides agree.
    slots["y"] = np.sin((np.arange(400) - delay) / 20.0)
    found = []
    for cut in (1, 13, 400):
        line = DelayLine(delay)
        parts = [line.take(slots[k : k + cut]) for k in range(0, u.size, cut)]
        found.append(np.concatenate(parts))
    assert found[0].tobytes() == found[1].tobytes() == found[2].tobytes()
    assert found[0].size >= 390
    assert np.isfinite(found[0]["u"]).all()
    # Cubic interpolation of 126 samples a period errs by 1e-6, a line by (1/20)^2 / 8; a turn that
    # stays where it is by up to (1/20)^2 / 2.
    np.testing.assert_allclose(found[0]["u"], found[0]["y"], atol=1.25e-3)


@pytest.mark.parametrize("delay", [2, 0.4, 3.4, -2])
@pytest.mark.parametrize("cut", [1, 7, 100])
def test_no_output_answers_an_input_from_beyond_a_gap(delay: float, cut: int) -> None:
    slots = np.zeros(100, dtype=SLOT)
    side = np.arange(100) >= 50
    slots["u"], slots["y"] = side, side
    slots["gap"][50], slots["backwards"][50], slots["repeated"][51] = True, True, 3
    line = DelayLine(delay)
    out = np.concatenate([line.take(slots[k : k + cut]) for k in range(0, 100, cut)])
    np.testing.assert_array_equal(out["u"], out["y"])
    first = int(np.flatnonzero(out["y"])[0])
    assert np.flatnonzero(out["gap"]).tolist() == [first]
    assert (out["backwards"].sum(), out["repeated"].sum()) == (1, 3)
    assert 100 - out.size <= 2 * math.ceil(abs(delay)) + 1
