"""What a model leaves beside richer ones: near 1 for the true model, and named where it is not."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import scipy.signal

import hyst
from hyst.identification.families.hammerstein import IdentifiedHammerstein
from hyst.identification.families.hammerstein.yardstick.left_out_stretches import LeftOutStretches
from hyst.identification.families.hammerstein.yardstick.local_dynamics import left_by_dynamics
from hyst.identification.families.hammerstein.yardstick.yardstick import (
    MOST_SAMPLES,
    Stretch,
    Yardstick,
    yardstick,
)
from hyst.identification.families.hammerstein.yardstick.yardstick_told import level_of, sentences
from hyst.models import LinearDynamics
from hyst.signals import Record, multisine

Array = np.ndarray

DT = 1e-4
START = 1000
FRONT = hyst.PrandtlIshlinskii([0.3, 0.25, 0.2, 0.15, 0.1], [0.5, 1.5, 3.0, 5.0, 8.0], 0.6)


def modes(*pairs: tuple[float, float], dt: float = DT, delay: int = 3) -> LinearDynamics:
    """Give resonances in a row, each a frequency, Hz, and a damping; gain 1 at rest."""
    b = a = np.ones(1)
    for frequency, damping in pairs:
        w = 2.0 * np.pi * frequency
        one = LinearDynamics.from_continuous([1.0], [w**-2, 2.0 * damping / w, 1.0], dt)
        zpk = scipy.signal.ss2tf(one.A, one.B[:, None], one.C[None], [[one.D]])
        b, a = np.convolve(b, zpk[0].ravel()), np.convolve(a, zpk[1])
    return LinearDynamics.from_transfer_function(b, a, dt, delay)


ONE, TWO = modes((200.0, 0.03)), modes((200.0, 0.03), (520.0, 0.03))


def drive(kind: str, samples: int = 12_000) -> Array:
    t, rng = np.arange(samples) * DT, np.random.default_rng(7)
    drives: dict[str, Callable[[], Array]] = {
        "full band": lambda: multisine(DT, samples, amplitude=10.0, seed=3).u,
        "two periods": lambda: (
            multisine(DT, samples // 2, amplitude=10.0, periods=2, band=(2.0, 1000.0), seed=3).u
        ),
        "chirp": lambda: 10.0 * scipy.signal.chirp(t, 1.0, t[-1], 1000.0),
        "held levels": lambda: np.repeat(rng.uniform(-10.0, 10.0, samples // 5), 5),
        "triangle": lambda: 10.0 * scipy.signal.sawtooth(20.0 * np.pi * t + 1.0, 0.5),
    }
    return drives[kind]()


def noisy(y: Array, share: float = 0.01, seed: int = 0) -> Array:
    return y + share * y.std() * np.random.default_rng(seed).normal(size=y.size)


def compared(u: Array, y: Array, modelled: Array, dynamics: LinearDynamics = ONE) -> Yardstick:
    return yardstick([Stretch(u, y, modelled, START)], dynamics)


def with_feedback(u: Array, dt: float, frequency: float, stiff: float) -> Array:
    """Simulate a mass on a spring with elements that slide: the hysteresis is in the loop.

    y'' / w^2 + 2 z y' / w + (1 - stiff) y + stiff * sum p (y - play(y)) = u
    """
    w, parts = 2.0 * np.pi * frequency, 8
    h, r, p = dt / parts, (0.5, 1.5, 3.0, 5.0), (0.6, 0.5, 0.5, 0.4)
    y, v, out = 0.0, 0.0, np.empty_like(u)
    z = [0.0] * len(r)
    for k, drive_now in enumerate(u.tolist()):
        for _ in range(parts):
            z = [max(y - a, min(y + a, b)) for a, b in zip(r, z, strict=True)]
            force = sum(a * (y - b) for a, b in zip(p, z, strict=True))
            v += h * (w * w * (drive_now - (1.0 - stiff) * y - stiff * force) - 0.06 * w * v)
            y += h * v
        out[k] = y
    return out


@pytest.mark.parametrize("kind", ["full band", "two periods", "chirp", "held levels", "triangle"])
@pytest.mark.parametrize("dynamics", [ONE, TWO], ids=["one mode", "two modes"])
def test_beside_the_true_model_nothing_is_missing(kind: str, dynamics: LinearDynamics) -> None:
    u = drive(kind)
    clean = (dynamics @ FRONT)(u)
    found = compared(u, noisy(clean), clean, dynamics)
    # 11,000 samples: the rms of noise is known to 0.7 %; the best of six may be some percent less.
    assert 1.0 <= found.ratio < 1.05
    assert found.missing == "nothing"
    assert level_of(found) == "good"
    assert found.best == pytest.approx(0.01 * clean.std(), rel=0.05)


@pytest.mark.parametrize(
    "kind", ["autoregressive", "through the dynamics", "steps", "of the drive"]
)
def test_noise_of_any_colour_is_no_part_of_the_model(kind: str) -> None:
    u = drive("held levels")
    clean, white = (ONE @ FRONT)(u), np.random.default_rng(4).normal(size=u.size)
    noise = {
        "autoregressive": scipy.signal.lfilter([1.0], [1.0, -0.95], white),
        "through the dynamics": ONE(white),
        "steps": np.round(10.0 * clean / clean.std()) / 10.0 - clean / clean.std(),
        "of the drive": white * np.abs(u),
    }[kind]
    y = clean + 0.05 * clean.std() * noise / noise.std()
    found = compared(u, y, clean)
    # Noise of a resonance has some tens of independent values only: a tenth may go by chance.
    assert found.ratio < 1.2
    assert level_of(found) == "good"


@pytest.mark.parametrize("kind", ["full band", "two periods", "chirp", "held levels"])
def test_a_further_resonance_is_told(kind: str) -> None:
    u = drive(kind)
    clean = (TWO @ FRONT)(u)
    found = compared(u, noisy(clean), (ONE @ FRONT)(u))
    assert found.missing == "dynamics"
    assert level_of(found) == "unfit"
    assert found.ratio > 5.0
    # Noise is 1 % of it; a band of frequencies resolves a resonance of 12 Hz in 1.1 s to some.
    assert found.other_dynamics < 0.05 * clean.std()
    # Another hysteresis is no further resonance.
    assert found.other_hysteresis > 10.0 * found.other_dynamics
    assert any("lacks a resonance" in each for each in sentences(found, "um"))


@pytest.mark.parametrize("kind", ["full band", "two periods", "held levels"])
@pytest.mark.parametrize(
    "front",
    [hyst.BoucWen(1.0, 0.6, 0.5, 0.3), hyst.RambergOsgood(1.0, 0.1, 0.8)],
    ids=["bouc-wen", "ramberg-osgood"],
)
def test_another_hysteresis_is_told(kind: str, front: hyst.Operator) -> None:
    u = drive(kind)
    v = front(u)
    clean = ONE(v * 10.0 / np.abs(v).max())
    gain = float(clean @ ONE(u)) / float(ONE(u) @ ONE(u))
    found = compared(u, noisy(clean), gain * ONE(u))  # a straight line for the hysteresis
    assert found.missing in {"hysteresis", "both"}
    assert found.ratio > 2.0
    assert found.other_hysteresis < 0.5 * found.model
    # Dynamics alone make no hysteresis.
    assert found.other_dynamics > 2.0 * found.other_hysteresis


def test_hysteresis_in_a_feedback_is_no_hammerstein_system() -> None:
    dt = 1e-3
    u = multisine(dt, 6000, amplitude=6.0, periods=1, seed=1).u
    y = noisy(with_feedback(u, dt, 80.0, 0.4))
    found = hyst.identify(Record(u, y, dt, output_unit="um"), family="hammerstein", hysteresis="pi")
    assert isinstance(found, IdentifiedHammerstein)
    assert found.yardstick.missing == "structure"
    assert found.verdict.level == "unfit"
    told = " ".join(found.verdict.sentences)
    assert f"{found.yardstick.ratio:.3g} times what" in told
    assert "no hysteresis followed by linear dynamics" in told
    assert "--family hammerstein" not in told


@pytest.mark.parametrize("kind", ["two periods", "held levels"])
def test_hysteresis_behind_the_dynamics_is_no_hammerstein_system(kind: str) -> None:
    u = drive(kind)
    y = FRONT(ONE(u))
    gain = float(y @ ONE(u)) / float(ONE(u) @ ONE(u))
    found = compared(u, noisy(y), gain * ONE(u))
    assert found.missing == "structure"
    assert level_of(found) == "unfit"
    # No Hammerstein model and no linear one comes near what hysteresis of the output leaves.
    assert min(found.both, found.linear) > 2.0 * found.generous


def test_an_order_too_low_is_unfit_with_the_ratio() -> None:
    dt = 1e-3
    true = modes((100.0, 0.05), (270.0, 0.03), dt=dt, delay=0)
    u = multisine(dt, 3000, amplitude=10.0, periods=2, seed=2).u
    record = Record(u, noisy((true @ FRONT)(u)), dt)
    found = hyst.identify(record, family="hammerstein", hysteresis="pi", plays=5, state_order=2)
    assert isinstance(found, IdentifiedHammerstein)
    assert found.verdict.level == "unfit"
    assert found.yardstick.missing == "dynamics"
    assert found.yardstick.ratio > 5.0
    assert found.verdict.sentences[0].startswith("No command should come from this model.")
    assert "yardstick: the model leaves" in found.summary()
    assert found.to_dict()["dynamics"]["yardstick"]["ratio"] == found.yardstick.ratio


def test_the_true_system_is_good_and_says_so() -> None:
    dt = 1e-3
    true = modes((80.0, 0.15), dt=dt, delay=0)
    u = multisine(dt, 6000, amplitude=10.0, periods=2, seed=2).u
    record = Record(u, noisy((true @ FRONT)(u)), dt)
    found = hyst.identify(record, family="hammerstein", hysteresis="pi", plays=5, state_order=2)
    assert isinstance(found, IdentifiedHammerstein)
    assert found.verdict.level == "good"
    assert found.yardstick.ratio < 1.1  # as of the true model


def test_a_bouc_wen_actuator_is_good_as_bouc_wen_and_not_as_plays() -> None:
    dt = 1e-3
    true, front = modes((80.0, 0.15), dt=dt, delay=0), hyst.BoucWen(1.0, 0.6, 0.5, 0.3)
    u = multisine(dt, 3000, amplitude=2.0, periods=2, seed=5).u
    record = Record(u, noisy((true @ front)(u)), dt)
    levels = {}
    for name in ("bouc-wen", "pi"):
        found = hyst.identify(record, family="hammerstein", hysteresis=name, state_order=2)
        levels[name] = found.verdict.level
    assert levels["bouc-wen"] == "good"
    assert levels["pi"] != "good"


def test_noise_between_periods_is_the_records_own() -> None:
    u = drive("two periods", 24_000)
    clean = (TWO @ FRONT)(u)
    found = compared(u, noisy(clean, 0.02), (ONE @ FRONT)(u))
    # 11,000 differences: their rms is known to 0.7 %, three standard deviations allowed; what the
    # second mode still rings of the first period's start adds less.
    assert found.noise == pytest.approx(0.02 * clean.std(), rel=0.03)
    other = drive("held levels")
    assert np.isnan(compared(other, noisy(FRONT(other)), FRONT(other)).noise)


def test_copies_of_a_period_are_no_measurement_of_noise() -> None:
    u = drive("two periods", 24_000)
    one = noisy((ONE @ FRONT)(u))[:12_000]
    found = compared(u, np.tile(one, 2), (ONE @ FRONT)(u))
    assert np.isnan(found.noise)
    assert found.missing == "nothing"


def test_slow_drift_follows_no_drive() -> None:
    u = drive("chirp")
    clean = (ONE @ FRONT)(u)
    y = noisy(clean) + 0.2 * clean.std() * np.linspace(-1.0, 1.0, u.size) ** 3
    assert compared(u, y, clean).missing == "nothing"


def test_other_units_give_the_same_to_the_last_bit() -> None:
    u = drive("held levels", 6000)
    y, modelled = noisy((TWO @ FRONT)(u)), (ONE @ FRONT)(u)
    here, there = compared(u, y, modelled), compared(4.0 * u, y / 1024.0, modelled / 1024.0)
    assert there.ratio == here.ratio
    assert there.generous * 1024.0 == here.generous
    assert there.linear * 1024.0 == here.linear
    assert there.missing == here.missing


def test_a_long_record_is_taken_by_a_stretch() -> None:
    u = np.tile(drive("held levels"), 10)
    long = Stretch(u, u, u, 60_000)
    short = long.shortened(MOST_SAMPLES)
    assert short.error.size == MOST_SAMPLES
    assert np.array_equal(short.u[short.start :], u[60_000 : 60_000 + MOST_SAMPLES])
    assert short.u.size < 1.5 * MOST_SAMPLES


def test_local_dynamics_take_what_linear_dynamics_make_and_no_noise() -> None:
    rng = np.random.default_rng(0)
    u, white = rng.normal(size=(2, 8000))
    made = TWO(u)
    # Twelve numbers in a band of twice as many lines, paid for: seven widths, the least of them.
    assert left_by_dynamics(white, [u]) == pytest.approx(white.var(), rel=0.05)
    # A band of 12 lines is 15 Hz wide, the resonances 12 and 31 Hz: no parabola, but near one.
    assert left_by_dynamics(made, [u]) < 0.03 * made.var()
    noise = 0.1 * made.std() * white
    left = left_by_dynamics(made + noise, [u])
    assert 0.9 * noise.var() < left < noise.var() + 0.03 * made.var()


def test_lines_too_far_apart_show_no_dynamics() -> None:
    t = np.arange(8000) * DT
    u = np.sin(2.0 * np.pi * 50.0 * t)
    foreign = np.sin(2.0 * np.pi * 50.0 * t + 1.0)  # one line: any dynamics would make it
    assert left_by_dynamics(foreign, [u]) > 0.9 * foreign.var()


def test_a_column_that_moves_in_one_stretch_spoils_no_regression() -> None:
    rng = np.random.default_rng(1)
    x, step = rng.normal(size=4000), np.zeros(4000)
    step[1300:1310] = 1.0
    y = 2.0 * x + 0.1 * rng.normal(size=4000)
    regression = LeftOutStretches.of([{"x": x[:, None], "step": step[:, None]}], [y])
    squared, rest = regression.left(("x", "step"))
    # 4000 samples: 2 % of the noise's square, and a standard error of as much.
    assert squared == pytest.approx(0.01, rel=0.08)
    assert rest[0].std() == pytest.approx(0.1, rel=0.03)


def test_noise_explains_nothing_of_stretches_left_out() -> None:
    rng = np.random.default_rng(2)
    columns, y = rng.normal(size=(2000, 60)), rng.normal(size=2000)
    squared, rest = LeftOutStretches.of([{"all": columns}], [y]).left(("all",))
    assert rest[0].var() < 0.98 * y.var()  # they fit it where they know it
    assert squared >= 0.99 * float(y @ y) / y.size
