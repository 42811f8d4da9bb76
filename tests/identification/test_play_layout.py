"""Free parameters, and the operators they make."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from simulated_records import drive

from hyst.identification.families.family import Start
from hyst.identification.families.play_layout import FirstGuess
from hyst.identification.families.plays import Plays, weights_left
from hyst.identification.families.registry import families

PLAYS = ("pi", "gpi", "mpi")
START = FirstGuess(
    p0=1.0,
    p=np.array([0.5, 0.2]),
    r=np.array([0.2, 0.6]),
    offset=0.7,
    sign=-1.0,
    knots=np.array([-0.5, -0.2, 0.3, 0.8]),
    largest_radius=0.9,
    mean_slope=1.7,
)


def parametrize(family: str, guess: FirstGuess) -> Start:
    its_family = families[family]
    assert isinstance(its_family, Plays)
    return its_family.parametrize(guess)


@pytest.mark.parametrize("family", PLAYS)
def test_the_start_is_a_plain_model_with_an_identity_map(family: str) -> None:
    parametrization, theta = parametrize(family, START)
    u = drive(200)
    expected = parametrize("pi", START)[0].operator(parametrize("pi", START)[1])(u)
    np.testing.assert_allclose(parametrization.operator(theta)(u), expected, atol=1e-14)


@pytest.mark.parametrize("family", PLAYS)
@given(data=st.data())
def test_every_theta_within_bounds_makes_an_invertible_operator(
    family: str, data: st.DataObject
) -> None:
    parametrization, _ = parametrize(family, START)
    lower = np.maximum(parametrization.lower, -2.0)
    upper = np.minimum(parametrization.upper, 3.0)
    shares = data.draw(st.lists(st.floats(0.0, 1.0), min_size=lower.size, max_size=lower.size))
    theta = parametrization.canonical(lower + np.array(shares) * (upper - lower))
    operator = parametrization.operator(theta)
    u = drive(50)
    # Slopes lie between 1e-3 * 0.02 and about 30, so rounding is amplified by up to 1e7.
    np.testing.assert_allclose(operator.inverse()(operator(u)), u, atol=1e-8)


@pytest.mark.parametrize("family", PLAYS)
def test_constants_are_affine_in_theta(family: str) -> None:
    parametrization, theta = parametrize(family, START)
    shifted = theta + 0.01
    difference = parametrization.constants(shifted) - parametrization.constants(theta)
    np.testing.assert_allclose(difference, parametrization.transform @ np.full(theta.size, 0.01))


@pytest.mark.parametrize("family", ["gpi", "mpi"])
def test_slopes_beyond_the_knots_are_the_free_parameters(family: str) -> None:
    """Slope of the map just beyond each knot, measured on the map itself."""
    parametrization, theta = parametrize(family, START)
    slopes = np.array([0.4, 0.7, 1.5, 0.2])
    theta[-5:-1] = slopes
    operator = parametrization.operator(theta)
    named = operator.parts[0]  # type: ignore[attr-defined]
    the_map = named.envelope if family == "gpi" else named.output_map
    beyond = START.knots + np.array([-1.0, -1.0, 1.0, 1.0]) * 1e-3
    measured = (the_map(beyond + 1e-5) - the_map(beyond - 1e-5)) / 2e-5
    np.testing.assert_allclose(measured, slopes, rtol=1e-6)


def test_canonical_sorts_plays_with_their_weights() -> None:
    parametrization, theta = parametrize("pi", START)
    shuffled = theta.copy()
    shuffled[1:5] = [0.2, 0.5, 0.6, 0.2]
    np.testing.assert_array_equal(parametrization.canonical(shuffled), theta)


def test_a_play_that_is_left_out_leaves_its_weight_to_the_one_before_it() -> None:
    working = np.array([False, True, False, False, True])
    kept = weights_left(np.array([1e-9, 7.0, -6.5, 0.25, 2.0]), working)
    np.testing.assert_array_equal(kept, [0.75, 2.0])
    assert weights_left(np.array([1e-9]), np.array([False])).shape == (0,)
