"""Model and inverse undo each other, both ways, from the first sample on.

Rounding sets the limit: y is rounded at the size of its terms, and the inverse's steepest slope
turns that into an error of u. So the error is at most a few eps times the condition number, the
product of the two sums of absolute weights, and a bound of 1e-12 of the signal's size needs a
condition of about 1e3. The random models have slopes within a ratio of 9 for each stage; the tests
below also go to 1e3 on a single one, with weights of one sign, where the sums are the slopes.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.typing import NDArray

import hyst
from hyst import (
    Affine,
    Composition,
    DeadZone,
    GeneralizedPrandtlIshlinskii,
    ModifiedPrandtlIshlinskii,
    Operator,
    PrandtlIshlinskii,
    load,
)
from reference.examples import EXAMPLES
from reference.random_operators import (
    invertible,
    invertible_banks,
    invertible_gpis,
    invertible_maps,
    invertible_mpis,
    numbers,
    signals,
)

Array = NDArray[np.float64]

TOLERANCE = 1e-12  # of the signal's range, as promised


def size_of(u: Array, *memories: Array) -> float:
    """Range of a signal from 0 on and of the memory it meets: what rounding scales with."""
    return max(np.ptp(np.append(u, 0.0)), *(np.abs(z).max(initial=0.0) for z in memories), 1e-3)


def offsets(operator: Operator) -> float:
    """What constants add to the signal on its way."""
    if isinstance(operator, Affine):
        return abs(operator.offset) * (1.0 + 1.0 / abs(operator.gain))
    return sum(offsets(part) for part in getattr(operator, "parts", ()))


def round_trip_errors(model: Operator, u: Array) -> tuple[float, float]:
    """Errors of inverse(model(u)) and of model(inverse(u)), as parts of the signal's size."""
    inverse = model.inverse()
    size = size_of(u, model.initial_state(), inverse.initial_state()) + offsets(model)
    there = np.abs(inverse(model(u)) - u).max() / size
    back = np.abs(model(inverse(u)) - u).max() / size
    return float(there), float(back)


def condition(model: Operator) -> float:
    return model.lipschitz_constant() * model.inverse().lipschitz_constant()


SOURCES = {
    "maps": invertible_maps,
    "banks": invertible_banks(),
    "gpis": invertible_gpis,
    "mpis": invertible_mpis,
    "everything": invertible,
}


@pytest.mark.parametrize("source", SOURCES)
@given(data=st.data())
def test_random_models(source: str, data: st.DataObject) -> None:
    model, u = data.draw(SOURCES[source]), data.draw(signals())
    assume(condition(model) <= 1e3)
    assert max(round_trip_errors(model, u)) <= TOLERANCE


@given(model=invertible_banks(steepness=1e3, most=20), u=signals())
def test_no_model_is_worse_than_its_condition(model: PrandtlIshlinskii, u: Array) -> None:
    """Also where 1e-12 cannot be had: weights of both signs, slopes from 1e-3 to 1e3."""
    sums = model.p0 + np.append(0.0, np.cumsum(model.p))
    absolute_sums = model.p0 + np.append(0.0, np.cumsum(np.abs(model.p)))
    # Cumulative weights lose digits where weights cancel, and the inverse's constants with them.
    cancellation = (absolute_sums / sums).max()
    n = model.p.size + 2
    bound = 4.0 * n * np.finfo(float).eps * condition(model) * cancellation
    assert max(round_trip_errors(model, u)) <= bound


@given(
    slopes=st.lists(st.floats(0.0, 3.0), min_size=1, max_size=25).map(sorted),
    stiffening=st.booleans(),
    u=signals(),
)
def test_slopes_over_three_decades(slopes: list[float], stiffening: bool, u: Array) -> None:
    c = 10.0 ** np.array(slopes if stiffening else slopes[::-1])
    r = 8.0 * np.arange(1, c.size) / c.size
    assert max(round_trip_errors(PrandtlIshlinskii(np.diff(c), r, c[0]), u)) <= TOLERANCE


# Their outputs have a limit below the signals of these tests, beyond which there is no input.
LIMITED = ("jiles-atherton", "jiles-atherton 1986", "jiles-atherton 1992", "masing that saturates")

