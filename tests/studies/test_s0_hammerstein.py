"""S0: the parts of the study that take no time, against the paper and the notes on it."""

from __future__ import annotations

import numpy as np
import pytest

from hyst.identification.families.hammerstein import fit_markov
from hyst.signals import persistence
from hyst.studies import s0_hammerstein as s0


def test_printed_input_is_the_sum_of_a_thousand_sines() -> None:
    k = np.array([0, 1, 17, 5000])
    expected = (5.0 * np.sin(np.outer(k * s0.DT, np.arange(1, 1001)))).sum(axis=1)
    # Arguments of up to 50,000 rad round in their eleventh digit.
    assert s0.printed_input(s0.DT, 5001)[k] == pytest.approx(expected, abs=1e-6)


def test_printed_sample_time_excites_six_directions() -> None:
    found = persistence(s0.printed_input(1e-5), s0.FIR_ORDER)
    assert found.rank == 6  # seeds' notes
    assert found.condition > 8e14


@pytest.mark.parametrize(
    ("reading", "designed", "expected", "slack"),
    [
        ("two-sided", False, 34.0, 0.5),  # percent; the notes print two digits
        ("as printed", False, 4.0, 0.5),
        ("two-sided", True, 1.0, 0.2),
    ],
)
def test_markov_errors_of_the_first_step(
    reading: str, designed: bool, expected: float, slack: float
) -> None:
    u = s0.designed_input() if designed else s0.printed_input(s0.DT)
    record = s0.simulate(s0.READINGS[reading], u)[1]
    error = s0.markov_error(fit_markov(record, s0.FIR_ORDER).values)
    assert error == pytest.approx(expected, abs=slack)
