"""Resonances, zeros and frequency response with errors, and what a drive does not determine."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import hyst
from hyst.errors import InputError
from hyst.identification.families.family import Fit
from hyst.identification.families.hammerstein.joint import JointParametrization, joint
from hyst.identification.families.hammerstein.told.drive_band import DriveBand, drive_band
from hyst.identification.families.hammerstein.told.dynamics_by_theta import DynamicsByTheta
from hyst.identification.families.hammerstein.told.dynamics_words import (
    not_determined,
    summary_lines,
    verdict_on,
)
from hyst.identification.families.hammerstein.told.found_root import FoundRoot, roots_found
from hyst.identification.families.hammerstein.told.known_dynamics import (
    KnownDynamics,
    known_dynamics,
)
from hyst.identification.fit.bounded_least_squares import Solution
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.record_use.used_samples import prepare
from hyst.identification.result.fit_spread import FitSpread, spread_of_fit
from hyst.identification.result.standard_errors import Spread
from hyst.models import LinearDynamics
from hyst.operators import Affine, Verdict
from hyst.signals import Record, multisine

W = 2.0 * np.pi * 200.0
RESONANCE = [1.0, 0.06 * W, W * W]
DT = 1e-4
G = LinearDynamics.from_continuous([W * W], RESONANCE, DT, delay=3)
PI = hyst.PrandtlIshlinskii([0.12, 0.09, 0.08, 0.06, 0.05], [0.5, 1.5, 3.0, 5.0, 8.0], 0.6)
T = np.arange(20_000) * DT


def found(
    dynamics: LinearDynamics, front: hyst.Operator, u: np.ndarray, noise: float, seed: int = 0
) -> KnownDynamics:
    """What the final fit tells, whatever it was started from: here, from the truth."""
    y = (dynamics @ front)(u)
    y = y + noise * y.std() * np.random.default_rng(seed).normal(size=y.size)
    data = prepare((Record(u, y, dynamics.dt),), "auto")
    values = front.parameters().values
    free = np.full(values.size, np.inf)
    own = Parametrization(front, np.eye(values.size), np.zeros(values.size), -free, free)
    parametrization, theta = joint((own, values), dynamics)
    family = hyst.families.Hammerstein(hysteresis=hyst.families.PrandtlIshlinskii())
    fit = Fit(family, 1, parametrization, Solution(theta, np.inf, 0, ""))
    fit = replace(fit, solution=family.solve(fit.problem(data), theta, 60))
    return known_dynamics(fit, data, spread_of_fit(data, fit))


def three_sines(phases: tuple[float, ...] = (0.0, 1.0, 2.0), scale: float = 10.0) -> np.ndarray:
    sines = zip((3.0, 11.0, 47.0), phases, strict=True)
    return scale / 3.0 * sum(np.sin(2.0 * np.pi * f * T + p) for f, p in sines)


def triangle(frequency: float) -> np.ndarray:
    return 20.0 / np.pi * np.arcsin(np.sin(2.0 * np.pi * frequency * T))


# Derivatives


def rotated() -> tuple[JointParametrization, np.ndarray]:
    """Poles and zeros of every sort, in coordinates of no kind, beside the realization itself."""
    zeros, poles = [1.4, -0.3, 0.5 + 0.6j, 0.5 - 0.6j], [0.9, 0.6 + 0.5j, 0.6 - 0.5j, 0.2]
    plain = LinearDynamics.from_zeros_poles_gain(zeros, poles, 1.0, 1e-3, delay=2)
    rng = np.random.default_rng(0)
    M = rng.normal(size=(4, 4)) + 3.0 * np.eye(4)
    A, B = np.linalg.solve(M, plain.A @ M), np.linalg.solve(M, plain.B)
    base = LinearDynamics(A, B, plain.C @ M, plain.D, 1e-3, 2)
    base = base.in_units(1.0, 1.0 / base.dc_gain())
    free = np.full(2, np.inf)
    line = Parametrization(Affine(2.0, 0.5), np.eye(2), np.zeros(2), -free, free)
    parametrization, theta = joint((line, np.array([2.0, 0.5])), base)
    assert isinstance(parametrization, JointParametrization)
    theta[2:6] += 0.002 * np.arange(4.0)
    return parametrization, theta


def central(function: object, theta: np.ndarray, step: float = 1e-6) -> np.ndarray:
    columns = [
        (function(theta + shift) - function(theta - shift)) / (2.0 * step)  # type: ignore[operator]
        for shift in step * np.eye(theta.size)
    ]
    return np.array(columns).T


def test_derivatives_are_those_of_differences() -> None:
    parametrization, theta = rotated()
    by_theta = DynamicsByTheta.of(parametrization, theta)
    f = np.array([0.0, 1.0, 80.0, 240.0, 500.0])

    def at(name: str, *more: np.ndarray) -> object:
        return lambda t: getattr(DynamicsByTheta.of(parametrization, t), name)(*more)[0]

    # Central differences of step 1e-6 keep half of the digits of what they differ.
    assert by_theta.poles()[1] == pytest.approx(central(at("poles"), theta), abs=1e-6)
    assert by_theta.zeros()[1] == pytest.approx(central(at("zeros"), theta), abs=1e-6)
    response = by_theta.response(f)
    assert response[1] == pytest.approx(central(at("response", f), theta), abs=1e-6)
    assert response[0] == pytest.approx(parametrization.dynamics(theta).frequency_response(f))


def test_errors_in_hertz_and_seconds_are_those_of_differences() -> None:
    """With a covariance of ones, a standard error is the length of the gradient."""
    parametrization, theta = rotated()
    m = theta.size
    unit = FitSpread(
        Spread(np.ones(m), 1.0, np.eye(m), np.empty((m, 0))), np.ones(m, dtype=bool), 1.0
    )
    band = DriveBand(np.array([1.0]), np.array([1e9]), 500.0)

    def roots(t: np.ndarray) -> list[FoundRoot]:
        by_theta = DynamicsByTheta.of(parametrization, t)
        poles = roots_found("pole", *by_theta.poles(), 1e-3, unit, band)
        return [*poles, *roots_found("zero", *by_theta.zeros(), 1e-3, unit, band)]

    def numbers(t: np.ndarray) -> np.ndarray:
        return np.array([[x.frequency, x.damping, x.time_constant, abs(x.value)] for x in roots(t)])

    gradient = central(numbers, theta)  # by theta, then number, then root
    lengths = np.sqrt(np.square(gradient).sum(axis=-1)).T
    got = np.array(
        [
            [x.frequency_error, x.damping_error, x.time_constant_error, x.modulus_error]
            for x in roots(theta)
        ]
    )
    assert np.isfinite(got).sum() == np.isfinite(lengths).sum() == 16
    assert got == pytest.approx(lengths, rel=1e-5, nan_ok=True)


# What is known


def test_a_resonance_is_told_in_hertz_and_damping() -> None:
    known = found(G, PI, multisine(DT, 20_000, amplitude=10.0).u, 0.01)
    (resonance,) = known.poles
    # Four standard errors: one run in some thousands fails with other seeds.
    assert abs(resonance.frequency - 200.0) < 4.0 * resonance.frequency_error < 0.02
    assert abs(resonance.damping - 0.03) < 4.0 * resonance.damping_error < 1e-4
    assert resonance.angular_frequency == pytest.approx(W, rel=1e-4)
    assert resonance.is_determined
    assert not not_determined(known)
    (zero,) = known.zeros  # of sampling, near -1
    assert abs(zero.value - G.zeros()[0]) < 4.0 * zero.standard_error.real
    assert zero.side == "open"
    assert np.isnan(zero.frequency)
    assert "between samples" in " ".join(summary_lines(known))


def test_errors_agree_with_scatter() -> None:
    """A resonance, a real pole and a zero outside the circle, over fifty records."""
    plant = LinearDynamics.from_zeros_poles_gain(
        [1.5, 0.7 + 0.3j, 0.7 - 0.3j], [0.8, 0.75 + 0.5j, 0.75 - 0.5j], 1.0, 1e-3
    )
    plant = plant.in_units(1.0, 1.0 / plant.dc_gain())
    front = hyst.PrandtlIshlinskii([0.5], [2.0], 1.0)
    u = multisine(1e-3, 1500, amplitude=10.0).u
    f = np.array([5.0, 60.0, 94.0, 200.0, 400.0])
    estimates, errors, inside = [], [], []
    true = np.log(plant.frequency_response(f))
    for seed in range(50):
        known = found(plant, front, u, 0.03, seed)
        lag, resonance = known.poles
        notch, ahead = sorted(known.zeros, key=lambda each: -each.is_pair)
        told = known.frequency_response(f)
        estimates.append(
            [
                resonance.frequency,
                resonance.damping,
                lag.time_constant,
                notch.frequency,
                notch.damping,
                ahead.time_constant,
                *np.log(told.gain),
            ]
        )
        errors.append(
            [
                resonance.frequency_error,
                resonance.damping_error,
                lag.time_constant_error,
                notch.frequency_error,
                notch.damping_error,
                ahead.time_constant_error,
                *told.gain_error,
            ]
        )
        low, high = told.gain_band(0.95)
        gain = np.exp(true.real)
        inside.append((low < gain) & (gain < high))
        assert ahead.side == "outside"
    # Fifty runs know a standard deviation to a tenth; four times that.
    ratio = np.std(estimates, axis=0) / np.mean(errors, axis=0)
    assert np.abs(ratio - 1.0).max() < 0.4
    # 250 bands, those of one record dependent: at least 85 % hold where 95 % are to.
    assert 0.85 < np.mean(inside) < 1.0


# What is not


@pytest.mark.parametrize("noise", [0.05, 0.01, 0.001])
@pytest.mark.parametrize("phases", [(0.0, 1.0, 2.0), (3.0, 0.5, 5.0)])
def test_three_sines_do_not_determine_a_resonance_above_them(
    noise: float, phases: tuple[float, ...]
) -> None:
    known = found(G, PI, three_sines(phases), noise)
    (resonance,) = known.poles
    assert not resonance.is_determined
    assert not resonance.is_shown
    (sentence,) = not_determined(known)
    assert sentence.startswith("the resonance at ")
    assert "of G is not determined by this drive: the drive shows nothing within" in sentence
    verdict = verdict_on(Verdict("good", ("Noise.",)), known)
    assert verdict.level == "fair"
    assert verdict.sentences[0].startswith("This drive does not determine the resonance at ")
    assert verdict_on(Verdict("unfit", ("No.",)), known).sentences[0] == "No."
    assert "NOT DETERMINED" in "\n".join(summary_lines(known))
    response = known.frequency_response([3.0, 47.0, 200.0, 3000.0])
    assert response.excited.tolist() == [True, True, False, False]


@pytest.mark.parametrize(
    "u",
    [
        triangle(10.0),
        10.0 * np.sin(2.0 * np.pi * (T + 0.5 * 999.0 / 2.0 * T * T)),
        np.repeat(np.random.default_rng(1).uniform(-10.0, 10.0, 4000), 5),
        multisine(DT, 20_000, amplitude=10.0, band=(1.0, 500.0)).u,
    ],
    ids=["triangle", "chirp", "held levels", "multisine to 500 Hz"],
)
def test_what_the_lines_of_a_drive_reach_is_determined(u: np.ndarray) -> None:
    known = found(G, PI, u, 0.01)
    (resonance,) = known.poles
    assert resonance.is_determined
    assert abs(resonance.frequency - 200.0) < 4.0 * resonance.frequency_error
    good = Verdict("good", ("Noise.",))
    assert verdict_on(good, known) == good


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_poles_drowned_in_noise_are_not_determined(seed: int) -> None:
    weak = LinearDynamics.from_continuous([W * W], [1.0, 1.6 * W, W * W], 1e-3)
    u = multisine(1e-3, 400, amplitude=10.0).u
    known = found(weak, Affine(1.0, 0.0), u, 3.0, seed)
    # The drive covers all frequencies: it is noise that hides them.
    assert all(not each.is_determined for each in known.poles)
    sentences = " ".join(not_determined(known))
    assert sentences.count("pole at") + sentences.count("the resonance at") == len(known.poles) > 0
    told = [why for each in known.poles if each.is_pair for why in each.undetermined]
    assert all("nothing" in why or "standard error" in why or "tell" in why for why in told)


def test_a_pole_that_may_lie_on_the_circle_is_told() -> None:
    values = np.array([0.9 + 0.43j, 0.9 - 0.43j])  # of modulus 0.9975
    for error, says in ((2e-3, True), (5e-4, False)):
        spread = FitSpread(
            Spread(np.ones(1), 1.0, np.array([[error**2]]), np.empty((1, 0))),
            np.ones(1, dtype=bool),
            1.0,
        )
        along = (values / np.abs(values))[:, None]
        band = DriveBand(np.array([70.0]), np.array([1e6]), 500.0)
        (pole,) = roots_found("pole", values, along, 1e-3, spread, band)
        assert pole.modulus_error == pytest.approx(error, rel=1e-12)
        assert any("reach the unit circle" in each for each in pole.undetermined) == says


def test_dynamics_that_are_held_have_no_error() -> None:
    spread = FitSpread(
        Spread(np.ones(1), 1.0, np.eye(1), np.empty((1, 0))), np.ones(1, dtype=bool), 1.0
    )
    nowhere = DriveBand(np.empty(0), np.empty(0), 500.0)
    poles = np.array([0.8 + 0.5j, 0.8 - 0.5j, -0.3])
    for pole in roots_found("pole", poles, np.zeros((3, 1), complex), 1e-3, spread, nowhere):
        assert pole.is_determined
        assert (pole.standard_error, pole.modulus_error) == (0.0, 0.0)
    (resonance,) = roots_found("pole", poles[:2], np.zeros((2, 1)), 1e-3, spread, nowhere)
    assert resonance.frequency_error == resonance.damping_error == 0.0
    held = DynamicsByTheta(G, np.zeros((2, 2, 1)), *np.zeros((2, 2, 1)), np.zeros(1))
    known = KnownDynamics(held, spread, nowhere, (resonance,), ())
    response = known.frequency_response([10.0, 200.0])
    assert response.excited.all()
    assert not response.gain_error.any()
    assert summary_lines(known)[0] == (
        "zeros and poles of G (order 2, given); delay 3 samples (0.0003 s):"
    )


def test_a_sampled_negative_pole_has_no_frequency() -> None:
    plant = LinearDynamics.from_zeros_poles_gain([0.2], [0.6, -0.5], 1.0, 1e-3)
    plant = plant.in_units(1.0, 1.0 / plant.dc_gain())
    known = found(plant, PI, multisine(1e-3, 4000, amplitude=10.0).u, 0.01)
    lag, negative = known.poles
    # tau = -dt / ln 0.6 and its corner, by hand.
    assert lag.time_constant == pytest.approx(1.9576e-3, rel=1e-2)
    assert lag.frequency == pytest.approx(81.30, rel=1e-2)
    assert negative.value == pytest.approx(-0.5, abs=0.01)
    assert np.isnan([negative.frequency, negative.damping, negative.time_constant]).all()
    assert negative.is_determined
    lines = "\n".join(summary_lines(known))
    assert "no continuous system has it" in lines
    assert "no continuous system: the pole -0." in lines


# The frequency response


def test_the_response_is_that_of_the_dynamics_with_a_band() -> None:
    known = found(G, PI, multisine(DT, 20_000, amplitude=10.0).u, 0.01)
    f = np.array([0.0, 50.0, 200.0, 1000.0])
    told = known.frequency_response(f)
    assert np.array_equal(told.response, known.dynamics.frequency_response(f))
    assert told.gain[0] == pytest.approx(1.0, abs=1e-6)
    assert told.gain_error[0] < 1e-9  # 1 at rest by definition
    low, high = told.gain_band(0.95)
    assert np.log(high / told.gain) == pytest.approx(1.959964 * told.gain_error, rel=1e-6)
    assert np.log(told.gain / low) == pytest.approx(1.959964 * told.gain_error, rel=1e-6)
    low, high = told.phase_band(0.5)
    assert 0.5 * (high - low) == pytest.approx(0.674490 * told.phase_error, rel=1e-6)
    true = G.frequency_response(f)
    assert np.abs(np.angle(told.response / true, deg=True))[1:] == pytest.approx(
        0.0, abs=4.0 * told.phase_error.max()
    )
    dense = known.frequency_response()
    assert dense.frequency[-1] == pytest.approx(5000.0)
    assert np.diff(dense.frequency)[np.abs(dense.frequency[:-1] - 200.0) < 5.0].max() < 2.0


@pytest.mark.parametrize("wrong", [[-1.0], [5001.0], [np.nan], [[1.0, 2.0]]])
def test_frequencies_are_from_rest_to_half_the_sample_rate(wrong: object) -> None:
    known = found(G, PI, multisine(DT, 4000, amplitude=10.0).u, 0.01)
    with pytest.raises(InputError, match="frequencies"):
        known.frequency_response(wrong)  # type: ignore[arg-type]


def test_python_control_takes_the_response() -> None:
    control = pytest.importorskip("control")
    known = found(G, PI, multisine(DT, 4000, amplitude=10.0).u, 0.01)
    told = known.frequency_response([10.0, 100.0, 300.0])
    frd = told.to_frd()
    assert isinstance(frd, control.FrequencyResponseData)
    assert frd.omega == pytest.approx(2.0 * np.pi * told.frequency)
    assert frd(2j * np.pi * 100.0) == pytest.approx(told.response[1], rel=1e-12)


def test_the_table_reads_back() -> None:
    known = found(G, PI, three_sines(), 0.01)
    told = known.frequency_response([10.0, 200.0])
    header, *lines = told.to_csv().splitlines()
    table = np.array([[float(each) for each in line.split(",")] for line in lines])
    assert header.split(",")[:4] == ["frequency [Hz]", "gain", "gain low", "gain high"]
    assert table[:, 1] == pytest.approx(told.gain, rel=1e-9)
    assert table[:, 7].tolist() == [1.0, 0.0]
    assert (table[:, 2] < table[:, 1]).all()
    assert (table[:, 1] < table[:, 3]).all()


# The band of a drive


def of(u: np.ndarray) -> Record:
    return Record(u, np.zeros(u.size), DT)


def test_a_band_is_where_lines_rise_above_the_noise() -> None:
    flat = LinearDynamics.from_transfer_function([1.0], [1.0], DT)
    u = np.sin(2.0 * np.pi * 100.0 * T)
    ((low, high),) = drive_band([of(u)], flat, 1.0, 0.1).bands()
    # One line: an octave to either side, and some of the taper's own width.
    assert 40.0 < low < 51.0
    assert 199.0 < high < 220.0
    # A line known to a tenth: amplitude^2 N / (4 noise^2) = 100, less a tenth of it for the taper.
    least = np.sqrt(0.9 * u.size / 400.0)
    assert drive_band([of(u)], flat, 1.0, 0.9 * least).bands()
    assert not drive_band([of(u)], flat, 1.0, 1.1 * least).bands()
    both = drive_band([of(u), of(np.sin(2.0 * np.pi * 1000.0 * T))], flat, 1.0, 0.1)
    assert len(both.bands()) == 2
    assert not drive_band([of(np.zeros(100))], flat, 1.0, 0.1).bands()


def test_units_change_no_bit() -> None:
    u = multisine(DT, 2000, amplitude=10.0).u
    one = drive_band([of(u)], G, 0.7, 0.01)
    other = drive_band([of(8.0 * u)], G, 0.7 * 4.0, 0.01 * 32.0)
    assert np.array_equal(one.evidence, other.evidence)
    assert np.array_equal(one.lines, other.lines)