# What changes in a sample, over the sample time, magnifies rounding; excess losses take its root.
WITH_LOSSES = {
    "jiles-atherton with losses": 1e-6,
    "jiles-atherton of B with eddy currents": 1e-9,
}
INVERSES_WITH_LOSSES = {"inverse jiles-atherton with eddy currents": 1e-9}
OTHERS = (*LIMITED, *WITH_LOSSES, *INVERSES_WITH_LOSSES)


@pytest.mark.parametrize(
    "name",
    [n for n, each in EXAMPLES.items() if each.traits().invertible and n not in OTHERS],
)
@given(u=signals())
def test_examples(name: str, u: Array) -> None:
    assert max(round_trip_errors(EXAMPLES[name], u)) <= TOLERANCE


@pytest.mark.parametrize("name", LIMITED)
@given(u=signals(-0.5, 0.5))
def test_examples_within_their_limits(name: str, u: Array) -> None:
    """From what the model gives for small inputs, and back."""
    model = EXAMPLES[name]
    y = model(u)
    np.testing.assert_allclose(model(model.inverse()(y)), y, rtol=0.0, atol=TOLERANCE)


@pytest.mark.parametrize("name", WITH_LOSSES)
@given(u=signals(-0.5, 0.5))
def test_examples_with_losses(name: str, u: Array) -> None:
    model = EXAMPLES[name]
    y = model(u)
    np.testing.assert_allclose(model(model.inverse()(y)), y, rtol=0.0, atol=WITH_LOSSES[name])


@pytest.mark.parametrize("name", INVERSES_WITH_LOSSES)
@given(u=signals())
def test_examples_of_inverses_with_losses(name: str, u: Array) -> None:
    assert max(round_trip_errors(EXAMPLES[name], u)) <= INVERSES_WITH_LOSSES[name]


@pytest.mark.parametrize("name", LIMITED)
def test_what_is_beyond_a_limit_is_refused_by_its_sample(name: str) -> None:
    with pytest.raises(hyst.InputError, match=r"at u\[1\] = 1000"):
        EXAMPLES[name].inverse()([0.0, 1000.0])


@given(model=invertible, u=signals(), tail=signals())
def test_both_go_on_together(model: Operator, u: Array, tail: Array) -> None:
    """Run in pieces, each with its own state: what an actuator and its compensator do."""
    assume(condition(model) <= 1e3)
    inverse = model.inverse()
    size = size_of(np.append(u, tail), model.initial_state(), inverse.initial_state())
    size += offsets(model)
    first, inverse_state = inverse.run(u)
    second, _ = inverse.run(tail, inverse_state)
    state = model.run(first)[1]
    assert np.abs(model.run(second, state)[0] - tail).max() <= TOLERANCE * size


@given(model=invertible_banks(), u=signals(), tail=signals())
def test_from_a_state_in_mid_record(model: PrandtlIshlinskii, u: Array, tail: Array) -> None:
    """A state that a run has left is a memory an inverse can start from."""
    assume(condition(model) <= 1e3)
    started = PrandtlIshlinskii(model.p, model.r, model.p0, z0=model.run(u)[1])
    assert max(round_trip_errors(started, tail)) <= TOLERANCE


def canonical(pi: PrandtlIshlinskii) -> tuple[Array, Array, Array]:
    """The model with plays of one threshold taken together, and those of 0 as the linear part.

    Written for the test: weights at the distinct thresholds above 0, and what is at or below 0.
    """
    r = np.array(sorted({value for value in pi.r.tolist() if value > 0.0}))
    p = np.array([pi.p[pi.r == value].sum() for value in r])
    z = np.array([pi.z0[pi.r == value][0] for value in r])
    return np.append(pi.p0 + pi.p[pi.r == 0.0].sum(), p), r, z


@given(model=invertible_banks())
def test_the_inverse_of_the_inverse_is_the_model(model: PrandtlIshlinskii) -> None:
    weights, r, z = canonical(model)
    assume(np.diff(r, prepend=0.0).min(initial=1.0) > 1e-3)  # closer ones merge on the way
    twice = model.inverse().inverse()
    # Slopes within a ratio of 9, up to 9 terms; relative to the largest of each kind.
    for found, wanted in zip(canonical(twice), (weights, r, z), strict=True):
        assert found.shape == wanted.shape
        scale = max(np.abs(wanted).max(initial=0.0), np.abs(r).max(initial=0.0))
        assert np.abs(found - wanted).max(initial=0.0) <= TOLERANCE * scale


