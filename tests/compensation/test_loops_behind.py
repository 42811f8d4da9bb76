"""Loops behind the dynamics: seen through the inverse of G, and whether the rate moves them."""

from __future__ import annotations

import json

import numpy as np
import pytest
from scipy import signal, stats

import hyst
from hyst.compensation import loops_behind
from hyst.compensation.loop_check.coincidence import coincidence

DT = 1e-3
FRONT = hyst.PrandtlIshlinskii([0.2, 0.15, 0.1], [0.5, 1.5, 3.0], p0=0.6)


def dynamics(late: int = 2, pole: complex = 0.3 + 0.4j, zero: float = 1.6) -> hyst.LinearDynamics:
    """Three poles, a zero outside the circle, a delay; gain 1 at rest."""
    poles = [0.5, pole, np.conj(pole)]
    G = hyst.LinearDynamics.from_zeros_poles_gain([zero], poles, 1.0, DT)
    G = G.in_units(1.0, 1.0 / G.dc_gain())
    return hyst.LinearDynamics(G.A, G.B, G.C, G.D, DT, late)


MODEL = dynamics() @ FRONT


def sine(frequency: float, periods: float, amplitude: float = 5.0, offset: float = 0.0):
    k = np.arange(int(periods / frequency / DT) + 60)
    return offset + amplitude * np.sin(2.0 * np.pi * frequency * DT * k)


def triangle(frequency: float, periods: float, amplitude: float = 5.0):
    k = np.arange(int(periods / frequency / DT) + 60)
    return amplitude * signal.sawtooth(2.0 * np.pi * frequency * DT * k + np.pi / 2.0, 0.5)


def recorded(actuator, inputs, noise=0.05, seed=0, colour=0.0):
    """Records of an actuator with noise of its sensor, white or of first order."""
    rng = np.random.default_rng(seed)
    records = []
    for u in inputs:
        white = noise * np.sqrt(1.0 - colour**2) * rng.normal(size=u.size + 500)
        records.append(
            hyst.Record(u, actuator(u) + signal.lfilter([1.0], [1.0, -colour], white)[500:], DT)
        )
    return records


def cause(found) -> str:
    (test,) = found.tests
    return test.cause


def test_v_of_the_paper_s_sine_by_an_independent_inverse() -> None:
    """S0 fig. 6, with G of eq. 48 held over 0.01 s: own plays, own filter, own Laurent series."""
    dt = 0.01
    numerator, denominator = [3.391e10], [1.0, 3759.0, 2.063e7, 7.514e10]
    b, a, _ = signal.cont2discrete((numerator, denominator), dt)
    b = b.ravel()
    np.testing.assert_allclose(b[1:], [0.256, 0.02439, 0.1349], rtol=2e-3)  # eq. 49 as printed
    p, r = [3.659, 2.8098, 2.1577, 1.6569], [0.0769, 0.1538, 0.2307, 0.3076]
    u = 10.0 * np.sin(dt * np.arange(4 * 628))
    v = np.zeros(u.size)
    for weight, radius in zip(p, r, strict=True):
        z = 0.0
        for k, x in enumerate(u):
            z = max(x - radius, min(x + radius, z))
            v[k] += weight * z
    y = signal.lfilter(b, a, v)
    turns = np.exp(2j * np.pi * np.arange(4096) / 4096)
    taps = np.fft.ifft(np.polyval(a, turns) / np.polyval(b, turns)).real
    # Taps from -1 on: one sample of preview, and the zeros of modulus 0.726 are forgotten by 120.
    h = np.roll(taps, 1)[:160]
    own = np.convolve(y, h)[1 : u.size + 1]

    G = hyst.LinearDynamics.from_continuous(numerator, denominator, dt)
    found = loops_behind(G @ hyst.PrandtlIshlinskii(p, r), hyst.Record(u, y, dt))
    (loop,) = found.loops
    seen = slice(200, u.size - 1)
    assert loop.valid.start < 200
    assert loop.valid.stop >= u.size - 1
    # The series is cut where 1e-9 of its taps are left out.
    np.testing.assert_allclose(loop.v[seen], own[seen], atol=1e-7 * np.ptp(v))
    np.testing.assert_allclose(loop.v[seen], v[seen], atol=1e-7 * np.ptp(v))
    assert loop.metrics.max_percent < 1e-5
    # The area between the samples of one cycle of 628.3, to what its end misses.
    cycle = slice(628, 628 + 629)
    polygon = 0.5 * abs(
        np.dot(u[cycle], np.roll(v[cycle], -1)) - np.dot(np.roll(u[cycle], -1), v[cycle])
    )
    (repeated,) = found.repeated
    assert repeated.area == pytest.approx(polygon, rel=2e-3)
    assert repeated.frequency == pytest.approx(1.0 / (2.0 * np.pi), rel=1e-9)


