"""Constants over a second signal, identified from records that plain Python has made."""

from __future__ import annotations

import functools
import json

import numpy as np
import pytest

import hyst
from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.schedule.shared import Estimate, sharing_of
from reference import moving_plays

KNOTS = (20.0, 35.0, 50.0)


def record(
    t: float,
    seed: int,
    noise: float = 0.002,
    scale: tuple[float, float] = (1.0, 1.0),
    **kinds: float,
) -> hyst.Record:
    """A record at one temperature, with white noise of a share of the output's range."""
    u = moving_plays.sweep(700)
    y = moving_plays.output(u, np.full(u.size, t), **kinds)
    y = y + noise * np.ptp(y) * np.random.default_rng(seed).normal(size=u.size)
    return hyst.Record(scale[0] * u, scale[1] * y, dt=1e-3)


def truth(t: float, **kinds: float) -> np.ndarray:
    of = moving_plays.actuator(t, **kinds)
    return np.concatenate([[of.p0], of.p, of.r, [of.offset]])


def identified(seed: int, at: tuple[float, ...] = KNOTS, **more) -> hyst.IdentifiedSchedule:
    kinds = more.pop("kinds", {})
    records = [record(t, 100 * seed + i, **kinds) for i, t in enumerate(at)]
    settings = {"family": "pi", "plays": 3, "delay": 0, "name": "temperature"} | more
    return hyst.identify_scheduled(records, at, **settings)


@functools.cache
def found() -> hyst.IdentifiedSchedule:
    held_out = [record(27.5, 91), record(60.0, 92, high=90.0)]
    return identified(0, validation=held_out, validation_at=[27.5, 60.0], unit="degC")


@pytest.mark.parametrize("moving_radii", [0.0, 0.3])
def test_constants_come_back_within_their_standard_errors(moving_radii: float):
    """Over 6 seeds, 7 constants that may move at 3 values: 126 scores, and 18 of the offset."""
    scores, moves = [], []
    for seed in range(6):
        kinds = {"moving_radii": moving_radii}
        result = identified(seed, kinds=kinds)
        expected = np.array([truth(t, **kinds) for t in KNOTS]).T
        values = np.array([each.values for each in result.constants])
        errors = np.array([each.standard_errors for each in result.constants])
        scores.append((values - expected) / errors)
        moves.append([each.moves for each in result.constants])
    size = np.sqrt(np.mean(np.square(scores)))
    # The mean square of some 50 independent scores lies within 0.6 to 1.5 but once in a thousand.
    assert 0.75 < size < 1.25
    assert np.mean(np.abs(scores) < 2.0) > 0.88  # 0.954, less three standard deviations
    share = np.mean(moves, axis=0)
    assert (share[:4] == 1.0).all()  # p0 and weights move by 10 % and 25 %, 20 errors or more
    still = share[7:] if moving_radii else share[4:]
    assert still.max() <= 1 / 3  # what stays is taken to move in 5 % of the runs, all together


def test_what_is_shared_is_one_number_and_surer():
    shared = [each for each in found().constants if not each.moves]
    assert [each.name.split(".")[1] for each in shared] == ["r[1]", "r[2]", "r[3]", "offset"]
    for each in shared:
        assert len(set(each.values.tolist())) == 1
        assert len(set(each.standard_errors.tolist())) == 1
    # Of the offset alone: three records of one noise share it, so its error falls by sqrt(3),
    # but that records at 50 are noisier by their range, and that weights are known better too.
    alone = hyst.identify(record(20.0, 0), family="pi", plays=3, delay=0)
    gain = alone.standard_errors[-1] / shared[-1].standard_errors[0]
    assert 1.4 < gain < 2.6


def test_a_drifting_signal_is_predicted_and_compensated_to_the_noise():
    u = moving_plays.sweep(3000, cycles=12.0)
    t = np.linspace(21.0, 49.0, u.size)
    true = moving_plays.output(u, t)
    model = found().model
    missed = np.sqrt(np.mean((model(u, t) - true) ** 2)) / np.ptp(true)
    frozen = np.sqrt(np.mean((model.at(35.0)(u) - true) ** 2)) / np.ptp(true)
    assert missed < 0.0015  # records have 0.2 % of noise, and 700 samples each
    assert frozen > 5.0 * missed  # the same without the signal, for comparison
    wanted = 0.8 * true
    command = model.inverse().run(wanted, t).y
    reached = moving_plays.output(command, t)
    assert np.sqrt(np.mean((reached - wanted) ** 2)) / np.ptp(wanted) < 0.0015


