"""Delays of part of a sample and first-order lags: found, told apart, and counted in all errors."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from numpy.typing import NDArray

import hyst
from hyst.errors import InputError, NotIdentifiableError, NotInvertibleError
from reference.rate_dependent_plays import ACTUATOR, DT, output, rate

Array = NDArray[np.float64]

FREQUENCIES = ((10.0, 2.0), (50.0, 6.0), (100.0, 12.0))
"""Hz, and periods of each record."""
NOISE = 0.3
"""Of a stroke of about 80."""
LAG = 0.42
"""Samples: 1.5 degrees at 100 Hz, what the amplifier of S4 lags by."""


def sine(frequency: float, periods: float, dt: float = DT) -> Array:
    return 40.0 * np.sin(2.0 * np.pi * frequency * np.arange(round(periods / frequency / dt)) * dt)


def late_sine(frequency: float, periods: float, kind: str, late: float, dt: float = DT) -> Array:
    """What an amplifier gives of the sine that begins at 0, in closed form; late in seconds."""
    t, w = np.arange(round(periods / frequency / dt)) * dt, 2.0 * np.pi * frequency
    if kind == "delay":
        return 40.0 * np.sin(w * np.maximum(t - late, 0.0))
    phase = np.arctan(w * late)
    settled = np.sin(w * t - phase) + np.sin(phase) * np.exp(-t / late)
    return 40.0 * np.cos(phase) * settled


def plant(v: Array, share: float = 1.0, dt: float = DT) -> Array:
    """S4's actuator behind its amplifier; a share of 0 takes the rate out of it."""
    widening = share * ACTUATOR["beta"] * rate(v, dt)
    return output(ACTUATOR["p"], ACTUATOR["r"], ACTUATOR["p0"], v, widening)


def noisy(clean: list[tuple[Array, Array]], seed: int, noise: float = NOISE) -> list[hyst.Record]:
    random = np.random.default_rng(seed)
    return [hyst.Record(u, y + noise * random.standard_normal(y.size), DT) for u, y in clean]


def clean(kind: str, late: float, share: float = 1.0) -> list[tuple[Array, Array]]:
    return [(sine(f, n), plant(late_sine(f, n, kind, late * DT), share)) for f, n in FREQUENCIES]


def told(found: hyst.Identified, name: str) -> tuple[float, float]:
    place = next(i for i, each in enumerate(found.parameter_names) if each.endswith(name))
    return float(found.parameter_values[place]), float(found.standard_errors[place])


@pytest.mark.parametrize(("kind", "seeds", "least"), [("delay", 20, 17), ("first-order", 8, 6)])
def test_beta_and_lag_are_held_by_what_is_told_of_them(kind: str, seeds: int, least: int) -> None:
    """Of what is held with 95 % fewer than these are held once in sixty times."""
    runs = clean(kind, LAG)
    held_beta = held_lag = 0
    for seed in range(seeds):
        found = hyst.identify(noisy(runs, seed), family="rdpi", plays=3)
        beta, error = told(found, "beta")
        held_beta += abs(beta - ACTUATOR["beta"]) <= 2.0 * error
        held_lag += found.delay_interval[0] <= LAG <= found.delay_interval[1]
        # Widened by the lag, and still known to a percent; without it 10 % off.
        assert error < 0.01 * ACTUATOR["beta"]
    assert held_beta >= least
    assert held_lag >= least


@pytest.mark.parametrize("late", [0.0, LAG])
def test_a_lag_makes_no_rate_dependence(late: float) -> None:
    """Beta 0 within two standard errors; on its bound it is 0 and has none."""
    runs = clean("delay", late, share=0.0)
    held = 0
    for seed in range(8):
        found = hyst.identify(noisy(runs, seed), family="rdpi", plays=3)
        beta, error = told(found, "beta")
        held += beta == 0.0 if np.isnan(error) else beta <= 2.0 * error
        # With the lag left in it is 13 % of S4's own.
        assert beta < 0.03 * ACTUATOR["beta"]
    assert held >= 6  # of 8 with 95 % each; fewer once in sixty times


P, R, P0 = (0.4, 0.3), (0.1, 0.35), 0.8


def decaying(late: float) -> tuple[Array, Array]:
    """A rate-independent plant in steps of a fiftieth of a sample, on strokes that fall."""
    dt, fine, count = 1e-3, 50, 1500

    def drive(t: Array) -> Array:
        return (1.0 - 0.6 * t / (count * dt)) * np.sin(2.0 * np.pi * 8.0 * t)

    t = np.arange(count * fine) * dt / fine - late * dt
    y = output(list(P), list(R), P0, drive(np.maximum(t, 0.0) if late > 0.0 else t), 0.0 * t)
    return drive(np.arange(count) * dt), y[::fine]


