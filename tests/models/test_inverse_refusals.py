"""What cannot be inverted says so, and names the weight, the piece or the memory to blame."""

from __future__ import annotations

import contextlib

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from hyst import (
    Affine,
    DeadZone,
    GeneralizedPrandtlIshlinskii,
    ModifiedPrandtlIshlinskii,
    NotInvertibleError,
    Operator,
    Play,
    PrandtlIshlinskii,
    Stop,
)
from hyst.models import SecondOrderSections
from reference.random_operators import RANDOM, numbers

BANK = PrandtlIshlinskii([0.5], [1.0], p0=0.5)
ZONE = DeadZone([1.0], [0.0])

REFUSED: dict[str, tuple[Operator, str]] = {
    "p0 = 0": (PrandtlIshlinskii([1.0], [1.0]), r"p0 is 0: without a positive linear part"),
    "p0 < 0": (PrandtlIshlinskii([1.0], [1.0], p0=-0.5), r"p0 is -0\.5: without"),
    "p0 = 0, no plays": (PrandtlIshlinskii([], []), r"p0 is 0"),
    "a linear part of two that cancel": (
        PrandtlIshlinskii([-0.5, 1.0], [0.0, 1.0], p0=0.5),
        r"the linear part p0 \+ p\[1\] \+ \.\. \+ p\[1\] is 0: without",
    ),
    "falling from the second play on": (
        PrandtlIshlinskii([0.2, -0.5, 0.9], [1.0, 2.0, 3.0], p0=0.25),
        r"p0 \+ p\[1\] \+ \.\. \+ p\[2\] is -0\.05: beyond threshold r\[2\] = 2 .*"
        r"p\[2\] = -0\.5 is too small",
    ),
    "flat beyond the last play": (
        PrandtlIshlinskii([0.25, -0.5], [1.0, 2.0], p0=0.25),
        r"p\[2\] is 0: beyond threshold r\[2\] = 2",
    ),
    "flat beyond tied plays": (
        PrandtlIshlinskii([-0.125, -0.125, 1.0], [1.0, 1.0, 2.0], p0=0.25),
        r"p\[2\] is 0: beyond threshold r\[2\] = 1",
    ),
    # 0.1 + 0.2 - 0.3 is 5.6e-17 in doubles, and zero to whoever wrote it.
    "flat but for rounding": (
        PrandtlIshlinskii([0.2, -0.3], [1.0, 2.0], p0=0.1),
        r"p\[2\] is .*: beyond threshold r\[2\] = 2",
    ),
    "impossible memory": (
        PrandtlIshlinskii([0.5, 0.5], [1.0, 2.0], p0=1.0, z0=[0.0, 1.5]),
        r"z0 is no memory that an input could have left .* give an admissible z0",
    ),
    "tied plays at odds": (
        PrandtlIshlinskii([0.5, 0.5], [1.0, 1.0], p0=1.0, z0=[0.0, 1e-9]),
        r"z0 is no memory",
    ),
    "overflow of 1/p0": (PrandtlIshlinskii([1.0], [1.0], p0=1e-310), r"beyond the range of double"),
    "overflow of the sums": (
        PrandtlIshlinskii([1e308, 1e308], [1.0, 2.0], p0=1e308),
        r"beyond the range of double",
    ),
    "overflow of a threshold": (
        PrandtlIshlinskii([1.0], [1e200], p0=1e200),
        r"beyond the range of double",
    ),
    "play": (Play(1.0), r"a play has no linear part \(p0 = 0\)"),
    "stop": (Stop(1.0), r"a stop is flat on its limit"),
    "gain 0": (Affine(0.0, 1.0), r"gain is 0: every input gives the same output"),
    "gain next to 0": (Affine(1e-310), r"beyond the range of double"),
    "offset over a small gain": (Affine(1e-200, 1e200), r"beyond the range of double"),
    "map by direction": (
        DeadZone([1.0], [0.0], "by-direction"),
        r"by direction .* jumps and has no inverse; use variant='two-sided'",
    ),
    "map without linear part": (
        DeadZone([1.0, 1.0], [1.0, -1.0]),
        r"flat around 0 .* give it a linear part",
    ),
    "map whose linear parts cancel": (
        DeadZone([0.1, 0.2, -0.3, 1.0], [0.0, 0.0, 0.0, 1.0]),
        r"flat around 0",
    ),
    "map flat beyond": (
        DeadZone([0.5, -0.5], [0.0, 2.0]),
        r"beyond threshold 2 its slope .* is 0, around 0 it is 0\.5",
    ),
    "map reversed to the left": (
        DeadZone([0.5, 0.25, -0.25, -1.0], [0.0, -1.0, 3.0, -2.0]),
        r"beyond threshold -2 its slope .* is -0\.25, around 0 it is 0\.5",
    ),
    "falling map that turns": (
        DeadZone([-0.5, 1.0], [0.0, 2.0]),
        r"beyond threshold 2 its slope .* is 0\.5, around 0 it is -0\.5",
    ),
    "map flat but for rounding": (
        DeadZone([0.1, 0.2, -0.3], [0.0, 1.0, 2.0]),
        r"beyond threshold 2 its slope",
    ),
    "map whose image of a threshold is 0": (
        DeadZone([1e-200, 1.0], [0.0, 1e-200]),
        r"beyond the range of double",
    ),
    "flat envelope": (
        GeneralizedPrandtlIshlinskii(DeadZone([1.0, -1.0], [0.0, 1.0]), BANK),
        r"beyond threshold 1 its slope",
    ),
    "bank in a generalized model": (
        GeneralizedPrandtlIshlinskii(ZONE, PrandtlIshlinskii([1.0], [1.0])),
        r"p0 is 0",
    ),
    "flat output map": (
        ModifiedPrandtlIshlinskii(BANK, DeadZone([1.0], [1.0])),
        r"flat around 0",
    ),
    "one stage of many": (Affine(2.0) @ BANK @ Stop(1.0) @ BANK, r"a stop is flat"),
}