def test_values_that_took_no_part_judge_the_straight_lines():
    result = found()
    between, outside = result.held_out
    assert (between.value, between.between, between.outside) == (27.5, (20.0, 35.0), False)
    assert between.rms_percent == pytest.approx(0.2, rel=0.15)  # the noise of the record
    assert between.interpolation < 0.5 * between.noise
    assert outside.outside
    assert outside.rms_percent > 0.5
    (inner,) = result.left_out
    assert (inner.value, inner.between) == (35.0, (20.0, 50.0))
    assert inner.interpolation < 0.5 * inner.noise
    assert result.verdict.level == "good"
    assert "outside 20 to 50" in result.summary()
    assert json.loads(json.dumps(result.to_dict(), allow_nan=False))["schedule"]["unit"] == "degC"


def test_a_validation_record_at_a_value_of_the_fit_says_nothing_of_straight_lines():
    result = identified(0, at=(20.0, 50.0), validation=[record(50.0, 77)], validation_at=[50.0])
    assert "records that took no part" in result.summary()
    assert "validation" in result.results[1].metrics
    assert any("do not show whether" in each for each in result.notes)
    between = identified(0, at=(20.0, 50.0), validation=[record(30.0, 77)], validation_at=[30.0])
    assert not any("do not show whether" in each for each in between.notes)


def test_constants_that_bend_are_told():
    """The gain is a parabola: half way between two values it is 10 % from a straight line."""
    u = moving_plays.sweep(700)

    def bent(t: float, seed: int) -> hyst.Record:
        rng = np.random.default_rng(seed)
        y = moving_plays.output(u, np.full(u.size, 20.0)) * (1.0 + 0.1 * ((t - 35.0) / 15.0) ** 2)
        return hyst.Record(u, y + 0.002 * np.ptp(y) * rng.normal(size=u.size), dt=1e-3)

    settings = {"family": "pi", "plays": 3, "delay": 0, "start": 0}
    result = hyst.identify_scheduled(
        [bent(20.0, 1), bent(50.0, 2)],
        [20.0, 50.0],
        validation=[bent(35.0, 3)],
        validation_at=[35.0],
        **settings,
    )
    assert result.verdict.level == "fair"
    assert "straight lines" in result.verdict.sentences[0]
    # 10 % of the rms of the output, of which 0.2 in 1.0 is the offset.
    rms = 0.1 * np.sqrt(np.mean(moving_plays.output(u, np.full(u.size, 20.0)) ** 2))
    assert result.held_out[0].interpolation == pytest.approx(rms, rel=0.05)
    three = hyst.identify_scheduled(
        [bent(20.0, 1), bent(35.0, 3), bent(50.0, 2)], [20.0, 35.0, 50.0], **settings
    )
    assert three.left_out[0].interpolation == pytest.approx(rms, rel=0.05)
    assert any("without the value 35" in each for each in three.notes)


def test_a_signal_that_changes_nothing_leaves_one_model():
    records = [record(20.0, seed) for seed in (1, 2, 3)]
    result = hyst.identify_scheduled(records, [1.0, 2.0, 3.0], family="pi", plays=3, delay=0)
    assert len(result.moving) <= 1
    if not result.moving:
        assert "one model would do" in result.notes[0]
    assert len({each.verdict.level for each in result.results}) == 1


def test_values_may_come_in_any_order_and_more_than_once():
    at = [50.0, 20.0, 35.0, 20.0]
    records = [record(t, i) for i, t in enumerate(at)]
    result = hyst.identify_scheduled(records, at, family="pi", plays=3, delay=0)
    assert result.values.tolist() == [20.0, 35.0, 50.0]
    assert [len(each.per_record) for each in result.results] == [2, 1, 1]
    order = [1, 3, 2, 0]
    again = hyst.identify_scheduled(
        [records[i] for i in order], [at[i] for i in order], family="pi", plays=3, delay=0
    )
    assert again.model == result.model


@pytest.mark.parametrize("scale", [(2.0**12, 2.0**-20), (2.0**-9, 2.0**6)])
def test_units_of_powers_of_two_change_no_bit(scale: tuple[float, float]):
    kinds = {"moving_radii": 0.3}
    results = [
        hyst.identify_scheduled(
            [record(t, i, scale=each, **kinds) for i, t in enumerate(KNOTS)],
            KNOTS,
            family="pi",
            plays=3,
            delay=0,
        )
        for each in ((1.0, 1.0), scale)
    ]
    assert results[1].model == results[0].model.in_units(*scale)
    assert results[1].moving == results[0].moving


