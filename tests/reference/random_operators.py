"""Random operators and signals for hypothesis.

Numbers come from a lattice of quarters as often as from the reals: on the lattice inputs meet
thresholds exactly, and plays are left exactly on their edge.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
import pytest
from hypothesis import strategies as st
from numpy.typing import NDArray

from hyst import (
    Affine,
    Composition,
    DeadZone,
    GeneralizedPrandtlIshlinskii,
    ModifiedPrandtlIshlinskii,
    Operator,
    Play,
    PrandtlIshlinskii,
    RateDependentPrandtlIshlinskii,
    Stop,
)
from hyst.models import (
    BoucWen,
    Butterfly,
    ColemanHodgdon,
    Dahl,
    DegradingBoucWen,
    ExponentialCurve,
    GeneralizedMaxwellSlip,
    Iwan,
    LinearDynamics,
    LuGre,
    MasingOperator,
    MaxwellSlip,
    MemoryElement,
    MemoryFunction,
    PiecewiseLinear,
    PowerLaw,
    Preisach,
    RambergOsgood,
    RateCurve,
    RateShift,
    SecondOrderSections,
    TwoEnvelopePrandtlIshlinskii,
)
from reference.examples import EXAMPLES
from reference.random_magnets import MAGNETS
from reference.random_numbers import numbers
from reference.random_time import WITH_TIME

Array = NDArray[np.float64]
Operators = st.SearchStrategy[Operator]


def signals(low: float = -8.0, high: float = 8.0, most: int = 16) -> st.SearchStrategy[Array]:
    return st.lists(numbers(low, high), min_size=1, max_size=most).map(np.array)


@st.composite
def banks(draw: st.DrawFn) -> PrandtlIshlinskii:
    r = sorted(draw(st.lists(numbers(0.0, 5.0), max_size=6)))
    p = draw(st.lists(numbers(-2.0, 2.0), min_size=len(r), max_size=len(r)))
    z0 = draw(st.none() | st.lists(numbers(-4.0, 4.0), min_size=len(r), max_size=len(r)))
    return PrandtlIshlinskii(p, r, draw(numbers(-2.0, 2.0)), z0)


@st.composite
def dead_zones(draw: st.DrawFn, variants: tuple[Any, ...] = ("two-sided",)) -> DeadZone:
    rho = draw(st.lists(numbers(-5.0, 5.0), min_size=1, max_size=6))
    weights = draw(st.lists(numbers(-2.0, 2.0), min_size=len(rho), max_size=len(rho)))
    return DeadZone(weights, rho, draw(st.sampled_from(variants)))


@st.composite
def rate_dependent_banks(draw: st.DrawFn) -> RateDependentPrandtlIshlinskii:
    r = sorted(draw(st.lists(numbers(0.0, 5.0), max_size=5)))
    p = draw(st.lists(numbers(-2.0, 2.0), min_size=len(r), max_size=len(r)))
    knees = draw(st.lists(numbers(0.25, 8.0), max_size=2))
    slopes = draw(st.lists(numbers(-1.0, 1.0), min_size=len(knees), max_size=len(knees)))
    powers = draw(st.lists(numbers(0.0, 0.25), max_size=2))
    curve = RateCurve(draw(numbers(0.0, 2.0)), powers, slopes, knees)
    dt = draw(st.sampled_from((0.5, 1.0, 2.0)))
    return RateDependentPrandtlIshlinskii(p, r, curve, dt, draw(numbers(-2.0, 2.0)))


@st.composite
def butterflies(draw: st.DrawFn) -> Butterfly:
    rows = draw(st.integers(1, 4))
    c = np.zeros((rows, rows))
    for i, j in zip(*np.indices(c.shape).reshape(2, -1), strict=True):
        if i + j < rows:
            c[i, j] = draw(numbers(-2.0, 2.0))
    return Butterfly(draw(banks() | st.builds(GeneralizedPrandtlIshlinskii, maps, banks())), c)


few = st.floats(0.1, 2.0)


@st.composite
def sliding_elements(draw: st.DrawFn) -> MaxwellSlip:
    r = np.sort(draw(st.lists(st.floats(0.1, 5.0), max_size=5)))
    k = np.array(draw(st.lists(st.floats(0.1, 2.0), min_size=r.size, max_size=r.size)))
    return MaxwellSlip(k, k * r, draw(numbers(0.0, 2.0)))


@st.composite
def sliding_elements_by_rate(draw: st.DrawFn) -> GeneralizedMaxwellSlip:
    n = draw(st.integers(1, 4))
    several = st.lists(st.floats(0.1, 2.0), min_size=n, max_size=n)
    Fc, dt = draw(few), draw(st.sampled_from((0.5, 1.0, 2.0)))
    Fs, vs, C = Fc * draw(st.floats(1.0, 2.0)), draw(few), draw(numbers(0.0, 2.0))
    k, alpha, delta = draw(several), draw(several), draw(st.floats(0.5, 2.0))
    return GeneralizedMaxwellSlip(k, alpha, C, Fc, Fs, vs, dt, delta, draw(numbers(0.0, 0.5)))


@st.composite
def lugres(draw: st.DrawFn) -> LuGre:
    """Half of them without what depends on the velocity."""
    by_rate = draw(st.sampled_from((0.0, 1.0)))
    sigma1, sigma2 = by_rate * draw(numbers(0.0, 0.5)), by_rate * draw(numbers(0.0, 0.5))
    Fc, ratio = draw(few), 1.0 + by_rate * draw(st.floats(0.0, 1.0))
    dt = draw(st.sampled_from((0.5, 1.0, 2.0)))
    Fv, vv = by_rate * draw(numbers(0.0, 0.5)), draw(few)
    return LuGre(draw(few), sigma1, sigma2, Fc, Fc * ratio, draw(few), dt, Fv, vv)


affines = st.builds(Affine, numbers(-2.0, 2.0), numbers(-3.0, 3.0))
maps = affines | dead_zones()
plain: Operators = st.one_of(
    affines,
    st.builds(Play, numbers(0.0, 5.0), numbers(-4.0, 4.0)),
    st.builds(Stop, numbers(0.0, 5.0), numbers(-4.0, 4.0)),
    dead_zones(),
    banks(),
    st.builds(GeneralizedPrandtlIshlinskii, maps, banks()),
    st.builds(ModifiedPrandtlIshlinskii, banks(), maps),
)
compositions = st.lists(plain | dead_zones(("by-direction",)), min_size=1, max_size=3).map(
    Composition
)


@st.composite
def invertible_banks(draw: st.DrawFn, steepness: float = 3.0, most: int = 8) -> PrandtlIshlinskii:
    """Slopes c_j of the loading curve between 1/steepness and steepness, memory an input left."""
    exponents = draw(st.lists(st.floats(-1.0, 1.0), min_size=1, max_size=most + 1))
    slopes = steepness ** np.array(exponents)
    n = slopes.size - 1
    gaps = np.array(draw(st.lists(numbers(0.0, 2.0), min_size=n, max_size=n)))
    moves = np.array(draw(st.lists(st.floats(-1.0, 1.0), min_size=n, max_size=n)))
    memory = draw(st.sampled_from((0.0, 1.0))) * np.cumsum(moves * gaps)
    return PrandtlIshlinskii(np.diff(slopes), np.cumsum(gaps), slopes[0], memory)


@st.composite
def invertible_dead_zones(draw: st.DrawFn, steepness: float = 3.0) -> DeadZone:
    """Slopes of all pieces between 1/steepness and steepness, of one sign."""
    sides = draw(
        st.lists(
            st.lists(st.tuples(numbers(0.25, 2.0), st.floats(-1.0, 1.0)), max_size=3),
            min_size=2,
            max_size=2,
        )
    )
    middle = steepness ** draw(st.floats(-1.0, 1.0))
    weights, thresholds = [np.array([middle])], [np.zeros(1)]
    for sign, side in zip((1.0, -1.0), sides, strict=True):
        slopes = np.array([middle, *(steepness**exponent for _, exponent in side)])
        weights.append(np.diff(slopes))
        thresholds.append(sign * np.cumsum([gap for gap, _ in side]))
    sign = draw(st.sampled_from((1.0, -1.0)))
    return DeadZone(sign * np.concatenate(weights), np.concatenate(thresholds))


invertible_affines = st.builds(
    lambda sign, gain, offset: Affine(sign * gain, offset),
    st.sampled_from((1.0, -1.0)),
    st.floats(1.0 / 3.0, 3.0),
    numbers(-3.0, 3.0),
)
invertible_maps = invertible_affines | invertible_dead_zones()
invertible_gpis = st.builds(GeneralizedPrandtlIshlinskii, invertible_maps, invertible_banks())
invertible_mpis = st.builds(ModifiedPrandtlIshlinskii, invertible_banks(), invertible_maps)
invertible: Operators = st.one_of(
    invertible_maps,
    invertible_banks(),
    invertible_gpis,
    invertible_mpis,
    st.lists(invertible_gpis | invertible_mpis | invertible_banks(), min_size=1, max_size=2).map(
        Composition
    ),
)

memories = st.sampled_from(("masing", "last-reversal"))
exponentials = st.builds(
    lambda first, last, way: ExponentialCurve(last, last - first, way), few, few, few
)
curves = (
    st.builds(PowerLaw, few, few, few)
    | exponentials
    | st.builds(
        lambda slopes: PiecewiseLinear(np.diff(slopes), np.arange(1.0, len(slopes)), slopes[0]),
        st.lists(few, min_size=1, max_size=4),
    )
)
functions = st.builds(MemoryFunction.power_law, few, few, few) | st.builds(
    lambda values: MemoryFunction.table(np.arange(float(len(values))), values),
    st.lists(few, min_size=1, max_size=4),
)
elements = st.builds(
    MemoryElement,
    functions,
    st.floats(0.01, 0.1),
    st.sampled_from(("signed", "absolute")),
    st.sampled_from(("never", "sign-change")),
    numbers(-1.0, 1.0),
)
# gamma over beta, and phi over what it may be, inside what is admissible.
bouc_wens = st.builds(
    lambda k, a, beta, share, n, h, tilt, z0: BoucWen(
        k, a, beta, share * beta, n, h, 0.5 * tilt * (1.0 + share) * beta, z0
    ),
    numbers(0.0, 3.0),
    few,
    few,
    st.floats(-0.75, 1.0),
    st.sampled_from((0.5, 1.0, 2.0)) | st.floats(0.3, 4.0),
    st.sampled_from((1.0, -1.0)),
    st.floats(-0.5, 0.5),
    st.just(0.0),
)
degrading_bouc_wens = st.builds(
    lambda k, a, beta, share, n, nu, eta, zeta, p: DegradingBoucWen(
        k, a, beta, share * beta, n, nu, eta, zeta, p, 0.1, 0.5, 0.02, 0.5
    ),
    few,
    few,
    few,
    st.floats(-0.75, 1.0),
    st.sampled_from((1.0, 2.0)) | st.floats(1.0, 4.0),
    st.floats(0.0, 0.02),
    st.floats(0.0, 0.1),
    st.floats(0.0, 0.49),
    st.floats(0.0, 1.0),
)
# Poles and zeros inside the unit circle.
lags = st.builds(
    lambda zero, poles, gain, delay: LinearDynamics.from_zeros_poles_gain(
        [zero], poles, gain, 0.01, delay
    ),
    st.floats(-0.9, 0.9),
    st.lists(st.floats(-0.9, 0.9), min_size=1, max_size=3),
    few,
    st.integers(0, 2),
)


@st.composite
def coleman_hodgdons(draw: st.DrawFn, least: float) -> ColemanHodgdon:
    """One piece or two of one width of loop; b is at least this share of a."""
    alpha, slope = draw(few), draw(few)
    width = slope * (1.0 - draw(st.floats(least, 0.95)))
    pieces = [slope, slope * draw(st.floats(1.0, 3.0))][: draw(st.integers(1, 2))]
    knots = [draw(numbers(0.5, 4.0))][: len(pieces) - 1]
    return ColemanHodgdon(alpha, pieces, [each - width for each in pieces], knots)


@st.composite
def two_envelopes(draw: st.DrawFn, least_p0: float = 0.0) -> TwoEnvelopePrandtlIshlinskii:
    """One envelope, and the same with a steeper piece to the right and one to the left of 0."""
    plain = draw(invertible_dead_zones().filter(lambda zone: zone.weights[0] > 0.0))
    extra = [draw(numbers(0.0, 1.0)) for _ in range(2)]
    start = [draw(numbers(0.25, 3.0)) for _ in range(2)]
    width = [draw(numbers(0.25, 2.0)) for _ in range(2)]
    weights, knots = plain.weights, plain.thresholds
    for sign, s, a, b in zip((1.0, -1.0), extra, start, width, strict=True):
        weights = np.concatenate([weights, [s, -s]])
        knots = np.concatenate([knots, [sign * a, sign * (a + b)]])
    pair = (plain, DeadZone(weights, knots))
    rising, falling = pair if draw(st.booleans()) else pair[::-1]
    # Twice the room that is needed: with all constants doubled it is needed twice.
    least = max(s * b for s, b in zip(extra, width, strict=True))
    r = least + np.array(sorted(draw(st.lists(numbers(0.0, 4.0), max_size=4))))
    p = draw(st.lists(numbers(0.0, 2.0), min_size=r.size, max_size=r.size))
    return TwoEnvelopePrandtlIshlinskii(p, r, rising, falling, draw(numbers(least_p0, 2.0)))


@st.composite
def relays(draw: st.DrawFn, least: float = 0.0) -> Preisach:
    """Cells on edges a quarter or more apart, from rest or from where an input has left them."""
    n = draw(st.integers(1, 4))
    widths = draw(st.lists(numbers(0.25, 2.0), min_size=n, max_size=n))
    edges = draw(numbers(-4.0, 1.0)) + np.cumsum([0.0, *widths])
    count = n * (n + 1) // 2
    weights = np.zeros((n, n))
    weights[np.tril_indices(n)] = draw(st.lists(numbers(0.0, 2.0), min_size=count, max_size=count))
    density = draw(st.sampled_from(("even", "ridges")))
    p0, u0 = draw(numbers(least, 2.0)), draw(st.just(0.0) | numbers(-6.0, 6.0))
    return Preisach(weights, edges, p0, u0, density)


RANDOM: dict[str, Operators] = {
    "affine": affines,
    "play": st.builds(Play, numbers(0.0, 5.0), numbers(-4.0, 4.0)),
    "stop": st.builds(Stop, numbers(0.0, 5.0), numbers(-4.0, 4.0)),
    "dead-zone": dead_zones(("two-sided", "by-direction")),
    "prandtl-ishlinskii": banks(),
    "generalized-prandtl-ishlinskii": st.builds(GeneralizedPrandtlIshlinskii, maps, banks()),
    "modified-prandtl-ishlinskii": st.builds(ModifiedPrandtlIshlinskii, banks(), maps),
    "rate-dependent-prandtl-ishlinskii": rate_dependent_banks(),
    "composition": compositions,
    "linear-dynamics": lags,
    "second-order-sections": st.builds(
        lambda numerator, poles: SecondOrderSections(
            [*numerator, -sum(poles), poles[0] * poles[1]], 0.01
        ),
        st.lists(numbers(-2.0, 2.0), min_size=3, max_size=3),
        st.tuples(st.floats(-0.9, 0.9), st.floats(-0.9, 0.9)),
    ),
    "masing": st.builds(MasingOperator, curves, memories),
    "ramberg-osgood": st.builds(RambergOsgood, few, few, few, memories),
    "iwan": st.builds(Iwan, few, few, st.floats(-0.45, 1.0), numbers(0.0, 2.0), numbers(0.0, 1.0)),
    "memory-element": elements,
    "inverse-memory-element": elements.map(lambda element: element.inverse()),
    "butterfly": butterflies(),
    "coleman-hodgdon": coleman_hodgdons(least=0.0),
    "inverse-coleman-hodgdon": coleman_hodgdons(least=0.7).map(lambda model: model.inverse()),
    "bouc-wen": bouc_wens,
    "inverse-bouc-wen": bouc_wens.filter(lambda model: model.traits().invertible).map(
        lambda model: model.inverse()
    ),
    "degrading-bouc-wen": degrading_bouc_wens,
    "inverse-degrading-bouc-wen": degrading_bouc_wens.filter(
        lambda model: model.traits().invertible
    ).map(lambda model: model.inverse()),
    "dahl": st.builds(Dahl, few, few, st.floats(0.3, 3.0), numbers(-1.0, 1.0)),
    **MAGNETS,
    **WITH_TIME,
    # A Coulomb force beyond every input of the contracts.
    "inverse-dahl": st.builds(Dahl, few, st.floats(1e3, 1e4), st.floats(1.0, 3.0)).map(
        lambda friction: friction.inverse()
    ),
    "maxwell-slip": sliding_elements(),
    "generalized-maxwell-slip": sliding_elements_by_rate(),
    "lugre": lugres(),
    "two-envelope-prandtl-ishlinskii": two_envelopes(),
    "inverse-two-envelope-prandtl-ishlinskii": two_envelopes(0.25).map(
        lambda model: model.inverse()
    ),
    "rate-shift": st.builds(
        RateShift, numbers(0.0, 2.0), st.floats(0.1, 2.0), st.sampled_from((0.5, 1.0, 2.0))
    ),
    "preisach": relays(),
    "inverse-preisach": relays(0.25).map(lambda model: model.inverse()),
    "inverse": invertible.map(lambda operator: operator.inverse()),
}

SINGLE = ("affine", "play", "stop", "dead-zone", "prandtl-ishlinskii")


def operators_that(
    predicate: Callable[[Operator], bool] = lambda _: True, kinds: Iterable[str] = tuple(RANDOM)
) -> pytest.MarkDecorator:
    """Run a contract for every example and every random operator that a predicate holds for."""
    cases = [
        pytest.param(st.just(each), id=name) for name, each in EXAMPLES.items() if predicate(each)
    ]
    for kind in kinds:
        # A kind that hardly ever satisfies the predicate would only be filtered, not tested.
        verdicts = [bool(predicate(each)) for each in EXAMPLES.values() if each.kind == kind] or [
            True
        ]
        if 2 * sum(verdicts) >= len(verdicts):
            cases.append(pytest.param(RANDOM[kind].filter(predicate), id=f"random {kind}"))
    return pytest.mark.parametrize("operators", cases)


every_operator = operators_that()
