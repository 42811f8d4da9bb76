"""First-order reversal curves of a record, and the density that they show."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import hyst
from hyst import InputError, NotIdentifiableError, Record
from hyst.signals import forc, forc_density, reversal_curves
from reference.switching_material import gaussian, switched


def test_curves_are_found_where_they_were_driven() -> None:
    drive = forc(0.01, -1.0, 1.0, 1.0, curves=8)
    noise = 1e-4 * np.random.default_rng(1).normal(size=drive.u.size)
    curves = reversal_curves(Record(drive.u + noise, drive.u, 0.01))
    # Evenly from the top down, to the sample's 0.01.
    np.testing.assert_allclose(
        [each.beta for each in curves], np.linspace(-1.0, 0.75, 8), atol=0.011
    )
    for each in curves:
        assert each.u[-1] == pytest.approx(1.0, abs=0.011)
        assert each.u_down[-1] == pytest.approx(1.0, abs=0.011)
        assert (np.diff(each.u) >= 0.0).all()


def test_rises_inside_are_passed_over() -> None:
    turns = [-1.0, 1.0, 0.5, 1.0, 0.0, 1.0, -0.5, 0.5, -0.2, 1.0, -1.0, 1.0]
    u = np.concatenate([np.linspace(a, b, 50) for a, b in pairwise(turns)])
    curves = reversal_curves(Record(u, u, 0.01))
    # That from -0.2 came from 0.5, inside.
    assert [round(each.beta, 6) for each in curves] == [-1.0, -0.5, 0.0, 0.5]


def test_a_record_with_too_few_curves_is_refused() -> None:
    u = np.sin(np.linspace(0.0, 6.0, 500))
    with pytest.raises(NotIdentifiableError, match=r"1 first-order reversal curves.*forc"):
        reversal_curves(Record(u, u, 0.01))


@pytest.mark.parametrize("noise", [0.0, 1e-3])
def test_one_loop_driven_again_is_one_curve(noise: float) -> None:
    turns = [0.0, 1.0] + 6 * [-1.0, 1.0]
    u = np.concatenate([np.linspace(a, b, 50) for a, b in pairwise(turns)])
    u = u + noise * np.random.default_rng(1).normal(size=u.size)
    with pytest.raises(NotIdentifiableError, match=r"6 first-order.* 1 different input, .*forc"):
        reversal_curves(Record(u, u, 0.01))


def test_curves_driven_twice_show_the_density_as_driven_once() -> None:
    drive = forc(0.02, -1.0, 1.0, 1.0, curves=20)
    even = hyst.Preisach([[1.0]], [-1.0, 1.0])
    record = Record(drive.u, even(drive.u), 0.02)
    shifted = Record(drive.u + 1e-4, even(drive.u), 0.02)
    found = forc_density(reversal_curves([record, shifted]), points=20)
    # A mass of 1 over an area of 2; the shift of 1e-4 moves it by as much at most.
    assert np.nanmedian(found.density) == pytest.approx(0.5, abs=1e-3)
    assert np.isfinite(found.density[np.tril_indices(20, -1)]).mean() > 0.9


@pytest.mark.parametrize("given", [[], [1.0], ["u"]])
def test_what_is_no_record_or_curve_is_refused(given: list[object]) -> None:
    with pytest.raises(InputError, match="record"):
        reversal_curves(given)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="curves"):
        forc_density(given)  # type: ignore[arg-type]


def test_the_density_is_that_of_the_material() -> None:
    density = gaussian(0.4, 0.15, 0.2)
    drive = forc(0.02, -1.0, 1.0, 1.0, curves=40)
    y = 2.0 * switched(density, drive.u) - 1.0
    noisy = y + 2e-3 * np.random.default_rng(2).normal(size=y.size)
    found = forc_density(reversal_curves(Record(drive.u, noisy, 0.02)), points=30)
    alpha, beta = np.meshgrid(found.alpha, found.beta, indexing="ij")
    true = np.where(alpha >= beta, density(alpha, beta), 0.0)
    true /= true.sum() * (found.alpha[1] - found.alpha[0]) ** 2
    known = np.isfinite(found.density) & ((alpha - beta) > 0.3) & (np.abs(alpha + beta) < 1.0)
    left = (found.density - true)[known]
    # Windows of 0.3 flatten a peak 0.15 wide by some percent; noise leaves less.
    assert np.sqrt(np.mean(left**2)) < 0.1 * true.max()
    place = np.nanargmax(np.where(known, found.density, np.nan))
    peak = np.unravel_index(place, found.density.shape)
    assert (found.alpha[peak[0]] - found.beta[peak[1]]) / 2.0 == pytest.approx(0.4, abs=0.1)
    assert (found.alpha[peak[0]] + found.beta[peak[1]]) / 2.0 == pytest.approx(0.0, abs=0.1)


def test_a_linear_part_has_no_density() -> None:
    drive = forc(0.02, -1.0, 1.0, 1.0, curves=12)
    found = forc_density(reversal_curves(Record(drive.u, 3.0 * drive.u, 0.02)), points=15)
    # Second differences over windows of half the range: rounding of 3.
    assert np.nanmax(np.abs(found.density)) < 1e-9
    with pytest.raises(hyst.InputError, match="points is 3"):
        forc_density(reversal_curves(Record(drive.u, drive.u, 0.02)), points=3)