@pytest.mark.parametrize(("periods", "colour"), [(3.0, 0.0), (6.0, 0.9)])
def test_noise_alone_is_called_a_difference_as_often_as_stated(
    periods: float, colour: float
) -> None:
    values = []
    for seed in range(200):
        inputs = [sine(frequency, periods) for frequency in (4.0, 10.0, 23.7)]
        records = recorded(MODEL, inputs, seed=seed, colour=colour)
        p_value = loops_behind(MODEL, records).p_value
        assert p_value is not None
        values.append(p_value)
    # Of 200 with a chance of 0.05, more than 22 come in 1 of 4000; Bonferroni makes it fewer.
    assert 1 <= np.sum(np.array(values) < 0.05) <= 22
    assert np.sum(np.array(values) < 0.01) <= 8  # more in 1 of 4000


def test_two_means_are_compared_as_by_welch() -> None:
    rng = np.random.default_rng(4)
    means = rng.normal(size=(2, 3, 2))
    variances, freedoms = np.array([[0.5, 0.2, 0.1], [0.1, 0.3, 0.8]]), (4, 9)
    found = coincidence(list(means), list(variances), freedoms)
    both = variances.sum(axis=0)
    t = (means[0] - means[1]) / np.sqrt(both)[:, None]
    freedom = both**2 / (variances[0] ** 2 / 4 + variances[1] ** 2 / 9)
    by_hand = 2.0 * stats.t.sf(np.abs(t), freedom[:, None])
    np.testing.assert_allclose(found.p_values, by_hand, rtol=1e-10)
    assert found.p_value == pytest.approx(min(1.0, 6 * by_hand.min()))


def test_noise_of_a_measured_input_is_not_the_rate() -> None:
    """The model's plays turn at the noise, those of the actuator do not."""
    alarms = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        records = [
            hyst.Record(each.u + 0.1 * rng.normal(size=each.u.size), each.y, DT)
            for each in recorded(MODEL, [sine(f, 6.0) for f in (4.0, 10.0, 23.7)], 0.02, seed)
        ]
        alarms += not loops_behind(MODEL, records, level=0.05).holds
    # Without a word on that noise a quarter are alarms; of 40 with 0.05, 7 or more in 1 of 250.
    assert alarms <= 6


# What is wrong is found, and called by its name


def test_plays_that_widen_with_the_rate_are_found() -> None:
    widening = hyst.RateDependentPrandtlIshlinskii(
        [0.2, 0.15, 0.1], [0.5, 1.5, 3.0], 5e-4, DT, p0=0.6
    )
    true = dynamics() @ widening
    inputs = [sine(f, 8.0) for f in (2.0, 6.0, 15.0)]
    for seed in range(20):
        noisy = loops_behind(MODEL, recorded(true, inputs, 0.05, seed))
        assert not noisy.holds
        # A delay of 0.2 samples does nearly the same, and noise may hide by how much not.
        assert cause(noisy) in ("wider", "delay")
        found = loops_behind(MODEL, recorded(true, inputs, 0.02, seed))
        assert cause(found) == "wider"
        areas = [each.area / each.modelled_area for each in found.repeated]
        assert areas == sorted(areas)
    by_itself = loops_behind(true, recorded(true, inputs))
    assert by_itself.holds
    assert "what the rate does in the model taken out" in by_itself.sentences()[0]


def test_creep_is_found_and_named() -> None:
    creeping = dynamics() @ hyst.Creep([0.06, 0.05], [0.02, 0.1], DT) @ FRONT
    inputs = [sine(f, 8.0) for f in (1.0, 4.0, 15.0)]
    for seed in range(10):
        found = loops_behind(MODEL, recorded(creeping, inputs, 0.02, seed))
        assert not found.holds
        assert cause(found) in ("creep", "narrower")
        assert "creep" in found.sentences()[0]


