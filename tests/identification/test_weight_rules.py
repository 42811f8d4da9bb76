"""Loops that flatten after a reversal need negative weights, and get them only where they pay."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import lsq_linear
from simulated_records import TRUE_PI, drive, plays_by_definition, record

import hyst
from hyst.identification.fit.weight_rules import INVERTIBLE
from hyst.identification.fit.weights import fit_weights
from hyst.identification.record_use.used_samples import prepare

FRICTION = hyst.PrandtlIshlinskii(p=[-0.5, -0.3], r=[0.05, 0.2], p0=1.0)


def test_friction_is_recovered_and_inverted() -> None:
    found = hyst.identify(record(FRICTION), family="pi", plays=2)
    np.testing.assert_allclose(found.parameter_values, [1.0, -0.5, -0.3, 0.05, 0.2, 0.0], atol=1e-6)
    u = drive(400, seed=5)
    np.testing.assert_allclose(found.model.inverse()(found.model(u)), u, atol=1e-12)


def test_non_negative_weights_can_be_insisted_on() -> None:
    found = hyst.identify(record(FRICTION), family="pi", plays=2, weights="non-negative")
    values = dict(zip(found.parameter_names, found.parameter_values, strict=True))
    assert all(value >= 0.0 for name, value in values.items() if ".p" in name)


def test_noise_does_not_call_for_negative_weights() -> None:
    found = hyst.identify(record(TRUE_PI, noise=0.05), family="pi", plays=8)
    values = dict(zip(found.parameter_names, found.parameter_values, strict=True))
    assert all(value >= 0.0 for name, value in values.items() if ".p[" in name)


def test_a_bound_is_respected_where_friction_saturates() -> None:
    """A stop is flat at its limit: no invertible model is, so the last slope stays at its bound."""
    saturating = record(hyst.Stop(0.2), noise=0.002)
    found = hyst.identify(saturating, family="pi", plays=1)
    assert found.model.is_invertible()
    assert np.isnan(found.standard_errors).any()
    assert found.metrics["training"].rms_percent < 1.0


def test_the_least_squares_problem_is_solved_under_the_cumulative_rule() -> None:
    given = record(FRICTION, noise=0.05)
    data = prepare(given, 0, 0)
    r = np.linspace(0.05, 0.6, 6)
    found = fit_weights(data, r, rule=INVERTIBLE)
    z = plays_by_definition(given.u, r)
    # Slope c_j of the loading curve multiplies the part of the input between plays j and j + 1.
    shells = -np.diff(np.column_stack([given.u, z, np.zeros(len(given))]), axis=1)
    matrix = np.column_stack([shells, np.ones(len(given))])
    bounds = ([0.0] * 7 + [-np.inf], np.inf)
    expected = lsq_linear(matrix, given.y, bounds, method="bvls", tol=1e-14)
    np.testing.assert_allclose(found.p0 + np.cumsum(found.p), expected.x[1:7], atol=1e-9)
    assert found.p0 == pytest.approx(expected.x[0], abs=1e-9)


def test_an_unknown_rule_is_refused() -> None:
    with pytest.raises(hyst.InputError, match="positive"):
        hyst.identify(record(FRICTION), weights="positive")


@pytest.mark.parametrize("name", ["ensaio.A.1.mat", "ensaio.B.5.mat"])
def test_a_measured_damper_is_described(measured_data: Path, name: str) -> None:
    """Force over displacement of a magneto-rheological damper, which a line leaves 35 % of."""
    path = measured_data / "mr-damper" / name
    given = hyst.read_record(path, input="dist", output="forc", rate=100)
    found = hyst.identify(given, family="linear,pi,gpi,mpi")
    assert found.metrics["training"].rms_percent < 10.0
    assert found.model.is_invertible()
    # The force follows the velocity as well, which plays cannot know.
    assert hyst.identify(given).family == "lugre"
