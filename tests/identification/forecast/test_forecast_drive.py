"""What a drive will determine: against the scatter of fits, and told where it is nothing."""

from __future__ import annotations

import math

import numpy as np
import pytest

import hyst
from hyst.errors import InputError
from hyst.identification import DriveForecast, forecast_drive, sketched_plays, sketched_stage
from hyst.identification.forecast.free_numbers import (
    free_numbers,
    frequency_and_damping,
    poles_by_directions,
)
from hyst.operators import Operator
from hyst.signals import Drive
from identification.forecast.scatter_of_fits import DELAY, DT, NAMES, TRUE, outputs, scatter, start

RADII, WEIGHTS = (0.05, 0.15, 0.3, 0.5, 0.8), (0.6, 0.12, 0.09, 0.08, 0.06, 0.05)
RUNS = 150


def small_stage() -> Operator:
    front = sketched_plays(TRUE[5:7], TRUE[2:5])
    return sketched_stage(DT, [(TRUE[0], TRUE[1])], delay=DELAY, front=front)


def audit_stage(*more: tuple[float, float], delay: int = 3) -> Operator:
    front = sketched_plays(RADII, WEIGHTS)
    return sketched_stage(1e-4, [(200.0, 0.03), *more], delay=delay, front=front)


def multisine(
    high: float, low: float = 1.0, amplitude: float = 1.0, samples: int = 20_000
) -> Drive:
    return hyst.signals.multisine(1e-4, samples, amplitude=amplitude, band=(low, high))


def named(found: DriveForecast, name: str) -> float:
    return {each.name: each.error for each in found.errors}[name]


def test_the_sketch_is_the_model_it_states() -> None:
    u = hyst.signals.levels(DT, 400, 1.0).u
    # The output of the independent simulation, whose resonance is sampled in closed form.
    assert small_stage()(u) == pytest.approx(outputs(u, start()[None])[0], abs=1e-12)


@pytest.mark.parametrize(
    "drive",
    [
        hyst.signals.levels(DT, 1500, 1.0, hold=4),
        hyst.signals.multisine(
            DT, 1500, amplitude=1.0, band=(1.0, 300.0), uniform=True, max_rate=60.0
        ),
        hyst.signals.swept_sine(DT, 1500, (1.0, 200.0), 1.0),
        # About a middle of 0.8 the offset is hard to tell from the weights.
        hyst.signals.lowpassed_noise(DT, 1500, 150.0, amplitude=1.0, offset=0.8),
    ],
    ids=lambda drive: drive.kind,
)
@pytest.mark.parametrize("decibels", [30.0, 50.0])
def test_errors_are_the_scatter_of_fits(drive: Drive, decibels: float) -> None:
    found = forecast_drive(drive, small_stage(), noise_db=decibels)
    expected = {each.name: each.standard_error for each in found.errors}
    ratios = scatter(drive.u, found.noise_rms, RUNS, seed=11) / [expected[each] for each in NAMES]
    # The scatter of RUNS fits is itself known to 1 / sqrt(2 RUNS) = 6 %; four times that.
    assert ratios == pytest.approx(np.ones(len(NAMES)), abs=4.0 / math.sqrt(2.0 * RUNS))


def test_lines_near_the_resonance_alone_tell_as_much() -> None:
    # A flat band around a light resonance: nothing else is in the data to tell of it.
    found = forecast_drive(multisine(1000.0), audit_stage())
    frequency, damping = found.of_dynamics
    assert frequency.by_own_lines == pytest.approx(frequency.standard_error, rel=0.2)
    assert damping.by_own_lines == pytest.approx(damping.standard_error, rel=0.2)