@pytest.mark.parametrize("samples", [0.4, -0.6])
def test_a_delay_of_part_of_a_sample_is_named_with_its_size(samples: float) -> None:
    """The true delay is whole in a clock four or more times as fast; the model's is 2 samples."""
    late = hyst.Delay(2.0 + samples, DT)
    records = recorded(dynamics(0) @ late @ FRONT, [sine(f, 8.0) for f in (3.0, 8.0, 20.0)], 0.01)
    found = loops_behind(MODEL, records)
    assert cause(found) == "delay"
    # Straight lines between samples make a little more of it; five standard errors are 0.02.
    assert found.tests[0].delay / DT == pytest.approx(samples, abs=0.03)
    assert ("the model lacks" if samples > 0.0 else "too long") in found.sentences()[0]


def test_a_wrong_resonance_is_a_gain_that_changes() -> None:
    true = dynamics(2, 0.6 + 0.5j) @ FRONT
    model = dynamics(2, 0.63 + 0.5j) @ FRONT
    inputs = [sine(f, 10.0) for f in (2.0, 20.0, 50.0)]
    found = loops_behind(model, recorded(true, inputs, 0.01))
    assert not found.holds
    assert cause(found) == "gain"
    at = [found.repeated[2].frequency]
    gain = true.parts[-1].frequency_response(at) / model.parts[-1].frequency_response(at)
    # The first harmonic of v is off by the ratio of the responses at 50 Hz; noise makes 3e-4.
    assert found.repeated[2].ratio == pytest.approx(complex(gain[0]), abs=2e-3)


def test_an_actuator_that_changed_is_not_called_rate() -> None:
    inputs = [sine(f, 8.0) for f in (4.0, 4.0, 15.0)]
    first, *others = recorded(MODEL, inputs, 0.01)
    changed = hyst.Record(first.u, 1.05 * first.y, DT)
    found = loops_behind(MODEL, [changed, *others])
    assert cause(found) == "changed"
    assert not found.holds


def test_another_hysteresis_of_the_same_rate_keeps_coinciding() -> None:
    """Loops that the model misses coincide all the same; 8 % of range or more is told."""
    near = hyst.PrandtlIshlinskii([0.2, 0.05, 0.2], [0.5, 1.5, 3.0], p0=0.6)
    far = hyst.PrandtlIshlinskii([0.2, 0.15, 1.5], [0.5, 1.5, 4.0], p0=0.1)
    records = recorded(MODEL, [sine(f, 8.0) for f in (4.0, 10.0, 23.7)])
    one, other = (loops_behind(dynamics() @ front, records) for front in (near, far))
    assert one.coincide
    assert one.holds
    assert other.coincide
    assert not other.holds
    assert "describes nothing" in other.sentences()[-1]


# What is compared


def test_stretches_of_one_record_are_compared_like_records() -> None:
    u = np.concatenate([sine(4.0, 5.0), sine(20.0, 10.0), np.zeros(100), sine(37.3, 14.0)])
    found = loops_behind(MODEL, recorded(MODEL, [u], 0.01))
    assert [each.frequency for each in found.repeated] == pytest.approx([4.0, 20.0, 37.3], rel=1e-6)
    assert found.tests
    assert found.holds


