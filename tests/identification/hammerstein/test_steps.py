"""The single steps: Markov parameters, realization, best linear approximation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.families.hammerstein import (
    average_periods,
    best_linear_approximation,
    fit_markov,
    realize,
)
from hyst.identification.families.hammerstein.impulse_response import markov
from hyst.identification.families.hammerstein.impulse_response.markov import (
    MarkovParameters,
    choose_markov,
)
from hyst.models import LinearDynamics
from hyst.signals import Record, multisine
from hyst.signals.lagged import lagged_factor, lagged_gram

RNG = np.random.default_rng(5)
G = LinearDynamics.from_continuous([3.391e10], [1.0, 3759.0, 2.063e7, 7.514e10], 0.01)


@pytest.mark.parametrize("order", [0, 1, 2, 5, 20])
@pytest.mark.parametrize("samples", [23, 24, 300])
def test_normal_equations_are_those_of_the_matrix(order: int, samples: int) -> None:
    u, y = RNG.normal(size=samples), RNG.normal(size=samples)
    rows = np.array([[*u[k - order : k + 1][::-1], 1.0] for k in range(order, samples)])
    gram, moment = lagged_gram(u, y, order)
    assert gram == pytest.approx(rows.T @ rows, abs=1e-11)
    assert moment == pytest.approx(rows.T @ y[order:], abs=1e-11)
    factor = lagged_factor(u, y, order)
    full = np.column_stack([rows, y[order:]])
    assert factor.T @ factor == pytest.approx(full.T @ full, abs=1e-10)


def test_markov_parameters_of_linear_dynamics_are_exact() -> None:
    u = RNG.normal(size=4000)
    found = fit_markov(Record(u, 7.0 + G(u), 0.01), 80)
    assert found.values == pytest.approx(G.impulse_response(81), abs=1e-11)
    assert found.offset == pytest.approx(7.0)


def test_markov_standard_errors_are_the_scatter() -> None:
    u, errors = RNG.normal(size=2000), []
    for seed in range(60):
        noise = 0.1 * np.random.default_rng(seed).normal(size=u.size)
        found = fit_markov(Record(u, G(u) + noise, 0.01), 60)
        errors.append((found.values - G.impulse_response(61)) / found.standard_errors)
    # 60 runs of 61 values: the rms of the ratio has a standard error of about 1 %.
    assert np.sqrt(np.mean(np.square(errors))) == pytest.approx(1.0, abs=0.06)


def test_several_records_count_together() -> None:
    u = RNG.normal(size=3000)
    parts = [Record(each, G(each), 0.01) for each in (u[:1000], u[1000:])]
    assert fit_markov(parts, 70).values == pytest.approx(G.impulse_response(71), abs=1e-11)


def test_ill_conditioned_inputs_take_the_qr_path() -> None:
    u = np.sin(0.3 * np.arange(3000)) + 1e-7 * RNG.normal(size=3000)
    found = fit_markov(Record(u, 2.0 * u, 0.01), 4)
    assert found.condition > 1e6
    assert found.values[0] == pytest.approx(2.0, rel=1e-4)


def test_what_does_not_excite_is_told_with_its_rank() -> None:
    u = np.sin(0.3 * np.arange(3000))
    with pytest.raises(NotIdentifiableError, match=r"rank 2 of 21.*more frequencies"):
        fit_markov(Record(u, G(u), 0.01), 20)


def test_a_response_that_leaves_a_residual_of_exactly_zero_is_kept(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # Whether a residual rounds to 0 is up to the BLAS: here every estimate says so.
    def exact(*arguments: object) -> MarkovParameters:
        found = fit_markov(*arguments)  # type: ignore[arg-type]
        return replace(found, standard_errors=np.zeros(found.values.size), residual_rms=0.0)

    # 23 lines and a constant excite 46 + 1 lags: 32 can be told apart, 64 cannot.
    period, phases = 6000, np.random.default_rng(3).uniform(0.0, 2.0 * np.pi, 23)
    lines = np.linspace(1, 2999, 23).astype(int)
    k = np.arange(2 * period)[:, None]
    u = np.cos(2.0 * np.pi * k * lines / period + phases).sum(axis=1)
    fast = LinearDynamics.from_transfer_function([0.0, 0.6], [1.0, -0.4], 0.01)
    monkeypatch.setattr(markov, "fit_markov", exact)
    found, doubts = choose_markov([Record(u, fast(u), 0.01)], "auto")
    assert found.order == 32
    assert "32 lags were taken" in doubts[0]


def test_short_records_and_live_tails_are_refused() -> None:
    u = RNG.normal(size=2000)
    with pytest.raises(InputError, match="longer record or lower fir_order"):
        fit_markov(Record(u[:50], u[:50], 0.01), 30)
    integrator = LinearDynamics.from_transfer_function([1.0], [1.0, -1.0], 0.01)
    with pytest.raises(NotIdentifiableError, match="has not died out"):
        choose_markov([Record(u, integrator(u), 0.01)], "auto")


def test_the_order_of_the_response_is_chosen_long_enough() -> None:
    u = RNG.normal(size=20_000)
    found, doubts = choose_markov([Record(u, G(u), 0.01)], "auto")
    assert doubts == ()
    slowest = abs(G.poles()[0])  # 0.7035
    assert slowest**found.order < 1e-3


@pytest.mark.parametrize("dt", [1.0, 0.01, 3e-5])
@pytest.mark.parametrize("feedthrough", [0.0, 0.7])
def test_realization_gets_feedthrough_and_dc_gain_right(dt: float, feedthrough: float) -> None:
    true = LinearDynamics(G.A, G.B, G.C, feedthrough, dt)
    found = realize(true.impulse_response(60), dt, 3)
    assert pytest.approx(feedthrough, abs=1e-12) == found.dynamics.D
    assert found.dynamics.dc_gain() == pytest.approx(true.dc_gain(), rel=1e-8)
    assert found.dynamics.dt == dt
    assert np.abs(np.sort_complex(found.dynamics.poles())) == pytest.approx(
        np.abs(np.sort_complex(true.poles())), abs=1e-6
    )


def test_realization_order_follows_the_noise() -> None:
    clean = G.impulse_response(61)
    noisy = clean + 1e-3 * RNG.normal(size=61)
    assert realize(clean, 0.01).dynamics.order == 3
    assert realize(noisy, 0.01, "auto", 1e-3).dynamics.order in (2, 3)


def test_unstable_realizations_are_replaced_by_stable_ones() -> None:
    growing = 1.05 ** np.arange(21)
    found = realize(growing, 1.0, 1)
    assert found.stabilized
    assert found.dynamics.is_stable()


def test_best_linear_approximation_separates_noise_and_distortion() -> None:
    period, noise, records = 1000, 0.02, []
    for seed in range(8):
        drive = multisine(0.01, period, rms=1.0, lines="odd", periods=6, seed=seed)
        y = G(drive.u) + 0.05 * G(drive.u**3) + noise * RNG.normal(size=len(drive))
        records.append(Record(drive.u, y, 0.01))
    found = best_linear_approximation(records, period)
    # A cube of a Gaussian input of variance 1 adds 3 times its factor to the linear part.
    expected = 1.15 * G.frequency_response(found.frequency)
    ratio = np.abs(found.response - expected) / found.total
    assert np.sqrt(np.mean(np.square(ratio))) < 1.5
    # White noise in a line: sigma^2 N / |U|^2, over 5 periods and 8 realisations.
    line = np.abs(np.fft.rfft(records[0].u[:period]))[1]
    assert np.median(found.noise) == pytest.approx(
        noise * np.sqrt(period) / line / np.sqrt(40), rel=0.1
    )
    assert np.median(found.distortion) > 5.0 * np.median(found.noise)
    even = np.rint(found.silent_frequency * period * 0.01) % 2 == 0
    assert np.median(found.silent_output[even] / found.silent_noise[even]) < 1.5  # cubes are odd


def test_averaging_periods_keeps_the_response_and_halves_noise() -> None:
    drive = multisine(0.01, 500, rms=1.0, periods=5)
    y = G(drive.u) + 0.1 * RNG.normal(size=len(drive))
    averaged = average_periods(Record(drive.u, y, 0.01), 500)
    assert len(averaged) == 1000
    settled = G(drive.u)[2000:]
    assert (averaged.y[500:] - settled).std() == pytest.approx(0.05, rel=0.15)  # four periods
    with pytest.raises(InputError, match="does not repeat"):
        average_periods(Record(drive.u, y, 0.01), 333)


PERIODIC = Record(np.tile(np.arange(8.0), 4), np.tile(np.arange(8.0), 4), 0.1)


@pytest.mark.parametrize(
    ("step", "says"),
    [
        (lambda: fit_markov([], 3), "no record"),
        (lambda: fit_markov(PERIODIC, -1), "order is -1"),
        (lambda: fit_markov(PERIODIC, 2.5), "order is 2.5"),  # type: ignore[arg-type]
        (lambda: realize(np.full(20, np.nan), 1.0), "markov"),
        (lambda: realize([1.0, 0.0, 0.0, 0.0], 1.0), "all 0"),
        (lambda: best_linear_approximation([], 8), "no record"),
        (lambda: best_linear_approximation(PERIODIC, "8"), "period is '8'"),  # type: ignore[arg-type]
        (lambda: best_linear_approximation(PERIODIC, 8, -1), "settle is -1"),
        (
            lambda: best_linear_approximation([PERIODIC, Record(PERIODIC.u, PERIODIC.y, 0.2)], 8),
            "different dt",
        ),
    ],
)
def test_what_a_step_cannot_use_is_refused(step: Callable[[], object], says: str) -> None:
    with pytest.raises(InputError, match=says):
        step()
