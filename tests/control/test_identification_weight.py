"""What an identification leaves unknown of a plant; what was not shown is not known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from identified_cases import DT, PI, G, W, drive, fitted_from_truth, found, record

import hyst
from hyst.control import (
    IdentifiedPlant,
    identification_weight,
    identified_plant,
    require_no_less_than_known,
    uncertainty_weight,
)
from hyst.control.uncertainty.left_unknown import deviations_left, within_bands
from hyst.models import LinearDynamics
from hyst.operators.dynamics_errors import DynamicsErrors

NYQUIST = 0.5 / DT


def off(plant: IdentifiedPlant, frequency: np.ndarray, truth: LinearDynamics = G) -> np.ndarray:
    true, nominal = (each.frequency_response(frequency) for each in (truth, plant.dynamics))
    return np.abs(true / nominal - 1.0)


def shown(plant: IdentifiedPlant) -> np.ndarray:
    assert plant.errors is not None
    frequency = np.array(plant.errors.frequency)
    inside = [(frequency >= low) & (frequency <= high) for low, high in plant.errors.bands]
    return frequency[np.any(inside, axis=0)]


@pytest.mark.parametrize("band", [None, (2.0, 300.0)], ids=["all", "to 300 Hz"])
def test_true_plants_lie_within_three_standard_errors(band: tuple[float, float] | None) -> None:
    u, squares, within, covered = drive(1500, band), [], [], []
    for seed in range(12):
        plant = fitted_from_truth(record(seed, u, 0.05))
        assert plant.errors is not None
        f = shown(plant)
        error = np.interp(f, plant.errors.frequency, plant.errors.standard_error)
        squares.append(np.mean(np.square(off(plant, f) / error)))
        within.append(np.all(off(plant, f) <= within_bands(plant.errors, f, 3.0)))
        if seed < 3:
            Wu = identification_weight(plant)
            every = np.linspace(1.0, 0.999 * NYQUIST, 400)
            gain = np.abs(Wu.system.response(np.exp(2j * np.pi * every * DT))[:, 0, 0])
            covered.append(np.all(off(plant, every) <= gain))
    # The mean of 12 squares of about three normal numbers each scatters by a quarter; twice that.
    assert 0.5 < np.mean(squares) < 1.7
    # Less than 3 % outside, which three normal numbers would have: two of 12 once in twenty runs.
    assert sum(within) >= 11
    assert all(covered)


def test_slopes_of_the_true_hysteresis_lie_within_three_standard_errors() -> None:
    u = drive(2000)
    moving = np.abs(np.diff(u)) > 0.3 * np.abs(np.diff(u)).max()
    within, ratios = [], []
    for seed in range(12):
        plant = fitted_from_truth(record(seed, u, 0.02))
        low, high = plant.slopes()
        slope = (np.diff(PI(u)) / np.diff(plant.hysteresis(u)))[moving]
        # Where a play begins to move between two samples, the two radii tell, not a slope.
        middle = np.quantile(slope, [0.02, 0.98])
        within.append(low <= middle[0] and middle[1] <= high)
        ratios.append(np.abs(middle - 1.0).max() / (high - 1.0))
    assert sum(within) >= 11
    assert np.median(ratios) > 0.1  # three errors beside about one: no bound out of the air
    twice = plant.slopes(0.5, 2.0, 1.0)
    assert twice == pytest.approx((0.5 * (2.0 + low) / 3.0, 2.0 * (2.0 + high) / 3.0), rel=1e-9)


def test_what_the_drive_does_not_show_is_not_known() -> None:
    plant = identified_plant(found(0, (5.0, 150.0)))
    assert plant.errors is not None
    ((low, high),) = plant.errors.bands
    left = deviations_left(plant)
    f = left.w / (2.0 * np.pi)
    # An octave beyond the lines, for what lies there still moves the gain at them.
    assert 2.0 < low < 3.0
    assert 280.0 < high < 310.0
    beyond = f >= high
    assert np.all(left.radius[beyond] >= f[beyond] / high * (1.0 - 1e-9))
    assert np.all(left.radius[f <= 0.1 * low] == pytest.approx(0.1, rel=1e-6))
    Wu = identification_weight(plant)
    assert np.all(Wu.gain >= Wu.radius)
    assert Wu.excess < 2.0


def test_a_mode_beyond_the_drive_is_within_the_weight() -> None:
    w2 = 2.0 * np.pi * 700.0
    mode = [w2 * w2], [1.0, 0.6 * w2, w2 * w2]
    num, den = np.polymul([W * W], mode[0]), np.polymul([1.0, 0.1 * W, W * W], mode[1])
    truth = LinearDynamics.from_continuous(num, den, DT, 2)
    plant = fitted_from_truth(record(1, drive(3000, (2.0, 150.0)), 0.02, truth))
    f = np.linspace(2.0, 0.98 * NYQUIST, 300)
    Wu = identification_weight(plant)
    gain = np.abs(Wu.system.response(np.exp(2j * np.pi * f * DT))[:, 0, 0])
    assert off(plant, f, truth).max() > 0.5  # the model does not know of it
    assert np.all(off(plant, f, truth) <= gain)


def test_a_gap_of_the_drive_is_not_known_and_a_narrow_one_is() -> None:
    plant = identified_plant(found())
    assert plant.errors is not None
    apart = replace(plant.errors, bands=((1.0, 20.0), (200.0, NYQUIST)))
    left = deviations_left(replace(plant, errors=apart))
    f = left.w / (2.0 * np.pi)
    inside = (f > 20.0) & (f < 200.0)
    assert inside.sum() > 5
    assert np.all(left.radius[inside] >= 1.0 - 1e-9)
    assert left.radius[np.argmin(np.abs(f - 5.0))] < 0.1


def test_what_a_model_visibly_lacks_is_counted() -> None:
    w2 = 2.0 * np.pi * 260.0
    both = np.polymul([1.0, 0.1 * W, W * W], [1.0, 0.2 * w2, w2 * w2])
    truth = LinearDynamics.from_continuous([W * W * w2 * w2], both, DT, 2)
    plant = fitted_from_truth(record(0, drive(4000), 0.02, truth))  # of one mode
    assert plant.errors is not None
    error, lacks = np.array(plant.errors.standard_error), np.array(plant.errors.missing)
    f = np.array(plant.errors.frequency)
    wrong = off(plant, f, truth)
    # At the mode that was found a wrong hysteresis makes up for wrong dynamics: only beyond it.
    about = (f > 200.0) & (f < 0.9 * NYQUIST)
    # Noise alone would not tell: it is what is left over the drive that does.
    assert np.median((wrong / error)[about]) > 5.0
    assert np.median((lacks / wrong)[about]) > 0.5
    right = fitted_from_truth(record(0, drive(4000), 0.02))
    assert right.errors is not None
    assert max(right.errors.missing) < 0.02


def test_the_weight_of_the_continuous_plant_grows_beyond_half_the_rate() -> None:
    plant = identified_plant(found())
    Wu = identification_weight(plant, continuous=True)
    f = np.array([0.2, 1.0, 5.0]) * NYQUIST
    gain = np.abs(Wu.system.response(2j * np.pi * f)[:, 0, 0])
    assert Wu.system.dt == 0.0
    assert np.all(gain >= [0.04, 1.0, 5.0])


def test_measured_responses_are_covered_beside_the_standard_errors() -> None:
    plant = identified_plant(found())
    f = np.geomspace(1.0, 500.0, 40)
    alike = (2.0 * np.pi * f, plant.dynamics.frequency_response(f))
    alone = uncertainty_weight(plant, [alike], least=1e-6)
    both = uncertainty_weight(plant, [alike], least=1e-6, identified=plant)
    assert alone.radius.max() < 1e-5
    f = shown(plant)
    gain = np.abs(both.system.response(np.exp(2j * np.pi * f * DT))[:, 0, 0])
    assert plant.errors is not None
    assert np.all(gain >= within_bands(plant.errors, f, 3.0) * (1.0 - 1e-9))


def test_a_weight_below_the_covariance_is_refused_with_both_numbers() -> None:
    plant = fitted_from_truth(record(0, drive(2000), 0.05))
    assert plant.errors is not None
    f = shown(plant)
    least = within_bands(plant.errors, f, 2.0)
    require_no_less_than_known(1.001 * float(least.max()), plant)
    require_no_less_than_known(identification_weight(plant), plant)
    with pytest.raises(hyst.InputError) as refused:
        require_no_less_than_known(1e-4, plant)
    worst = int(np.argmax(least))
    told = f"Wu is 0.0001 at {f[worst]:.4g} Hz, where the identification of the model leaves "
    assert str(refused.value).startswith(told + f"{least[worst]:.3g} unknown")


def test_dynamics_that_were_given_have_no_errors() -> None:
    given = hyst.identify(
        record(0, drive()), family="hammerstein", hysteresis="pi", plays=2, dynamics=G
    )
    with pytest.raises(hyst.InputError, match="they were given"):
        identification_weight(identified_plant(given))


def test_a_drive_that_shows_nothing_is_told() -> None:
    plant = identified_plant(found())
    assert plant.errors is not None
    nothing = replace(plant, errors=replace(plant.errors, bands=()))
    with pytest.raises(hyst.InputError, match="shows nothing of its dynamics"):
        identification_weight(nothing)
    with pytest.raises(hyst.InputError, match="standard_errors is -1"):
        identification_weight(plant, -1.0)
    with pytest.raises(hyst.InputError, match="slow is -1"):
        identification_weight(plant, slow=-1.0)


@pytest.mark.parametrize("unit", [2.0**-30, 2.0**20])
def test_units_of_the_record_do_not_matter(unit: float) -> None:
    measured = record(3, drive(2000))
    options = {"family": "hammerstein", "hysteresis": "pi", "plays": 2, "state_order": 2}
    plain = hyst.identify(measured, **options)
    scaled = hyst.identify(hyst.Record(unit * measured.u, measured.y / unit, DT), **options)
    first, second = (each.description.dynamics_errors for each in (plain, scaled))
    assert first is not None
    assert second is not None
    assert (first.frequency, first.bands) == (second.frequency, second.bands)
    np.testing.assert_array_equal(first.standard_error, second.standard_error)
    np.testing.assert_array_equal(first.missing, second.missing)
    assert first.slope_error == second.slope_error is not None


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"frequency": (2.0, 1.0)}, "do not ascend"),
        ({"frequency": (0.0, 1.0)}, "do not ascend from above 0"),
        ({"frequency": (1.0,)}, "there are 1 frequencies, 2 standard errors"),
        ({"missing": (0.0, -0.1)}, "an error is below 0"),
        ({"standard_error": (0.0, float("inf"))}, "finite number"),
        ({"standard_error": "ab"}, "give a list of numbers"),
        ({"bands": ((2.0, 1.0),)}, "lower one first"),
        ({"bands": ((1.0,),)}, "no pair"),
        ({"bands": 3}, "bands is 3"),
        ({"slope_error": -0.1}, "an error is below 0"),
        ({"slope_error": "a"}, "slope_error is 'a'"),
        ({"more": 1}, "have the entries frequency"),
    ],
)
def test_damaged_errors_are_refused(change: dict[str, object], told: str) -> None:
    good = {"frequency": [1.0, 2.0], "standard_error": [0.1, 0.1], "missing": [0.0, 0.0]}
    whole = good | {"bands": [[1.0, 2.0]]}
    assert DynamicsErrors.from_dict(whole).to_dict() == whole
    told_slope = whole | {"slope_error": 0.01}
    assert DynamicsErrors.from_dict(told_slope).to_dict() == told_slope
    with pytest.raises(hyst.InputError, match=told):
        DynamicsErrors.from_dict(whole | change)
