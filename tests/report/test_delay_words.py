"""A delay is told with how sure it is, and advice to act only where the records exclude none."""

from __future__ import annotations

import pytest

import hyst
from hyst.export.c.readme_rows import lag_row
from hyst.operators import ModelDescription
from hyst.report.delay_words import delay_sentence, delay_to_act_on

ACT = "only anticipated, by giving the command that much earlier"


def test_a_delay_that_is_sure() -> None:
    told = delay_sentence(4, 0.005, (3.8, 4.2))
    assert "lags the model by 4 samples (3.8 to 4.2), 20 ms." in told
    assert ACT in told


def test_a_delay_that_was_given_has_no_interval() -> None:
    assert "lags the model by 1 sample, 250 us." in delay_sentence(1, 2.5e-4, (1, 1))
    assert "lags the model by 1.42 samples." in delay_sentence(1.42, None)


@pytest.mark.parametrize("interval", [(0.0, 5.0), (-1.0, 6.0)])
def test_no_advice_to_act_where_the_records_would_bear_none(interval: tuple[float, float]) -> None:
    told = delay_sentence(3, 0.01, interval)
    assert "the records would also bear no delay" in told
    assert ACT not in told


def test_no_delay_is_told_with_what_it_might_be() -> None:
    told = delay_sentence(0, None, (0.0, 5.0))
    assert told == "No delay is taken; the records would also bear 0 to 5 samples."
    assert "bear -2 to 1 samples (-20 to 10 ms)" in delay_sentence(0, 0.01, (-2.0, 1.0))
    assert delay_sentence(0, 0.01, (-0.1, 0.2)) == (
        "The output does not lag (the records bear -0.1 to 0.2 samples)."
    )
    for nothing_known in (None, (0, 0)):
        assert delay_sentence(0, 0.01, nothing_known) == (
            "No delay is taken; the records were not asked, or show too little to find one."
        )


def test_an_output_ahead_is_no_actuators() -> None:
    told = delay_sentence(-10, 0.002, (-10.3, -9.5))
    assert "is 10 samples AHEAD of the input (9.5 to 10.3, 20 ms), which no actuator is" in told
    assert "the channels are not aligned" in told
    assert ACT not in told
    assert "1 sample AHEAD of the input, which" in delay_sentence(-1, None)
    assert "would also bear none" in delay_sentence(-1, None, (-2.0, 0.5))


@pytest.mark.parametrize(
    ("delay", "interval", "acted_on"),
    [
        (4, None, "4 samples, 40 ms"),
        (4, (3.5, 4.5), "4 samples (3.5 to 4.5), 40 ms"),
        (4, (0.0, 5.0), ""),
        (0, (0.0, 5.0), ""),
        (0, None, ""),
        (-2, (-3.0, -1.0), ""),
    ],
)
def test_only_a_known_delay_is_acted_on(
    delay: float, interval: tuple[float, float] | None, acted_on: str
) -> None:
    about = ModelDescription(delay=delay, delay_interval=interval, dt=0.01)
    assert delay_to_act_on(about) == acted_on
    # The same in the table of an exported project, which also names what is ahead.
    assert ("lag" in lag_row(about)) == bool(acted_on or delay < 0)


def test_the_table_of_a_file_tells_it_in_samples_and_time() -> None:
    about = ModelDescription(delay=-2.5, delay_interval=(-3, -2), dt=0.01)
    rows = dict(hyst.report.description_table(about).rows)
    assert rows["delay of the output"] == "-2.5 samples (-3 to -2), -25 ms: not aligned"