@pytest.mark.parametrize("late", [0.0, 0.2, 0.42, 0.5, 0.9, 1.42, -0.7])
def test_any_part_of_a_sample_is_counted(late: float) -> None:
    """4 seeds of 6 constants; errors within a record are correlated, so 20 of 24 are asked for."""
    u, y = decaying(late)
    truth = np.array([P0, *P, *R, 0.0])
    held = inside = 0
    for seed in range(4):
        noise = 0.002 * np.random.default_rng(seed).standard_normal(y.size)
        found = hyst.identify(hyst.Record(u, y + noise, 1e-3), family="pi", plays=2)
        held += found.delay_interval[0] <= late <= found.delay_interval[1]
        miss = np.abs(found.parameter_values - truth)
        inside += int((miss <= 2.0 * found.standard_errors).sum())
        if late == 0.0:
            assert found.delay == 0
    assert held == 4
    assert inside >= 20


def test_a_delay_is_in_its_standard_errors_only_where_it_was_estimated() -> None:
    records = noisy(clean("delay", LAG), 0)
    known = hyst.identify(records, family="rdpi", plays=3, delay=LAG)
    estimated = hyst.identify(records, family="rdpi", plays=3)
    assert told(estimated, "beta")[1] > 1.05 * told(known, "beta")[1]
    assert known.delay_interval == (LAG, LAG)


def test_a_lag_of_many_samples_is_told_from_a_delay() -> None:
    """8 samples are 29 degrees at 100 Hz, where a lag takes 10 % off the amplitude."""
    lagging = hyst.identify(noisy(clean("first-order", 8.0), 0), family="rdpi", plays=3, lag="auto")
    assert lagging.lag is not None
    assert lagging.lag_interval is not None
    low, high = lagging.lag_interval
    assert low <= 8.0 * DT <= high
    assert high - low < 0.6 * DT
    assert lagging.delay == 0
    assert lagging.verdict.level == "good"
    assert any("not a pure delay" in each for each in lagging.undetermined)
    late = hyst.identify(noisy(clean("delay", 8.0), 0), family="rdpi", plays=3, lag="auto")
    assert late.lag is None
    assert late.delay_interval[0] <= 8.0 <= late.delay_interval[1]
    assert any("not a first-order lag" in each for each in late.undetermined)


def test_a_lag_of_part_of_a_sample_is_not_told_from_a_delay_and_says_so() -> None:
    found = hyst.identify(noisy(clean("first-order", LAG), 3), family="rdpi", plays=3, lag="auto")
    tau, error = told(found, "time_constant")
    assert abs(tau - LAG * DT) <= 3.0 * error
    assert any("describe the records alike" in each for each in found.undetermined)
    beta, error = told(found, "beta")
    assert abs(beta - ACTUATOR["beta"]) <= 3.0 * error


def test_records_without_a_lag_are_given_none() -> None:
    found = hyst.identify(noisy(clean("delay", 0.0), 0), family="rdpi", plays=3, lag="auto")
    assert found.lag is None
    assert any("no lag" in each for each in found.undetermined)


def test_a_lag_that_is_given_is_held_and_undone() -> None:
    records = noisy(clean("first-order", 6.0), 0, noise=0.05)
    found = hyst.identify(records, family="rdpi", plays=3, lag=6.0 * DT)
    assert found.lag == 6.0 * DT
    assert found.lag_interval == (6.0 * DT, 6.0 * DT)
    assert "lag.time_constant" not in found.parameter_names
    assert "lag" in found.summary()
    beta, error = told(found, "beta")
    assert abs(beta - ACTUATOR["beta"]) <= 3.0 * error
    assert found.metrics["training"].rms < 1.1 * 0.05


@pytest.fixture(scope="module")
def two_sample_times() -> hyst.Identified:
    """A rate-independent plant behind a lag of 0.6 ms, at 10 and at 4 kHz."""
    records = []
    for seed, (frequency, periods, dt) in enumerate(((100.0, 12.0, 1e-4), (25.0, 4.0, 2.5e-4))):
        v = late_sine(frequency, periods, "first-order", 6e-4, dt)
        noise = 0.05 * np.random.default_rng(seed).standard_normal(v.size)
        y = plant(v, share=0.0, dt=dt) + noise
        records.append(hyst.Record(sine(frequency, periods, dt), y, dt))
    return hyst.identify(records, family="pi", plays=3, lag="auto")


def test_one_lag_in_seconds_for_records_of_other_sample_times(
    two_sample_times: hyst.Identified,
) -> None:
    tau, error = told(two_sample_times, "time_constant")
    assert abs(tau - 6e-4) <= 3.0 * error
    assert error < 1e-5
    assert two_sample_times.verdict.level != "unfit"


