"""Operators survive dictionaries, JSON, files, copies and other processes, to the last bit."""

from __future__ import annotations

import copy
import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hyst import Affine, Composition, DeadZone, Operator, Play, PrandtlIshlinskii, Stop, load
from hyst.operators import operator_from_dict
from reference.examples import EXAMPLES
from reference.random_operators import every_operator, signals

each_example = pytest.mark.parametrize("operator", EXAMPLES.values(), ids=list(EXAMPLES))


def bits(operator: Operator) -> bytes:
    return operator.parameters().values.tobytes() + operator.initial_state().tobytes()


def through_json(operator: Operator) -> Operator:
    return operator_from_dict(json.loads(json.dumps(operator.to_dict())))


@every_operator
@given(data=st.data())
def test_all_ways_round_are_exact(operators: st.SearchStrategy, data: st.DataObject) -> None:
    operator, u = data.draw(operators), data.draw(signals())
    ways = (
        through_json,
        copy.copy,
        copy.deepcopy,
        lambda each: pickle.loads(pickle.dumps(each)),
    )
    for way in ways:
        again = way(operator)
        assert again == operator
        assert hash(again) == hash(operator)
        assert type(again) is type(operator)
        assert bits(again) == bits(operator)
        assert again(u).tobytes() == operator(u).tobytes()
        assert again.traits() == operator.traits()


def only_plain(value: Any) -> bool:
    if isinstance(value, dict):
        return all(type(key) is str and only_plain(each) for key, each in value.items())
    if isinstance(value, list):
        return all(map(only_plain, value))
    return type(value) in (float, int, str)


@each_example
def test_dictionaries_are_plain(operator: Operator) -> None:
    model = operator.to_dict()
    assert only_plain(model)
    assert model["kind"] == operator.kind


@each_example
def test_files_give_the_operator_back(operator: Operator, tmp_path: Path) -> None:
    operator.save(tmp_path / "model.json")
    again = load(tmp_path / "model.json")
    assert again == operator
    assert bits(again) == bits(operator)
    assert list(tmp_path.iterdir()) == [tmp_path / "model.json"]


doubles = st.floats(allow_nan=False, allow_infinity=False)  # subnormal, -0.0 and 1.8e308 included
sizes = doubles.map(abs)


@st.composite
def operators_of_any_doubles(draw: st.DrawFn) -> Operator:
    n = draw(st.integers(0, 4))
    many = st.lists(doubles, min_size=n, max_size=n)
    some = st.lists(st.tuples(doubles, doubles), min_size=1, max_size=4)
    r = sorted(draw(st.lists(sizes, min_size=n, max_size=n)))
    operators = [
        Affine(draw(doubles), draw(doubles)),
        Play(draw(sizes), draw(doubles)),
        Stop(draw(sizes), draw(doubles)),
        DeadZone(*zip(*draw(some), strict=True)),
        PrandtlIshlinskii(draw(many), r, draw(doubles), draw(many)),
    ]
    return Composition(operators)


@pytest.fixture(scope="module")
def scratch(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("models") / "model.json"


@given(operator=operators_of_any_doubles())
def test_a_file_keeps_every_double(operator: Operator, scratch: Path) -> None:
    operator.save(scratch)
    again = load(scratch)
    assert bits(again) == bits(operator)
    assert again == operator


@pytest.mark.parametrize(
    "value", [5e-324, 4.9e-21, 2.2250738585072014e-308, 0.1, 1.0 / 3.0, 1e22, 1e300, 2.0**53 + 2.0]
)
def test_doubles_that_short_formats_lose(value: float, scratch: Path) -> None:
    PrandtlIshlinskii([value, -value], [value, 2.0 * value], p0=value).save(scratch)
    model = load(scratch)
    assert isinstance(model, PrandtlIshlinskii)
    assert [model.p0, *model.p, *model.r] == [value, value, -value, value, 2.0 * value]


def test_equal_operators_have_equal_hashes() -> None:
    assert Affine(0.0) == Affine(-0.0)
    assert hash(Affine(0.0)) == hash(Affine(-0.0))
    assert Play(1.0) != Play(1.0, z0=2.0)
    assert Play(1.0) != Stop(1.0)
    assert DeadZone([1.0], [1.0]) != DeadZone([1.0], [1.0], "by-direction")
    assert Play(1.0) != 1.0


def test_grouping_makes_no_difference() -> None:
    f, g, h = Affine(2.0), Play(1.0), Stop(3.0)
    assert (f @ g) @ h == f @ (g @ h) == Composition((h, g, f))
    assert Composition((Composition((h,)), g, f)) == f @ g @ h


@each_example
def test_operators_are_frozen(operator: Operator) -> None:
    with pytest.raises(AttributeError):
        operator.kind = "another"
    for value in vars(operator).values():
        if isinstance(value, np.ndarray):
            assert not value.flags.writeable
