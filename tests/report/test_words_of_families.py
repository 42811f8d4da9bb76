"""What the report says of families whose inverse is no operator, or that have no plays."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import hyst
from hyst.identification import Identified
from hyst.identification.families.hammerstein.told.words import words_behind
from hyst.report import in_short, write_report
from hyst.report.words import command_method, lag_sentence, words_of

PLAYS = hyst.PrandtlIshlinskii([0.5], [1.0], p0=1.0)
LATE = hyst.LinearDynamics.from_transfer_function([0.5], [1.0, -0.5], dt=1e-3)


@pytest.mark.usefixtures("undrawn")
def test_a_rate_dependent_model_is_named_explained_and_led_on(tmp_path: Path) -> None:
    stage = hyst.RateDependentPrandtlIshlinskii([0.4], [2.0], 2e-3, 1e-3, 1.0)
    records = []
    for f in (1.0, 10.0):
        u = 10.0 * np.sin(2.0 * np.pi * f * np.arange(round(3.0 / f / 1e-3)) * 1e-3)
        noise = np.random.default_rng(0).normal(0.0, 0.01, u.size)
        records.append(hyst.Record(u, stage(u) + noise, 1e-3))
    found = hyst.identify(records, family="rdpi", plays=1)
    write_report(found, records, (), tmp_path)
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "The model is a rate-dependent Prandtl-Ishlinskii model with 1 play." in page
    assert "|du/dt|" in page
    assert "(beta) is the growth of their radii" in page
    assert "--method trajectory -o command.csv" in page


@pytest.mark.usefixtures("undrawn")
def test_a_hammerstein_model_without_plays_explains_dynamics_and_no_plays(tmp_path: Path) -> None:
    u = hyst.signals.multisine(1e-3, 2000, amplitude=1.0, periods=2).u
    dynamics = hyst.LinearDynamics.from_zeros_poles_gain([], [0.5], 0.5, 1e-3)
    record = hyst.Record(u, dynamics(u) + 1e-3 * np.random.default_rng(0).normal(size=u.size), 1e-3)
    found = hyst.identify(record, family="hammerstein", hysteresis="linear", fir_order=20)
    write_report(found, record, (), tmp_path)
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "The model is a Hammerstein model (hysteresis, then linear dynamics)." in page
    assert "v(t) = gain" in page
    assert "y(t) = G[v](t)" in page
    assert "is a play" not in page
    method = "" if found.model.is_invertible() else " --method noncausal"
    assert f"--column 0{method} -o command.csv" in page


def result(model: hyst.Operator, family: str) -> Identified:
    """A result of another model and family than the line it was found as."""
    u = np.sin(np.linspace(0.0, 20.0, 200))
    found = hyst.identify(hyst.Record(u, 2.0 * u, 1e-3), family="linear", delay=0)
    return replace(found, model=model, family=family)


def test_the_sign_is_that_of_the_output() -> None:
    rising, falling = (words_of(result(hyst.Affine(k) @ PLAYS, "pi")) for k in (1.0, -1.0))
    assert rising.equations[0] == "y(t) = P[u](t) + offset"
    assert falling.equations[0] == "y(t) = -P[u](t) + offset"


@pytest.mark.parametrize(
    ("family", "name"), [("of tomorrow", "of tomorrow model"), ("", "model of the given shape")]
)
def test_a_family_nobody_knows_is_told_by_what_it_does(family: str, name: str) -> None:
    found = result(PLAYS, family)
    assert words_of(found).full_name == name
    u = np.sin(np.linspace(0.0, 20.0, 200))
    assert in_short(found, (hyst.Record(u, u, 1e-3),))[0] == f"The model is a {name} with 1 play."
    assert command_method(found) == "exact"


def test_dynamics_call_the_output_of_the_hysteresis_v() -> None:
    words = words_behind(hyst.families["pi"].words)
    assert words.equations[0] == "v(t) = {sign}P[u](t) + offset"
    assert words.equations[-1] == "y(t) = G[v](t)"
    assert "is a play" in words.explanations[0]
    assert words.explanations[-1].startswith("v is the output of the hysteresis")


def test_the_method_is_one_that_the_model_has() -> None:
    at_rate = hyst.RateDependentPrandtlIshlinskii([0.4], [2.0], 2e-3, 1e-3, 1.0)
    at_rest = hyst.RateDependentPrandtlIshlinskii([0.4], [2.0], 0.0, 1e-3, 1.0)
    assert command_method(result(at_rate, "rdpi")) == "trajectory"
    assert command_method(result(at_rest, "rdpi")) == "exact"
    # What the family would take suits no model that has it not.
    assert command_method(result(LATE @ PLAYS, "pi")) == "noncausal"
    assert command_method(result(hyst.Play(1.0), "pi")) == ""


def test_a_lag_is_told_as_part_of_the_model_where_it_is() -> None:
    late = hyst.LinearDynamics(LATE.A, LATE.B, LATE.C, LATE.D, 1e-3, delay=3)
    assert lag_sentence(result(late @ PLAYS, "")) == (
        "The dynamics contain a delay of 3 samples (0.003 s)."
    )
    assert "no delay beside their own lag" in lag_sentence(result(LATE @ PLAYS, ""))
    # The delay was given, so the records were not asked for it.
    assert "No delay is taken" in lag_sentence(result(PLAYS, ""))