@pytest.mark.parametrize("damping", [0.02, 0.3, 0.8])
def test_frequency_and_damping_move_with_their_poles(damping: float) -> None:
    stage = sketched_stage(1e-3, [(60.0, damping), (150.0, 0.1)], front=sketched_plays([0.2]))
    _, G = free_numbers(stage).dynamics[0]
    poles, by_k = poles_by_directions(G)
    own = int(np.argmin(np.abs(np.abs(poles) - 2.0 * np.pi * 60.0) - 1e-3 * poles.imag))
    frequency, ratio, slopes = frequency_and_damping(complex(poles[own]), by_k[own])
    assert (frequency, ratio) == pytest.approx((60.0, damping))
    for place, step in enumerate(1e-6 * np.eye(G.order)):
        moved = []
        for sign in (1.0, -1.0):
            s = np.log(np.linalg.eigvals(G.A + sign * np.outer(G.B, step)).astype(complex)) / 1e-3
            nearest = s[np.argmin(np.abs(s - poles[own]))]
            moved.append([abs(nearest) / (2.0 * np.pi), -nearest.real / abs(nearest)])
        difference = (np.array(moved[0]) - moved[1]) / 2e-6
        # Central differences: their square and the rounding of eigenvalues stay below 1e-5.
        assert slopes[:, place] == pytest.approx(difference, rel=1e-4, abs=1e-4)


@pytest.mark.parametrize("decibels", [20.0, 60.0])
def test_errors_grow_with_the_noise_and_fall_with_the_root_of_samples(decibels: float) -> None:
    once, four = (
        hyst.signals.multisine(1e-4, samples, rms=0.3, band=(1.0, 1000.0))
        for samples in (20_000, 80_000)
    )
    stage = audit_stage()
    usual = forecast_drive(once, stage)
    other = forecast_drive(once, stage, noise_db=decibels)
    factor = 10.0 ** ((40.0 - decibels) / 20.0)
    for name in ("resonance [Hz]", "damping of 200 Hz", "p[2]", "r[4]"):
        assert named(other, name) == pytest.approx(factor * named(usual, name), rel=1e-9)
    longer = forecast_drive(four, stage, noise=usual.noise_rms)
    # Another draw of phases of the same power: the answer near the resonance is alike to some
    # per cent.
    assert named(longer, "resonance [Hz]") == pytest.approx(
        0.5 * named(usual, "resonance [Hz]"), rel=0.1
    )


@pytest.mark.parametrize("power", [-7, 9])
def test_units_change_nothing(power: int) -> None:
    scale = 2.0**power
    drive, stage = multisine(500.0, samples=4000), audit_stage()
    larger = Drive(scale * drive.u, drive.dt, drive.kind, drive.period)
    plain = forecast_drive(drive, stage)
    scaled = forecast_drive(larger, stage.in_units(scale, 1.0))
    assert [each.verdict for each in scaled.errors] == [each.verdict for each in plain.errors]
    for name in ("resonance [Hz]", "damping of 200 Hz"):
        assert named(scaled, name) == pytest.approx(named(plain, name), rel=1e-6)
    assert named(scaled, "r[3]") == pytest.approx(scale * named(plain, "r[3]"), rel=1e-6)


@pytest.mark.parametrize(
    "drive",
    [
        multisine(5000.0),
        multisine(500.0),
        hyst.signals.swept_sine(1e-4, 20_000, (1.0, 1000.0), 1.0),
        hyst.signals.swept_sine(1e-4, 20_000, (1.0, 1000.0), 1.0, spacing="logarithmic"),
        hyst.signals.levels(1e-4, 20_000, 1.0),
        hyst.signals.lowpassed_noise(1e-4, 20_000, 1000.0, amplitude=1.0),
    ],
    ids=lambda drive: f"{drive.kind} {drive.max_rate:.3g}",
)
def test_drives_an_amplifier_can_play_suffice(drive: Drive) -> None:
    found = forecast_drive(drive, audit_stage())
    assert found.sufficient
    assert found.advice == ()
    assert (found.free_of_dynamics, found.free_of_front) == (3, 11)


@pytest.mark.parametrize("amplitude", [0.9, 30.0])
def test_nothing_near_the_resonance_is_told_whatever_the_corners_of_plays_add(
    amplitude: float,
) -> None:
    front = sketched_plays(np.array(RADII) * amplitude, WEIGHTS)
    stage = sketched_stage(1e-4, [(200.0, 0.03)], delay=3, front=front)
    found = forecast_drive(multisine(60.0, amplitude=amplitude), stage)
    # By the letter of the stated model 60 Hz tell of 200 Hz to a few hundredths; no actuator is it.
    assert found.of_dynamics[0].standard_error < 0.1
    assert set(found.undetermined) == {"resonance [Hz]", "damping of 200 Hz"}
    assert found.advice[0] == (
        "the resonance at 200 Hz and its damping are not determined: the drive has nothing above "
        "60 Hz; add frequencies up to 300 Hz"
    )


