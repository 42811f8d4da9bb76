"""hyst simulate, compensate and info: what they compute, say and refuse."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_runs import STAGE, Run, describe, drive, write_csv

import hyst
from hyst.models import PrandtlIshlinskii

U = drive(300)


def column(path: Path, name: str | int) -> np.ndarray:
    return hyst.io.read_column(path, name)[0]


def simulate(*arguments: object) -> tuple[object, ...]:
    return ("simulate", "model.json", *arguments, "-o", "out.csv")


def compensate(*arguments: object) -> tuple[object, ...]:
    return ("compensate", "model.json", "ref.csv", "--column", 0, *arguments, "-o", "command.csv")


def test_simulate_writes_input_and_output_exactly(run: Run, model_file: Path, folder: Path) -> None:
    write_csv(folder / "drive.csv", "a,drive", U, U)
    ended = run(*simulate("drive.csv", "--input", "drive"))
    assert (ended.code, ended.err) == (0, "")
    assert (folder / "out.csv").read_text().splitlines()[0] == "drive [V],stroke [um]"
    assert np.array_equal(column(folder / "out.csv", "drive"), U)
    assert np.array_equal(column(folder / "out.csv", "stroke"), STAGE(U))


def test_simulate_with_delay_lags_as_the_record_did(
    run: Run, model_file: Path, folder: Path
) -> None:
    write_csv(folder / "drive.csv", "drive", U)
    assert run(*simulate("drive.csv", "--input", 0, "--with-delay")).code == 0
    y = STAGE(U)
    assert np.array_equal(column(folder / "out.csv", 1), np.concatenate([[y[0]] * 2, y[:-2]]))


def test_simulate_says_when_it_extrapolates(run: Run, model_file: Path, folder: Path) -> None:
    write_csv(folder / "drive.csv", "drive", 2.0 * U)
    ended = run(*simulate("drive.csv", "--input", 0))
    assert ended.code == 0
    assert "identified from 0 to 4" in ended.err


def test_a_command_for_a_sine_of_ones_own(run: Run, model_file: Path, folder: Path) -> None:
    y_ref = 4.5 + 1.5 * np.sin(np.linspace(0.0, 20.0, 500))
    write_csv(folder / "ref.csv", "wanted [um]", y_ref)
    ended = run(*compensate())
    assert (ended.code, ended.err) == (0, "")
    lines = (folder / "command.csv").read_text().splitlines()
    assert lines[0] == "reference [um],command [V],predicted [um]"
    assert np.array_equal(column(folder / "command.csv", "reference"), y_ref)
    command = column(folder / "command.csv", "command")
    assert np.array_equal(column(folder / "command.csv", "predicted"), STAGE(command))
    assert np.abs(STAGE(command) - y_ref).max() < 1e-12 * np.ptp(y_ref)
    assert "limits 0 to 4" in ended.out
    assert "lags the model by 2 samples" in ended.out
    # What simulate makes of the command is the reference again.
    assert run(*simulate("command.csv", "--input", "command")).code == 0
    assert np.abs(column(folder / "out.csv", 1) - y_ref).max() < 1e-9 * np.ptp(y_ref)


def test_a_reference_out_of_reach_is_refused_or_clipped(
    run: Run, refused: Callable[..., str], model_file: Path, folder: Path
) -> None:
    y_ref = 4.0 + 5.0 * np.sin(np.linspace(0.0, 20.0, 500))
    write_csv(folder / "ref.csv", "wanted", y_ref)
    message = refused(*compensate())
    assert "y_ref[" in message
    assert "reach" in message
    ended = run(*compensate("--outside", "clip"))
    assert ended.code == 0
    assert "out of reach and were clipped" in ended.out
    command = column(folder / "command.csv", "command")
    assert (command.min(), command.max()) == (0.0, 4.0)


def test_limits_can_be_given_or_taken_away(run: Run, model_file: Path, folder: Path) -> None:
    y_ref = STAGE(1.2 * U)
    write_csv(folder / "ref.csv", "wanted", y_ref)
    assert run(*compensate("--no-limits")).code == 0
    command = column(folder / "command.csv", "command")
    np.testing.assert_allclose(command, 1.2 * U, atol=1e-12)
    assert run(*compensate("--limits", "0,4.9", "--force")).code == 0
    clipped = ("--limits", "-1,4.5", "--outside", "clip", "--force")
    assert run(*compensate(*clipped)).code == 0
    assert column(folder / "command.csv", "command").max() == 4.5


def test_history_sets_the_memory(run: Run, model_file: Path, folder: Path) -> None:
    before = [0.0, 4.0, 0.0]
    y_ref = STAGE(np.concatenate([before, U]))[3:]
    write_csv(folder / "ref.csv", "wanted", y_ref)
    assert run(*compensate("--history", "0,4,0")).code == 0
    np.testing.assert_allclose(column(folder / "command.csv", "command"), U, atol=1e-12)


def test_no_range_in_the_file_means_no_limits_and_says_so(run: Run, folder: Path) -> None:
    STAGE.save(folder / "model.json")
    write_csv(folder / "ref.csv", "wanted", STAGE(100.0 * U))
    ended = run(*compensate())
    assert ended.code == 0
    assert "(no limits)" in ended.out


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (("--method", "oracle"), "exact"),
        (("--method", "oracle", "--preview", 5), "exact"),
        (("--preview", 5), "--preview is for --method preview, not for exact"),
        (("--rate-limit", 5), "--rate-limit is for --method preview or trajectory"),
        (("--method", "explicit", "--allow-unconverged"), "--allow-unconverged is for"),
        (("--outside", "ignore"), "clip"),
        (("--limits", "0,4", "--no-limits"), "--no-limits"),
        (("--limits", "0"), "--limits"),
        (("--limits", "4,0"), "input_range"),
        (("--limits", "low,high"), "--limits"),
        (("--history", "1;2"), "--history"),
        (("--history", "1,nan"), "history"),
    ],
)
def test_bad_arguments_are_refused(
    arguments: tuple[object, ...],
    part: str,
    refused: Callable[..., str],
    model_file: Path,
    folder: Path,
) -> None:
    write_csv(folder / "ref.csv", "wanted", STAGE(U))
    assert part in refused(*compensate(*arguments))


@pytest.mark.parametrize(
    ("content", "part"),
    [
        ("wanted\n3.0\nnan\n", "line 3"),
        ("wanted\n3.0\noops\n", "line 3"),
        ("wanted\n", "ref.csv"),
        ("wanted [nm]\n3.0\n4.0\n", "'nm'"),
    ],
)
def test_bad_references_are_refused(
    content: str, part: str, refused: Callable[..., str], model_file: Path, folder: Path
) -> None:
    (folder / "ref.csv").write_text(content)
    assert part in refused(*compensate())


def test_micro_is_micro_however_it_is_spelt(run: Run, model_file: Path, folder: Path) -> None:
    (folder / "ref.csv").write_text("wanted [\u00b5m]\n3.0\n4.0\n", encoding="utf-8")
    assert run(*compensate()).code == 0


def test_simulate_refuses_bad_input(
    refused: Callable[..., str], model_file: Path, folder: Path
) -> None:
    (folder / "drive.csv").write_text("drive [mV]\n1\n2\n")
    assert "'mV'" in refused(*simulate("drive.csv", "--input", 0))
    (folder / "drive.csv").write_text("drive\n1\nnan\n")
    assert "line 3" in refused(*simulate("drive.csv", "--input", 0))
    assert "no column" in refused(*simulate("drive.csv", "--input", "volts"))


def test_folders_on_the_way_to_an_output_are_made(run: Run, model_file: Path, folder: Path) -> None:
    write_csv(folder / "ref.csv", "wanted", STAGE(U))
    simulate = ("simulate", "model.json", "ref.csv", "--input", 0, "-o", "missing/deep/y.csv")
    assert run(*simulate).code == 0
    compensate = ("compensate", "model.json", "ref.csv", "--column", 0, "-o", "other/u.csv")
    assert run(*compensate).code == 0
    assert (folder / "missing" / "deep" / "y.csv").is_file()
    assert (folder / "other" / "u.csv").is_file()


def test_a_file_on_the_way_to_an_output_is_named(
    refused: Callable[..., str], model_file: Path, folder: Path
) -> None:
    write_csv(folder / "ref.csv", "wanted", STAGE(U))
    where = ("-o", "ref.csv/out.csv")
    assert "ref.csv" in refused("simulate", "model.json", "ref.csv", "--input", 0, *where)
    assert "ref.csv" in refused("compensate", "model.json", "ref.csv", "--column", 0, *where)


def test_a_model_without_inverse_is_refused_with_the_reason(
    refused: Callable[..., str], run: Run, folder: Path
) -> None:
    model = PrandtlIshlinskii(p=[1.0], r=[0.5])
    model.save(folder / "model.json", describe(model))
    write_csv(folder / "ref.csv", "wanted", STAGE(U))
    assert "p0 is 0" in refused(*compensate())
    ended = run("info", "model.json")
    assert ended.code == 0
    assert "no exact inverse: p0 is 0" in ended.out


def test_info_shows_everything(run: Run, model_file: Path) -> None:
    ended = run("info", model_file)
    assert (ended.code, ended.err) == (0, "")
    parts = ["pi", "drive, 0 to 4 V", "stroke um", "0.01 s", "2 samples", "affine.offset"]
    parts += ["prandtl_ishlinskii.p[2]", "0.3", "return point memory", "It has an exact inverse"]
    for part in parts:
        assert part in ended.out


def edited(folder: Path, edit: Callable[[dict[str, Any]], None]) -> None:
    """Write a sound model file with one thing changed."""
    model = PrandtlIshlinskii(p=[0.5, 0.3], r=[0.4, 1.1], p0=1.0, z0=[0.1, 0.1])
    model.save(folder / "model.json", describe(model))
    content = json.loads((folder / "model.json").read_text())
    edit(content)
    (folder / "model.json").write_text(json.dumps(content))


def change(**entries: object) -> Callable[[dict[str, Any]], None]:
    return lambda content: content["model"].update(entries)


BAD_MODELS: dict[str, tuple[Callable[[dict[str, Any]], None], str]] = {
    "missing entry": (lambda content: content["model"].pop("r"), "'r' is missing"),
    "unknown entry": (change(q=1), "unknown entry 'q'"),
    "NaN": (change(p=[0.5, math.nan]), "NaN"),
    "infinite": (change(p0=math.inf), "Infinity"),
    "wrong version": (lambda content: content.update(version=99), "version 99"),
    "lengths": (change(r=[0.4]), "p has 2 entries but r has 1"),
    "unsorted radii": (change(r=[1.1, 0.4]), "sort"),
    "negative radius": (change(r=[-0.4, 1.1]), "zero or positive"),
    "state of the wrong length": (change(z0=[0.1]), "z0 has 1 entries"),
    "unknown kind": (change(kind="oracle"), "oracle"),
    "no model": (lambda content: content.pop("model"), "'model' is missing"),
    "text for a number": (change(p0="one"), "p0"),
}


@pytest.mark.parametrize("name", BAD_MODELS)
@pytest.mark.parametrize("verb", ["simulate", "compensate", "info"])
def test_bad_model_files_are_refused(
    name: str, verb: str, refused: Callable[..., str], folder: Path
) -> None:
    edit, part = BAD_MODELS[name]
    edited(folder, edit)
    write_csv(folder / "ref.csv", "wanted", STAGE(U))
    arguments = {
        "simulate": simulate("ref.csv", "--input", 0),
        "compensate": compensate(),
        "info": ("info", "model.json"),
    }[verb]
    message = refused(*arguments)
    assert "model.json" in message
    assert part in message


@pytest.mark.parametrize("content", [b"", b"{", b"[1, 2]", b"\xff\xfe\x00", b'{"a": 1, "a": 2}'])
def test_files_that_are_no_model_are_refused(
    content: bytes, refused: Callable[..., str], folder: Path
) -> None:
    (folder / "model.json").write_bytes(content)
    assert "model.json" in refused("info", "model.json")


def test_a_model_file_that_is_not_there_is_refused(refused: Callable[..., str]) -> None:
    assert "nowhere.json" in refused("info", "nowhere.json")
