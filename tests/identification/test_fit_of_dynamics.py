"""`hyst.fit` with linear dynamics before, behind and on both sides of a hysteresis."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import least_squares

import hyst
from hyst import InputError, LinearDynamics, Operator

DT = 1e-4
SAMPLES = 6000
DB = 40.0

PLAYS = hyst.PrandtlIshlinskii([0.3, 0.2, 0.15], [0.05, 0.15, 0.35], p0=0.5)
ROUGH = hyst.PrandtlIshlinskii([0.25, 0.25, 0.1], [0.03, 0.2, 0.4], p0=0.6)


def resonance(frequency: float, damping: float) -> LinearDynamics:
    w = 2.0 * np.pi * frequency
    return LinearDynamics.from_continuous([w * w], [1.0, 2.0 * damping * w, w * w], DT)


def low_pass(frequency: float) -> LinearDynamics:
    w = 2.0 * np.pi * frequency
    return LinearDynamics.from_continuous([w], [1.0, w], DT)


WIENER = PLAYS @ resonance(200.0, 0.3)
ROUGH_WIENER = ROUGH @ resonance(220.0, 0.33)
BOTH = resonance(200.0, 0.03) @ PLAYS @ low_pass(2000.0)
ROUGH_BOTH = resonance(180.0, 0.04) @ ROUGH @ low_pass(1800.0)


def multisine(seed: int, top: float = 1000.0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    lines = np.zeros(SAMPLES // 2 + 1, dtype=complex)
    last = int(top * SAMPLES * DT)
    lines[1 : last + 1] = np.exp(2j * np.pi * rng.random(last))
    u = np.fft.irfft(lines, SAMPLES)
    return np.asarray(u / np.abs(u).max())


def chirp(seed: int) -> np.ndarray:
    """Sweep up over two decades, of growing and falling size."""
    t = np.arange(SAMPLES) / SAMPLES
    phase = 2.0 * np.pi * 10.0 * SAMPLES * DT / np.log(100.0) * (100.0**t - 1.0)
    return np.asarray(np.sin(phase + seed) * (0.6 + 0.4 * np.sin(9.0 * t)))


def recorded(model: Operator, u: np.ndarray, seed: int = 0, db: float = DB) -> hyst.Record:
    y = model(u)
    sigma = float(np.std(y)) * 10.0 ** (-db / 20.0)
    return hyst.Record(u, y + sigma * np.random.default_rng(seed).normal(size=u.size), DT)


def missed(model: Operator, true: Operator, u: np.ndarray) -> float:
    """Share of the output's deviation that a model misses of what the truth would give."""
    y = true(u)
    return float(np.std(model(u) - y) / np.std(y))


PAIRS = {
    "before": (WIENER, ROUGH_WIENER),
    "behind": (resonance(200.0, 0.03) @ PLAYS, resonance(220.0, 0.03) @ ROUGH),
    "both sides": (BOTH, ROUGH_BOTH),
    "both sides of another kind": (
        resonance(200.0, 0.03) @ hyst.Dahl(5.0, 1.5) @ low_pass(2000.0),
        resonance(180.0, 0.03) @ hyst.Dahl(4.0, 1.2) @ low_pass(1800.0),
    ),
}


@pytest.mark.parametrize("drive", [multisine, chirp])
@pytest.mark.parametrize("where", PAIRS)
def test_a_start_ten_percent_off_ends_at_the_truth(where: str, drive: type) -> None:
    true, start = PAIRS[where]
    u = drive(3)
    found = hyst.fit(start, recorded(true, u), start=0)
    # Some 15 constants from 6000 samples leave a twentieth of the noise, which is 1 %.
    assert missed(found.model, true, u) < 1.5e-3
    assert missed(start, true, u) > 0.05
    assert found.verdict.level == "good"


