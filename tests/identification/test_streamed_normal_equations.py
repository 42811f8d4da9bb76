"""Normal equations summed block by block: those of the whole Jacobian, whatever there is beside."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

import hyst
from hyst.identification.families.family import Fit
from hyst.identification.families.registry import chosen_families
from hyst.identification.fit import evaluation, problem
from hyst.identification.fit.bounded_least_squares import Problem, minimize
from hyst.identification.fit.normal_equations import LongSum, NormalEquations
from hyst.identification.fit.nuisance import Drift, Nuisances, Settling
from hyst.identification.fit.problem import problem_of
from hyst.identification.fit_model import parametrize_own
from hyst.identification.record_use.used_samples import Data, prepare
from hyst.identification.result.fit_spread import spread_of_fit
from hyst.identification.result.lateness import lateness_of
from hyst.operators import Affine

Array = NDArray[np.float64]

DT = 0.05
TRUE = Affine(1.0, 0.3) @ hyst.Creep([0.2], [2.0], DT) @ hyst.PrandtlIshlinskii([0.4], [0.3], 1.0)
TAU = 4
"""Place of the time constant in theta."""

CASES = ["plain", "mask", "weights", "samples left out", "drift", "drift and settling", "prior"]


def _data(case: str) -> Data:
    rng = np.random.default_rng(1)
    records, kept = [], []
    for samples in (400, 250):
        t = DT * np.arange(samples)
        u = np.sin(1.3 * t) + 0.8 * np.sin(0.31 * t) * (t > 5.0)
        y = TRUE(u) + 0.2 * t / t[-1] + 0.01 * rng.standard_normal(samples)
        records.append(hyst.Record(u, y, DT))
        kept.append(rng.random(samples) > 0.1)
    data = replace(prepare(records, 0), starts=(30, 5)).delayed(2)
    return replace(data, kept=tuple(kept)) if case == "samples left out" else data


def _posed(case: str) -> tuple[Problem, Array]:
    data = _data(case)
    places = ["creep", "prandtl_ishlinskii", "affine.offset"]
    parametrization, theta = parametrize_own(TRUE, places, {})
    if case == "drift":
        parametrization = replace(parametrization, nuisances=Nuisances((Drift(2),)))
    if case == "drift and settling":
        both = Nuisances((Drift(), Settling((TAU,))))
        parametrization = replace(parametrization, nuisances=both)
    if case == "prior":
        parametrization = replace(parametrization, prior=0.01 * np.eye(theta.size)[:2])
    samples = data.measured().size
    chosen = np.arange(samples) % 7 != 3 if case in ("mask", "weights") else None
    root = np.linspace(0.5, 2.0, samples) if case == "weights" else None
    return problem_of(data, parametrization, chosen, root), theta


@pytest.fixture
def streamed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(problem, "LARGEST_JACOBIAN", 0)
    monkeypatch.setattr(evaluation, "BLOCK", 37)


@pytest.mark.usefixtures("streamed")
@pytest.mark.parametrize("case", CASES)
def test_blocks_sum_to_what_the_whole_jacobian_gives(case: str) -> None:
    posed, theta = _posed(case)
    theta = theta * 1.05
    whole = NormalEquations.of(*posed.linearize(theta))
    found = posed.normal_equations(theta)
    size = np.sqrt(np.diag(whole.matrix))
    outer = np.outer(size, size)
    np.testing.assert_allclose(found.matrix / outer, whole.matrix / outer, rtol=0, atol=1e-12)
    bound = 1e-12 * np.sqrt(whole.cost)
    np.testing.assert_allclose(found.gradient / size, whole.gradient / size, rtol=0, atol=bound)
    assert found.cost == pytest.approx(whole.cost, rel=1e-12)
    assert found.count == whole.count
    rows = np.concatenate([each.jacobian for each in posed.blocks_at(theta)()])
    np.testing.assert_allclose(rows, posed.linearize(theta)[1], rtol=0, atol=1e-12 * size.max())


def _result(case: str) -> tuple[Array, Array, Array]:
    posed, theta = _posed(case)
    data = _data(case)
    found = minimize(posed, theta * 1.1, 200)
    parametrization, _ = parametrize_own(TRUE, ["creep", "prandtl_ishlinskii", "affine.offset"], {})
    family = chosen_families("pi", {"plays": 1})[0]
    fit = Fit(family, 1, parametrization, found)
    late = lateness_of(data, fit)
    errors = spread_of_fit(data, fit).of(np.eye(theta.size))
    return found.theta, errors, np.array([late.change, late.error, *late.by_delay])


def test_long_and_short_ways_end_at_the_same_constants_and_errors(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    short = _result("plain")
    monkeypatch.setattr(problem, "LARGEST_JACOBIAN", 0)
    monkeypatch.setattr(evaluation, "BLOCK", 37)
    long = _result("plain")
    for one, other in zip(short, long, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-6)


def test_long_sums_keep_what_single_additions_round_off() -> None:
    total = LongSum((1,))
    total.add(np.array([1e16]))
    for _ in range(1000):
        total.add(np.array([1.0]))
    total.add(np.array([-1e16]))
    assert total.total[0] == 1000.0
