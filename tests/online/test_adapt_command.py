"""hyst adapt, and the study of the paper on a measured piezo."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import hyst
from hyst.cli import main
from online.plants import P, R

TRUTH = hyst.Affine(1.0, 2.0) @ hyst.PrandtlIshlinskii(P, R, 0.3)


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    u = 30.0 * np.sin(2 * np.pi * np.arange(4000) / 1000.0)
    y = TRUTH(u) + 0.05 * np.random.default_rng(0).standard_normal(u.size)
    hyst.io.write_columns(tmp_path / "data.csv", ["drive", "way"], (u, y))
    start = hyst.Affine(1.0, 1.0) @ hyst.PrandtlIshlinskii(1.1 * P, 0.9 * R, 0.3)
    start.save(tmp_path / "model.json")
    return tmp_path / "model.json", tmp_path / "data.csv"


def adapt(files: tuple[Path, Path], folder: Path, *more: str) -> int:
    model, data = files
    columns = ["--input", "drive", "--output", "way", "--rate", "1000"]
    return main(["adapt", str(model), str(data), *columns, "-o", str(folder), *more])


def test_writes_parameters_over_time_with_bands(
    files: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "out"
    assert adapt(files, folder) == 0
    shown = capsys.readouterr().out
    assert "r[5]" in shown
    assert "every play goes from envelope to envelope" in shown
    header, *rows = (folder / "parameters.csv").read_text().splitlines()
    assert header.startswith("time [s],p0,p0 standard error")
    assert len(rows) == 2000
    assert (folder / "parameters.png").read_bytes().startswith(b"\x89PNG")
    u = np.linspace(-30.0, 30.0, 50)
    # 4 periods at a noise of 0.05.
    assert hyst.load(folder / "model.json").inverse() is not None
    found = hyst.load(folder / "model.json")
    path = np.concatenate([u, u[::-1], u])
    assert found(path)[100:] == pytest.approx(TRUTH(path)[100:], abs=0.1)


@pytest.mark.usefixtures("undrawn")
def test_stopped_and_resumed_it_gives_the_same(files: tuple[Path, Path], tmp_path: Path) -> None:
    model, data = files
    lines = data.read_text().splitlines()
    (tmp_path / "a.csv").write_text("\n".join([lines[0], *lines[1:1501]]))
    (tmp_path / "b.csv").write_text("\n".join([lines[0], *lines[1501:]]))
    assert adapt(files, tmp_path / "whole") == 0
    assert adapt((model, tmp_path / "a.csv"), tmp_path / "first") == 0
    resume = ["--resume", str(tmp_path / "first" / "estimator.json")]
    assert adapt((model, tmp_path / "b.csv"), tmp_path / "second", *resume) == 0
    whole, second = (
        json.loads((tmp_path / each / "estimator.json").read_text()) for each in ("whole", "second")
    )
    used = slice(0, 140)  # everything but the scratch area at the end
    assert whole["state"][used] == second["state"][used]


@pytest.mark.usefixtures("undrawn")
def test_bad_input_is_one_sentence(
    files: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert adapt(files, tmp_path / "out", "--resume", str(files[0])) == 2
    assert "holds no estimator" in capsys.readouterr().err
    # An estimator brings its own options, so others would be dropped unsaid.
    assert adapt(files, tmp_path / "out", "--resume", str(files[0]), "--memory", "2") == 2
    assert "leave out --memory" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_no_rival_disturbs_the_estimate_on_a_measured_piezo(measured_data: Path) -> None:
    path = measured_data / "piezo-dbo" / "Model_Vi_Do.dat"
    whole = hyst.read_record(path, input="0", output="4", rate=200.0)
    found = hyst.identify(whole, family="pi", plays=3)
    lag = found.delay
    record = hyst.Record(whole.u[400 : whole.samples - lag], whole.y[400 + lag :], whole.dt)
    runs = {}
    for search in (True, False):
        estimator = hyst.online.JointEstimator(
            found.model, dt=whole.dt, memory=5.0, radius_spread=0.3, search=search
        )
        estimator.follow(whole.u[:400])
        runs[search] = estimator.run(record)
        assert not estimator.innovation.consistent
    # A piezo is not made of three plays. Rivals did better for some strokes and worse after.
    assert (runs[True].values == runs[False].values).all()


def test_readme_names_the_command_and_its_page() -> None:
    root = Path(__file__).resolve().parents[2]
    readme = (root / "README.md").read_text(encoding="utf-8")
    assert "`hyst adapt`" in readme
    assert "(docs/online.md)" in readme
    assert (root / "docs" / "online.md").exists()


@pytest.mark.usefixtures("undrawn")
def test_resuming_needs_no_model_and_refuses_another(
    files: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model, data = files
    hyst.load(model).save(model, hyst.operators.ModelDescription(output_unit="um"))
    assert adapt(files, tmp_path / "first") == 0
    columns = ["--input", "drive", "--output", "way", "--rate", "1000"]
    resume = ["--resume", str(tmp_path / "first" / "estimator.json")]
    second = ["-o", str(tmp_path / "second")]
    assert main(["adapt", str(data), *columns, *resume, *second]) == 0
    # What the numbers mean came with the estimator.
    assert '"output_unit": "um"' in (tmp_path / "second" / "model.json").read_text()
    # The model it started from and the one it ended with are its own, another is not.
    assert adapt((tmp_path / "first" / "model.json", data), tmp_path / "third", *resume) == 0
    other = tmp_path / "other.json"
    hyst.PrandtlIshlinskii(P, 1.2 * R, 0.3).save(other)
    capsys.readouterr()
    assert adapt((other, data), tmp_path / "fourth", *resume) == 2
    assert "is not the model that" in capsys.readouterr().err
    assert main(["adapt", str(data), *columns, *second, "--force"]) == 2
    assert "give MODEL and DATA" in capsys.readouterr().err


@pytest.mark.usefixtures("undrawn")
def test_a_start_at_the_end_of_the_record_is_refused(
    files: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for start in ("3999", "4000", "99999"):
        assert adapt(files, tmp_path / "out", "--start", start) == 2
        assert f"--start is {start} but the record has 4000 samples" in capsys.readouterr().err
    assert adapt(files, tmp_path / "out", "--start", "3998") == 0


@pytest.mark.usefixtures("undrawn")
def test_it_says_when_what_is_left_is_no_noise(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    # Plays cannot make a parabola, whatever their constants.
    u = 30.0 * np.sin(2 * np.pi * np.arange(4000) / 1000.0)
    hyst.io.write_columns(tmp_path / "data.csv", ["drive", "way"], (u, u + 0.01 * u**2))
    hyst.PrandtlIshlinskii([0.5], [1.0], 1.0).save(tmp_path / "model.json")
    assert adapt((tmp_path / "model.json", tmp_path / "data.csv"), tmp_path / "out") == 0
    told = " ".join(capsys.readouterr().err.split())
    assert "model or estimate are wrong" in told
    assert "the plant is no such model, or has changed, and the bands are too narrow" in told


@pytest.mark.usefixtures("undrawn")
def test_a_record_of_which_little_can_be_used_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    # Squares of these overflow, so that only the 0 at the start can be used.
    u = 1e200 * np.sin(2 * np.pi * np.arange(4000) / 1000.0)
    hyst.io.write_columns(tmp_path / "data.csv", ["drive", "way"], (u, 2.0 * u))
    hyst.PrandtlIshlinskii([0.5], [1.0], 1.0).save(tmp_path / "model.json")
    assert adapt((tmp_path / "model.json", tmp_path / "data.csv"), tmp_path / "out") == 2
    assert "overflow at 3999 samples and taught at 1;" in capsys.readouterr().err
    assert not (tmp_path / "out" / "model.json").exists()
