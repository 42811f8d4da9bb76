"""hyst adapt for any family: scale and offset, the choice of what is estimated, and the guard."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import hyst
from hyst.cli import main
from hyst.cli.adapt.telling import tell_gain
from hyst.online import ESTIMATORS
from reference.family_examples import family_example

DT = 1e-3
TRUTH = hyst.BoucWen(0.6, 0.35, 0.12, 0.06, h=-1.0)
COLUMNS = ["--input", "drive", "--output", "way", "--rate", "1000"]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A record of 4 s whose gain falls by 30 percent, and the model of its start."""
    t = np.arange(4000) * DT
    u = 8.0 * np.sin(2.0 * np.pi * 5.0 * t)
    y = (1.0 - 0.3 * t / 4.0) * TRUTH(u) + 0.2
    y += 0.01 * np.random.default_rng(0).standard_normal(u.size)
    y_ref = 3.0 * np.sin(2.0 * np.pi * 5.0 * t)
    headers = ["drive [V]", "way [um]", "wanted [um]"]
    hyst.io.write_columns(tmp_path / "data.csv", headers, (u, y, y_ref))
    about = hyst.ModelDescription(input_unit="V", output_unit="um")
    TRUTH.save(tmp_path / "model.json", about)
    return tmp_path


def adapt(folder: Path, *more: str, out: str = "out") -> int:
    files = [str(folder / "model.json"), str(folder / "data.csv")]
    return main(["adapt", *files, *COLUMNS, "-o", str(folder / out), *more])


def rows(path: Path) -> tuple[list[str], np.ndarray]:
    header, *lines = path.read_text().splitlines()
    return header.split(","), np.array(
        [[float(cell) for cell in each.split(",")] for each in lines]
    )


