"""Which column is what, in Python and on the command line."""

import pytest

import hyst
from hyst.studio.work.choice import Choice


def test_a_role_belongs_to_one_column_and_a_column_has_one_role() -> None:
    choice = Choice(input=1, output=2, time=0).with_role(2, "input")
    assert (choice.input, choice.output, choice.time) == (2, None, 0)
    assert choice.with_role(2, "").input is None
    assert choice.role_of(0) == "time"
    assert choice.role_of(1) == ""


@pytest.mark.parametrize(
    ("choice", "said"),
    [
        (Choice(), "Choose the column of the input and that of the output."),
        (Choice(input=0), "Choose the column of the output."),
        (Choice(input=0, output=1), "Give the samples per second"),
        (Choice(input=0, output=1, rate=10.0), ""),
        (Choice(input=0, output=1, time=2), ""),
    ],
)
def test_what_is_missing_is_said(choice: Choice, said: str) -> None:
    assert choice.missing().startswith(said)
    assert bool(choice.missing()) == bool(said)


def test_arguments_and_options_say_the_same() -> None:
    choice = Choice(1, 2, 0, time_unit="ms", repair=True, table=2)
    assert choice.arguments() == {
        "input": 1, "output": 2, "table": 2, "time": 0, "time_unit": "ms", "repair": True,
        "resample": False, "output_time": None,
    }  # fmt: skip
    said = " ".join(choice.options())
    assert said == "--input 1 --output 2 --time 0 --time-unit ms --repair --table 2"
    assert Choice(1, 2, rate=1e3).options() == ["--input", "1", "--output", "2", "--rate", "1000"]


def test_arguments_of_half_a_choice_are_refused() -> None:
    with pytest.raises(hyst.InputError, match="output"):
        Choice(input=1).arguments()
