"""hyst.compare: what it measures is checked by hand, what it says by records made for it."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst.operators import Affine, ModelDescription, Verdict

DT = 1e-3
TRUE = hyst.PrandtlIshlinskii([0.5, 0.3], [0.1, 0.3], p0=1.0)
ROUGH = hyst.PrandtlIshlinskii([0.75], [0.2], p0=1.0)


def shrinking(samples: int = 3000, largest: float = 1.0) -> np.ndarray:
    t = np.arange(samples) / samples
    return largest * np.sin(2.0 * np.pi * 7.0 * t) * np.where(t < 0.3, 1.0, 1.3 - t)


def sine(samples: int = 3000, amplitude: float = 1.0) -> np.ndarray:
    return amplitude * np.sin(2.0 * np.pi * 7.0 * np.arange(samples) / samples)


def record_of(
    model: hyst.Operator, u: np.ndarray, noise: float = 0.005, seed: int = 1, **names: str
) -> hyst.Record:
    y = model(u) + noise * np.random.default_rng(seed).normal(size=u.size)
    return hyst.Record(u, y, DT, **names)


def described(model: hyst.Operator, **about: object) -> hyst.Operator:
    return model.with_description(ModelDescription(**about))  # type: ignore[arg-type]


@pytest.mark.parametrize("delay", [0, 7, -3])
def test_errors_are_those_of_a_calculation_by_hand(delay: int) -> None:
    """The output is measured late; from where the input has passed 95 % of its range it counts."""
    u = shrinking()
    y = np.roll(TRUE(u), delay)
    record = hyst.Record(u, y, DT)
    found = hyst.compare(described(ROUGH, delay=delay, dt=DT), record)
    (each,) = found.models
    covered = np.maximum.accumulate(u) - np.minimum.accumulate(u) >= 0.95 * np.ptp(u)
    first, stop = int(covered.argmax()) + delay, u.size + min(delay, 0)
    error = np.roll(ROUGH(u), delay)[first:stop] - y[first:stop]
    assert (found.used[0].start, found.used[0].stop) == (first, stop)
    # Sums of 2000 squares in another order.
    assert each.metrics.rms == pytest.approx(np.sqrt(np.mean(error**2)), rel=1e-12)
    assert each.metrics.max_abs == np.abs(error).max()
    assert each.metrics.output_range == np.ptp(y)
    assert each.free_offset.rms == pytest.approx(error.std(), rel=1e-12)
    at = first + int(np.abs(error).argmax())
    assert (each.worst.record, each.worst.sample) == (1, at)
    assert (each.worst.time, each.worst.input) == (at * DT, u[at])
    assert each.worst.error == error[at - first]


def test_a_delay_is_taken_in_time_to_a_record_of_other_samples() -> None:
    """Four samples of 1 ms are eight of half a millisecond."""
    u = shrinking(6000)
    record = hyst.Record(u, np.roll(TRUE(u), 8), DT / 2.0)
    found = hyst.compare(described(TRUE, delay=4, dt=DT), record)
    assert found.best.metrics.rms == 0.0
    wrong = hyst.compare(described(TRUE, delay=8, dt=DT), record)
    assert wrong.best.metrics.rms > 0.01


def test_all_models_are_judged_on_the_samples_they_have_in_common() -> None:
    record = record_of(TRUE, shrinking())
    alone = {
        delay: hyst.compare(described(ROUGH, delay=delay, dt=DT), record).used[0]
        for delay in (-40, 0, 60)
    }
    models = {str(delay): described(ROUGH, delay=delay, dt=DT) for delay in alone}
    both = hyst.compare(models, record)
    assert both.used[0].start == max(each.start for each in alone.values())
    assert both.used[0].stop == min(each.stop for each in alone.values())
    assert len({each.metrics.samples for each in both}) == 1


def test_outer_strokes_and_minor_loops_are_told_apart() -> None:
    """A model that is right on strokes of more than 1.9 and wrong on all others."""
    u = np.concatenate([sine(2000), sine(2000, 0.4)])
    wrong_inside = np.where(np.arange(u.size) < 2000, 0.0, 0.1)
    record = hyst.Record(u, TRUE(u) + wrong_inside, DT)
    each = hyst.compare(TRUE, record).best
    assert each.outer_strokes == 0.0
    # The last outer stroke ends up to one stroke of 143 samples before the first inner one.
    assert 0.09 < each.minor_loops <= 0.1


def test_a_record_of_one_amplitude_says_nothing_of_minor_loops() -> None:
    found = hyst.compare({"a": TRUE, "b": ROUGH}, record_of(TRUE, sine()))
    assert found.best_on_minor_loops is None
    assert all(each.minor_loops is None and each.outer_strokes is None for each in found)
    assert any("hardly any loops inside" in each for each in found.sentences())


def test_the_simplest_of_those_that_are_not_told_apart_is_taken() -> None:
    """A third play of the actuator has a weight far below the noise: nothing of it shows."""
    rich = hyst.PrandtlIshlinskii([0.5, 0.3, 3e-4], [0.1, 0.3, 0.5], p0=1.0)
    found = hyst.compare([rich, TRUE, ROUGH], record_of(rich, shrinking()))
    assert found.best is found["prandtl-ishlinskii 1"]
    assert [each.name for each in found] == [f"prandtl-ishlinskii {k}" for k in (1, 2, 3)]
    assert found.chosen is found["prandtl-ishlinskii 2"]
    assert found.for_commands is found.chosen
    told = found.to_dict()
    assert told["as_good_as_best"] == ["prandtl-ishlinskii 1", "prandtl-ishlinskii 2"]
    assert told["chosen"] == "prandtl-ishlinskii 2"


def test_a_difference_that_shows_in_every_block_counts() -> None:
    """5 % more error in noise: of 3000 samples 2 % is the standard error; paired, it shows."""
    u = shrinking()
    record = record_of(TRUE, u, noise=0.01)
    worse = Affine(1.0, 0.0035) @ TRUE
    found = hyst.compare({"true": TRUE, "worse": worse}, record)
    ratio = found["worse"].metrics.rms / found["true"].metrics.rms
    assert 1.02 < ratio < 1.12
    assert found.chosen is found["true"]
    assert not found.is_as_good(found["worse"], found["true"])


def test_only_models_with_an_inverse_are_for_commands() -> None:
    falling = hyst.PrandtlIshlinskii([0.5, 0.3], [0.1, 0.3], p0=0.0)
    found = hyst.compare({"flat": falling, "line": Affine(1.0, 0.0)}, record_of(falling, sine()))
    assert found.best is found["flat"]
    assert found["flat"].not_invertible
    assert found.for_commands is found["line"]
    alone = hyst.compare({"flat": falling}, record_of(falling, sine()))
    assert alone.for_commands is None
    assert any(found["flat"].not_invertible in each for each in alone.sentences())


def test_an_unfit_model_is_never_chosen() -> None:
    bad = Verdict("unfit", ("It describes nothing.",))
    models = {"saved as unfit": described(TRUE, verdict=bad), "rough": ROUGH}
    found = hyst.compare(models, record_of(TRUE, shrinking()))
    assert found.best is found["saved as unfit"]
    assert found.chosen is found.for_commands is found["rough"]
    assert any("no command should come from it" in each for each in found.sentences())
    alone = hyst.compare({"x": models["saved as unfit"]}, record_of(TRUE, shrinking()))
    assert alone.chosen is None
    assert alone.for_commands is None


def test_a_model_that_misses_the_record_is_unfit_here() -> None:
    """The output runs the other way: it explains nothing."""
    found = hyst.compare({"other sign": Affine(-1.0, 0.0) @ TRUE}, record_of(TRUE, shrinking()))
    assert found.is_unfit(found.best)
    assert found.chosen is None
    assert any("no model here is better than that line" in each for each in found.sentences())


def test_a_zero_that_is_off_does_not_decide() -> None:
    """The rough model has by chance the zero of the record, the true one has not."""
    record = record_of(Affine(1.0, 0.5) @ TRUE, shrinking())
    models = {"true": Affine(1.0, 0.0) @ TRUE, "rough": Affine(1.0, 0.01) @ ROUGH}
    assert len(models["rough"].parameters()) < len(models["true"].parameters())
    found = hyst.compare(models, record)
    assert found["rough"].metrics.rms < found["true"].metrics.rms
    assert found.zero_is_off
    assert found.best is found.chosen is found["true"]
    assert "zero of these records is off by 0.5" in found.sentences()[0]


def test_what_a_model_was_identified_from_is_no_test_of_it() -> None:
    records = [record_of(TRUE, shrinking(), seed=seed) for seed in (1, 2, 3)]
    of_first = hyst.identify(records[0], family="pi", plays=2, delay=0)
    of_two = hyst.identify(records[1:], family="pi", plays=2, delay=0)
    found = hyst.compare({"one": of_first, "two": of_two, "none": TRUE}, records)
    assert [each.seen for each in found] == [(1,), (2, 3), ()]
    warnings = [each for each in found.sentences() if each.startswith("Warning")]
    assert len(warnings) == 2
    assert "two was identified from records 2 and 3" in warnings[1]
    fresh = hyst.compare({"one": of_first}, record_of(TRUE, shrinking(), seed=4))
    assert not any("Warning" in each for each in fresh.sentences())


def test_an_input_beyond_the_range_of_a_model_is_told() -> None:
    models = {
        "narrow": described(TRUE, input_low=-0.5, input_high=0.5),
        "wide": described(TRUE, input_low=-3.0, input_high=3.0),
        "unknown": TRUE,
    }
    u = shrinking()
    found = hyst.compare(models, record_of(TRUE, u))
    assert found["narrow"].extrapolated == np.mean(np.abs(u) > 0.5)
    assert found["wide"].extrapolated == 0.0
    assert found["unknown"].extrapolated is None
    told = [each for each in found.sentences() if " was identified from " in each]
    assert "narrow was identified from -0.5 to 0.5" in told[0]
    assert told[0].startswith("Warning")
    assert "nothing is said here of larger loops" in told[1]


def test_an_error_far_above_that_of_training_is_told() -> None:
    about = {"errors": {"training": {"rms": 0.001}}}
    found = hyst.compare({"a": described(ROUGH, **about)}, record_of(TRUE, shrinking()))
    assert any("does not carry over" in each for each in found.sentences())


def test_several_records_are_judged_together() -> None:
    quiet, loud = record_of(TRUE, shrinking(), 0.0), record_of(TRUE, shrinking(largest=2.0), 0.0)
    spoiled = hyst.Record(loud.u, loud.y + (np.arange(loud.samples) == 2500), DT)
    each = hyst.compare(TRUE, [quiet, spoiled]).best
    assert (each.worst.record, each.worst.sample, each.worst.error) == (2, 2500, -1.0)
    assert each.metrics.output_range == np.ptp(spoiled.y)
    assert len(each.outputs) == 2


@pytest.mark.parametrize(
    ("input_scale", "output_scale"), [(2.0**40, 2.0**-33), (2.0**-200, 2.0**200)]
)
def test_nothing_depends_on_units(input_scale: float, output_scale: float) -> None:
    """Powers of two scale every number bit for bit and change no choice."""
    record = record_of(TRUE, shrinking())
    scaled = hyst.Record(input_scale * record.u, output_scale * record.y, DT)
    plain = hyst.compare({"true": TRUE, "rough": ROUGH}, record)
    units = {
        each.name: each.model.in_units(input_scale, output_scale)  # type: ignore[attr-defined]
        for each in plain
    }
    other = hyst.compare(units, scaled)
    for each in plain:
        assert other[each.name].metrics.rms == output_scale * each.metrics.rms
        assert other[each.name].minor_loops == output_scale * each.minor_loops
        np.testing.assert_array_equal(other[each.name].block_errors, each.block_errors)
    assert other.straight_line_rms == output_scale * plain.straight_line_rms
    assert other.chosen.name == plain.chosen.name


def test_what_cannot_be_compared_is_refused() -> None:
    u = shrinking()
    record = record_of(TRUE, u, input_unit="V", output_unit="um")
    with pytest.raises(hyst.InputError, match="there is no model"):
        hyst.compare([], record)
    with pytest.raises(hyst.InputError, match="there is no record"):
        hyst.compare(TRUE, [])
    with pytest.raises(hyst.InputError, match="model 2 is of type str"):
        hyst.compare([TRUE, "pi"], record)
    with pytest.raises(
        hyst.InputError, match="output of record 1 is in 'um' but that of a in 'mm'"
    ):
        hyst.compare({"a": described(TRUE, output_unit="mm")}, record)
    lag = hyst.LinearDynamics.from_transfer_function([0.2], [1.0, -0.8], dt=2e-3)
    with pytest.raises(
        hyst.InputError, match=r"record 1, for b, has dt = 0.001 s, the model 0.002"
    ):
        hyst.compare({"b": lag @ TRUE}, record)
    with pytest.raises(hyst.InputError, match="none is left beside the delays"):
        hyst.compare({"late": described(TRUE, delay=5000, dt=DT)}, record)
    with pytest.raises(hyst.NotIdentifiableError, match="turns 0 times"):
        hyst.compare(TRUE, hyst.Record(np.linspace(0.0, 1.0, 50), np.linspace(0.0, 1.0, 50), DT))
    with pytest.raises(hyst.InputError, match="there is no model 'z'; choose one of"):
        hyst.compare({"a": TRUE}, record)["z"]