def by_threshold(zone: DeadZone) -> dict[float, float]:
    found: dict[float, float] = {}
    for weight, threshold in zip(zone.weights, zone.thresholds, strict=True):
        found[float(threshold)] = found.get(float(threshold), 0.0) + float(weight)
    return dict(sorted(found.items()))


@given(data=st.data())
def test_the_inverse_of_the_inverse_map_is_the_map(data: st.DataObject) -> None:
    zone = data.draw(invertible_maps)
    assume(isinstance(zone, DeadZone))
    found, wanted = by_threshold(zone.inverse().inverse()), by_threshold(zone)
    assert len(found) == len(wanted)
    for given_pair, wanted_pair in zip(found.items(), wanted.items(), strict=True):
        # Slopes within a ratio of 9, thresholds up to 6, four pieces a side.
        assert given_pair == pytest.approx(wanted_pair, rel=TOLERANCE, abs=6.0 * TOLERANCE)


@given(model=invertible_gpis | invertible_mpis, u=signals())
def test_the_inverse_of_the_inverse_model_does_the_same(model: Operator, u: Array) -> None:
    assume(condition(model) <= 1e3)
    twice = model.inverse().inverse()
    size = size_of(model(u), model.initial_state(), u) + offsets(model)
    # Twice the constants are computed, twice with the same few roundings.
    assert np.abs(twice(u) - model(u)).max() <= 2.0 * TOLERANCE * size * condition(model) ** 0.5


def test_generalized_and_modified_are_each_others_inverse() -> None:
    bank = PrandtlIshlinskii([0.5, 0.2], [1.0, 2.0], p0=0.3)
    zone = DeadZone([0.8, 0.4], [0.0, 1.5])
    generalized = GeneralizedPrandtlIshlinskii(zone, bank)
    modified = ModifiedPrandtlIshlinskii(bank, zone)
    assert generalized.inverse() == ModifiedPrandtlIshlinskii(bank.inverse(), zone.inverse())
    assert modified.inverse() == GeneralizedPrandtlIshlinskii(zone.inverse(), bank.inverse())
    nested = modified @ Affine(2.0, 1.0) @ generalized
    assert nested.inverse() == Composition(
        (modified.inverse(), Affine(2.0, 1.0).inverse(), generalized.inverse())
    )


@given(model=invertible_gpis | invertible_mpis)
def test_an_inverse_model_is_saved_and_loaded_as_what_it_is(
    model: Operator, tmp_path_factory: pytest.TempPathFactory
) -> None:
    inverse = model.inverse()
    other = {GeneralizedPrandtlIshlinskii, ModifiedPrandtlIshlinskii} - {type(model)}
    assert type(inverse) in other
    assert type(inverse.inverse()) is type(model)
    path = tmp_path_factory.mktemp("inverse") / "inverse.json"
    inverse.save(path)
    found = load(path)
    assert type(found) is type(inverse)
    assert found == inverse
    # What rises with its input has an inverse that does.
    assert inverse.traits().invertible
    assert inverse.traits().monotone == model.traits().monotone


# What the equations make of special cases, worked out by hand.


def test_by_hand() -> None:
    # c = 1, 1.5, 2: g = 1, -0.5/1.5, -0.5/3; s = 1, 1 + 1.5.
    model = PrandtlIshlinskii([0.5, 0.5], [1.0, 2.0], p0=1.0, z0=[1.0, 1.5])
    inverse = model.inverse()
    assert inverse.p0 == 1.0
    assert inverse.p == pytest.approx([-1.0 / 3.0, -1.0 / 6.0], rel=1e-15)
    assert inverse.r.tolist() == [1.0, 2.5]
    # w_2 = 2 1.5, w_1 = 1.5 1 + 0.5 1.5.
    assert inverse.z0.tolist() == [2.25, 3.0]


def test_tied_thresholds_count_as_one_play() -> None:
    tied = PrandtlIshlinskii([0.25, 0.25, 1.0], [1.0, 1.0, 3.0], p0=0.5, z0=[0.5, 0.5, 2.0])
    assert tied.inverse() == PrandtlIshlinskii([0.5, 1.0], [1.0, 3.0], 0.5, [0.5, 2.0]).inverse()


