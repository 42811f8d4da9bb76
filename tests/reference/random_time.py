"""Random operators that answer to time alone: creep, lags and delays."""

from __future__ import annotations

from hypothesis import strategies as st

from hyst import Operator
from hyst.models import Creep, Delay, Lag
from hyst.models.previewed_delay import PreviewedDelay
from reference.random_numbers import numbers


@st.composite
def creeps(draw: st.DrawFn, most: float) -> Creep:
    times = draw(st.lists(st.floats(1e-3, 1e3), max_size=4))
    weights = [draw(numbers(-0.5, most)) for _ in times]
    return Creep(weights, times, 0.01, rest=draw(numbers(-2.0, 2.0)))


first_order = st.builds(
    Lag, st.floats(1e-5, 0.2), st.just(0.01), st.sampled_from(("first", "zero"))
)

WITH_TIME: dict[str, st.SearchStrategy[Operator]] = {
    "creep": creeps(1.0),
    "inverse-creep": creeps(0.5)
    .filter(lambda creep: creep.is_invertible())
    .map(lambda creep: creep.inverse()),
    "delay": st.builds(Delay, numbers(0.0, 5.0), st.sampled_from((0.01, 1.0))),
    "inverse-delay": st.builds(Delay, st.floats(0.0, 0.24), st.just(0.01)).map(
        lambda delay: delay.inverse()
    ),
    "previewed-delay": st.builds(PreviewedDelay, st.floats(0.55, 1.0), st.integers(0, 6)),
    "lag": first_order,
    "inverse-lag": first_order.map(lambda lag: lag.inverse()),
}
