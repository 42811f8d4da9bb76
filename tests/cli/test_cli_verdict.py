"""The verdict on the command line: told first, exit code 3, and no command from what is unfit."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from command_runs import STAGE, Run, describe, drive, write_csv

import hyst
from hyst.identification.result import identified_from_fit
from hyst.operators import Verdict

# Pictures are looked at elsewhere.
pytestmark = pytest.mark.usefixtures("undrawn")

COLUMNS = ("--input", "u", "--output", "y", "--time", "t")
QUICK = ("--family", "pi", "--plays", 2, "--delay", 0)
UNFIT = Verdict("unfit", ("Hardly better than a line.", "Record loops of several amplitudes."))
COMMAND = "so a wanted output can be turned into a command"


@pytest.fixture
def judged(monkeypatch: pytest.MonkeyPatch) -> Callable[[Verdict], None]:
    """Let every fit have a verdict."""

    def judge_so(verdict: Verdict) -> None:
        monkeypatch.setattr(identified_from_fit, "judge", lambda *_: verdict)

    return judge_so


@pytest.fixture
def unfit_file(folder: Path) -> Path:
    """The simulated stage's own model, said to be unfit."""
    STAGE.save(folder / "unfit.json", describe(STAGE, verdict=UNFIT))
    write_csv(folder / "ref.csv", "wanted", STAGE(drive()))
    return folder / "unfit.json"


def test_unfit_ends_in_3_with_all_files_and_nothing_about_commands(
    judged: Callable[[Verdict], None], run: Run, record_file: Path, folder: Path
) -> None:
    judged(UNFIT)
    ended = run("identify", record_file, *COLUMNS, *QUICK, "-o", "out")
    assert (ended.code, ended.err) == (3, "")
    assert ended.out.splitlines()[:2] == [
        "verdict: unfit - Hardly better than a line.",
        "  Record loops of several amplitudes.",
    ]
    assert COMMAND not in ended.out
    page = (folder / "out" / "report.html").read_text()
    assert COMMAND not in page
    assert "What next" not in page
    assert "hyst compensate" not in page
    numbers = json.loads((folder / "out" / "metrics.json").read_text())
    assert numbers["verdict"] == {"level": "unfit", "sentences": list(UNFIT.sentences)}
    assert hyst.load(folder / "out" / "model.json").description.verdict == UNFIT
    again = run("fit", "out/model.json", record_file, *COLUMNS, "-o", "refitted")
    assert again.code == 3
    assert (folder / "refitted" / "model.json").exists()
    assert "verdict: unfit - Hardly better" in run("info", "out/model.json").out.splitlines()[0]


def test_no_advice_on_a_delay_of_what_is_unfit(
    judged: Callable[[Verdict], None], run: Run, record_file: Path
) -> None:
    late = ("--family", "pi", "--plays", 2, "--delay", 3)
    judged(UNFIT)
    told = run("identify", record_file, *COLUMNS, *late, "-o", "out").out
    assert "a delay of 3 samples, 30 ms; of a model that does not describe its record" in told
    assert "giving the command" not in told
    judged(Verdict("fair", ("Drift is left.",)))
    told = run("identify", record_file, *COLUMNS, *late, "-o", "out", "--force").out
    assert "by giving the command that much earlier" in told


@pytest.mark.parametrize("level", ["good", "fair"])
def test_what_is_fit_ends_in_0_and_is_offered_for_commands(
    level: str, judged: Callable[[Verdict], None], run: Run, record_file: Path, folder: Path
) -> None:
    judged(Verdict(level, ("What is left is small.",)))  # type: ignore[arg-type]
    ended = run("identify", record_file, *COLUMNS, *QUICK, "-o", "out")
    assert ended.code == 0
    assert ended.out.startswith(f"verdict: {level} - What is left is small.\n")
    assert COMMAND in ended.out
    assert "What next" in (folder / "out" / "report.html").read_text()


def test_info_says_that_an_exact_inverse_is_of_no_use(run: Run, unfit_file: Path) -> None:
    shown = run("info", unfit_file).out
    assert COMMAND not in shown
    assert "but its verdict is unfit: no command should come from it" in shown


@pytest.mark.parametrize(
    ("verb", "what"),
    [
        (("compensate", "unfit.json", "ref.csv", "--column", 0, "-o", "u.csv"), "no command is"),
        (("export", "unfit.json", "--inverse", "-o", "code"), "nothing is exported"),
        (("export", "unfit.json", "--target", "mex", "-o", "code"), "nothing is exported"),
        (
            ("export", "unfit.json", "--target", "fmu", "--no-binary", "-o", "stage.fmu"),
            "nothing is exported",
        ),
    ],
)
def test_no_command_comes_from_it_unless_told(
    verb: tuple[object, ...], what: str, run: Run, refused: Callable[..., str], unfit_file: Path
) -> None:
    message = refused(*verb)
    assert f"{what}" in message
    assert "unfit: Hardly better than a line;" in message
    assert "--despite-verdict" in message
    assert run(*verb, "--despite-verdict").code == 0


