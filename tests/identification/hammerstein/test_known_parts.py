"""Dynamics or hysteresis that are known are held, and the other part is found before or after."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy.signal

import hyst
from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.families.hammerstein import IdentifiedHammerstein
from hyst.models import LinearDynamics
from hyst.operators import Affine
from hyst.signals import MeasuredResponse, Record, multisine

DT, W, DAMPING = 1e-4, 2.0 * np.pi * 200.0, 0.03
NUM, DEN = [W * W], [1.0, 2.0 * DAMPING * W, W * W]
DELAY = 3
G = LinearDynamics.from_continuous(NUM, DEN, DT, DELAY)
WEIGHTS, RADII, P0 = (0.12, 0.09, 0.08, 0.06, 0.05), (0.5, 1.5, 3.0, 5.0, 8.0), 0.6
PI = hyst.PrandtlIshlinskii(WEIGHTS, RADII, P0)
T = np.arange(8000) * DT
TRIANGLE = 20.0 / np.pi * np.arcsin(np.sin(2.0 * np.pi * 10.0 * T))
SINES = sum(a * np.sin(2.0 * np.pi * f * T + f) for a, f in ((5.0, 6.0), (3.0, 22.0), (2.0, 95.0)))
F = np.linspace(1.0, 1000.0, 200)


def record_of(
    u: np.ndarray, front: hyst.Operator = PI, noise: float = 0.01, seed: int = 0
) -> Record:
    y = (G @ front)(u)
    return Record(u, y + noise * y.std() * np.random.default_rng(seed).normal(size=y.size), DT)


def identified(record: Record | list[Record], **options: Any) -> IdentifiedHammerstein:
    found = hyst.identify(record, family="hammerstein", **options)
    assert isinstance(found, IdentifiedHammerstein)
    return found


def constants(found: IdentifiedHammerstein) -> dict[str, tuple[float, float]]:
    pairs = zip(found.parameter_values, found.standard_errors, strict=True)
    return dict(zip(found.parameter_names, pairs, strict=True))


def error_percent(model: hyst.Operator, u: np.ndarray) -> float:
    """Of the noiseless output, once what the start left has died out."""
    clean = (G @ PI)(u)
    return float(100.0 * (model(u) - clean)[3000:].std() / clean[3000:].std())


def test_a_triangle_identifies_the_hysteresis_before_known_dynamics() -> None:
    """It excites no impulse response, so without ``dynamics`` it is refused or tells little."""
    found = identified(record_of(TRIANGLE), dynamics=G, hysteresis="pi", radii=RADII)
    for i, weight in enumerate(WEIGHTS, 1):
        value, error = constants(found)[f"prandtl_ishlinskii.p[{i}]"]
        assert abs(value - weight) < 4.0 * error < 0.1  # one run in some thousands fails
    # 1 % noise over 8000 samples and seven constants: 0.03 %; a lag of one sample would make 0.7 %.
    assert error_percent(found.model, TRIANGLE) < 0.1
    assert found.verdict.level == "good"


def test_standard_errors_are_those_of_the_hysteresis_alone() -> None:
    found = identified(record_of(SINES), dynamics=G, hysteresis="pi", radii=RADII)
    assert not any(name.startswith("dynamics") for name in found.parameter_names)
    assert found.dynamics_are_given
    assert found.dynamics == LinearDynamics(
        G.A, G.B, G.C / G.dc_gain(), G.D / G.dc_gain(), DT, DELAY
    )
    assert not found.pole_standard_errors.any()
    assert np.sort_complex(found.poles) == pytest.approx(np.sort_complex(G.poles()), abs=1e-12)
    assert found.markov is None
    assert "(order 2, given)" in found.summary()
    assert found.to_dict()["dynamics"]["given"] is True


def test_standard_errors_agree_with_scatter() -> None:
    runs = [
        constants(
            identified(record_of(SINES, seed=seed), dynamics=G, hysteresis="pi", radii=RADII)
        )["prandtl_ishlinskii.p[3]"]
        for seed in range(8)
    ]
    values, errors = np.array(runs).T
    # Eight runs know their scatter to a quarter; three times that to either side.
    assert 0.4 < values.std(ddof=1) / errors.mean() < 1.8
    assert abs(values.mean() - WEIGHTS[2]) < 4.0 * errors.mean() / np.sqrt(8.0)


@pytest.mark.parametrize("gain", [1.0, 0.37, -20.0])
def test_the_gain_of_known_dynamics_is_taken_as_one_and_told(gain: float) -> None:
    scaled = LinearDynamics(G.A, G.B, gain * G.C, 0.0, DT, DELAY)
    found = identified(record_of(SINES), dynamics=scaled, hysteresis="pi", radii=RADII)
    assert found.dynamics.dc_gain() == pytest.approx(1.0, abs=1e-12)
    assert any(f"gain at rest, {gain:.6g}, is taken as 1" in each for each in found.undetermined)
    assert error_percent(found.model, SINES) < 0.1


def given_as(kind: str) -> Any:
    control = pytest.importorskip("control") if kind.startswith("control") else None
    return {
        "model": lambda: G @ PI,
        "lti": lambda: scipy.signal.lti(NUM, DEN),
        "zpk": lambda: scipy.signal.ZerosPolesGain([], np.roots(DEN), W * W),
        "control.tf": lambda: control.tf(NUM, DEN),  # type: ignore[union-attr]
        "control.ss": lambda: control.ss(control.tf(NUM, DEN)),  # type: ignore[union-attr]
        "response": lambda: MeasuredResponse(F, 2.0 * G.frequency_response(F)),
        "control.frd": lambda: control.frd(  # type: ignore[union-attr]
            2.0 * G.frequency_response(F), 2.0 * np.pi * F
        ),
    }[kind]()


@pytest.mark.parametrize(
    "kind", ["model", "lti", "zpk", "control.tf", "control.ss", "response", "control.frd"]
)
def test_dynamics_may_be_given_in_many_ways(kind: str) -> None:
    """Continuous ones know no delay; sines of several rates tell it."""
    found = identified(record_of(SINES), dynamics=given_as(kind), hysteresis="pi", radii=RADII)
    assert error_percent(found.model, SINES) < 0.1
    assert np.sort_complex(found.poles) == pytest.approx(np.sort_complex(G.poles()), abs=1e-8)
    if "response" not in kind and "frd" not in kind:  # a numerator may hold a sample of delay
        assert found.dynamics.delay == DELAY


def test_a_delay_stands_beside_dynamics_that_say_none() -> None:
    continuous = scipy.signal.lti(NUM, DEN)
    found = identified(record_of(TRIANGLE), dynamics=continuous, delay=DELAY, hysteresis="pi")
    assert found.dynamics.delay == DELAY
    # At one rate a lag is a radius: the record does not say it, and that is told.
    alone = identified(record_of(TRIANGLE), dynamics=continuous, hysteresis="pi")
    assert any("describe the records about as well, so give it" in e for e in alone.undetermined)
    with pytest.raises(InputError, match=r"delay is 2, and the dynamics .* have 3 samples"):
        identified(record_of(TRIANGLE), dynamics=G, delay=2, hysteresis="pi")


def test_dynamics_that_are_not_those_of_the_record_are_told() -> None:
    w = 0.95 * W
    wrong = LinearDynamics.from_continuous([w * w], [1.0, 2.0 * DAMPING * w, w * w], DT, DELAY)
    found = identified(record_of(SINES), dynamics=wrong, hysteresis="pi", radii=RADII)
    assert any("described better by other dynamics" in each for each in found.undetermined)
    right = identified(record_of(SINES), dynamics=G, hysteresis="pi", radii=RADII)
    assert not any("described better" in each for each in right.undetermined)


@pytest.mark.parametrize(
    ("dynamics", "error", "says"),
    [
        (lambda: PI, InputError, "is a prandtl-ishlinskii at its output"),
        (lambda: "G.json", InputError, "dynamics is 'G.json'; give a LinearDynamics"),
        (lambda: LinearDynamics.from_continuous(NUM, DEN, 2e-4), InputError, "time 0.0002 s, the"),
        (lambda: scipy.signal.lti([1.0], [1.0, -5.0]), NotIdentifiableError, "are not stable"),
        (lambda: scipy.signal.lti([1.0, 0.0], [1.0, 5.0]), NotIdentifiableError, "gain .* at rest"),
        (
            lambda: MeasuredResponse(F, np.random.default_rng(0).normal(size=F.size)),
            NotIdentifiableError,
            "of the frequency response, and no order up to 12",
        ),
        (lambda: MeasuredResponse(F[:5], F[:5]), NotIdentifiableError, "has 5 points below half"),
    ],
)
def test_what_are_no_dynamics_of_the_record_is_refused(
    dynamics: Any, error: type[Exception], says: str
) -> None:
    with pytest.raises(error, match=says):
        identified(record_of(SINES), dynamics=dynamics(), hysteresis="pi")


@pytest.mark.parametrize("hysteresis", ["mpi", "bouc-wen", "ramberg-osgood"])
def test_any_family_may_be_before_known_dynamics(hysteresis: str) -> None:
    front: hyst.Operator = {
        "mpi": hyst.PrandtlIshlinskii([0.3, 0.2], [1.5, 4.0], 1.0),
        "bouc-wen": hyst.BoucWen(1.2, 0.6, 1.4, 0.5, h=-1.0),
        "ramberg-osgood": hyst.RambergOsgood(1.0, 0.1, 0.8),
    }[hysteresis]
    found = identified(record_of(SINES, front), dynamics=G, hysteresis=hysteresis)
    clean = (G @ front)(SINES)
    error = (found.model(SINES) - clean)[3000:].std() / clean[3000:].std()
    assert error < 1e-2  # the noise itself


def test_known_hysteresis_leaves_gain_offset_and_dynamics() -> None:
    drive = multisine(DT, 5000, amplitude=10.0, periods=2)
    y = (G @ Affine(2.5, 1.0) @ PI)(drive.u)
    noisy = y + 0.01 * y.std() * np.random.default_rng(3).normal(size=y.size)
    found = identified(Record(drive.u, noisy, DT), front=PI)
    values = constants(found)
    for name, true in (("affine.gain", 2.5), ("affine.offset", 1.0)):
        value, error = values[name]
        assert abs(value - true) < 4.0 * error < 0.01
    assert found.hysteresis == Affine(values["affine.gain"][0], values["affine.offset"][0]) @ PI
    ratio = (np.sort_complex(found.poles) - np.sort_complex(G.poles())) / 1e-5
    assert np.abs(ratio).max() < 1.0  # 1 % noise over 10,000 samples: some 1e-6
    assert {name for name in values if not name.startswith("dynamics")} == {
        "affine.gain",
        "affine.offset",
    }
    assert any("hysteresis was given and is held" in each for each in found.undetermined)


def test_known_hysteresis_may_be_a_result_or_the_model_of_a_stage() -> None:
    slow = 20.0 / np.pi * np.arcsin(np.sin(2.0 * np.pi * T / T[-1] * 4.0))
    static = hyst.identify(Record(slow, PI(slow), 1e-2), family="pi", radii=RADII)
    record = record_of(SINES)
    for front in (static, G @ PI):
        found = identified(record, front=front, dynamics=G)
        assert constants(found).keys() >= {"affine.offset"} or "affine_2.offset" in constants(found)
        assert error_percent(found.model, SINES) < 0.1


def test_a_result_does_not_depend_on_units_where_parts_are_held() -> None:
    record = record_of(SINES)
    scaled = Record(4.0 * record.u, 0.125 * record.y, DT)
    one = identified(record, dynamics=G, hysteresis="pi", radii=RADII)
    other = identified(scaled, dynamics=G, hysteresis="pi", radii=[4.0 * each for each in RADII])
    assert np.array_equal(0.125 * one.model(record.u), other.model(scaled.u))
    front = identified(record, front=PI, dynamics=G)
    fourfold = identified(scaled, front=PI.in_units(4.0, 1.0), dynamics=G)
    assert np.array_equal(0.125 * front.model(record.u), fourfold.model(scaled.u))


def test_what_is_no_known_hysteresis_is_refused() -> None:
    record = record_of(SINES)
    with pytest.raises(InputError, match=r"front is 'H\.json'; give an operator"):
        identified(record, front="H.json")
    with pytest.raises(InputError, match="front is linear-dynamics without a hysteresis"):
        identified(record, front=G)
    with pytest.raises(InputError, match="front is given, so hysteresis 'pi' and its options"):
        identified(record, front=PI, hysteresis="pi")
    with pytest.raises(InputError, match="front is given, so hysteresis 'mpi' and its options"):
        identified(record, front=PI, plays=3)
    foreign = hyst.PrandtlIshlinskii([1.0], [500.0], 0.0)
    with pytest.raises(NotIdentifiableError, match="stands still at 0 in record 1"):
        identified(record, front=foreign, dynamics=G)
