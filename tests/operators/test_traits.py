"""Traits are worked out when they are asked for, and have degrees."""

from __future__ import annotations

import pytest

from hyst import Affine, DeadZone, GeneralizedPrandtlIshlinskii, Play, PrandtlIshlinskii
from hyst.operators import Degree, Traits


def traits(degree: Degree = Degree.EXACTLY, **asked: object) -> Traits:
    given = dict.fromkeys(
        ("memoryless", "return_point_memory", "congruent_loops", "monotone", "invertible"), True
    )
    return Traits(rate_independent=degree, **(given | asked))  # type: ignore[arg-type]


def test_a_trait_is_worked_out_once_and_not_before_it_is_asked_for() -> None:
    asked = []

    def invertible() -> bool:
        asked.append("invertible")
        return False

    held = traits(invertible=invertible)
    assert held.monotone
    assert asked == []
    assert not held.invertible
    assert not held.invertible
    assert asked == ["invertible"]
    assert held == traits(invertible=False)
    assert held != traits()


def test_composing_a_model_inverts_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_: DeadZone) -> DeadZone:
        raise AssertionError("a map was inverted to say whether it has memory")

    monkeypatch.setattr(DeadZone, "inverse", refuse)
    plays = PrandtlIshlinskii([0.5], [1.0], p0=1.0)
    model = GeneralizedPrandtlIshlinskii(DeadZone([1.0, 0.5], [0.0, 1.0]), plays)
    assert model.traits().rate_independent is Degree.EXACTLY


def test_a_composition_is_as_exact_as_its_least_exact_part(monkeypatch: pytest.MonkeyPatch) -> None:
    assert (Affine(2.0) @ Play(1.0)).traits().rate_independent is Degree.EXACTLY
    monkeypatch.setattr(Play, "traits", lambda _: traits(Degree.TO_ROUNDING))
    assert (Affine(2.0) @ Play(1.0)).traits().rate_independent is Degree.TO_ROUNDING
    by_direction = DeadZone([1.0], [0.5], "by-direction")
    assert (by_direction @ Play(1.0)).traits().rate_independent is Degree.NO


def test_degrees_are_true_unless_they_are_none() -> None:
    assert Degree.EXACTLY
    assert Degree.TO_ROUNDING
    assert not Degree.NO
