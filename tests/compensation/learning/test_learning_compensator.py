"""Learning from repetitions, on plants that are simulated here and are not the model.

The plant is a bank of plays of its own, a mode by scipy behind it where there is one, and noise;
errors are compared with that noise, whose size is known here.
"""

import numpy as np
import pytest
from scipy.signal import cont2discrete, lfilter

import hyst
from hyst.compensation import Contraction, LearningCompensator
from hyst.models import PrandtlIshlinskii
from hyst.operators import Affine

DT = 1e-3
N = 1000
REST = np.full(50, 0.0)
PHASE = np.linspace(0.0, 4.0 * np.pi, N - 100)
Y_REF = np.concatenate([REST, 3.0 - 3.0 * np.cos(PHASE), REST])
TRIANGLE = np.concatenate([REST, 6.0 - np.abs(6.0 - np.arange(N - 100) % 450 / 37.5), REST])
MODEL = PrandtlIshlinskii([0.5], [1.0], p0=1.0)
PLANT = PrandtlIshlinskii([0.6, 0.1], [1.1, 2.0], p0=0.9)
NOISE = 0.003


class Plant:
    """Plays, a mode behind them, a delay, noise; a gain and an end of the sensor."""

    def __init__(self, mode=0.0, damping=0.05, delay=0, seed=0, noise=NOISE):
        self.mode, self.damping, self.delay, self.noise = mode, damping, delay, noise
        self.draws = np.random.default_rng(seed)
        self.gain, self.end = 1.0, np.inf

    def moved(self, u):
        y = self.gain * PLANT(u)
        if self.mode:
            w = 2.0 * np.pi * self.mode
            top, below = [w * w], [1.0, 2.0 * self.damping * w, w * w]
            b, a, _ = cont2discrete((top, below), DT, method="foh")
            y = lfilter(np.ravel(b), a, y - y[0]) + y[0]
        return np.concatenate([np.full(self.delay, y[0]), y])[: u.size]

    def measured(self, u):
        return np.minimum(self.moved(u) + self.noise * self.draws.standard_normal(u.size), self.end)


def repeated(learning, plant, count):
    """Errors as measured over the plant's noise, from the first repetition on."""
    for _ in range(count):
        learning.update(plant.measured(learning.command))
    return np.array([each.error_rms for each in learning.history]) / plant.noise


def test_the_first_command_is_the_inverse():
    learning = LearningCompensator(MODEL, Y_REF)
    # The exact inverse is exact to rounding.
    assert np.abs(MODEL(learning.command) - Y_REF).max() < 1e-12
    assert learning.state == "learning"
    assert learning.best is None
    assert "nothing measured yet" in learning.status
    assert not learning.contraction.holds
    assert "not known" in learning.contraction.sentence


@pytest.mark.parametrize("y_ref", [Y_REF, TRIANGLE, -Y_REF], ids=["sine", "triangle", "down"])
@pytest.mark.parametrize("seed", [1, 2])
def test_three_repetitions_reach_the_noise(y_ref, seed):
    errors = repeated(LearningCompensator(MODEL, y_ref, dt=DT), Plant(seed=seed), 5)
    assert errors[0] > 50.0
    # 1.5 times the noise is the bar; the noise itself makes 1 of it.
    assert errors[3] < 1.5
    assert errors.max() == errors[0]


def test_a_gain_alone_reaches_the_noise_in_eight():
    errors = repeated(LearningCompensator(Affine(1.5), Y_REF, dt=DT), Plant(seed=3), 9)
    assert errors[0] > 150.0
    assert errors[8] < 1.5
    assert errors.max() == errors[0]


@pytest.mark.parametrize(("mode", "damping"), [(90.0, 0.05), (60.0, 0.2), (130.0, 0.02)])
def test_a_mode_that_the_model_has_not_is_learnt(mode, damping):
    learning = LearningCompensator(MODEL, TRIANGLE, dt=DT)
    errors = repeated(learning, Plant(mode, damping, seed=4), 8)
    assert errors.max() == errors[0]
    # Its corners are beyond the mode: what they leave is not followed at once.
    assert errors[7] < 3.0


def test_a_delay_of_the_plant_is_learnt():
    learning = LearningCompensator(MODEL, Y_REF, dt=DT)
    errors = repeated(learning, Plant(delay=6, seed=5), 8)
    # The end of the motion comes after the record's: the last samples cannot be learnt.
    assert errors[7] < 2.0
    assert errors.max() == errors[0]