@pytest.mark.parametrize(("operator", "message"), REFUSED.values(), ids=list(REFUSED))
def test_refusals(operator: Operator, message: str) -> None:
    with pytest.raises(NotInvertibleError, match=message) as refusal:
        operator.inverse()
    assert "\n" not in str(refusal.value)
    assert not operator.is_invertible()
    assert not operator.traits().invertible


# Two records that an operator without inverse cannot tell apart.
INDISTINGUISHABLE: dict[str, tuple[Operator, list[float], list[float]]] = {
    "play": (Play(1.0), [0.25], [0.75]),
    "stop": (Stop(1.0), [2.0], [3.0]),
    "gain 0": (Affine(0.0), [1.0], [2.0]),
    "map by direction": (DeadZone([1.0], [0.0], "by-direction"), [3.0, 2.0], [3.0, 1.0]),
    "map without linear part": (DeadZone([1.0], [1.0]), [0.25], [0.75]),
    "map that turns": (DeadZone([1.0, -2.0], [0.0, 1.0]), [0.5], [1.5]),
    "no linear part": (PrandtlIshlinskii([1.0], [1.0]), [0.25], [0.75]),
    "cumulative weight below 0": (PrandtlIshlinskii([-2.0], [1.0], p0=1.0), [0.5], [1.5]),
    "cumulative weight of 0": (PrandtlIshlinskii([-1.0], [1.0], p0=1.0), [1.5], [2.5]),
    "impossible memory": (
        # Slopes 1, 2, 0.5 while the plays move in order. At 8 they are at 9 and 6: up by 1 the
        # second moves alone, 1 - 1.5, down by 0.25 the first, 0.25 (1 + 1).
        PrandtlIshlinskii([1.0, -1.5], [1.0, 2.0], p0=1.0, z0=[9.0, 0.0]),
        [8.0, 9.0],
        [8.0, 7.75],
    ),
}