def test_no_observer_is_designed_around_it(
    run: Run, refused: Callable[..., str], unfit_file: Path, folder: Path
) -> None:
    spec = run("observer", "--template").out
    start = spec.index("[hysteresis]")
    stop = spec.index("\n[", start)
    (folder / "spec.toml").write_text(
        spec[:start] + '[hysteresis]\nfile = "unfit.json"\n' + spec[stop:]
    )
    assert "no controller is designed" in refused("observer", "spec.toml", "-o", "out")


def test_an_estimate_from_it_is_as_unfit(run: Run, unfit_file: Path, folder: Path) -> None:
    u = drive()
    write_csv(folder / "more.csv", "u,y", u, STAGE(u))
    about = hyst.load(unfit_file).description
    STAGE.save(unfit_file, replace(about, delay=0))
    columns = ("--input", "u", "--output", "y", "--rate", 100)
    ended = run("adapt", unfit_file, "more.csv", *columns, "-o", "out")
    assert ended.code == 0
    assert "unfit, and the estimate has its shape: Hardly better than a line." in ended.err
    assert hyst.load(folder / "out" / "model.json").description.verdict == UNFIT


def test_a_row_for_every_record_with_its_file(run: Run, folder: Path) -> None:
    u = drive()
    time = np.arange(u.size) * 0.01
    write_csv(folder / "first.csv", "t,u,y", time, u, STAGE(u))
    write_csv(folder / "other.csv", "t,u,y", time, u, 1.5 * STAGE(u))
    ended = run("identify", "first.csv", "other.csv", *COLUMNS, *QUICK, "-o", "out")
    assert "Error by record" in ended.out
    assert "1, first.csv" in ended.out
    assert "2, other.csv" in ended.out
    by_record = json.loads((folder / "out" / "metrics.json").read_text())["per_record"]
    assert [(each["record"], each["name"]) for each in by_record] == [
        (1, "first.csv"),
        (2, "other.csv"),
    ]
    assert "2, other.csv" in (folder / "out" / "report.html").read_text()
    one = run("identify", "first.csv", *COLUMNS, *QUICK, "-o", "one")
    assert "Error by record" not in one.out


def test_compensate_tells_the_error_to_expect(run: Run, folder: Path) -> None:
    errors = {"training": {"rms": 0.195, "rms_percent": 0.4, "max_abs": 0.8}}
    STAGE.save(folder / "model.json", describe(STAGE, errors=errors, smallest_swing=3.0))
    shallow = 4.5 + 0.5 * np.sin(np.linspace(0.0, 20.0, 500))
    write_csv(folder / "ref.csv", "wanted", shallow)
    asked = ("compensate", "model.json", "ref.csv", "--column", 0, "-o", "u.csv")
    ended = run(*asked)
    first = ended.out.splitlines()[0]
    assert first.startswith("exact for the model (rounding ")
    assert first.endswith(
        "; the model itself missed its record by 0.195 um rms, 0.8 at most (training): expect that"
    )
    assert "model itself, rms (training)" in ended.out
    assert "memory taken as virgin" in ended.out
    assert "smaller than any in the records" in ended.err
    assert "memory taken as virgin" not in run(*asked, "--history", "0,4,0").out


@pytest.mark.parametrize("delay", [1.4, 0.25, -2.0, -1.5])
def test_simulate_takes_any_delay(delay: float, run: Run, folder: Path) -> None:
    # Of a line driven by a line, what comes later is lower by slope times delay.
    hyst.Affine(2.0).save(folder / "model.json", hyst.ModelDescription(delay=delay, dt=0.01))
    write_csv(folder / "drive.csv", "u", np.arange(50.0))
    asked = ("simulate", "model.json", "drive.csv", "--input", 0, "-o", "out.csv")
    ended = run(*asked, "--with-delay")
    assert ended.code == 0
    y = np.loadtxt(folder / "out.csv", delimiter=",", skiprows=1)[:, 1]
    # Numbers of this size are exact to some 1e-14.
    assert y[5:-5] == pytest.approx(2.0 * (np.arange(5.0, 45.0) - delay), abs=1e-12)
    assert ("AHEAD" in ended.err) == (delay < 0.0)


@pytest.mark.parametrize("delay", [2, 1.5, -3])
def test_adapt_sets_the_signals_side_by_side(delay: float, run: Run, folder: Path) -> None:
    # A straight drive, so that input and output at any time in between are known exactly.
    u = 4.0 * np.abs(((np.arange(1200) / 300.0) % 2.0) - 1.0)
    later = 4.0 * np.abs((((np.arange(1200) - delay) / 300.0) % 2.0) - 1.0)
    stage = hyst.PrandtlIshlinskii(p=[0.5], r=[0.7], p0=1.0)
    write_csv(folder / "data.csv", "u,y", u, stage(later))
    start = hyst.PrandtlIshlinskii(p=[0.4], r=[0.8], p0=1.1)
    start.save(folder / "model.json", hyst.ModelDescription(delay=delay, dt=0.01))
    columns = ("--input", "u", "--output", "y", "--rate", 100)
    assert run("adapt", "model.json", "data.csv", *columns, "-o", "out").code == 0
    found = hyst.load(folder / "out" / "model.json")
    # A sample of misalignment is 0.013 of a drive of 4; the corners of 1.5 samples cost less.
    assert found.parameters().values[:3] == pytest.approx([1.0, 0.5, 0.7], abs=5e-3)