def test_a_gain_that_drifts_while_it_runs_is_recovered_in_four():
    for change in (1.3, 0.7):
        plant = Plant(seed=6)
        learning = LearningCompensator(MODEL, Y_REF, dt=DT)
        repeated(learning, plant, 6)
        plant.gain = change
        errors = repeated(learning, plant, 5)[6:]
        assert errors[0] > 100.0
        assert "has changed" in learning.history[6].note
        assert errors[4] < 1.5


def test_it_stops_at_the_noise_and_goes_on_when_the_error_grows():
    plant = Plant(seed=7)
    learning = LearningCompensator(MODEL, Y_REF, dt=DT)
    repeated(learning, plant, 12)
    assert learning.state in ("at the noise", "settled")
    held = learning.command
    repeated(learning, plant, 1)
    assert np.array_equal(learning.command, held)
    plant.gain = 1.02
    repeated(learning, plant, 1)
    assert learning.state == "learning"
    assert not np.array_equal(learning.command, held)


def test_a_repetition_that_is_not_to_be_believed_does_not_move_the_command():
    plant = Plant(seed=8)
    learning = LearningCompensator(MODEL, Y_REF, dt=DT)
    repeated(learning, plant, 5)
    best = learning.best
    plant.gain = 0.2
    repeated(learning, plant, 1)
    assert np.array_equal(learning.command, best.command)
    assert learning.best is best
    plant.gain = 1.0
    assert repeated(learning, plant, 1)[-1] < 1.5


def test_a_plant_that_answers_the_wrong_way_round_is_stopped_at_the_best_command():
    learning = LearningCompensator(MODEL, Y_REF, dt=DT)
    first = PLANT(learning.command)
    draws = np.random.default_rng(9)
    for _ in range(16):
        y = first - 3.0 * (PLANT(learning.command) - first)
        learning.update(y + NOISE * draws.standard_normal(N))
    assert learning.state == "diverged"
    assert np.array_equal(learning.command, learning.best.command)
    assert learning.best.error_rms <= learning.history[0].error_rms
    assert "reset" in learning.status


def test_limits_are_kept_and_nothing_is_added_up_at_them():
    high = 4.0
    learning = LearningCompensator(MODEL, Y_REF, (-2.0, high), dt=DT)
    plant = Plant(seed=10)
    for _ in range(6):
        assert learning.command.max() <= high
        learning.update(plant.measured(learning.command))
    reached = plant.moved(learning.command)
    within = np.flatnonzero(PLANT(np.linspace(0.0, high, 200))[-1] - 0.2 < Y_REF)[0]
    # Before the command first comes to its limit, tracking is at the noise as without one.
    assert np.sqrt(np.mean((reached - Y_REF)[:within] ** 2)) < 2.0 * NOISE
    assert "held at a limit" in learning.status
    # The unreachable part asks for no more than the limit however often it is repeated.
    assert learning.command.max() == high


def test_the_rate_limit_is_kept():
    learning = LearningCompensator(MODEL, Y_REF, dt=DT, rate_limit=30.0)
    plant = Plant(seed=11)
    for _ in range(3):
        # Rounding of a difference of numbers of the size of the command.
        assert np.abs(np.diff(learning.command)).max() <= 30.0 * DT + 1e-12
        learning.update(plant.measured(learning.command))


def test_what_was_applied_is_learnt_from():
    learning = LearningCompensator(MODEL, Y_REF, dt=DT)
    plant = Plant(seed=12)
    for _ in range(5):
        applied = np.minimum(learning.command, 4.0)  # the amplifier has an end of its own
        learning.update(plant.measured(applied), applied)
    assert "applied input is off" in learning.history[0].note
    assert learning.command.max() < 10.0


def test_a_record_of_another_length_is_refused_with_both_lengths():
    learning = LearningCompensator(MODEL, Y_REF)
    with pytest.raises(hyst.InputError, match="has 990 samples, the reference 1000"):
        learning.update(PLANT(learning.command)[:990])
    with pytest.raises(hyst.InputError, match="longer by 3"):
        learning.update(np.append(PLANT(learning.command), [0.0, 0.0, 0.0]))
    assert learning.history == ()


def test_a_record_at_another_rate_is_refused():
    learning = LearningCompensator(MODEL, Y_REF, dt=DT)
    u = learning.command
    with pytest.raises(hyst.InputError, match=r"dt = 0.002 s, the motion 0.001 s"):
        learning.update(hyst.Record(u, PLANT(u), 2e-3))
    learning.update(hyst.Record(u, PLANT(u), DT))
    assert len(learning.history) == 1