def test_a_play_without_width_counts_as_linear_part() -> None:
    ideal = PrandtlIshlinskii([0.5, 1.0], [0.0, 3.0], p0=0.5, z0=[77.0, 2.0])
    # Its memory is overwritten by the first input, so it may be anything.
    assert ideal.inverse() == PrandtlIshlinskii([1.0], [3.0], 1.0, [2.0]).inverse()
    # Without it p0 is too small to say where the input is; the sum is not.
    tiny = PrandtlIshlinskii([1.0, 1.0], [0.0, 3.0], p0=1e-9)
    assert max(round_trip_errors(tiny, np.array([0.0, 5.0, -4.0, 1.0]))) <= TOLERANCE
    linear = PrandtlIshlinskii([1.0, 1.0], [0.0, 3.0], p0=0.0)
    assert max(round_trip_errors(linear, np.array([0.0, 5.0, -4.0, 1.0]))) <= TOLERANCE


def test_idle_plays_stay_idle() -> None:
    idle = PrandtlIshlinskii([0.0, 0.5, 0.0], [1.0, 2.0, 50.0], p0=0.5)
    inverse = idle.inverse()
    assert inverse.p.tolist() == [0.0, -1.0, 0.0]
    assert inverse.r.tolist() == [0.5, 1.0, 49.0]


def test_no_plays() -> None:
    assert PrandtlIshlinskii([], [], p0=4.0).inverse() == PrandtlIshlinskii([], [], p0=0.25)


def test_thresholds_far_beyond_the_signal() -> None:
    """Plays that never move, with memory: their share of the output is a constant."""
    model = PrandtlIshlinskii([0.5, 0.5], [1e6, 2e6], p0=1.0, z0=[3.0, -4.0])
    u = np.sin(np.arange(100.0))
    assert max(round_trip_errors(model, u)) <= TOLERANCE


def test_inputs_that_stop_exactly_at_thresholds() -> None:
    model = PrandtlIshlinskii([0.5, 0.25, 0.125], [0.5, 1.0, 2.0], p0=1.0)
    lattice = np.random.default_rng(3).integers(-12, 13, 400) / 4.0
    # Quarters and eighths are exact, so only the inverse's thirds are rounded.
    assert max(round_trip_errors(model, lattice)) <= 1e-14


@pytest.mark.parametrize("seed", range(3))
def test_a_thousand_plays(seed: int) -> None:
    generator = np.random.default_rng(seed)
    p = generator.exponential(1e-3, 1000)
    r = np.cumsum(generator.exponential(0.01, 1000))
    u = np.cumsum(generator.standard_normal(3000))
    assert max(round_trip_errors(PrandtlIshlinskii(p, r, 0.5), u)) <= TOLERANCE


@pytest.mark.parametrize("scale", [1e-150, 1e-6, 1e6, 1e150])
def test_units_do_not_matter(scale: float) -> None:
    u = np.array([0.0, 5.0, -4.0, 1.0, 3.0]) * scale
    model = PrandtlIshlinskii([0.5, 0.25], [1.0 * scale, 2.0 * scale], p0=0.5)
    assert np.abs(model.inverse()(model(u)) - u).max() <= 1e-15 * np.ptp(u)
    gain = PrandtlIshlinskii([0.5 * scale, 0.25 * scale], [1.0, 2.0], p0=0.5 * scale)
    assert np.abs(gain.inverse()(gain(u)) - u).max() <= 1e-15 * np.ptp(u)


@given(gain=numbers(0.25, 3.0), offset=numbers(-3.0, 3.0), u=signals())
def test_falling_lines(gain: float, offset: float, u: Array) -> None:
    line = Affine(-gain, offset)
    inverse = line.inverse()
    assert inverse.gain < 0.0
    # A handful of roundings of numbers up to 8 + 3/0.25.
    assert np.abs(inverse(line(u)) - u).max() <= 6.0 * np.finfo(float).eps * 20.0


def test_falling_envelopes() -> None:
    # -u up to 1, then slope -2; slope -0.5 below -3.
    zone = DeadZone([-1.0, -1.0, 0.5], [0.0, 1.0, -3.0])
    inverse = zone.inverse()
    # The kinks are at y = -1 and 3, with slopes -1, -1/2 below -1 and -2 above 3.
    assert by_threshold(inverse) == {-1.0: 0.5, 0.0: -1.0, 3.0: -1.0}
    model = GeneralizedPrandtlIshlinskii(zone, PrandtlIshlinskii([0.5], [1.0], p0=0.5))
    u = np.array([0.0, 5.0, -7.0, 1.0, -3.0, 2.0])
    assert max(round_trip_errors(model, u)) <= 1e-15 * 10