def test_what_is_told_of_dynamics_are_modes_and_coefficients() -> None:
    found = hyst.fit(ROUGH_BOTH, recorded(BOTH, multisine(0)), start=0)
    told = dict(zip(found.parameter_names, found.parameter_values, strict=True))
    errors = dict(zip(found.parameter_names, found.standard_errors, strict=True))
    assert not any(".A[" in name or ".B[" in name for name in told)
    expected = {
        "linear_dynamics_1.time_constant[1]": 1.0 / (2.0 * np.pi * 2000.0),
        "linear_dynamics_2.frequency[1]": 200.0,
        "linear_dynamics_2.damping[1]": 0.03,
        "linear_dynamics_2.a[1]": -2.0
        * np.exp(-0.03 * 0.04 * np.pi)
        * np.cos(0.04 * np.pi * np.sqrt(1.0 - 0.03**2)),
        "linear_dynamics_2.a[2]": np.exp(-2.0 * 0.03 * 0.04 * np.pi),
    }
    for name, value in expected.items():
        # Four standard errors: of five numbers, one in some thousand runs is beyond.
        assert abs(told[name] - value) < 4.0 * errors[name], name
        assert errors[name] < 0.05 * abs(value), name
    assert all(np.isfinite(each) for name, each in errors.items() if "linear" in name)


def test_standard_errors_agree_with_scatter() -> None:
    fits = [hyst.fit(BOTH, recorded(BOTH, multisine(1), seed), start=0) for seed in range(24)]
    values = np.array([each.parameter_values for each in fits])
    stated = np.array([each.standard_errors for each in fits])
    ratio = values.std(axis=0, ddof=1) / np.sqrt(np.mean(stated**2, axis=0))
    dynamics = np.array(["linear" in name for name in fits[0].parameter_names])
    # 24 draws know a standard deviation to 15 %; a dozen numbers, three of that.
    assert (ratio[dynamics] < 1.5).all()
    assert (ratio[dynamics] > 0.55).all()


def test_the_scale_between_stages_is_held_and_told() -> None:
    found = hyst.fit(ROUGH_BOTH, recorded(BOTH, multisine(0)), start=0)
    before, _, behind = found.model.parts
    # A gauge of ten times the output's deviation holds the gain to the rounding of the fit.
    assert before.dc_gain() == pytest.approx(1.0, abs=1e-6)
    assert behind.dc_gain() == pytest.approx(1.0, abs=1e-6)
    assert sum("at rest is held at 1" in each for each in found.undetermined) == 2
    assert np.isfinite(found.standard_errors).all()


def test_a_gain_that_is_seen_is_an_estimate() -> None:
    """The hysteresis is held, so that nothing makes up for the gain of the dynamics."""
    start = PLAYS @ LinearDynamics.from_continuous([1.3e6], [1.0, 800.0, 1.6e6], DT)
    found = hyst.fit(start, recorded(WIENER, multisine(0)), free="linear_dynamics", start=0)
    told = dict(zip(found.parameter_names, found.parameter_values, strict=True))
    errors = dict(zip(found.parameter_names, found.standard_errors, strict=True))
    assert abs(told["linear_dynamics.gain"] - 1.0) < 4.0 * errors["linear_dynamics.gain"] < 0.02
    assert not any("held" in each for each in found.undetermined)


def test_another_gain_at_rest_stays_the_one_of_the_start() -> None:
    """An amplifier of gain 8 keeps it, and the radii are in its output's unit."""
    amplifier = LinearDynamics.from_continuous([8.0 * 1e4], [1.0, 1e4], DT)
    plays = hyst.PrandtlIshlinskii(PLAYS.p, 8.0 * PLAYS.r, p0=PLAYS.p0)
    rough = hyst.PrandtlIshlinskii(ROUGH.p, 8.0 * ROUGH.r, p0=ROUGH.p0)
    record = recorded(plays @ amplifier, multisine(0))
    found = hyst.fit(rough @ amplifier, record, start=0)
    assert found.model.parts[0].dc_gain() == pytest.approx(8.0, rel=1e-6)
    assert found.model.parts[1].r == pytest.approx(plays.r, rel=0.05)
    assert any("at rest is held at 8" in each for each in found.undetermined)