def test_of_two_resonances_the_one_beyond_the_band_is_named() -> None:
    found = forecast_drive(multisine(300.0), audit_stage((520.0, 0.02)))
    assert set(found.undetermined) == {"damping of 520 Hz", "resonance [Hz]"}
    assert [each.verdict for each in found.of_dynamics] == ["yes", "yes", "no", "no"]
    assert "520 Hz and its damping are not determined" in found.advice[0]
    assert "add frequencies up to 780 Hz" in found.advice[0]
    wider = forecast_drive(multisine(1000.0), audit_stage((520.0, 0.02)))
    assert wider.undetermined == ()
    # Beyond 520 Hz the output of two resonances falls as 1/f^4 into the noise, and four free zeros
    # make up for a sample of delay below.
    assert wider.delay_is_open
    quiet = forecast_drive(multisine(5000.0), audit_stage((520.0, 0.02)), noise_db=90.0)
    assert not quiet.delay_is_open


def test_three_sines_do_not_determine_the_poles() -> None:
    k = np.arange(20_000) * 1e-4
    u = sum(np.sin(2.0 * np.pi * f * k + f) for f in (3.0, 11.0, 47.0)) / 3.0
    found = forecast_drive(Drive(np.asarray(u), 1e-4, "sines"), audit_stage())
    assert {"resonance [Hz]", "damping of 200 Hz"} <= set(found.undetermined)
    assert found.delay_is_open
    assert "nothing above 47" in found.advice[0]
    assert "delay is not determined" in found.advice[-1]


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_plays_beyond_the_amplitude_are_named(sign: float) -> None:
    drive = multisine(1000.0, amplitude=0.4)
    found = forecast_drive(Drive(sign * drive.u, 1e-4, "m", drive.period), audit_stage())
    assert set(found.undetermined) == {"p[4]", "p[5]", "r[4]", "r[5]"}
    assert len(found.advice) == 1
    assert "plays of radius 0.5, 0.8 are not determined" in found.advice[0]
    assert "raise the amplitude" in found.advice[0]


def test_two_levels_tell_of_the_dynamics_alone() -> None:
    found = forecast_drive(hyst.signals.prbs(1e-4, 1.0, register=12, clock=5), audit_stage())
    assert [each.verdict for each in found.of_dynamics] == ["yes", "yes"]
    assert {each.verdict for each in found.of_front} == {"no"}
    assert "nothing in the output tells them apart" in found.advice[0]


def test_too_much_noise_is_told_with_what_it_takes() -> None:
    drive = hyst.signals.levels(DT, 300, 1.0, hold=4)
    found = forecast_drive(drive, small_stage(), noise_db=0.0)
    loud = [each for each in found.of_front if not each.determined]
    assert loud
    worst = max(each.share for each in loud)
    assert f"{worst / 0.1:.2g} times the amplitude" in " ".join(found.advice)


def test_what_no_drive_tells_apart_is_shared_and_not_the_drives_fault() -> None:
    # A play of radius 0 is the input itself; a map behind plays shares a factor with their weights.
    stage = sketched_stage(1e-4, [(200.0, 0.03)], front=sketched_plays([0.0, 0.3]))
    found = forecast_drive(multisine(1000.0), stage)
    assert found.shared == ("p0", "p[1]")
    assert found.sufficient
    assert len(found.held) == 1
    # Two weights add up, so what is left has the error of their sum: that of the same stage with
    # one weight, and some more for the radius that is free besides.
    (other,) = set(found.shared) - set(found.held)
    alone = sketched_stage(1e-4, [(200.0, 0.03)], front=sketched_plays([0.3], [0.8, 0.2]))
    of_one = named(forecast_drive(multisine(1000.0), alone), "p0")
    assert of_one <= named(found, other) <= 1.1 * of_one
    curved = hyst.DeadZone([0.8, 0.3, 0.2], [0.01, -0.2, 0.25])
    plays = sketched_plays([0.2, 0.4], [0.6, 0.2, 0.2])
    mapped = sketched_stage(1e-4, [(200.0, 0.03)], front=curved @ plays)
    wide = forecast_drive(multisine(1000.0), mapped)
    assert {"p0", "p[1]", "p[2]"} <= set(wide.shared)
    assert not {"r[1]", "r[2]"} & set(wide.shared)
    assert wide.undetermined == ()
    # The same model, and a drive to blame: two levels, or an amplitude below a radius.
    binary = forecast_drive(hyst.signals.prbs(1e-4, 1.0, register=11, clock=5), mapped)
    assert {"r[1]", "r[2]", "p[1]"} <= set(binary.undetermined)
    small = forecast_drive(multisine(1000.0, amplitude=0.3), mapped)
    assert {"r[2]", "p[2]"} <= set(small.undetermined)


