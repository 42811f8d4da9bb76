"""No operator escapes the contracts: every registered kind has examples and a random source."""

from __future__ import annotations

import pytest

import hyst.models  # registers its kinds
from hyst.operators.registry import registered
from hyst.operators.traits import Degree
from reference.examples import EXAMPLES
from reference.random_operators import RANDOM


def test_every_kind_has_an_example() -> None:
    assert {each.kind for each in EXAMPLES.values()} == set(registered())


def test_every_kind_has_a_random_source() -> None:
    assert set(RANDOM) - {"inverse"} == set(registered())


@pytest.mark.parametrize("trait", hyst.Play(1.0).traits().held())
def test_every_trait_is_declared_true_and_false(trait: str) -> None:
    declared = {bool(getattr(each.traits(), trait)) for each in EXAMPLES.values()}
    assert declared == {True, False}


# Theory: memoryless, rate independent (R exactly, r to rounding), return-point memory, congruent
# loops, monotone, invertible.
# A trait that is not declared is not tested, so what must be declared is written down here.
DECLARED = {
    "play": "-RMCO-",
    "stop": "-RMCO-",
    "affine": "LRMCOI",
    "affine falling": "LRMC-I",
    "affine flat": "LRMCO-",
    "dead-zone odd": "LRMCOI",
    "dead-zone falling": "LRMC-I",
    "dead-zone tent": "LRMC--",
    "dead-zone by direction": "------",
    "pi": "-RMCOI",
    "pi wavy": "-RMCOI",
    "pi without linear part": "-RMCO-",
    "pi without plays": "LRMCOI",
    "pi falling": "-RMC--",
    "gpi": "-RMCOI",
    "gpi behind a tent": "-R-C--",
    "gpi without memory": "LRMCOI",
    "mpi": "-RM-OI",
    "mpi onto a tent": "-RM---",
    "composition of two banks": "-RMCOI",
    "gpi after pi": "-RM-OI",
    "inverse of gpi": "-RM-OI",
    "inverse of mpi": "-RMCOI",
    "butterfly": "-RM---",
    "butterfly of friction": "-R----",
    "coleman-hodgdon": "-R--OI",
    "coleman-hodgdon saturating": "-R--OI",
    "coleman-hodgdon that falls": "-R----",
    "inverse coleman-hodgdon": "-R--OI",
    "bouc-wen": "-R--OI",
    "bouc-wen sharp": "-R--OI",
    "bouc-wen without inverse": "-R----",
    "inverse bouc-wen": "-R--OI",
    "degrading bouc-wen": "-R--OI",
    "degrading bouc-wen that pinches": "-R--OI",
    "degrading bouc-wen without inverse": "-R----",
    "inverse degrading bouc-wen": "-R--OI",
    "dahl": "-R--OI",
    "inverse dahl": "-R--OI",
    "maxwell-slip": "-RMCOI",
    "maxwell-slip that slides": "-RMCO-",
    "generalized maxwell-slip": "------",
    "lugre": "------",
    "lugre without rate": "-r--O-",
    "masing that stiffens": "-RMCOI",
    "masing that saturates": "-RMCOI",
    "inverse of a masing that softens": "-RMCOI",
    "iwan": "-RMCOI",
    "iwan without a spring": "-RMCO-",
    "inverse iwan": "-RMCOI",
    "two envelopes": "-rMCOI",
    "two envelopes without linear part": "-rMCO-",
    "inverse of two envelopes": "-rM-OI",
    "rate-dependent preview": "------",
    "rate-dependent preview held back": "------",
    "creep": "-----I",
    "creep that goes back": "-----I",
    "inverse creep": "-----I",
    "creeping plays": "-----I",
    "inverse of creeping plays": "-----I",
    "lag": "-----I",
    "lag of a held signal": "-----I",
    "inverse lag": "-----I",
    "delay": "------",
    "delay of whole samples": "------",
    "delay of nothing": "LRMCOI",
    "inverse delay": "-----I",
    "delay taken back by preview": "------",
    "preisach": "-RMCOI",
    "preisach of relays alone": "-RMCO-",
    "preisach from saturation": "-RMCOI",
    "preisach of ridges": "-RMCOI",
    "inverse preisach": "-RM-OI",
    "jiles-atherton": "-R--OI",
    "jiles-atherton 1992": "-R--OI",
    "jiles-atherton 1986": "-R--OI",
    "jiles-atherton of B": "-R--OI",
    "jiles-atherton with losses": "-----I",
    "jiles-atherton of B with eddy currents": "-----I",
    "inverse jiles-atherton with eddy currents": "-----I",
    "inverse jiles-atherton": "-R--OI",
    "inverse jiles-atherton of B": "-R--OI",
}


@pytest.mark.parametrize("name", DECLARED)
def test_what_holds_is_declared(name: str) -> None:
    held = EXAMPLES[name].traits().held()
    declared = "".join(
        "r" if value is Degree.TO_ROUNDING else letter if value else "-"
        for letter, value in zip("LRMCOI", held.values(), strict=True)
    )
    assert declared == DECLARED[name]
