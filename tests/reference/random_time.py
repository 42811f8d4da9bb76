"""Random operators that answer to time: creep, lags, delays, and what plans ahead."""

from __future__ import annotations

from hypothesis import strategies as st

from hyst import Operator
from hyst.models import Creep, CreepingPlays, Delay, Lag, RateCurve, RateDependentPreview
from hyst.models import RateDependentPrandtlIshlinskii as RateDependentPlays
from hyst.models.previewed_delay import PreviewedDelay
from reference.random_numbers import numbers


@st.composite
def creeps(draw: st.DrawFn, most: float) -> Creep:
    times = draw(st.lists(st.floats(1e-3, 1e3), max_size=4))
    weights = [draw(numbers(-0.5, most)) for _ in times]
    return Creep(weights, times, 0.01, rest=draw(numbers(-2.0, 2.0)))


@st.composite
def previews(draw: st.DrawFn) -> RateDependentPreview:
    r = sorted(draw(st.lists(numbers(0.0, 5.0), max_size=4)))
    p = draw(st.lists(numbers(0.0, 1.0), min_size=len(r), max_size=len(r)))
    powers = draw(st.lists(numbers(0.0, 0.25), max_size=2))
    knees = draw(st.lists(numbers(0.25, 8.0), max_size=1))
    curve = RateCurve(draw(numbers(0.0, 2.0)), powers, [0.5] * len(knees), knees)
    plays = RateDependentPlays(
        p, r, curve, draw(st.sampled_from((0.5, 2.0))), draw(numbers(0.3, 2))
    )
    limits = draw(st.sampled_from((None, (-2.0, 1.5))))
    return RateDependentPreview(plays, draw(st.integers(1, 6)), limits, draw(st.just(None) | few))


few = st.floats(0.1, 2.0)


@st.composite
def creeping_plays(draw: st.DrawFn) -> CreepingPlays:
    r = sorted(draw(st.lists(numbers(0.0, 5.0), min_size=1, max_size=3)))
    p = [draw(numbers(0.0, 2.0)) for _ in r]
    times = draw(st.lists(st.floats(1e-3, 1e3), max_size=2))
    weights = [[draw(st.floats(-0.05, 0.05)) for _ in times] for _ in r]
    return CreepingPlays(p, r, draw(numbers(1.0, 2.0)), weights, times, 0.01)


first_order = st.builds(
    Lag, st.floats(1e-5, 0.2), st.just(0.01), st.sampled_from(("first", "zero"))
)

WITH_TIME: dict[str, st.SearchStrategy[Operator]] = {
    "creep": creeps(1.0),
    "inverse-creep": creeps(0.5)
    .filter(lambda creep: creep.is_invertible())
    .map(lambda creep: creep.inverse()),
    "creeping-plays": creeping_plays(),
    "inverse-creeping-plays": creeping_plays().map(lambda plays: plays.inverse()),
    "delay": st.builds(Delay, numbers(0.0, 5.0), st.sampled_from((0.01, 1.0))),
    "inverse-delay": st.builds(Delay, st.floats(0.0, 0.24), st.just(0.01)).map(
        lambda delay: delay.inverse()
    ),
    "previewed-delay": st.builds(PreviewedDelay, st.floats(0.55, 1.0), st.integers(0, 6)),
    "rate-dependent-preview": previews(),
    "lag": first_order,
    "inverse-lag": first_order.map(lambda lag: lag.inverse()),
}