def test_the_minimum_is_that_of_another_optimiser_over_coefficients() -> None:
    """SciPy over the numbers of the transfer function, by differences, ends nowhere lower."""
    true = PLAYS @ resonance(200.0, 0.3)
    u = multisine(0)[:2500]
    record = hyst.Record(u, recorded(true, u, db=30.0).y, DT)
    found = hyst.fit(true, record, free=["linear_dynamics"], start=0)

    def residual(theta: np.ndarray) -> np.ndarray:
        dynamics = LinearDynamics.from_transfer_function(theta[2:], [1.0, *theta[:2]], DT)
        return (PLAYS @ dynamics)(u) - record.y

    denominator = np.poly(true.parts[0].A)
    numerator = true.parts[0].impulse_response(3)[1:]
    numerator = np.array([numerator[0], numerator[1] + denominator[1] * numerator[0]])
    expected = least_squares(
        residual, [*denominator[1:], *numerator], x_scale=[1e-3, 1e-3, 1e-4, 1e-4]
    )
    cost = float(np.sum((found.model(u) - record.y) ** 2))
    assert cost <= 2.0 * expected.cost * (1.0 + 1e-6)


def test_realization_and_zero_feedthrough_stay() -> None:
    """A companion form stays one, and D = 0 stays unless it is named."""
    a = np.poly(resonance(220.0, 0.3).A)
    companion = LinearDynamics.from_transfer_function([a.sum()], a, DT)
    assert companion.D == 0.0
    record = recorded(WIENER, multisine(0))
    free = ["prandtl_ishlinskii", "linear_dynamics"]
    found = hyst.fit(ROUGH @ companion, record, free=free, start=0)
    after = found.model.parts[0]
    assert after.D == 0.0
    np.testing.assert_array_equal(after.A[1], companion.A[1])
    np.testing.assert_array_equal(after.B, companion.B)
    named = hyst.fit(ROUGH @ companion, record, free=[*free, "linear_dynamics.D"], start=0)
    assert named.model.parts[0].D != 0.0
    assert "linear_dynamics.b[0]" in named.parameter_names
    assert "linear_dynamics.b[0]" not in found.parameter_names


def test_any_realization_of_the_start_gives_the_same_system() -> None:
    turn = np.array([[3.0, 1.0], [-40.0, 2.0]])
    start = resonance(220.0, 0.3)
    turned = LinearDynamics(
        turn @ start.A @ np.linalg.inv(turn),
        turn @ start.B,
        start.C @ np.linalg.inv(turn),
        0.0,
        DT,
    )
    record = recorded(WIENER, multisine(0))
    fits = [hyst.fit(ROUGH @ each, record, start=0) for each in (start, turned)]
    # Both end at the minimum, to a small share of a standard error.
    apart = np.abs(fits[0].parameter_values - fits[1].parameter_values)
    assert (apart < 0.05 * fits[0].standard_errors).all()


def test_single_entries_that_are_named_are_what_moves() -> None:
    start = PLAYS @ resonance(220.0, 0.3)
    names = ["linear_dynamics.A[1,1]", "linear_dynamics.C"]
    found = hyst.fit(start, recorded(WIENER, multisine(0)), free=names, start=0)
    assert found.parameter_names[0] == "linear_dynamics.A[1,1]"
    np.testing.assert_array_equal(found.model.parts[0].A.ravel()[1:], start.parts[0].A.ravel()[1:])


def test_two_stages_of_dynamics_in_a_row_are_told() -> None:
    true = low_pass(400.0) @ resonance(200.0, 0.3)
    start = low_pass(450.0) @ resonance(190.0, 0.3)
    found = hyst.fit(start, recorded(true, multisine(0)), start=0)
    assert missed(found.model, true, multisine(0)) < 1.5e-3
    assert any("which poles and zeros are of which" in each for each in found.undetermined)
    assert np.isfinite(found.standard_errors).all()