def test_the_inverse_undoes_hysteresis_and_lag(two_sample_times: hyst.Identified) -> None:
    model = two_sample_times.model
    y_ref = 20.0 * np.sin(np.arange(2000) * 0.02) * np.linspace(1.0, 0.2, 2000)
    # Rounding, made larger by the inverse of a lag of six samples (12 n^2).
    np.testing.assert_allclose(model(model.inverse()(y_ref)), y_ref, atol=1e-12 * 40.0)
    assert model.stepper() is not None


def test_scaled_records_give_the_scaled_lag_bit_for_bit() -> None:
    records = noisy(clean("first-order", 3.0), 1)
    plain = hyst.identify(records, family="rdpi", plays=3, lag="auto")
    scaled = hyst.identify(
        [dataclasses.replace(r, u=r.u * 2.0**-30, y=r.y * 2.0**41) for r in records],
        family="rdpi",
        plays=3,
        lag="auto",
    )
    assert plain.lag is not None
    assert scaled.lag == plain.lag
    assert scaled.delay == plain.delay
    expected = plain.model.in_units(2.0**-30, 2.0**41).parameters()
    np.testing.assert_array_equal(scaled.model.parameters().values, expected.values)


def test_lag_and_creep_are_fitted_together() -> None:
    """Simulated in steps of a twentieth of a sample; 7 % of creep beside a lag of 1.5 samples."""
    dt, fine, count = 1e-3, 20, 6000
    t = np.arange(count * fine) * dt / fine
    u = np.sin(8.0 * np.pi * t) * (1.0 - 0.6 * t / t[-1]) + 0.3 * np.sin(2.0 * t)
    plays = hyst.PrandtlIshlinskii(list(P), list(R), P0)
    creep = hyst.Creep([0.04, 0.03], [0.05, 0.9], dt / fine)
    y = creep(plays(hyst.Lag(1.5 * dt, dt / fine)(u)))[::fine]
    y = y + 0.002 * np.random.default_rng(0).standard_normal(count)
    record = hyst.Record(u[::fine], y, dt)
    found = hyst.identify(record, family="pi", plays=2, lag="auto", creep=2)
    tau, error = told(found, "lag.time_constant")
    assert abs(tau - 1.5 * dt) <= 3.0 * error
    assert error < 0.1 * dt
    # The slower lag is a fraction of the record, so it is known badly; the quicker one well.
    for name, true in (("weights[1]", 0.04), ("weights[2]", 0.03), ("time_constants[2]", 0.9)):
        value, error = told(found, f"creep.{name}")
        assert abs(value - true) <= 3.0 * error
    assert told(found, "creep.weights[1]")[1] < 0.25 * 0.04
    assert found.metrics["training"].rms < 1.1 * 0.002
    assert found.model.is_invertible()


def test_a_delay_is_put_into_the_model_on_request() -> None:
    u, y = decaying(1.42)
    noise = 0.002 * np.random.default_rng(0).standard_normal(y.size)
    found = hyst.identify(hyst.Record(u, y + noise, 1e-3), family="pi", plays=2)
    late = found.with_delay()
    # The line between two samples is not the cubic of predict: 50 samples a period differ so far.
    assert np.abs(late(u) - found.predict(u))[10:].max() < 0.01
    assert late.description.delay == 0
    with pytest.raises(NotInvertibleError, match="preview"):
        late.inverse()
    y_ref = 0.8 * np.sin(np.arange(500) * 0.05)
    followed = late(late.inverse(preview=12)(y_ref))[12:]
    # What the part of a sample leaves with ten samples of preview, and 0.07 without any.
    assert np.abs(followed - y_ref[:-12])[100:].max() < 0.01
    assert np.abs(found.predict(found.model.inverse()(y_ref)) - y_ref)[100:].max() > 0.05


def test_what_is_ahead_has_no_stage() -> None:
    u, y = decaying(-2.0)
    found = hyst.identify(hyst.Record(u, y, 1e-3), family="pi", plays=2, delay=-2)
    with pytest.raises(InputError, match="ahead"):
        found.with_delay()


@pytest.mark.parametrize("lag", [0.0, -1e-3, np.nan, np.inf, "some", True])
def test_what_is_no_lag_is_refused(lag: object) -> None:
    u, y = decaying(0.0)
    with pytest.raises(InputError, match="lag is"):
        hyst.identify(hyst.Record(u, y, 1e-3), lag=lag)  # type: ignore[arg-type]


def test_dynamics_hold_their_own_lag() -> None:
    u, y = decaying(0.0)
    record = hyst.Record(u, y, 1e-3)
    with pytest.raises(NotIdentifiableError, match="dynamics of its own"):
        hyst.identify(record, family="hammerstein", hysteresis="linear", state_order=1, lag=1e-3)
