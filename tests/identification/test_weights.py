"""Weights of given radii against scipy's solver on the explicit matrix."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import nnls
from simulated_records import TRUE_PI, plays_by_definition, record

from hyst import Affine, Record
from hyst.identification.fit.play_bank import bank_matrix
from hyst.identification.fit.weights import LARGEST_CONDITION, fit_weights
from hyst.identification.record_use.used_samples import prepare


def test_recovers_the_weights_of_a_noise_free_record() -> None:
    data = prepare(record(TRUE_PI), "auto", 0)
    found = fit_weights(data, TRUE_PI.r)
    # The problem is well conditioned (below 1e4), so 12 digits remain.
    np.testing.assert_allclose(found.p, TRUE_PI.p, rtol=1e-9)
    assert found.p0 == pytest.approx(1.0, rel=1e-9)
    assert found.offset == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("plays", [1, 10, 60, 150])
def test_agrees_with_nnls_on_the_matrix(plays: int) -> None:
    data = prepare(record(TRUE_PI, noise=0.02), "auto", 0)
    r = data.half_range * np.arange(1, plays + 1) / (plays + 1)
    found = fit_weights(data, r)
    matrix = bank_matrix(data, r)
    one = np.ones((len(matrix), 1))
    _, norm = nnls(np.hstack([matrix, one, -one]), data.measured(), maxiter=10_000)
    # With 150 plays the minimum is flat: the residual is unique, the weights are not.
    assert found.rms == pytest.approx(norm / np.sqrt(len(matrix)), rel=1e-7)
    assert (found.p >= 0.0).all()
    assert found.p0 >= 0.0


def test_both_solution_paths_are_exercised_above() -> None:
    data = prepare(record(TRUE_PI, noise=0.02), "auto", 0)

    def condition(plays: int) -> float:
        return fit_weights(data, data.half_range * np.arange(1, plays + 1) / (plays + 1)).condition

    assert condition(10) < LARGEST_CONDITION < condition(150)


def test_the_bank_matrix_holds_input_and_plays_over_the_samples_used() -> None:
    given = record(TRUE_PI)
    data = prepare([given, given], 5, 2)
    matrix = bank_matrix(data, TRUE_PI.r)
    expected = np.column_stack([given.u, plays_by_definition(given.u, TRUE_PI.r)])[5:-2]
    np.testing.assert_array_equal(matrix, np.concatenate([expected, expected]))


def test_a_falling_output_gives_positive_weights_with_negative_sign() -> None:
    data = prepare(record(Affine(-1.0, 5.0) @ TRUE_PI), "auto", 0)
    found = fit_weights(data, TRUE_PI.r, sign=-1.0)
    np.testing.assert_allclose(found.p, TRUE_PI.p, rtol=1e-9)
    assert found.offset == pytest.approx(5.0, abs=1e-9)


def test_radii_that_hardly_differ_have_weights_whatever_the_rounding() -> None:
    """About one Gram matrix in ten of these is not positive definite, though not ill-conditioned.

    Two plays that hardly differ leave what one leaves; the noise of a sample is 0.1.
    """
    for seed in range(60):
        generator = np.random.default_rng(seed)
        u = np.sin(np.linspace(0.0, 60.0, 1500)) * generator.uniform(0.5, 2.0)
        noisy = Record(u, u + 0.1 * generator.standard_normal(u.size), 1e-3)
        data = prepare(noisy, 0, 0)
        first = 10.0 ** generator.uniform(-5.0, -1.0)
        second = first * (1.0 + 10.0 ** generator.uniform(-7.0, -3.0))
        found = fit_weights(data, np.array([first, second, 0.2]), rule="invertible")
        one_less = fit_weights(data, np.array([first, 0.2]), rule="invertible")
        assert found.rms == pytest.approx(one_less.rms, rel=1e-2)
