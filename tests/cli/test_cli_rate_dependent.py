"""hyst identify --family rdpi with several files, and hyst compensate with its methods."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command_runs import Run, describe, write_csv

import hyst
from hyst import RateDependentPrandtlIshlinskii
from reference.rate_dependent_plays import ACTUATOR, DT, EXAMPLE, output, rate, reference_signal

MODEL = RateDependentPrandtlIshlinskii(**EXAMPLE, dt=DT)


def write_records(folder: Path, frequencies: tuple[float, ...]) -> list[str]:
    names = []
    for number, f in enumerate(frequencies):
        u = 40.0 * np.sin(2.0 * np.pi * f * np.arange(round(max(3.0, f / 5.0) / f / DT)) * DT)
        widening = ACTUATOR["beta"] * rate(u, DT)
        y = output(ACTUATOR["p"], ACTUATOR["r"], ACTUATOR["p0"], u, widening)
        y = y + np.random.default_rng(number).normal(0.0, 0.1, u.size)
        names.append(f"at_{f:g}_hz.csv")
        write_csv(folder / names[-1], "u [V],y [um]", u, y)
    return names


def test_identify_takes_several_files(run: Run, folder: Path) -> None:
    names = write_records(folder, (10.0, 50.0, 100.0))
    ended = run(
        *("identify", *names, "--input", "u", "--output", "y", "--rate", 10000),
        *("--family", "rdpi", "--plays", 3, "--record-weights", "1,1.56,2", "-o", "found"),
    )
    assert ended.code == 0, ended.err
    model = hyst.load(folder / "found" / "model.json")
    assert model.dt == DT
    values = dict(zip(model.parameters().names, model.parameters().values, strict=True))
    # Three standard errors: 0.7 % of beta with this noise.
    beta = values["rate_dependent_prandtl_ishlinskii.beta"]
    assert beta == pytest.approx(ACTUATOR["beta"], rel=0.01)
    metrics = json.loads((folder / "found" / "metrics.json").read_text())
    assert metrics["family"] == "rdpi"
    assert "beta" in ended.out


def test_identify_says_what_one_frequency_hides(run: Run, folder: Path) -> None:
    names = write_records(folder, (50.0,))
    ended = run(
        *("identify", *names, "--input", "u", "--output", "y", "--rate", 10000),
        *("--family", "rdpi", "--plays", 3, "-o", "found"),
    )
    assert ended.code == 0, ended.err
    assert "beta and a linear lag cannot be told apart" in ended.out


@pytest.mark.parametrize(
    ("method", "largest"),
    [("explicit", 13.65), ("sample-exact", 1e-6), ("preview", 2.0), ("trajectory", 1.2)],
)
def test_compensate_by_every_method(run: Run, folder: Path, method: str, largest: float) -> None:
    MODEL.save(folder / "model.json", describe(MODEL, input_low=None, input_high=None, delay=0))
    y_ref = reference_signal(60.0)
    write_csv(folder / "ref.csv", "y [um]", y_ref)
    ended = run(
        *("compensate", "model.json", "ref.csv", "--column", "y", "--method", method),
        *("--rate", 10000, "-o", "command.csv"),
    )
    assert ended.code == 0, ended.err
    u = hyst.io.read_column(folder / "command.csv", "command")[0]
    y = output(EXAMPLE["p"], EXAMPLE["r"], EXAMPLE["p0"], u, EXAMPLE["beta"] * rate(u, DT))
    assert np.abs(y - y_ref).max() < largest
    assert "total variation" in ended.out
    if method == "sample-exact":
        assert "several solutions" in ended.out


def test_what_a_trajectory_is_polished_for(run: Run, folder: Path) -> None:
    MODEL.save(folder / "model.json", describe(MODEL, input_low=None, input_high=None, delay=0))
    y_ref = reference_signal(200.0)
    write_csv(folder / "ref.csv", "y [um]", y_ref)
    words = ("compensate", "model.json", "ref.csv", "--column", "y", "--rate", 10000)
    how = ("--objective", "largest", "--roughness", "0.2", "-o", "command.csv")
    ended = run(*words, "--method", "trajectory", *how)
    assert ended.code == 0, ended.err
    said = " ".join(ended.out.split())
    assert "polished for the largest error" in said
    assert "a second difference of 1 counting as an error of 0.2" in said
    u = hyst.io.read_column(folder / "command.csv", "command")[0]
    assert f"{np.abs(np.diff(u, 2)).max():.4g} at most" in said
    ended = run(*words, "--method", "preview", *how, "--force")
    assert ended.code == 2
    assert "--objective" in ended.err


def test_a_reference_of_another_sample_time_is_refused(run: Run, folder: Path) -> None:
    MODEL.save(folder / "model.json")
    write_csv(folder / "ref.csv", "y", reference_signal(60.0))
    for verb in (
        ("compensate", "model.json", "ref.csv", "--column", 0, "--method", "explicit"),
        ("simulate", "model.json", "ref.csv", "--input", 0),
    ):
        ended = run(*verb, "--rate", 1000, "-o", "command.csv")
        assert ended.code == 2
        assert "dt = 0.001 s, the model 0.0001 s" in ended.err
        assert not (folder / "command.csv").exists()


def test_the_exact_method_names_the_others(run: Run, folder: Path) -> None:
    MODEL.save(folder / "model.json")
    write_csv(folder / "ref.csv", "y", reference_signal(60.0))
    ended = run("compensate", "model.json", "ref.csv", "--column", 0, "-o", "command.csv")
    assert ended.code == 2
    message = " ".join(ended.err.split())
    assert "--method trajectory" in message
    for method in ("preview", "sample-exact", "explicit"):
        assert method in message
    assert "invert_trajectory" not in message


def test_help_lists_every_method(run: Run) -> None:
    ended = run("compensate", "--help")
    for method in ("exact", "noncausal", "explicit", "sample-exact", "preview", "trajectory"):
        assert method in ended.out


@pytest.mark.parametrize(
    ("header", "step", "message"),
    [
        ("t", 1e-4, None),
        ("Time [ms]", 0.1, None),
        ("t", 1e-3, "by its column 't' has dt = 0.001 s, the model 0.0001 s"),
        ("time [ms]", 1e-4, "has dt = 1e-07 s, the model 0.0001 s"),
        ("time [beats]", 1e-4, "give --rate"),
    ],
)
def test_a_time_column_of_the_reference_is_checked(
    run: Run, folder: Path, header: str, step: float, message: str | None
) -> None:
    MODEL.save(folder / "model.json")
    y_ref = reference_signal(60.0)
    write_csv(folder / "ref.csv", f"{header},y", step * np.arange(y_ref.size), y_ref)
    for verb in (
        ("compensate", "model.json", "ref.csv", "--column", "y", "--method", "explicit"),
        ("simulate", "model.json", "ref.csv", "--input", "y"),
    ):
        ended = run(*verb, "-o", "command.csv", "--force")
        if message is None:
            assert ended.code == 0, ended.err
            assert "is taken to have" not in ended.err + ended.out
        else:
            assert ended.code == 2
            assert message in " ".join(ended.err.split())


def test_uneven_time_of_the_reference_needs_a_rate(run: Run, folder: Path) -> None:
    MODEL.save(folder / "model.json")
    y_ref = reference_signal(60.0)
    t = DT * np.arange(y_ref.size)
    t[200:] += 3.0 * DT
    write_csv(folder / "ref.csv", "t,y", t, y_ref)
    words = ("compensate", "model.json", "ref.csv", "--column", "y", "--method", "explicit")
    ended = run(*words, "-o", "command.csv")
    assert ended.code == 2
    assert "give --rate" in " ".join(ended.err.split())
    assert run(*words, "--rate", 10000, "-o", "command.csv").code == 0
