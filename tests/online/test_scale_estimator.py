"""Scale and offset of any model's output: recovered, with errors that agree with scatter."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import lfilter
from scipy.stats import binom

import hyst
from hyst.online import JointEstimator, ModelEstimator, ScaleEstimator, estimator_for
from hyst.online.choice import ESTIMATORS
from hyst.operators import Affine, Operator
from reference.examples import EXAMPLES
from reference.family_examples import family_example, names_with_an_example

Array = NDArray[np.float64]

DT = 1e-3
BOUC_WEN = hyst.BoucWen(0.6, 0.35, 0.12, 0.06, h=-1.0)
RELAYS = EXAMPLES["preisach"]
RATE = hyst.RateDependentPrandtlIshlinskii([0.5, 0.3], [0.5, 1.5], beta=0.02, dt=DT, p0=1.0)
DRIFTING = {"bouc-wen": BOUC_WEN, "preisach": RELAYS, "rate-dependent": RATE}


def sine(samples: int, amplitude: float, period: float, phase: float = 0.0) -> Array:
    return amplitude * np.sin(2.0 * np.pi * np.arange(samples) / period + phase)


def feed(estimator: ScaleEstimator, u: Array, y: Array) -> ScaleEstimator:
    for u_k, y_k in zip(u.tolist(), y.tolist(), strict=True):
        estimator.update(u_k, y_k)
    return estimator


@pytest.mark.parametrize("name", sorted(names_with_an_example()))
def test_every_family_is_followed(name: str) -> None:
    example = family_example(name)
    model, u = example.model, example.drives[-1]
    y = 0.7 * model(u) - 0.4
    estimator = estimator_for(model, dt=DT, only=("scale", "offset"))
    estimator.run(hyst.Record(u, y, DT))
    # Without noise least squares gives them to rounding, some 1e-16 sqrt(N) of the sizes.
    assert estimator.parameters == pytest.approx([0.7, -0.4], abs=1e-11)
    ahead = estimator.model.stepper(estimator.memory)
    if not model.is_invertible():
        with pytest.raises(hyst.NotInvertibleError, match="no command can be given"):
            estimator.command(0.1)
        return
    # The command goes through the memory that the record has left, and the model answers to it.
    y_ref = float(y[-1]) + 0.02 * float(np.ptp(y))
    assert ahead(estimator.command(y_ref)) == pytest.approx(y_ref, abs=1e-9 * float(np.ptp(y)))


@pytest.mark.parametrize("name", sorted(DRIFTING))
def test_a_gain_that_drifts_by_thirty_percent_is_followed(name: str) -> None:
    model, samples = DRIFTING[name], 20_000
    u = sine(samples, 5.0, 100.0, 0.3)
    w = model(u)
    gain = np.linspace(1.0, 0.7, samples)
    span = float(np.ptp(w))
    rng = np.random.default_rng(0)
    y = gain * w + 0.05 * span + 1e-3 * span * rng.standard_normal(samples)
    estimator = ScaleEstimator(model, dt=DT, memory=0.5)
    trajectory = estimator.run(hyst.Record(u, y, DT), every=100)
    # It lags by about its memory: 0.5 s of 20 s, in which the gain falls by 0.0075; some 500
    # samples of noise leave 1e-3 / sqrt(500) of a few more.
    assert trajectory.of("scale")[20:] == pytest.approx(gain[99::100][20:], abs=0.011)
    half = samples // 2
    frozen = (y - w)[half:]
    assert np.std(trajectory.error[half:]) < 0.1 * np.std(frozen - frozen.mean())
    # It knows that it lags, and its bands hold the truth.
    knowledge = estimator.knowledge
    assert knowledge.low[0] < 0.7 < knowledge.high[0]
    assert "drift faster than the memory forgets" in str(knowledge)


def scatter(
    kind: str, memory: float, runs: int = 120, samples: int = 3000
) -> tuple[Array, Array, Array]:
    """Give errors over standard errors, errors, and standard errors, each shape (runs, 2)."""
    rng = np.random.default_rng(5)
    found, errors = np.empty((runs, 2)), np.empty((runs, 2))
    for run in range(runs):
        u = sine(samples, 8.0, rng.uniform(40.0, 400.0), rng.uniform(0.0, 6.0))
        white = rng.standard_normal(samples)
        noise = {
            "white": white,
            "following": lfilter([math.sqrt(1.0 - 0.9**2)], [1.0, -0.9], white),
            "below the noise": 0.9 * white
            + lfilter([0.4 * math.sqrt(1.0 - 0.98**2)], [1.0, -0.98], rng.standard_normal(samples)),
        }[kind]
        truth = np.array([rng.uniform(0.7, 1.4), rng.uniform(-2.0, 2.0)])
        y = truth[0] * BOUC_WEN(u) + truth[1] + 0.2 * noise
        estimator = ScaleEstimator(BOUC_WEN, memory=memory)
        estimator.run(hyst.Record(u, y, 1.0), samples)
        found[run], errors[run] = estimator.parameters - truth, estimator.standard_errors
    return found / errors, found, errors


@pytest.mark.parametrize("memory", [math.inf, 400.0])
@pytest.mark.parametrize("kind", ["white", "following", "below the noise"])
def test_standard_errors_cover_the_truth(kind: str, memory: float) -> None:
    ratio, found, errors = scatter(kind, memory)
    within = (np.abs(ratio) < 2.0).sum(axis=0)
    # 2 standard errors hold 0.954 of a normal scatter. Noise that follows itself has to be found in
    # sums of a few blocks, which costs some of that: 0.9 is what is promised.
    promised = 0.95 if kind == "white" else 0.9
    assert (within >= binom.ppf(0.005, len(ratio), promised)).all()
    # Nor are they wide for nothing: for white noise they are what the scatter is, to the 7 percent
    # of 120 runs and what doubt about whiteness adds.
    if kind == "white":
        share = np.sqrt((errors**2).mean(axis=0)) / np.sqrt((found**2).mean(axis=0))
        assert (share > 0.8).all()
        assert (share < 1.5).all()


def test_against_weighted_least_squares() -> None:
    # An independent solution: all samples at once, with exponential weights, no rest, wide prior.
    rng = np.random.default_rng(3)
    u = sine(2000, 8.0, 90.0) + 2.0 * sine(2000, 1.0, 17.0)
    w = BOUC_WEN(u)
    y = 1.2 * w + 0.3 + 0.1 * rng.standard_normal(u.size)
    memory = 250.0
    estimator = ScaleEstimator(BOUC_WEN, memory=memory, spread=1e3)
    estimator.run(hyst.Record(u, y, 1.0))
    weights = (1.0 - 1.0 / memory) ** np.arange(u.size)[::-1]
    regressors = np.column_stack([w, np.ones_like(w)]) * np.sqrt(weights)[:, None]
    wanted = np.linalg.lstsq(regressors, y * np.sqrt(weights), rcond=None)[0]
    # Least squares both; the start of spread 1000 counts as 1e-6 of the samples' knowledge.
    assert estimator.parameters == pytest.approx(wanted, abs=1e-6)


def test_while_it_rests_the_scale_is_kept_and_the_offset_followed() -> None:
    u = np.concatenate([sine(2000, 8.0, 100.0), np.full(8000, 3.0)])
    w = BOUC_WEN(u)
    rng = np.random.default_rng(1)
    offset = np.concatenate([np.full(2000, 0.5), np.linspace(0.5, 0.9, 8000)])
    y = 1.25 * w + offset + 0.01 * rng.standard_normal(u.size)
    estimator = ScaleEstimator(BOUC_WEN, memory=300.0)
    estimator.run(hyst.Record(u[:2000], y[:2000], 1.0))
    moving = estimator.standard_errors[0]
    estimator.run(hyst.Record(u[2000:], y[2000:], 1.0))
    # Nothing tells the scale anew; what little moves at first counts for less than an error.
    assert estimator.parameters[0] == pytest.approx(1.25, abs=0.01)
    assert estimator.standard_errors[0] < 10.0 * moving
    # The model's output there is right to scale's error; the offset lags by its memory, 0.015.
    assert estimator.model.run(u)[0][-1] == pytest.approx(1.25 * w[-1] + 0.9, abs=0.03)


def test_a_small_swing_tells_no_scale_and_it_says_so() -> None:
    rng = np.random.default_rng(2)
    u = 5.0 + sine(1000, 1e-3, 100.0)
    y = 1.3 * BOUC_WEN(u) + 0.1 * rng.standard_normal(u.size)
    estimator = feed(ScaleEstimator(BOUC_WEN), u, y)
    knowledge = estimator.knowledge
    assert not knowledge.known
    assert not knowledge.determined[0]
    assert "move farther" in knowledge.reasons[0]
    # The start is believed, to its spread; the offset takes the rest, and says what it rests on.
    assert estimator.parameters[0] == pytest.approx(1.0, abs=0.3)
    assert "depends on the scale" in knowledge.reasons[1]
    u = sine(1000, 5.0, 100.0)
    feed(estimator, u, 1.3 * BOUC_WEN.run(u, estimator.memory)[0])
    assert estimator.knowledge.known


def test_before_there_are_samples_nothing_is_known() -> None:
    knowledge = ScaleEstimator(BOUC_WEN).knowledge
    assert not knowledge.determined.any()
    assert str(knowledge).startswith("scale, offset are not determined: 0 samples are too few")
    assert np.isinf(knowledge.high[1])


@pytest.mark.parametrize("gain", [-0.7, 1e-4, 400.0])
def test_it_stays_invertible_and_says_where_it_stopped(gain: float) -> None:
    u = sine(800, 6.0, 100.0)
    estimator = feed(ScaleEstimator(BOUC_WEN), u, gain * BOUC_WEN(u))
    # The sign of the start is kept, and the bounds.
    assert 0.05 <= estimator.parameters[0] <= 20.0
    assert "on its bound" in estimator.knowledge.reasons[0]
    assert math.isfinite(estimator.command(0.5))


@pytest.mark.parametrize("held", ["scale", "offset"])
def test_what_is_held_stays(held: str) -> None:
    u = sine(1000, 6.0, 100.0)
    y = 1.2 * BOUC_WEN(u) + 0.4
    estimator = feed(ScaleEstimator(BOUC_WEN, held=[held]), u, y)
    place = ("scale", "offset").index(held)
    assert estimator.parameters[place] == (1.0, 0.0)[place]
    assert estimator.standard_errors[place] == 0.0
    assert estimator.standard_errors[1 - place] > 0.0
    w = BOUC_WEN(u)
    by_hand = float(w @ y / (w @ w)) if held == "offset" else float(np.mean(y - w))
    # What is held wrongly leaves errors that follow each other: a hundred samples of them tell
    # little more than one, and the start counts for that. The mean has no start.
    assert estimator.parameters[1 - place] == pytest.approx(by_hand, abs=0.01)


def test_a_record_gives_the_bits_of_its_samples() -> None:
    rng = np.random.default_rng(4)
    u = sine(1500, 6.0, 130.0)
    y = 1.2 * BOUC_WEN(u) + 0.1 * rng.standard_normal(u.size)
    one, other = (ScaleEstimator(BOUC_WEN, memory=200.0) for _ in range(2))
    trajectory = one.run(hyst.Record(u, y, 1.0), every=50)
    feed(other, u, y)
    assert one.saved()[1].tobytes() == other.saved()[1].tobytes()
    assert trajectory.values[-1].tobytes() == other.parameters.tobytes()
    assert trajectory.standard_errors[-1] == pytest.approx(other.standard_errors, rel=1e-12)
    assert trajectory.error[-1] == other.error


def test_units_change_no_digit() -> None:
    rng = np.random.default_rng(6)
    plays = hyst.PrandtlIshlinskii([0.5, 0.3], [1.0, 2.0], 1.0)
    u = sine(1500, 6.0, 130.0)
    y = 1.2 * plays(u) + 0.3 + 0.1 * rng.standard_normal(u.size)
    one = feed(ScaleEstimator(plays, memory=300.0), u, y)
    scaled = hyst.PrandtlIshlinskii([0.5 * 2**-9, 0.3 * 2**-9], [2.0**5, 2.0**6], 2.0**-9)
    # u in units of 2^-5, y in units of 2^4: the model's output is 2^-4 of what it was.
    other = feed(ScaleEstimator(scaled, memory=300.0), 2.0**5 * u, 2.0**-4 * y)
    assert other.parameters.tolist() == [one.parameters[0], 2.0**-4 * one.parameters[1]]
    assert other.standard_errors.tolist() == [
        one.standard_errors[0],
        2.0**-4 * one.standard_errors[1],
    ]


def test_saved_and_restored_it_goes_on_with_the_same_bits(tmp_path: Path) -> None:
    rng = np.random.default_rng(7)
    u = sine(2000, 6.0, 130.0)
    y = 1.2 * BOUC_WEN(u) + 0.1 * rng.standard_normal(u.size)
    whole = feed(ScaleEstimator(BOUC_WEN, memory=200.0), u, y)
    part = feed(ScaleEstimator(BOUC_WEN, memory=200.0), u[:777], y[:777])
    part.save(tmp_path / "estimator.json")
    restored = hyst.load(tmp_path / "estimator.json")
    assert isinstance(restored, ScaleEstimator)
    feed(restored, u[777:], y[777:])
    assert restored.saved()[1].tobytes() == whole.saved()[1].tobytes()
    assert restored.command(1.0) == whole.command(1.0)


@pytest.mark.parametrize(
    ("place", "value", "message"),
    [
        ("scale", -1.0, "scale = -1 from the start 1, outside"),
        ("scale", 99.0, "scale = 99 from the start 1, outside"),
        ("start", 0.0, "outside"),
        ("noise", -1.0, "noise = -1"),
        ("used", -1.0, "used = -1"),
    ],
)
def test_a_saved_state_that_cannot_be_is_refused(
    place: str, value: float, message: str, tmp_path: Path
) -> None:
    path = tmp_path / "estimator.json"
    estimator = ScaleEstimator(BOUC_WEN)
    estimator.save(path)
    content = json.loads(path.read_text())
    content["state"][estimator._at[place]] = value
    path.write_text(json.dumps(content))
    with pytest.raises(hyst.InputError, match=message):
        hyst.load(path)


def test_restarted_it_keeps_the_memory_and_forgets_the_rest() -> None:
    u = sine(1130, 6.0, 130.0)
    y = 1.2 * BOUC_WEN(u)
    estimator = feed(ScaleEstimator(BOUC_WEN), u, y)
    found, memory = estimator.model, estimator.memory
    estimator.restart()
    assert estimator.parameters.tolist() == [1.0, 0.0]
    assert estimator.memory.tobytes() == memory.tobytes()
    assert estimator.standard_errors[0] == 0.3
    estimator.restart(found)
    assert estimator.model == found
    more = sine(500, 6.0, 130.0, 2.0 * np.pi * 1130 / 130.0)
    after = 1.2 * BOUC_WEN.run(np.concatenate([u, more]))[0][1130:]
    feed(estimator, more, after)
    # It goes on with the memory of all inputs, so that nothing is left to explain.
    assert abs(estimator.error) < 1e-9
    for other in (hyst.BoucWen(0.5, 0.35, 0.12, 0.06), Affine(0.0) @ BOUC_WEN):
        with pytest.raises(hyst.InputError, match=r"not the one at the start|scale to go on"):
            estimator.restart(other)


def test_frozen_it_learns_nothing_and_follows() -> None:
    u = sine(800, 6.0, 130.0)
    estimator = feed(ScaleEstimator(BOUC_WEN), u, 1.2 * BOUC_WEN(u))
    frozen = estimator.frozen()
    assert frozen.command(1.0) == estimator.command(1.0)
    feed(frozen, u[:100], 5.0 * u[:100])
    assert frozen.parameters.tolist() == estimator.parameters.tolist()
    estimator.follow(u[:100])
    assert frozen.memory.tobytes() == estimator.memory.tobytes()
    assert frozen.command(1.0) == estimator.command(1.0)


def test_bad_samples_are_skipped_and_counted() -> None:
    u = sine(400, 6.0, 130.0)
    y = 1.2 * BOUC_WEN(u)
    clean, other = ScaleEstimator(BOUC_WEN), ScaleEstimator(BOUC_WEN)
    feed(clean, u, y)
    for k, (u_k, y_k) in enumerate(zip(u, y, strict=True)):
        if k % 50 == 7:
            assert not other.update(math.nan, y_k)
            assert not other.update(u_k, math.inf)
        assert other.update(u_k, y_k)
    assert other.counts == {"used": 400, "skipped": 16, "refused": 0}
    assert other.parameters.tobytes() == clean.parameters.tobytes()
    assert not other.update(1.0, 1e200)
    assert other.counts["refused"] == 1
    assert other.parameters.tobytes() == clean.parameters.tobytes()


def test_a_lost_output_does_not_lose_the_memory() -> None:
    u = sine(600, 6.0, 130.0)
    y = 1.2 * BOUC_WEN(u)
    estimator = feed(ScaleEstimator(BOUC_WEN), u[:400], y[:400])
    estimator.update(u[400], math.nan)
    estimator.follow(u[400:500])
    feed(estimator, u[500:], y[500:])
    assert abs(estimator.error) < 1e-12


@pytest.mark.parametrize(
    ("model", "options", "message"),
    [
        (5, {}, "model is a int; give an operator"),
        (RATE, {"dt": 1.0}, "resample the record"),
        (BOUC_WEN, {"memory": -1.0}, "memory is -1"),
        (BOUC_WEN, {"spread": 0.0}, "spread is 0"),
        (BOUC_WEN, {"held": "gain"}, "held names 'gain'"),
        (BOUC_WEN, {"least": 2.0}, "a share below 1"),
        (BOUC_WEN, {"most": 0.5}, "a multiple above it"),
    ],
)
def test_arguments_that_make_no_sense(
    model: Operator, options: dict[str, float], message: str
) -> None:
    with pytest.raises(hyst.InputError, match=message):
        ScaleEstimator(model, **options)  # type: ignore[arg-type]


def test_the_estimator_that_suits() -> None:
    plays = hyst.PrandtlIshlinskii([0.5, 0.3], [1.0, 2.0], 1.0)
    assert isinstance(estimator_for(plays), JointEstimator)
    assert isinstance(estimator_for(plays, only=["scale", "offset"]), ScaleEstimator)
    assert isinstance(estimator_for(plays, estimator="scale"), ScaleEstimator)
    assert isinstance(estimator_for(RELAYS), ScaleEstimator)
    one = estimator_for(plays, only=["r", "p0"])
    free = dict(zip(one.names, one.standard_errors > 0.0, strict=True))
    assert [name for name, is_free in free.items() if is_free] == ["p0", "r[1]", "r[2]"]
    assert estimator_for(RATE).dt == DT
    # What is no scale, nor of the joint estimator, is the model's own.
    assert isinstance(estimator_for(BOUC_WEN, only="A"), ModelEstimator)
    with pytest.raises(hyst.InputError, match="there is no estimator 'kalman'"):
        estimator_for(plays, estimator="kalman")
    with pytest.raises(hyst.InputError, match="only names 'q'"):
        estimator_for(plays, only="q")
    assert set(ESTIMATORS) >= {"scale", "joint"}


def test_what_is_said_of_errors_does_not_contradict_itself() -> None:
    # What follows itself is below the noise, so neighbours do not show it; sums do.
    rng = np.random.default_rng(7)
    u = sine(20_000, 6.0, 100.0)
    noise = 0.1 * rng.standard_normal(u.size) + 0.05 * np.sin(np.arange(u.size) / 300.0)
    estimator = feed(ScaleEstimator(BOUC_WEN), u, BOUC_WEN(u) + noise)
    innovation, knowledge = estimator.innovation, estimator.knowledge
    assert abs(innovation.correlation) < 0.5
    assert not innovation.consistent
    assert str(innovation) in knowledge.sentences[0]
    assert "as in noise" not in str(innovation)
    assert "follow each other over some" in str(innovation)


@pytest.mark.parametrize(("factor", "says"), [(-1.0, "-1"), (1e-3, "0.001"), (1e3, "1000")])
def test_a_sensor_of_other_sign_or_unit_is_told_with_its_errors(factor: float, says: str) -> None:
    u = sine(2000, 6.0, 100.0)
    y = factor * BOUC_WEN(u)
    estimator = feed(ScaleEstimator(BOUC_WEN), u, y)
    told = estimator.knowledge
    assert not told.determined.any()
    assert f"samples alone say {says};" in told.reasons[0]
    assert not estimator.innovation.consistent
    scale, offset = estimator.parameters
    left = float(np.sqrt(np.mean((y - scale * BOUC_WEN(u) - offset) ** 2)))
    assert estimator.innovation.rms == pytest.approx(left, rel=0.02)
