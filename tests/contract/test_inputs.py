"""Whatever holds real numbers is taken, in whatever layout; the rest is refused by name."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hyst import InputError, Operator
from reference.examples import EXAMPLES
from reference.random_operators import every_operator, signals

each_example = pytest.mark.parametrize("operator", EXAMPLES.values(), ids=list(EXAMPLES))


@every_operator
@given(data=st.data())
def test_layout_does_not_matter(operators: st.SearchStrategy, data: st.DataObject) -> None:
    operator, u = data.draw(operators), data.draw(signals())
    y = operator(u)
    sparse = np.full(3 * u.size, np.nan)
    sparse[::3] = u
    frozen = u.copy()
    frozen.flags.writeable = False
    layouts = [sparse[::3], u[::-1].copy()[::-1], frozen, u.astype(">f8"), u.tolist(), tuple(u)]
    for layout in layouts:
        assert operator(layout).tobytes() == y.tobytes()
    batch = np.stack([u, -u, u + 1.0])
    for layout in (
        np.asfortranarray(batch),
        np.stack([batch] * 2, axis=2)[:, :, 0],
        batch.tolist(),
    ):
        assert operator(layout).tobytes() == operator(batch).tobytes()


@each_example
@pytest.mark.parametrize("dtype", [np.int8, np.uint16, np.int64, np.float16, np.float32, bool])
def test_other_number_types_are_taken_at_their_value(operator: Operator, dtype: type) -> None:
    u = np.array([0, 3, 1, 5, 2, 0]).astype(dtype)
    assert operator(u).tobytes() == operator([float(value) for value in u]).tobytes()


@each_example
def test_what_is_no_signal_is_refused(operator: Operator) -> None:
    refused = {
        r"u\[2\] is nan": [0.0, 1.0, np.nan, np.nan],
        r"u\[1\] is inf": [0.0, np.inf],
        r"u\[0\] is -inf": [-np.inf],
        r"u\[\(1, 0\)\] is nan": [[0.0, 1.0], [np.nan, 2.0]],
        r"u is empty": [],
        r"u is empty.*": np.empty((3, 0)),
        r"u has 0 dimensions": 1.0,
        r"u has 3 dimensions": np.zeros((2, 2, 2)),
        r"u has dtype complex128": [1.0 + 0.0j],
        r"u has dtype <U1": ["1"],
        r"u has dtype object": [1.0, None],
        r"u has dtype object.*": [10**400],
        r"u has dtype datetime64": np.array(["2020-01-01"], dtype="datetime64[D]"),
        r"u is not a rectangular array": [[1.0, 2.0], [3.0]],
        r"u has masked entries": np.ma.masked_array([1.0, 2.0], mask=[False, True]),
    }
    for message, u in refused.items():
        for use in (operator, operator.run, operator.jacobian):
            with pytest.raises(InputError, match=message) as refusal:
                use(u)
            assert "\n" not in str(refusal.value)


@each_example
def test_the_jacobian_takes_one_record(operator: Operator) -> None:
    with pytest.raises(InputError, match=r"u has shape \(2, 3\); the Jacobian takes one record"):
        operator.jacobian(np.zeros((2, 3)))