def test_triangles_and_sines_have_one_loop() -> None:
    inputs = [triangle(4.0, 6.0), triangle(10.0, 8.0), sine(20.0, 10.0)]
    found = loops_behind(MODEL, recorded(MODEL, inputs, 0.0))
    assert [each.cycles.is_sine for each in found.repeated] == [False, False, True]
    assert found.tests[0].distance_percent < 1e-4
    late = dynamics(3) @ FRONT
    noisy = loops_behind(MODEL, recorded(late, inputs[:2], 0.01))
    assert cause(noisy) == "delay"
    # Five standard errors, as scattered over seeds.
    assert noisy.tests[0].delay / DT == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize(
    ("inputs", "said"),
    [
        ([sine(4.0, 6.0)], "there is one loop only, of 4 Hz"),
        ([sine(4.0, 6.0), sine(20.0, 9.0, amplitude=4.0)], "no two of the 2 loops"),
        ([sine(4.0, 6.0), sine(20.0, 9.0, offset=1.0)], "no two of the 2 loops"),
        ([sine(4.0, 6.0), sine(4.0, 9.0)], "no two of the 2 loops"),
        ([hyst.signals.multisine(DT, 1500, amplitude=5.0).u], "no input repeats"),
        ([5.0 * np.sign(sine(10.0, 20.0) + 1e-9)], "no input repeats"),  # jumps
        ([sine(120.0, 50.0)], "no input repeats"),  # eight samples a cycle
        ([signal.chirp(DT * np.arange(400), 3.0, 0.4, 40.0) * 5.0], "no input repeats"),
    ],
)
def test_what_cannot_be_compared_is_not_and_is_told(inputs, said: str) -> None:
    found = loops_behind(MODEL, recorded(MODEL, inputs, 0.01))
    assert found.p_value is None
    assert found.coincide is None
    assert found.holds  # nothing speaks against the model
    assert said in found.sentences()[0]


def test_amplitudes_are_compared_among_themselves() -> None:
    inputs = [sine(f, 8.0, a) for a in (5.0, 2.0) for f in (4.0, 15.0)]
    found = loops_behind(MODEL, recorded(dynamics(3) @ FRONT, inputs, 0.01))
    assert [round(each.loops[0].cycles.high) for each in found.tests] == [5, 2]
    assert [each.cause for each in found.tests] == ["delay", "delay"]


def test_differences_below_the_tolerance_are_told_and_allowed() -> None:
    widening = hyst.Lag(2e-5, DT)
    records = recorded(dynamics() @ widening @ FRONT, [sine(f, 20.0) for f in (4.0, 20.0)], 1e-4)
    found = loops_behind(MODEL, records)
    assert found.p_value is not None
    assert found.p_value < 1e-3
    assert cause(found) == "small"
    assert found.holds
    assert not loops_behind(MODEL, records, tolerance=0.0).holds


def test_a_zero_on_the_circle_leaves_a_band() -> None:
    G = hyst.LinearDynamics.from_zeros_poles_gain(
        [np.exp(0.6j), np.exp(-0.6j)], [0.5, 0.3 + 0.4j, 0.3 - 0.4j], 1.0, DT
    )
    model = G.in_units(1.0, 1.0 / G.dc_gain()) @ FRONT
    records = recorded(model, [sine(f, 20.0) for f in (4.0, 12.0)], 0.01)
    found = loops_behind(model, records)
    assert found.holds
    assert all(
        "a zero of the dynamics lies next to the unit circle" in each for each in found.notes
    )
    band = found.loops[0].seen_through.band
    assert band is not None
    assert band < 0.6 / (2.0 * np.pi * DT)
    with pytest.raises(hyst.NotInvertibleError, match=r"lies within 0\.001 of the unit circle"):
        loops_behind(model, records, band=90.0)


def test_noise_that_would_drown_the_loop_limits_the_band() -> None:
    """200 Hz at 10 kHz: the inverse of all frequencies makes 7000 times of the noise."""
    dt, w = 1e-4, 2.0 * np.pi * 200.0
    G = hyst.LinearDynamics.from_continuous([w**2], [1.0, 0.06 * w, w**2], dt)
    model = G @ FRONT
    records = []
    for frequency, periods in ((10.0, 30.0), (60.0, 8.0)):  # longer than that inverse, and not
        k = np.arange(int(periods / frequency / dt))
        u = 5.0 * np.sin(2.0 * np.pi * frequency * dt * k)
        noise = 0.02 * np.random.default_rng(1).normal(size=u.size)
        records.append(hyst.Record(u, model(u) + noise, dt))
    found = loops_behind(model, records)
    assert found.holds
    for loop in found.loops:
        assert "would blur the loop" in loop.seen_through.note
        assert loop.band < 0.03 * np.ptp(loop.modelled)
        # Three harmonics of the drive are compared, all below the band.
    assert [each.shape.beside.shape for each in found.repeated] == [(3, 2), (3, 2)]
    free = loops_behind(model, records[0], band=400.0)
    assert free.loops[0].seen_through.band == 400.0
    assert free.loops[0].seen_through.note == ""