def test_a_family_without_an_estimator_of_its_own_is_followed_by_scale_and_offset(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert adapt(folder, "--memory", "0.1") == 0
    told = capsys.readouterr()
    assert "scale" in told.out
    assert "known within" in told.out
    # It drifts, so that errors follow each other, and that is said.
    assert "drift faster than the memory forgets" in " ".join(told.err.split())
    header, values = rows(folder / "out" / "parameters.csv")
    assert header[:2] == ["time [s]", "scale"]
    # It lags by its memory, 0.1 of 4 s, in which the gain falls by 0.0075.
    assert values[-1, 1] == pytest.approx(0.7, abs=0.02)
    found = hyst.load(folder / "out" / "model.json")
    assert found.description.output_unit == "um"
    u = np.linspace(0.0, 5.0, 50)
    assert found(u) == pytest.approx(0.7 * TRUTH(u) + 0.2, abs=0.1)


@pytest.mark.parametrize("family", ["pi", "preisach", "jiles-atherton", "rdpi", "hammerstein"])
@pytest.mark.usefixtures("undrawn")
def test_only_scale_and_offset_of_any_family(
    family: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    example = family_example(family)
    u = example.drives[-1]
    hyst.io.write_columns(
        tmp_path / "data.csv", ["drive", "way"], (u, 1.2 * example.model(u) - 0.1)
    )
    example.model.save(tmp_path / "model.json")
    assert adapt(tmp_path, "--only", "scale,offset") == 0
    assert "not determined" not in capsys.readouterr().out
    estimator = hyst.load(tmp_path / "out" / "estimator.json")
    # Without noise; to rounding.
    assert estimator.parameters == pytest.approx([1.2, -0.1], abs=1e-9)


@pytest.mark.usefixtures("undrawn")
def test_only_some_constants_of_plays(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    hyst.PrandtlIshlinskii([0.1, 0.1], [1.0, 3.0], 0.2).save(folder / "model.json")
    assert adapt(folder, "--only", "p0,r") == 0
    shown = capsys.readouterr().out
    table = {line.split()[0]: line.split()[-1] for line in shown.splitlines() if line[:2] == "  "}
    assert table["p[1]"] == table["p[2]"] == table["offset"] == "held"
    assert "held" not in (table["p0"], table["r[1]"], table["r[2]"])


@pytest.mark.usefixtures("undrawn")
def test_a_swing_that_tells_no_scale_is_told(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    u = 5.0 + 1e-3 * np.sin(np.arange(1000) / 20.0)
    y = TRUTH(u) + 0.1 * np.random.default_rng(1).standard_normal(u.size)
    hyst.io.write_columns(folder / "data.csv", ["drive", "way"], (u, y))
    assert adapt(folder) == 0
    told = capsys.readouterr()
    assert "not determined" in told.out
    assert "move farther" in " ".join(told.err.split())


def test_the_guard_writes_what_it_would_have_done(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert adapt(folder, "--memory", "0.2", "--guard", "--commands", "wanted") == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "status: commands come from the" in told
    assert "windows of 0.2 s, a period of the motion" in told
    header, values = rows(folder / "out" / "guard.csv")
    assert header == [
        "time [s]",
        "prediction [um]",
        "error [um]",
        "from estimate",
        "fallbacks",
        "command [V]",
    ]
    assert values.shape == (4000, 6)
    _, data = rows(folder / "data.csv")
    assert values[:, 1] + values[:, 2] == pytest.approx(data[:, 1], abs=1e-12)
    # The true gain at the end, through the true memory, makes of the last command what was wanted:
    # the estimate lags by 0.2 s, in which the gain falls by 0.015 of 3.
    plant = TRUTH.stepper()
    for u in data[:-1, 0]:
        plant(u)
    assert 0.7 * plant(values[-1, 5]) + 0.2 == pytest.approx(data[-1, 2], abs=0.06)
    # Frozen the model would miss by what the gain has lost.
    frozen = data[:, 1] - TRUTH(data[:, 0])
    assert np.std(values[2000:, 2]) < 0.2 * np.std(frozen[2000:])


@pytest.mark.usefixtures("undrawn")
def test_a_guarded_run_goes_on_where_it_stopped(folder: Path) -> None:
    lines = (folder / "data.csv").read_text().splitlines()
    whole = folder / "data.csv"
    assert adapt(folder, "--memory", "0.2", "--guard", out="whole") == 0
    whole.write_text("\n".join(lines[:1501]))
    assert adapt(folder, "--memory", "0.2", "--guard", out="first") == 0
    whole.write_text("\n".join([lines[0], *lines[1501:]]))
    resume = ["--resume", str(folder / "first" / "guard.json")]
    files = [str(folder / "data.csv")]
    assert main(["adapt", *files, *COLUMNS, *resume, "-o", str(folder / "second")]) == 0
    once, twice = (
        json.loads((folder / each / "guard.json").read_text()) for each in ("whole", "second")
    )
    assert once["state"] == twice["state"]
    assert once["settings"]["estimator"]["state"] == twice["settings"]["estimator"]["state"]
    assert once["settings"]["judgement"] == twice["settings"]["judgement"]


@pytest.mark.usefixtures("undrawn")
def test_scale_and_offset_go_on_where_they_stopped(folder: Path) -> None:
    lines = (folder / "data.csv").read_text().splitlines()
    assert adapt(folder, "--memory", "0.2", out="whole") == 0
    (folder / "data.csv").write_text("\n".join(lines[:1501]))
    assert adapt(folder, "--memory", "0.2", out="first") == 0
    (folder / "data.csv").write_text("\n".join([lines[0], *lines[1501:]]))
    resume = ["--resume", str(folder / "first" / "estimator.json")]
    assert adapt(folder, *resume, out="second") == 0
    once, twice = (
        json.loads((folder / each / "estimator.json").read_text()) for each in ("whole", "second")
    )
    assert once["state"] == twice["state"]


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (["--only", "r"], "only names 'r'; there are scale, offset"),
        (["--estimator", "kalman"], "there is no estimator 'kalman'"),
        (["--estimator", "joint"], "no Prandtl-Ishlinskii stage"),
        (["--estimate-maps"], "no Prandtl-Ishlinskii stage"),
        (["--estimator", "scale", "--estimate-maps"], "leave one of them out"),
        (["--estimator", "model", "--estimate-maps"], "leave one of them out"),
        (["--window", "long"], "--window is 'long'; give seconds, or auto"),
        (["--window", "-1"], "--window is -1"),
        (["--commands", "nothing"], "no column"),
        (["--commands", "drive"], "convert the column"),
        (["--resume", "model.json", "--only", "scale"], "leave out --only with --resume"),
    ],
)
def test_bad_input_is_one_sentence(
    more: list[str],
    message: str,
    folder: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(folder)
    assert adapt(folder, *more) == 2
    told = capsys.readouterr().err
    assert message in told
    assert told.count("\n") == 1
    assert not (folder / "out").exists()


@pytest.mark.usefixtures("undrawn")
def test_a_guard_of_what_has_no_inverse_is_refused(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    hyst.RateDependentPrandtlIshlinskii([0.1], [1.0], 0.02, DT, p0=0.3).save(folder / "model.json")
    assert adapt(folder, "--guard") == 2
    assert "no command can be given, but the estimate goes on" in capsys.readouterr().err
    assert adapt(folder) == 0


def test_help_names_every_estimator(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["adapt", "--help"]) == 0
    shown = " ".join(capsys.readouterr().out.replace("│", " ").split())
    for name in ESTIMATORS:
        assert name in shown.partition("Which one: auto by")[2].partition("--")[0]


def test_what_is_known_is_written_as_it_is_told(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plays = hyst.PrandtlIshlinskii([0.6, 0.4], [0.8, 2.0], 1.0)
    u = 1.5 * np.sin(2.0 * np.pi * 2.0 * np.arange(4000) * DT)
    y = plays(u) + 0.05 * np.random.default_rng(3).standard_normal(u.size)
    hyst.io.write_columns(folder / "data.csv", ["drive", "way"], (u, y))
    plays.save(folder / "model.json")
    assert adapt(folder) == 0
    told = capsys.readouterr()
    written = json.loads((folder / "out" / "knowledge.json").read_text())
    assert not written["known"]
    unknown = [each["name"] for each in written["constants"] if not each["determined"]]
    # 1.5 does not move the play of radius 2.
    assert {"p[2]", "r[2]"} <= set(unknown)
    table = [each.split() for each in told.out.splitlines()]
    says = [each[0] for each in table if each and each[-2:] == ["not", "determined"]]
    assert says == unknown
    # One sentence for each reason, however many constants have it.
    reasons = {each["reason"] for each in written["constants"] if not each["determined"]}
    assert " ".join(told.err.split()).count("not determined: ") == len(reasons)


@pytest.mark.parametrize(("off", "is_worse"), [(0.5, True), (0.0, False)])
def test_estimates_that_predict_worse_than_their_start_are_told(
    off: float, is_worse: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    y = np.sin(np.arange(400) / 20.0)
    made = np.zeros((4, 1))
    trajectory = hyst.online.Trajectory(np.arange(4.0), ("p0",), made, made, 0.1 * y + off)
    tell_gain(trajectory, y, 0.8 * y)
    told = capsys.readouterr()
    assert ("made them worse" in told.err) is is_worse
    assert ("predictions miss by 0.07" in told.out) is not is_worse


@pytest.mark.parametrize(("name", "is_advised"), [("p0", True), ("scale", False)])
def test_estimating_less_is_advised_where_there_is_less(
    name: str, is_advised: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    y, made = np.sin(np.arange(400) / 20.0), np.zeros((4, 1))
    tell_gain(hyst.online.Trajectory(np.arange(4.0), (name,), made, made, y), y, 0.8 * y)
    assert ("--only scale,offset" in capsys.readouterr().err) is is_advised