@pytest.mark.parametrize("family", ["linear", "gpi", "mpi", "maxwell-slip", "dahl"])
def test_other_families_have_constants_over_the_signal_too(family: str):
    u = moving_plays.sweep(700)

    def actuator(x: float) -> hyst.Operator:
        if family == "linear":
            return hyst.Affine(2.0 + x, 0.3)
        if family == "dahl":
            return hyst.Dahl(5.0 + x, 1.0 + 0.2 * x, 1.0)
        if family == "maxwell-slip":
            return hyst.MaxwellSlip([0.4 + 0.1 * x, 0.3], [0.04 + 0.01 * x, 0.12], 0.3)
        plays = hyst.PrandtlIshlinskii([0.4 + 0.1 * x, 0.3], [0.1, 0.4], p0=1.0)
        return plays if family == "gpi" else hyst.DeadZone([1.0, -0.2], [0.0, 0.5]) @ plays

    def at(x: float, seed: int) -> hyst.Record:
        y = actuator(x)(u)
        noise = 0.002 * np.ptp(y) * np.random.default_rng(seed).normal(size=u.size)
        return hyst.Record(u, y + noise, dt=1e-3)

    more = {"plays": 2} if family in ("gpi", "mpi") else {}
    result = hyst.identify_scheduled(
        [at(x, i) for i, x in enumerate((0.0, 0.5, 1.0))],
        [0.0, 0.5, 1.0],
        family=family,
        delay=0,
        **more,
    )
    y = actuator(0.25)(u)
    missed = np.sqrt(np.mean((result.model.at(0.25)(u) - y)[150:] ** 2)) / np.ptp(y)
    assert missed < 0.002  # of the noise
    assert 0 < len(result.moving) < len(result.constants)
    runs = family != "dahl"
    assert runs == (not any("cannot run" in each for each in result.notes))
    if runs:
        t = np.linspace(0.0, 1.0, u.size)
        y = result.model.run(u, t).y
        np.testing.assert_allclose(result.model.inverse().run(y, t).y, u, rtol=0, atol=1e-12)


def test_what_cannot_be_used_is_refused():
    records = [record(t, i) for i, t in enumerate(KNOTS)]
    with pytest.raises(InputError, match=r"3 record\(s\) but 2 values"):
        hyst.identify_scheduled(records, [20.0, 35.0])
    with pytest.raises(InputError, match="one value 20"):
        hyst.identify_scheduled(records, [20.0] * 3)
    with pytest.raises(InputError, match="values of the records"):
        hyst.identify_scheduled(records, [20.0, np.nan, 50.0])
    with pytest.raises(InputError, match="values of the second signal"):
        hyst.identify_scheduled(records, KNOTS, validation=[records[0]])
    u = moving_plays.sweep(700)
    volts = hyst.Record(u, records[0].y, dt=1e-3, input_unit="V")
    millivolts = hyst.Record(u, records[0].y, dt=1e-3, input_unit="mV")
    with pytest.raises(InputError, match="in 'mV'"):
        hyst.identify_scheduled([volts, millivolts], [20.0, 35.0])
    still = hyst.Record(u, np.zeros(u.size), dt=1e-3)
    with pytest.raises(NotIdentifiableError, match="at s = 35: "):
        hyst.identify_scheduled([records[0], still], [20.0, 35.0])
    with pytest.raises(InputError, match="unknown family"):
        hyst.identify_scheduled(records, KNOTS, family="none")


def test_sharing_by_hand():
    """Two values, two parameters: 1 and 1.2 with errors 0.1 differ by sqrt(2), 0 and 5 by far."""
    spread = np.diag([0.01, 0.01])
    inside = np.array([True, True])
    given = [Estimate(np.array(theta), spread, inside) for theta in ([1.0, 0.0], [1.2, 5.0])]
    sharing = sharing_of(given)
    assert sharing.shared.tolist() == [True, False]
    np.testing.assert_allclose(sharing.thetas, [[1.1, 0.0], [1.1, 5.0]], rtol=0, atol=1e-8)
    # P(chi squared of one degree of freedom > 2) = 0.1573.
    assert sharing.chance[0] == pytest.approx(0.1573, abs=1e-4)
    np.testing.assert_allclose(np.diag(sharing.covariances[0]), [0.005, 0.01], rtol=1e-6)
    # What is correlated follows: with rho = 0.5 the second one moves by half as much.
    joined = np.array([[0.01, 0.005], [0.005, 0.01]])
    given = [Estimate(np.array(theta), joined, inside) for theta in ([1.0, 0.0], [1.2, 5.0])]
    np.testing.assert_allclose(
        sharing_of(given).thetas, [[1.1, 0.05], [1.1, 4.95]], rtol=0, atol=1e-8
    )
    # On a bound at one of the values, nothing is asked.
    given = [Estimate(each.theta, joined, np.array([False, True])) for each in given]
    assert not sharing_of(given).shared.any()