def test_plays_on_both_sides_hold_a_constant_of_theirs() -> None:
    """Two scales, and one gain of the dynamics between them: a weight holds the other."""
    more = hyst.PrandtlIshlinskii([0.3], [0.2], p0=0.7)
    true = more @ resonance(200.0, 0.3) @ PLAYS
    found = hyst.fit(true, recorded(true, multisine(0)), start=0)
    assert sum("is held at" in each for each in found.undetermined) == 2
    assert len(found.parameter_names) == 7 + 3 + 6 - 1


@pytest.mark.parametrize(("input_exponent", "output_exponent"), [(3, -2), (7, -20), (0, 30)])
def test_units_do_not_matter(input_exponent: int, output_exponent: int) -> None:
    by_input, by_output = 2.0**input_exponent, 2.0**output_exponent
    record = recorded(BOTH, multisine(0))
    scaled = hyst.Record(by_input * record.u, by_output * record.y, DT)
    start = resonance(180.0, 0.04) @ ROUGH.in_units(by_input, by_output) @ low_pass(1800.0)
    plain = hyst.fit(ROUGH_BOTH, record, start=0).model
    other = hyst.fit(start, scaled, start=0).model
    np.testing.assert_array_equal(other.parts[0].A, plain.parts[0].A)
    np.testing.assert_array_equal(other.parts[2].C, plain.parts[2].C)
    np.testing.assert_array_equal(other.parts[1].r, by_input * plain.parts[1].r)


def test_what_no_fit_can_start_from_is_refused() -> None:
    record = recorded(WIENER, multisine(0))
    unstable = LinearDynamics([[1.01]], [1.0], [0.1], 0.0, DT)
    with pytest.raises(InputError, match=r"linear_dynamics has the pole 1\.01.*not inside"):
        hyst.fit(ROUGH @ unstable, record)
    unmoved = LinearDynamics([[0.5, 0.0], [0.0, 0.9]], [1.0, 0.0], [0.5, 1.0], 0.0, DT)
    with pytest.raises(InputError, match=r"pole 0\.9.*lower order"):
        hyst.fit(ROUGH @ unmoved, record)
    with pytest.raises(InputError, match="fitted as a whole"):
        hyst.fit(ROUGH_WIENER, record, bounds={"linear_dynamics.C": (0.0, 1.0)})
    with pytest.raises(InputError, match="sample times"):
        ROUGH @ low_pass(100.0) @ LinearDynamics([[0.5]], [1.0], [0.5], 0.0, 2 * DT)
    with pytest.raises(InputError, match=r"the model 0\.0001 s"):
        hyst.fit(ROUGH_WIENER, hyst.Record(record.u, record.y, 2 * DT))


def test_dynamics_without_states_are_a_gain() -> None:
    gain = LinearDynamics(np.zeros((0, 0)), [], [], 1.0, DT)
    found = hyst.fit(gain @ ROUGH, recorded(PLAYS, multisine(0)), start=0)
    gain_found = found.model.parts[1].dc_gain()
    assert gain_found == pytest.approx(1.0, abs=1e-6)  # of the gauge, as above
    assert missed(found.model, PLAYS, multisine(0)) < 1.5e-3  # as above


def test_loops_that_dynamics_turn_over_are_no_doubt_where_noise_is_left() -> None:
    """A phase of more than a quarter turn makes falling output of rising input."""
    true = PLAYS @ resonance(300.0, 0.7)
    record = recorded(true, multisine(23))
    assert any(each.name == "butterfly" for each in hyst.diagnose(record).findings)
    found = hyst.fit(ROUGH @ resonance(330.0, 0.8), record, start=0)
    assert missed(found.model, true, record.u) < 1.5e-3  # as above
    assert found.verdict.level == "good"