@pytest.mark.parametrize("shift", [40, -40])
def test_a_shifted_record_is_refused_and_nothing_is_learnt(shift):
    plant = Plant(seed=13)
    learning = LearningCompensator(MODEL, Y_REF, dt=DT)
    repeated(learning, plant, 3)
    before = learning.command
    y = plant.measured(before)
    shifted = np.roll(y, shift)
    with pytest.raises(hyst.InputError, match="by 40 samples against what was to be expected"):
        learning.update(shifted)
    assert np.array_equal(learning.command, before)
    assert len(learning.history) == 3


def test_bad_samples_are_named_and_an_output_at_rest_is_refused():
    learning = LearningCompensator(MODEL, Y_REF, dt=DT)
    y = PLANT(learning.command)
    y[17] = np.nan
    with pytest.raises(hyst.InputError, match="17"):
        learning.update(y)
    with pytest.raises(hyst.InputError, match="look at sensor and amplifier"):
        learning.update(1.0 + NOISE * np.random.default_rng(0).standard_normal(N))
    assert learning.history == ()


def test_nothing_is_learnt_where_the_sensor_stands_at_its_end():
    plant = Plant(seed=14)
    plant.end = 5.0
    learning = LearningCompensator(MODEL, Y_REF, dt=DT)
    for _ in range(6):
        learning.update(plant.measured(learning.command))
    assert "sensor stands at an end" in learning.history[0].note
    # No more than the motion asks for: the true inverse of the plant's top needs less than 6.
    assert learning.command.max() < 6.0


def test_periodic_motion_is_learnt_in_the_state_it_leaves():
    wave = 3.0 * np.sin(np.linspace(0.0, 4.0 * np.pi, 800, endpoint=False))
    learning = LearningCompensator(MODEL, wave, dt=DT, periodic=True)
    draws, step, errors = np.random.default_rng(15), PLANT.stepper(), []
    for _ in range(8):
        y = np.array([step(each) for each in learning.command.tolist()])
        errors.append(np.sqrt(np.mean((y - wave) ** 2)) / NOISE)
        learning.update(y + NOISE * draws.standard_normal(y.size))
    # Without noise in the error itself; what the noise of the updates leaves is below it.
    assert min(errors[4:]) < 1.2
    assert max(errors) == errors[0]


def test_another_reference_begins_anew_and_what_is_known_is_kept():
    plant = Plant(90.0, 0.05, seed=16)
    learning = LearningCompensator(MODEL, TRIANGLE, dt=DT)
    repeated(learning, plant, 6)
    learning.reset(0.7 * TRIANGLE)
    assert learning.history == ()
    assert learning.state == "learning"
    known = repeated(learning, plant, 2)
    anew = LearningCompensator(MODEL, 0.7 * TRIANGLE, dt=DT)
    # The second command knows the mode already.
    assert known[1] < repeated(anew, Plant(90.0, 0.05, seed=16), 2)[1]


def test_the_contraction_says_what_slopes_allow():
    assert Contraction.with_best_gain(0.8, 1.3, "given").rate == pytest.approx(0.3)
    steep = Contraction.with_best_gain(0.5, 3.0, "given")
    # 2 / (0.5 + 3), and then 1 - 0.5 times that, by hand.
    assert steep.gain == pytest.approx(4.0 / 7.0)
    assert steep.rate == pytest.approx(5.0 / 7.0)
    assert steep.holds
    assert "0.571" in steep.sentence
    assert not Contraction.with_best_gain(-0.1, 1.0, "given").holds
    with pytest.raises(hyst.InputError, match="slopes are"):
        LearningCompensator(MODEL, Y_REF, slopes=(0.0, 1.0))


def test_a_saved_learning_goes_on_with_the_same_bits(tmp_path):
    plant, again = Plant(90.0, seed=17), Plant(90.0, seed=17)
    learning = LearningCompensator(MODEL, TRIANGLE, (-8.0, 8.0), dt=DT)
    repeated(learning, plant, 3)
    learning.save(tmp_path / "learning.json")
    loaded = hyst.load(tmp_path / "learning.json")
    assert loaded.status == learning.status
    assert loaded.model == MODEL
    again.draws = np.random.default_rng(18)
    plant.draws = np.random.default_rng(18)
    repeated(learning, plant, 2)
    repeated(loaded, again, 2)
    assert np.array_equal(loaded.command, learning.command)
    assert [each.note for each in loaded.history] == [each.note for each in learning.history]


def test_a_damaged_file_is_refused(tmp_path):
    learning = LearningCompensator(MODEL, Y_REF)
    data = learning.to_dict()
    del data["trials"]
    with pytest.raises(hyst.InputError, match="damaged"):
        LearningCompensator.from_dict(data)