def test_models_without_dynamics_and_dynamics_alone() -> None:
    loop = forecast_drive(multisine(100.0), sketched_plays(RADII, WEIGHTS))
    assert loop.of_dynamics == ()
    assert loop.delay_evidence is None
    assert loop.sufficient
    G = hyst.LinearDynamics.from_continuous([1.0], [1.0 / (2 * np.pi * 50.0), 1.0], 1e-4)
    lag = forecast_drive(multisine(1000.0), G)
    assert [each.name for each in lag.of_dynamics] == ["lag [Hz]"]
    assert lag.of_dynamics[0].value == pytest.approx(50.0)
    assert lag.of_dynamics[0].determined
    assert lag.free_of_dynamics == 2  # the gain is free where nothing else takes it


def test_high_orders_at_a_high_rate_stay_accurate() -> None:
    # Six states with poles near 1: the standard errors must not be those of rounding.
    modes = [(60.0, 0.03), (150.0, 0.02), (320.0, 0.02)]
    stage = sketched_stage(1e-4, modes, front=sketched_plays(RADII, WEIGHTS))
    found = forecast_drive(multisine(1000.0), stage)
    frequencies = [each for each in found.of_dynamics if each.is_frequency]
    assert [each.value for each in frequencies] == pytest.approx([60.0, 150.0, 320.0])
    for each in frequencies:
        assert each.by_own_lines == pytest.approx(each.standard_error, rel=0.5)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: forecast_drive(Drive(np.ones(99), 1e-4, "rest"), audit_stage()), "rests at 1"),
        (
            lambda: forecast_drive(multisine(900.0, samples=4000), small_stage()),
            "the drive has dt = 0.0001 s, the model 0.001 s",
        ),
        (
            lambda: forecast_drive(Drive(np.arange(9.0), 1e-4, "ramp"), audit_stage()),
            "9 samples and the model 15 numbers",
        ),
        (
            lambda: forecast_drive(multisine(900.0, samples=4000), audit_stage(), noise=0.0),
            "noise is 0.0",
        ),
        (
            lambda: forecast_drive(
                multisine(900.0, samples=4000, amplitude=0.1), sketched_plays([0.5], [0.0, 1.0])
            ),
            "the model's output does not move",
        ),
        (
            lambda: forecast_drive(multisine(900.0, samples=4000, amplitude=1e300), audit_stage()),
            r"the drive goes to 1e\+300; choose units",
        ),
        (
            lambda: forecast_drive(multisine(900.0, samples=4000, amplitude=1e-200), audit_stage()),
            "the drive goes to 1e-200; choose units",
        ),
        (
            lambda: sketched_stage(1e-3, [(500.0, 0.1)], front=sketched_plays([1.0])),
            "500 Hz, not below half the sample rate",
        ),
        (lambda: sketched_stage(1e-3, [], front=sketched_plays([1.0])), "no resonance is given"),
        (lambda: sketched_stage(1e-3, [(9.0, 0.0)], front=sketched_plays([1.0])), "is 0.0"),
        (lambda: sketched_plays([1.0, 2.0], [1.0]), "1 weights are given for 2 radii"),
    ],
)
def test_what_cannot_be_told_is_refused(make: object, says: str) -> None:
    with pytest.raises(InputError, match=says):
        make()  # type: ignore[operator]
