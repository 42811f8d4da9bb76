"""Model files that something went wrong with: an InputError of one sentence, or an operator."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hyst import InputError, Operator, load
from hyst.operators import operator_from_dict
from reference.examples import EXAMPLES

MODELS = [each.to_dict() for each in EXAMPLES.values()]
MANY = 4 * settings().max_examples
FRAME = {"format": "hyst model", "version": 1, "description": {"dt": 0.1, "delay": 1}}


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("fuzz") / "model.json"


def assert_refused_or_an_operator(file: Path) -> None:
    try:
        operator = load(file)
    except InputError as error:
        assert "\n" not in str(error)  # noqa: PT017  a refusal or an operator, both are right
        return
    assert isinstance(operator, Operator)
    assert np.isfinite(operator.parameters().values).all()
    operator.traits()
    operator([0.0, 1.0, -1.0])
    assert operator_from_dict(operator.to_dict()) == operator


values = st.recursive(
    st.sampled_from(
        [None, True, False, 0, 1, -1, 0.0, -0.0, 1.0, -2.5, 5e-324, 1e308, "", "1", "play"]
    )
    | st.integers()
    | st.floats()
    | st.text(max_size=5)
    | st.sampled_from(MODELS).map(copy.deepcopy),
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(
            st.sampled_from(["kind", "p", "r", "p0", "z0", "stages", "pi", "envelope", "gain"])
            | st.text(max_size=3),
            inner,
            max_size=4,
        )
    ),
    max_leaves=8,
)


def nodes(content: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Paths of all entries of lists and objects."""
    if isinstance(content, dict):
        children: Any = content.items()
    elif isinstance(content, list):
        children = enumerate(content)
    else:
        return []
    return [found for key, each in children for found in [(*path, key), *nodes(each, (*path, key))]]


@st.composite
def damaged(draw: st.DrawFn) -> Any:
    """A model file with a few entries replaced, taken away, doubled or renamed."""
    content = copy.deepcopy({**FRAME, "model": draw(st.sampled_from(MODELS))})
    for _ in range(draw(st.integers(1, 3))):
        path = draw(st.sampled_from(nodes(content)))
        parent = content
        for key in path[:-1]:
            parent = parent[key]
        match draw(st.sampled_from(["replace", "remove", "rename", "nest"])):
            case "replace":
                parent[path[-1]] = draw(values)
            case "remove":
                del parent[path[-1]]
            case "rename" if isinstance(parent, dict):
                parent[draw(st.text(max_size=4))] = parent.pop(path[-1])
            case _:
                parent[path[-1]] = [parent[path[-1]]]
        if not nodes(content):
            break
    return content


@settings(max_examples=MANY)
@given(content=damaged())
def test_damaged_entries(content: Any, file: Path) -> None:
    file.write_text(json.dumps(content), encoding="utf-8")  # NaN and infinities included
    assert_refused_or_an_operator(file)


@settings(max_examples=MANY)
@given(data=st.data())
def test_damaged_bytes(data: st.DataObject, file: Path) -> None:
    content = bytearray(json.dumps({**FRAME, "model": data.draw(st.sampled_from(MODELS))}).encode())
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(content)))
        removed = data.draw(st.integers(0, 4))
        content[at : at + removed] = data.draw(
            st.binary(max_size=3) | st.sampled_from([b"[", b"{", b"]", b"}", b'"', b",", b"9e9"])
        )
    file.write_bytes(content)
    assert_refused_or_an_operator(file)


@given(content=st.binary(max_size=60))
def test_any_bytes(content: bytes, file: Path) -> None:
    file.write_bytes(content)
    assert_refused_or_an_operator(file)


@settings(max_examples=MANY)
@given(model=values)
def test_any_model(model: Any, file: Path) -> None:
    file.write_text(json.dumps({**FRAME, "model": model}), encoding="utf-8")
    assert_refused_or_an_operator(file)
