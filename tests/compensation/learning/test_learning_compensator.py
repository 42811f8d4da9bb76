"""Learning from repetitions, on plants that are simulated here and are not the model."""

import numpy as np
import pytest

import hyst
from hyst.compensation import LearningCompensator
from hyst.models import PrandtlIshlinskii

Y_REF = 3.0 - 3.0 * np.cos(np.linspace(0.0, 4.0 * np.pi, 400))
MODEL = PrandtlIshlinskii([0.5], [1.0], p0=1.0)
PLANT = PrandtlIshlinskii([0.6, 0.1], [1.1, 2.0], p0=0.9)


def test_the_first_command_is_the_inverse():
    learning = LearningCompensator(MODEL, Y_REF)
    # The exact inverse is exact to rounding.
    assert np.abs(MODEL(learning.command) - Y_REF).max() < 1e-12


def test_a_record_of_another_length_is_refused_with_both_lengths():
    learning = LearningCompensator(MODEL, Y_REF)
    with pytest.raises(hyst.InputError, match="has 390 samples, the reference 400"):
        learning.update(PLANT(learning.command)[:390])
    with pytest.raises(hyst.InputError, match="longer by 3"):
        learning.update(np.append(PLANT(learning.command), [0.0, 0.0, 0.0]))
    assert learning.history == ()