def test_a_map_behind_and_a_delay_of_the_description_are_taken_back() -> None:
    model = hyst.Affine(2.0, 1.0) @ MODEL
    records = recorded(model, [sine(f, 8.0) for f in (4.0, 15.0)], 0.0)
    found = loops_behind(model, records)
    assert found.loops[0].metrics.max_percent < 1e-5
    late = [hyst.Record(each.u, np.roll(each.y, 3), DT) for each in records]
    described = model.with_description(hyst.ModelDescription(delay=3.0))
    found = loops_behind(described, late)
    assert found.holds
    assert found.loops[0].metrics.max_percent < 1e-5


def test_results_do_not_depend_on_units() -> None:
    records = recorded(MODEL, [sine(f, 8.0) for f in (4.0, 15.0)])
    scaled = [hyst.Record(1024.0 * each.u, each.y / 8.0, DT) for each in records]
    found = loops_behind(MODEL, records)
    other = loops_behind(MODEL.in_units(1024.0, 1.0 / 8.0), scaled)
    # Products with a scaled unit round alike; only sums of input and output units could differ.
    assert other.p_value == pytest.approx(found.p_value, rel=1e-6)
    assert other.tests[0].distance_percent == pytest.approx(
        found.tests[0].distance_percent, rel=1e-6
    )


def test_numbers_are_values_of_json() -> None:
    found = loops_behind(MODEL, recorded(MODEL, [sine(f, 8.0) for f in (4.0, 15.0)]))
    told = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert told["holds"] is True
    assert told["p_value"] == found.p_value
    assert [each["frequency"] for each in told["repeated"]] == pytest.approx([4.0, 15.0])
    assert told["tests"][0]["loops"] == [0, 1]


@pytest.mark.parametrize(
    ("model", "records", "options", "said"),
    [
        (FRONT, recorded(FRONT, [sine(4.0, 3.0)]), {}, "the model has no linear dynamics"),
        (dynamics() @ MODEL, recorded(MODEL, [sine(4.0, 3.0)]), {}, "2 stages of linear dynamics"),
        (
            FRONT @ dynamics(),
            recorded(MODEL, [sine(4.0, 3.0)]),
            {},
            "behind the dynamics has memory",
        ),
        (MODEL, [], {}, "there is no record"),
        (MODEL, [hyst.Record(sine(4.0, 3.0), sine(4.0, 3.0), 2e-3)], {}, "dt = 0.002 s"),
        (MODEL, recorded(MODEL, [sine(20.0, 0.1)[:40]]), {}, "has 40 samples, and the inverse"),
        (MODEL, recorded(MODEL, [np.ones(300)]), {}, "is 1 throughout"),
        (MODEL, recorded(MODEL, [sine(4.0, 3.0)]), {"band": 500.0}, "hold nothing above 500 Hz"),
        (MODEL, recorded(MODEL, [sine(4.0, 3.0)]), {"level": 0.0}, "level"),
        (MODEL, recorded(MODEL, [sine(4.0, 3.0)]), {"tolerance": -1.0}, "tolerance"),
        (MODEL, recorded(MODEL, [sine(4.0, 3.0)]), {"names": ("a", "b")}, "2 names for 1 records"),
    ],
)
def test_what_cannot_be_seen_is_refused_by_name(model, records, options, said: str) -> None:
    with pytest.raises(hyst.InputError, match=said):
        loops_behind(model, records, **options)


def test_dynamics_without_a_stable_inverse_are_refused() -> None:
    slow = hyst.LinearDynamics.from_zeros_poles_gain(
        [np.exp(0.06j), np.exp(-0.06j)], [0.5, 0.3], 1.0, DT
    )
    unstable = hyst.LinearDynamics.from_zeros_poles_gain([0.1], [1.01, 0.5], 1.0, DT)
    records = recorded(MODEL, [sine(4.0, 3.0)])
    with pytest.raises(hyst.NotInvertibleError, match=r"9\.5493 Hz"):
        loops_behind(slow @ FRONT, records)
    with pytest.raises(hyst.NotInvertibleError, match=r"1\.01"):
        loops_behind(unstable @ FRONT, records)
