"""Options of families on the command line: made from the registry, refused as in Python."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from pathlib import Path

import pytest
from command_runs import Run

import hyst
from hyst.cli.identify import identify

# Pictures are looked at elsewhere.
pytestmark = pytest.mark.usefixtures("undrawn")

COLUMNS = ("--input", "u", "--output", "y", "--time", "t")
OPTIONS = sorted({option for each in hyst.families.values() for option in each.options()})


def as_typed(option: str) -> str:
    """By its own name, unless the command line has another meaning for that."""
    what = hyst.families.option(hyst.families.takers(option)[0], option)
    typed = "" if what is None else what.typed
    return f"--{typed or option.replace('_', '-')}"


def test_the_help_explains_every_option_with_its_families(run: Run) -> None:
    shown = " ".join(run("identify", "--help").out.replace("\u2502", " ").split())
    for option in OPTIONS:
        takers = hyst.families.takers(option)
        what = hyst.families.option(takers[0], option)
        assert what is not None
        assert as_typed(option) in shown
        assert f"({', '.join(takers)})" in shown
        assert what.help.split()[0] in shown


@pytest.mark.parametrize("option", OPTIONS)
def test_an_option_is_said_alike_wherever_families_share_it(option: str) -> None:
    shared = [hyst.families.option(each, option) for each in hyst.families.takers(option)]
    assert len({(each.help, each.metavar) for each in shared if each is not None}) == 1
    assert None not in shared


def test_no_option_of_a_family_is_one_of_the_verb() -> None:
    of_the_verb = {f"--{each.replace('_', '-')}" for each in inspect.signature(identify).parameters}
    assert not {as_typed(each) for each in OPTIONS} & of_the_verb


@pytest.mark.parametrize("option", OPTIONS)
def test_a_foreign_option_is_refused_in_the_words_of_python(
    option: str, refused: Callable[..., str], record_file: Path
) -> None:
    family = next(each for each in hyst.families if each not in hyst.families.takers(option))
    record = hyst.Record([0.0, 1.0, 0.0], [0.0, 1.0, 0.0], 1.0)
    with pytest.raises(hyst.InputError) as said:
        hyst.identify(record, family=family, **{option: 1})
    message = refused(
        "identify", record_file, *COLUMNS, "--family", family, as_typed(option), 1, "-o", "out"
    )
    expected = str(said.value).replace(f"{option} is", f"{as_typed(option)} is")
    assert message.strip() == f"error: {expected.replace(' family', ' --family')}"


def test_an_unknown_family_is_refused_with_all_there_are(
    refused: Callable[..., str], record_file: Path
) -> None:
    message = refused("identify", record_file, *COLUMNS, "--family", "pi,mip", "-o", "out")
    assert "unknown family 'mip'" in message
    assert ", ".join(hyst.families) in message


def test_a_misspelled_option_is_refused_with_the_one_that_was_meant(
    refused: Callable[..., str], record_file: Path
) -> None:
    message = refused("identify", record_file, *COLUMNS, "--plyas", 3, "-o", "out")
    assert "--plyas" in message
    assert "--plays" in message


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--radii", "0.5;1"), "--radii is '0.5;1'; give numbers with commas between them"),
        (("--radii", "1,-1"), "--radii is [1.0, -1.0]; give one or more finite numbers above 0"),
        (("--plays", 2.5), "--plays is '2.5'; give a whole number from 1 to 200"),
        (("--radii", "0.5,1", "--plays", 3), "plays is 3 but 2 radii are given"),
        (("--weights", "heavy"), "--weights is 'heavy'; choose one of auto, non-negative"),
    ],
)
def test_what_cannot_be_read_is_refused_before_the_record_is(
    arguments: tuple[object, ...], says: str, refused: Callable[..., str]
) -> None:
    words = ("identify", "nowhere.csv", *COLUMNS, "--family", "pi")
    assert says in refused(*words, *arguments, "-o", "out")


def test_radii_that_are_given_are_kept(run: Run, record_file: Path, folder: Path) -> None:
    words = ("--family", "pi", "--radii", "0.4,1.1", "--delay", 0)
    ended = run("identify", record_file, *COLUMNS, *words, "-o", "out")
    assert ended.code == 0, ended.err
    model = hyst.load(folder / "out" / "model.json").parameters()
    values = dict(zip(model.names, model.values, strict=True))
    kept = [values[f"prandtl_ishlinskii.r[{i}]"] for i in (1, 2)]
    assert kept == [0.4, 1.1]
    # Their weights are those of the stage; the noise is a thousandth of the smaller.
    found = [values[f"prandtl_ishlinskii.p[{i}]"] for i in (1, 2)]
    assert found == pytest.approx([0.5, 0.3], abs=0.01)


def test_an_option_goes_to_those_of_several_families_that_take_it(
    run: Run, record_file: Path
) -> None:
    words = ("--family", "linear,mpi", "--plays", 1, "--knots", 3, "--delay", 0)
    ended = run("identify", record_file, *COLUMNS, *words, "-o", "out")
    assert ended.code == 0, ended.err
