"""Columns beside a model: the same minimum and standard errors as a fit that holds them all."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.optimize
from numpy.typing import NDArray

import hyst
from hyst.errors import NotIdentifiableError
from hyst.identification.families.family import Fit
from hyst.identification.families.registry import chosen_families
from hyst.identification.fit.bounded_least_squares import CONVERGED, Solution, minimize
from hyst.identification.fit.nuisance import (
    Beside,
    Drift,
    Nuisances,
    Settling,
    over_whole_records,
)
from hyst.identification.fit.problem import problem_of
from hyst.identification.fit.stages import with_part, with_stage
from hyst.identification.fit_model import parametrize_own
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data, prepare
from hyst.identification.result.fit_spread import spread_of_fit
from hyst.operators import Affine

Array = NDArray[np.float64]

DT = 0.05
TRUE = Affine(1.0, 0.3) @ hyst.Creep([0.2], [2.0], DT) @ hyst.PrandtlIshlinskii([0.4], [0.3], 1.0)
NUISANCES = Nuisances((Drift(), Settling((4,))))
"""theta = (p0, p, r, creep's weight, its time constant, offset)."""


def _records(rng: np.random.Generator) -> Data:
    records = []
    for samples, drift, before in ((400, 0.5, -0.3), (250, -0.2, 0.6)):
        t = DT * np.arange(samples)
        u = np.sin(1.3 * t) + 0.8 * np.sin(0.31 * t) * (t > 5.0)
        more = drift * (2.0 * t / t[-1] - 1.0) + before * np.exp(-t / 2.0)
        y = TRUE(u) + more + 0.01 * rng.standard_normal(samples)
        records.append(hyst.Record(u, y, DT))
    return prepare(records, 0)


def _parametrized():
    places = ["creep", "prandtl_ishlinskii", "affine.offset"]
    parametrization, theta = parametrize_own(TRUE, places, {})
    return replace(parametrization, nuisances=NUISANCES), theta


def _joint_columns(data: Data, tau: float) -> Array:
    """Drift and settling of each record in columns of their own, written anew."""
    blocks = []
    for record in data.records:
        t = record.dt * np.arange(len(record))
        blocks.append(np.column_stack([2.0 * t / t[-1] - 1.0, np.exp(-t / tau)]))
    (n, m), zeros = (len(each) for each in blocks), np.zeros
    return np.block([[blocks[0], zeros((n, 2))], [zeros((m, 2)), blocks[1]]])


def test_projected_columns_give_the_minimum_of_the_joint_fit() -> None:
    data = _records(np.random.default_rng(1))
    parametrization, theta = _parametrized()
    found = minimize(problem_of(data, parametrization), theta * 1.1, 200, 1e-9)

    def joint(both: Array) -> Array:
        model = parametrization.operator(both[:6])
        output = np.concatenate([model(record.u) for record in data.records])
        return output + _joint_columns(data, both[4]) @ both[6:] - data.measured()

    start = np.concatenate([theta, np.zeros(4)])
    reference = scipy.optimize.least_squares(joint, start, xtol=1e-14, ftol=1e-14, gtol=1e-14)
    errors = spread_of_fit(data, Fit(_pi(), 1, parametrization, found)).of(np.eye(6))
    # Both iterations end within a small part of a standard error.
    assert np.all(np.abs(found.theta - reference.x[:6]) < 1e-3 * errors)
    assert found.cost == pytest.approx(2.0 * reference.cost, rel=1e-7)


def test_standard_errors_are_those_of_the_joint_fit() -> None:
    data = _records(np.random.default_rng(2))
    parametrization, theta = _parametrized()
    found = minimize(problem_of(data, parametrization), theta, 200, 1e-9)
    told = spread_of_fit(data, Fit(_pi(), 1, parametrization, found))
    beside = Beside(data, NUISANCES).at(found.theta)
    tau = found.theta[4]
    model = parametrization.operator(found.theta)
    output = np.concatenate([model(record.u) for record in data.records])
    coefficients = np.concatenate(beside.coefficients(data.measured() - output))
    by_theta = np.concatenate([model.jacobian(r.u) for r in data.records])
    by_theta = by_theta @ parametrization.transform
    step = 1e-5 * tau
    moved = _joint_columns(data, tau + step) - _joint_columns(data, tau - step)
    by_theta[:, 4] += moved @ coefficients / (2.0 * step)
    whole = np.column_stack([by_theta, _joint_columns(data, tau)])
    residual = data.measured() - output - _joint_columns(data, tau) @ coefficients
    variance = float(residual @ residual) / (residual.size - whole.shape[1])
    # White noise: the textbook covariance; the robust one scatters around it by some percent.
    textbook = np.sqrt(variance * np.diag(np.linalg.inv(whole.T @ whole)))[:6]
    assert told.of(np.eye(6)) == pytest.approx(textbook, rel=0.25)
    assert told.noise_rms == pytest.approx(np.sqrt(variance), rel=1e-6)
    assert beside.directions == 4


def test_standard_errors_agree_with_scatter() -> None:
    found, errors = [], []
    for seed in range(40):
        data = _records(np.random.default_rng(100 + seed))
        parametrization, theta = _parametrized()
        solution = minimize(problem_of(data, parametrization), theta)
        found.append(solution.theta)
        errors.append(spread_of_fit(data, Fit(_pi(), 1, parametrization, solution)).of(np.eye(6)))
    scatter, told = np.std(found, axis=0), np.median(errors, axis=0)
    # The standard deviation of 40 values is known to 11 %: three times that.
    assert np.all(np.abs(scatter / told - 1.0) < 0.34)


def test_what_the_columns_make_is_found_over_the_whole_record() -> None:
    data = _records(np.random.default_rng(3))
    parametrization, theta = _parametrized()
    model = parametrization.operator(theta)
    output = np.concatenate([model(record.u) for record in data.records])
    coefficients = Beside(data, NUISANCES).at(theta).coefficients(data.measured() - output)
    made = over_whole_records(data, NUISANCES, theta, coefficients)
    t = DT * np.arange(400)
    drift = t / t[-1] - 0.3 * np.exp(-t / 2.0)
    # The offset, which is the model's, takes the mean of the drift; noise of 0.01 on 400 samples.
    assert np.abs(np.diff(made[0]) - np.diff(drift)).max() < 0.002


def _pi():
    return chosen_families("pi", {})[0]


@pytest.mark.parametrize("name", ["pi", "gpi", "mpi", "preisach", "bouc-wen", "linear", "dahl"])
@pytest.mark.parametrize("where", ["output", "drive"])
def test_stage_stands_in_its_place_in_every_family(name: str, where: str) -> None:
    t = np.linspace(0.0, 30.0, 600)
    u = np.sin(t) * np.linspace(1.0, 0.4, t.size) + 0.2
    y = hyst.PrandtlIshlinskii([0.5, 0.3], [0.2, 0.5], 1.0)(u) + 0.1
    overview = Overview(prepare(hyst.Record(u, y, DT), "auto"))
    (family,) = chosen_families(name, {})
    base, theta = family.starts(overview, family.sizes()[0], 1)[0]
    creep = hyst.Creep([0.1], [1.5], DT)
    staged, both = with_stage(base, theta, creep, where, np.zeros(2) + 1e-3, np.full(2, np.inf))
    alone = base.operator(base.canonical(theta))
    own = staged.operator(staged.canonical(both))
    if where == "drive":
        expected = alone(creep(u))
    else:
        offset = alone.parts[-1].offset if name != "linear" else alone.offset
        expected = offset + creep(alone(u) - offset)
    # Two ways to round the same sums.
    assert np.abs(own(u) - expected).max() < 1e-12 * np.ptp(expected)
    assert np.abs(staged.as_template(staged.canonical(both))(u) - expected).max() < 1e-9
    scaled = staged.in_units(both, 0.5, 4.0)
    # Powers of two change no digit of most models; some take roots of their constants.
    assert scaled.operator(both)(0.5 * u) == pytest.approx(4.0 * own(u), rel=1e-9, abs=1e-9)


def test_model_whose_constant_would_creep_is_refused() -> None:
    butterfly = hyst.Butterfly(
        hyst.PrandtlIshlinskii([0.5], [0.2], 0.1), np.array([[0.0, 1.0], [1.0, 0.0]])
    )
    with pytest.raises(NotIdentifiableError, match="butterfly, whose constant would creep"):
        with_part(butterfly, hyst.Creep([0.1], [1.0], DT), "output")


def test_no_column_changes_nothing() -> None:
    data = _records(np.random.default_rng(4))
    parametrization, theta = _parametrized()
    bare = replace(parametrization, nuisances=None)
    with_none = replace(parametrization, nuisances=Nuisances((Drift(0),)))
    solutions = [minimize(problem_of(data, each), theta) for each in (bare, with_none)]
    assert solutions[0].status == CONVERGED
    assert np.array_equal(solutions[0].theta, solutions[1].theta)
    assert isinstance(solutions[1], Solution)