@pytest.mark.parametrize(
    ("operator", "u", "v"), INDISTINGUISHABLE.values(), ids=list(INDISTINGUISHABLE)
)
def test_refused_operators_do_lose_their_input(
    operator: Operator, u: list[float], v: list[float]
) -> None:
    assert u != v
    assert not operator.traits().invertible
    assert operator(u).tolist() == operator(v).tolist()


@given(
    p0=st.floats(0.1, 2.0),
    p=st.lists(st.floats(-2.0, 2.0), min_size=1, max_size=8),
)
def test_the_first_failing_weight_is_the_one_named(p0: float, p: list[float]) -> None:
    model = PrandtlIshlinskii(p, np.arange(1.0, len(p) + 1.0), p0)
    sums = [p0 + sum(p[:j]) for j in range(1, len(p) + 1)]
    failing = [j for j, total in enumerate(sums, start=1) if total <= 0.0]
    assume(all(abs(total) > 1e-12 for total in sums))  # either verdict is right nearer to 0
    assert model.traits().invertible == (not failing)
    if failing:
        with pytest.raises(NotInvertibleError, match=rf"\.\. \+ p\[{failing[0]}\] is -"):
            model.inverse()


@pytest.mark.parametrize("kind", sorted(RANDOM))
@given(data=st.data())
def test_any_operator_is_inverted_or_refused(kind: str, data: st.DataObject) -> None:
    operator = data.draw(RANDOM[kind])
    if operator.traits().invertible:
        assert isinstance(operator.inverse(), Operator)
    else:
        with pytest.raises(NotInvertibleError):
            operator.inverse()


doubles = st.floats(allow_nan=False, allow_infinity=False)


@given(
    p0=doubles,
    pairs=st.lists(st.tuples(doubles, doubles.map(abs), doubles), max_size=5),
)
def test_no_doubles_make_anything_but_a_clean_refusal(
    p0: float, pairs: list[tuple[float, float, float]]
) -> None:
    pairs = sorted(pairs, key=lambda pair: pair[1])
    p, r, z0 = ([pair[i] for pair in pairs] for i in range(3))
    operators = [
        PrandtlIshlinskii(p, r, p0, z0),
        PrandtlIshlinskii(p, r, p0),
        Affine(p0, sum(p[:1])),
    ]
    if pairs:
        operators += [DeadZone([p0, *p], [0.0, *r]), DeadZone([p0, *p], [0.0, *(-x for x in r)])]
    for operator in operators:
        operator.traits()
        operator.lipschitz_constant()
        # Whatever else is raised, a warning included, is a failure.
        with contextlib.suppress(NotInvertibleError):
            assert np.isfinite(operator.inverse().parameters().values).all()


@given(excess=numbers(0.25, 5.0), r=numbers(0.25, 5.0))
def test_memory_is_admissible_up_to_its_edge(excess: float, r: float) -> None:
    def bank(second: float) -> PrandtlIshlinskii:
        return PrandtlIshlinskii([0.5, 0.5], [1.0, 1.0 + r], p0=1.0, z0=[2.0, second])

    assert bank(2.0 + r).traits().invertible
    assert bank(2.0 - r).traits().invertible
    assert not bank(2.0 + r + excess).traits().invertible
    assert not bank(2.0 - r - excess).traits().invertible


def test_a_section_whose_numerator_hardly_answers_at_once_is_refused_quietly() -> None:
    # Zeros at +-0.5i times 2e156: far outside; their quotients overflow.
    tiny = SecondOrderSections([2.2e-313, 0.0, 0.25, 0.0, 0.0], 0.01)
    with pytest.raises(NotInvertibleError, match="section 1 has the numerator"):
        tiny.inverse()
    # (z - 0.5)(z + 0.9) and (z - 0.5)(z + 1.1).
    assert SecondOrderSections([1.0, 0.4, -0.45, 0.0, 0.0], 0.01).is_invertible()
    assert not SecondOrderSections([1.0, 0.6, -0.55, 0.0, 0.0], 0.01).is_invertible()
