"""hyst excite: drive, figure, what it can determine; and from there to a model."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import hyst
from hyst.cli import main


def test_writes_a_drive_that_can_be_read_back(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "drive.csv"
    arguments = ["--kind", "multisine", "--rate", "1000", "--rms", "2", "--duration", "0.5"]
    arguments += ["--periods", "3", "--fir-order", "20", "--name", "drive [V]", "-o", str(out)]
    assert main(["excite", *arguments]) == 0
    u, name, unit = hyst.io.read_column(out, "drive")
    assert (name, unit, u.size) == ("drive", "V", 1500)
    assert u.std() == pytest.approx(2.0, rel=1e-6)
    assert out.with_suffix(".png").read_bytes().startswith(b"\x89PNG")
    said = capsys.readouterr().out
    assert "crest factor" in said
    assert "rank 21 of 21" in said


def test_limits_hold_in_the_file(tmp_path: Path) -> None:
    out = tmp_path / "forc.csv"
    arguments = ["--kind", "forc", "--rate", "1000", "--amplitude", "5", "--periods", "4"]
    arguments += ["--max-rate", "100", "--max-acceleration", "20000", "-o", str(out)]
    assert main(["excite", *arguments]) == 0
    u, _, _ = hyst.io.read_column(out, "u")
    # The file holds every digit, so no tolerance for writing; differences round in the last place.
    assert np.abs(np.diff(u)).max() * 1000.0 <= 100.0
    assert np.abs(np.diff(u, 2)).max() * 1000.0**2 <= 20000.0


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--kind", "sawtooth", "--rate", "100"], "unknown kind 'sawtooth'"),
        (["--kind", "triangle", "--rate", "100"], "give max_rate"),
        (["--kind", "multisine", "--rate", "0"], "--rate is 0.0"),
        (["--kind", "multisine", "--rate", "100", "--band", "1"], "--band is '1'"),
        (["--kind", "multisine", "--rate", "100", "--fir-order", "-3"], "--fir-order is -3"),
        (
            ["--kind", "multisine", "--rate", "1000", "--duration", "1e9"],
            "would have 1e+12 samples",
        ),
        (["--kind", "swept-sine", "--rate", "1e5", "--duration", "1e308"], "at most 1e+08"),
        (["--kind", "multisine", "--rate", "1e5", "--periods", "100000"], "would have 1e+10"),
        (["--kind", "prbs", "--rate", "100", "--clock", "1000000"], "would have 1.023e+09"),
        (["--kind", "prbs", "--rate", "100", "--register", "0"], "register is 0"),
        (["--kind", "triangle", "--rate", "1", "--max-rate", "1e-9"], "would have 4e+09 samples"),
        (
            ["--kind", "triangle", "--rate", "1", "--max-rate", "1", "--periods", "1000000000"],
            "would have 1e+09 samples",
        ),
        (
            ["--kind", "staircase", "--rate", "1000", "--max-rate", "9", "--duration", "1e7"],
            "samples, and at most 1e+08",
        ),
        (["--kind", "prbs", "--rate", "100", "--band", "1,9"], "--band is for --kind multisine, "),
        (["--kind", "prbs", "--rate", "100", "--duration", "9"], "--duration is for --kind"),
        (["--kind", "forc", "--rate", "100", "--rms", "1"], "not for forc; leave it out"),
        (["--kind", "triangle", "--rate", "100", "--decay", "0.5"], "--kind reversals"),
        (["--kind", "multisine", "--rate", "100", "--clock", "2"], "--clock is for --kind prbs"),
        (["--kind", "schroeder", "--rate", "100", "--seed", "2"], "--seed is for --kind"),
        (["--kind", "multisine", "--rate", "100", "--rms", "1", "--amplitude", "2"], "one of them"),
        (["--kind", "multisine", "--rate", "100", "--duration", "-1"], "--duration is -1.0"),
        (["--kind", "multisine", "--rate", "100", "--duration", "nan"], "--duration is nan"),
        (["--kind", "multisine", "--rate", "100", "--band", "1,60"], "half the sample rate, 50 Hz"),
        (["--kind", "schroeder", "--rate", "100", "--band", "9,3"], "9 to 3 Hz; give two"),
        (["--kind", "noise", "--rate", "100"], "give its corner, in Hz"),
        (["--kind", "noise", "--rate", "100", "--corner", "50"], "half the sample rate, 50 Hz"),
        (["--kind", "levels", "--rate", "100", "--hold", "60"], "hold is 60 samples and a period"),
        (["--kind", "prbs", "--rate", "100", "--hold", "6"], "--hold is for --kind levels"),
        (["--kind", "levels", "--rate", "100", "--uniform"], "--uniform is for --kind"),
        (["--kind", "multisine", "--rate", "100", "--spacing", "linear"], "--kind swept-sine"),
        (["--kind", "multisine", "--rate", "100", "--spectrum", "blue"], "spectrum is 'blue'"),
        (["--kind", "multisine", "--rate", "100", "--keep", "all"], "keep is 'all'; choose one of"),
        (["--kind", "multisine", "--rate", "100", "--max-rate", "1"], "the lowest line, needs"),
        (["--kind", "multisine", "--rate", "100", "--resonance", "9"], "--resonance is '9'; give"),
        (
            ["--kind", "multisine", "--rate", "100", "--resonance", "60,0.1"],
            "is at 60 Hz, not below",
        ),
        (["--kind", "multisine", "--rate", "100", "--delay", "2"], "--delay is for --resonance"),
        (["--kind", "multisine", "--rate", "100", "--weights", "2"], "--weights is for"),
        (
            ["--kind", "multisine", "--rate", "100", "--noise", "loud"],
            "--noise is 'loud'; give it as",
        ),
        (["--kind", "multisine", "--rate", "100", "--noise", "-1"], "--noise is '-1'; give it as"),
        (["--kind", "multisine", "--rate", "99", "--model", "m", "--radii", "1"], "it states all"),
        (
            ["--kind", "levels", "--rate", "99", "--duration", "0.1", "--resonance", "9,0.1"],
            "the drive has 10 samples and the model 15 numbers",
        ),
    ],
)
def test_refuses_in_one_sentence(
    arguments: list[str], says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["excite", *arguments, "-o", str(tmp_path / "drive.csv")]) == 2
    assert says in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_drive_record_identify_from_files(tmp_path: Path) -> None:
    drive, data, out = (str(tmp_path / name) for name in ("drive.csv", "data.csv", "out"))
    arguments = ["--kind", "multisine", "--rate", "1000", "--amplitude", "10", "--duration", "4"]
    assert main(["excite", *arguments, "--name", "drive [V]", "-o", drive]) == 0
    u, _, _ = hyst.io.read_column(drive, "drive")
    w = 2.0 * np.pi * 80.0
    G = hyst.LinearDynamics.from_continuous([1.0], [w**-2, 0.3 / w, 1.0], 1e-3)
    y = (G @ hyst.PrandtlIshlinskii([0.3, 0.2], [0.5, 2.0], 1.0))(u)
    y = y + 0.01 * y.std() * np.random.default_rng(0).normal(size=y.size)
    columns = (np.arange(u.size) * 1e-3, u, y)
    hyst.io.write_columns(data, ["time [s]", "drive [V]", "position [um]"], columns)
    arguments = ["--input", "drive", "--output", "position", "--time", "time"]
    arguments += ["--family", "hammerstein", "--hysteresis", "pi", "--plays", "2", "-o", out]
    assert main(["identify", data, *arguments]) == 0
    model = hyst.load(Path(out) / "model.json")
    assert model.dt == pytest.approx(1e-3)
    assert (Path(out) / "estimated_loop.png").exists()
    assert np.std(model(u) - y) < 0.011 * y.std()


def test_every_kind_is_drawn_without_a_warning(tmp_path: Path) -> None:
    kinds = ["odd-multisine", "schroeder", "prbs", "swept-sine", "triangle", "staircase", "levels"]
    for kind in [*kinds, "noise"]:
        out = tmp_path / f"{kind}.csv"
        arguments = ["--kind", kind, "--rate", "100", "--max-rate", "1e4", "-o", str(out)]
        arguments += ["--corner", "20"] if kind == "noise" else []
        assert main(["excite", *arguments]) == 0
        assert out.with_suffix(".png").exists()


AUDITED = ["--resonance", "200,0.03", "--delay", "3", "--radii", "0.05,0.15,0.3,0.5,0.8"]


def excited(tmp_path: Path, *more: str) -> int:
    usual = ["--rate", "10000", "--duration", "2", "-o", str(tmp_path / "drive.csv")]
    return main(["excite", *usual, *more])


def test_says_what_it_will_determine(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    limits = ["--amplitude", "1", "--max-rate", "500", "--max-acceleration", "2e6"]
    assert excited(tmp_path, "--kind", "multisine", "--band", "1,1000", *limits, *AUDITED) == 0
    told = capsys.readouterr()
    assert "13 of 13 numbers" in told.out
    assert "nothing stays open" in told.out
    assert "the amplitude is kept and the spectrum shaped" in told.err
    # The paper's method would ask for more, and says so behind it.
    assert told.out.index("nothing stays open") < told.out.index("not persistently exciting")
    u, _, _ = hyst.io.read_column(tmp_path / "drive.csv", "u")
    assert np.abs(u).max() == pytest.approx(1.0, rel=1e-9)
    assert np.abs(np.diff(u)).max() * 1e4 <= 500.0


def test_names_what_stays_open(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    more = ["--kind", "multisine", "--band", "1,60", "--amplitude", "0.4", "--noise", "0.002"]
    assert excited(tmp_path, *more, *AUDITED) == 0
    told = capsys.readouterr().out
    assert "with noise of 0.002 on an output" in told
    assert "nothing above 60 Hz; add frequencies up to 300 Hz" in told
    assert "plays of radius 0.5, 0.8 are not determined" in told
    assert "nothing stays open" not in told


def test_a_model_file_states_the_actuator(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    front = hyst.PrandtlIshlinskii([0.3, 0.2], [0.2, 0.5], 1.0)
    model = hyst.identification.sketched_stage(1e-4, [(300.0, 0.05)], front=front)
    model.save(tmp_path / "model.json")
    more = ["--kind", "levels", "--hold", "8", "--model", str(tmp_path / "model.json")]
    assert excited(tmp_path, *more) == 0
    told = capsys.readouterr().out
    assert "damping of 300 Hz" in told
    assert "7 of 7 numbers" in told
    assert main(["excite", "--rate", "1000", *more, "-o", str(tmp_path / "other.csv")]) == 2
    assert "dt = 0.001 s, the model 0.0001 s" in capsys.readouterr().err
    assert not (tmp_path / "other.csv").exists()


def test_identify_averages_periods(tmp_path: Path) -> None:
    u = np.tile(np.random.default_rng(4).normal(size=1000), 5).astype(np.float64)
    y: NDArray[np.float64] = 2.0 * np.convolve(u, 0.5 ** np.arange(1, 40))[: u.size]
    y += 0.4 * np.random.default_rng(5).normal(size=u.size)
    data, out = str(tmp_path / "data.csv"), tmp_path / "out"
    hyst.io.write_columns(data, ["u", "y"], (u, y))
    arguments = ["--input", "u", "--output", "y", "--rate", "1000", "--period", "1000"]
    arguments += ["--family", "hammerstein", "--hysteresis", "linear", "-o", str(out)]
    assert main(["identify", data, *arguments]) == 0
    told = json.loads((out / "metrics.json").read_text(encoding="utf-8"))
    # Four periods averaged halve the noise; 1000 samples tell its size to 2.2 %, four times that.
    assert _found(told, "noise_rms") == pytest.approx(0.2, rel=0.09)


def _found(tree: dict[str, Any], name: str) -> Any:
    if name in tree:
        return tree[name]
    branches = [_found(each, name) for each in tree.values() if isinstance(each, dict)]
    return next((each for each in branches if each is not None), None)