@pytest.mark.parametrize("samples", [1, 5, 7])
def test_a_reference_too_short_to_learn_from_is_refused(samples):
    with pytest.raises(hyst.InputError, match=f"y_ref has {samples} samples, too few"):
        LearningCompensator(MODEL, np.linspace(0.0, 3.0, samples))
    learning = LearningCompensator(MODEL, Y_REF)
    with pytest.raises(hyst.InputError, match="too few"):
        learning.reset(np.zeros(samples))


def test_a_sign_that_is_reversed_is_told_at_once():
    learning = LearningCompensator(MODEL, Y_REF, dt=DT)
    with pytest.raises(hyst.InputError, match="turn the sign of the sensor or of the drive"):
        learning.update(-Plant(seed=19).measured(learning.command))
    assert learning.history == ()


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("noise", [0.0, None])
def test_a_plant_without_noise_is_learnt_without_a_warning(noise):
    learning = LearningCompensator(MODEL, TRIANGLE, dt=DT, noise=noise)
    for _ in range(5):
        learning.update(PLANT(learning.command))
    errors = [each.error_rms for each in learning.history]
    # What plays at the turns miss is left; a hundredth of the first error is far above rounding.
    assert errors[4] < 0.02 * errors[0]


def test_an_error_that_repeats_is_not_taken_for_noise():
    step = np.where(np.arange(N) < 300, 0.0, 4.0)
    learning = LearningCompensator(MODEL, step, dt=DT)
    plant = Plant(60.0, 0.05, seed=20)
    repeated(learning, plant, 8)
    # Ringing after a step fills the whole spectrum; only a command played twice tells it from
    # noise. N samples tell an rms to 1 / sqrt(2 N) = 2 %; three times that.
    assert learning.noise == pytest.approx(NOISE, rel=0.07)
    assert learning.state != "at the noise"


@pytest.mark.parametrize("delay", [20, 60])
def test_a_long_delay_is_learnt_without_a_step_that_is_foreseen_to_be_worse(delay):
    learning = LearningCompensator(MODEL, Y_REF, dt=DT)
    errors = repeated(learning, Plant(delay=delay, seed=5), 6)
    assert errors.max() == errors[0]
    assert errors[5] < 0.02 * errors[0]


def test_a_delay_is_learnt_in_any_unit():
    unit = 2.0**20
    model = PrandtlIshlinskii([0.5 * unit], [1.0], p0=unit)
    own = LearningCompensator(MODEL, Y_REF, dt=DT)
    scaled = LearningCompensator(model, unit * Y_REF, dt=DT)
    for seed in range(3):
        own.update(Plant(delay=24, seed=seed).measured(own.command))
        scaled.update(unit * Plant(delay=24, seed=seed).measured(scaled.command))
    # Sums of logarithms are rounded differently in another unit; nothing else is.
    assert np.abs(scaled.command - own.command).max() < 1e-12


@pytest.mark.parametrize("y_ref", [Y_REF, TRIANGLE], ids=["sine", "triangle"])
def test_spikes_of_the_sensor_are_told_and_not_learnt(y_ref):
    draws = np.random.default_rng(21)
    plant = Plant(seed=21)
    learning = LearningCompensator(MODEL, y_ref, dt=DT)
    for _ in range(4):
        y = plant.measured(learning.command)
        y[draws.integers(0, N, 3)] += draws.choice([-20.0, 20.0], 3)
        learning.update(y)
    assert "3 samples of the measured output jump by up to" in learning.history[0].note
    # As without spikes: 1.5 times the noise after three repetitions.
    assert learning.history[3].error_rms < 1.5 * NOISE


def test_a_motion_that_jumps_has_no_spikes():
    y_ref = np.where((np.arange(N) > 300) & (np.arange(N) < 303), 3.0, 0.0)
    y_ref[500:] = np.tile([0.0, 0.0, 2.0, 0.0, 0.0], 100)
    learning = LearningCompensator(Affine(1.0), y_ref)
    learning.update(np.roll(0.9 * y_ref, 1))
    assert "jump" not in learning.history[0].note


def test_a_hysteresis_that_a_gain_misses_is_no_delay():
    # On a ramp a wide loop is late by a twentieth of the motion, as a delay is.
    plant = PrandtlIshlinskii([0.4, 0.4], [1.0, 2.0], p0=0.5)
    slow = np.interp(np.linspace(0.0, 1.0, 4000), np.linspace(0.0, 1.0, N), TRIANGLE)
    learning = LearningCompensator(Affine(1.0), slow, dt=1e-4)
    draws = np.random.default_rng(22)
    for _ in range(6):
        learning.update(plant(learning.command) + NOISE * draws.standard_normal(slow.size))
    errors = [each.error_rms for each in learning.history]
    assert max(errors) == errors[0]
    # Taken for a delay, it stayed at ten times the noise.
    assert errors[5] < 1.5 * NOISE
