"""What is said of loops at several frequencies, one sentence each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from hyst.compensation.loop_check.rate_test import (
    CHANGED,
    COINCIDE,
    CREEP,
    DELAY,
    GAIN,
    LAG,
    NARROWER,
    SHAPE,
    SMALL,
    WIDER,
    RateTest,
    RepeatedLoop,
    comparable,
)

if TYPE_CHECKING:
    from hyst.compensation.loop_check.loops import LoopOfRecord

_MEANS = {
    WIDER: "the loop grows wider with the frequency: the dynamics lack a lag, or the hysteresis "
    "depends on the rate (identify with --hysteresis rdpi)",
    NARROWER: "the loop is wider at low frequencies: creep or another slow relaxation, which the "
    "model lacks (identify with --creep, from records with holds)",
    CREEP: "gain and width of the loop fall with the frequency: creep or another slow relaxation, "
    "which the model lacks (identify with --creep, from records with holds)",
    LAG: "the gain falls and the loop grows wider with the frequency: the dynamics lack a lag or "
    "have a wrong resonance, or the hysteresis depends on the rate (--hysteresis rdpi)",
    GAIN: "the gain changes with the frequency: the dynamics are wrong there (identify them from a "
    "drive that holds these frequencies), or, where it falls from the lowest on, the model lacks "
    "creep",
    SHAPE: "the shape of the loop changes with the frequency more than its gain and width: the "
    "dynamics are wrong at multiples of the frequency, hum lies on one of them, or the "
    "hysteresis depends on the rate",
    CHANGED: "but loops of one frequency differ from each other as well, so it is not the rate: "
    "the actuator changed between the records (temperature, load, drift)",
}


def sentence_of_test(test: RateTest, level: float, tolerance: float, rate_free: bool) -> str:
    """Say whether loops of several frequencies are one.

    Parameters
    ----------
    test
        What was found.
    level, tolerance
        By which it was judged.
    rate_free
        Whether the hysteresis of the model does not depend on the rate.
    """
    loops = test.loops
    first, last = loops[0], loops[-1]
    between = (
        f"{len(loops)} loops of {first.frequency:.4g} to {last.frequency:.4g} Hz, input "
        f"{first.cycles.low:.4g} to {first.cycles.high:.4g}"
    )
    what = "" if rate_free else ", what the rate does in the model taken out,"
    sizes = f"{test.distance_percent:.2g} % of range at most, p {_p(test.found.p_value)}"
    if test.cause == COINCIDE:
        return f"The loops{what} coincide as far as noise lets one see ({between}; {sizes})."
    if test.cause == SMALL:
        return (
            f"The loops{what} differ by more than noise, but by less than {tolerance:g} % of range "
            f"({between}; {sizes})."
        )
    return f"The model does not hold: the loops{what} differ ({between}; {sizes}); {_why(test)}."


def _why(test: RateTest) -> str:
    if test.cause == DELAY:
        return _as_delay(test)
    slow, fast = test.loops[0], test.loops[-1]
    numbers = (
        f"from {slow.frequency:.4g} to {fast.frequency:.4g} Hz the gain goes from "
        f"{100.0 * abs(slow.ratio):.4g} to {100.0 * abs(fast.ratio):.4g} % of the model's, the "
        f"area from {_area_percent(slow)} to {_area_percent(fast)}"
    )
    if test.cause in (WIDER, LAG):
        numbers += (
            f"; a delay alone, of {test.delay / test.dt:.3g} samples, would leave {_left(test)}"
        )
    return f"{_MEANS[test.cause]}; {numbers}"


def _as_delay(test: RateTest) -> str:
    samples = test.delay / test.dt
    said = f"{abs(samples):.3g} samples ({abs(test.delay):.3g} s)"
    what = (
        f"as a delay of {said} does that the model lacks"
        if samples > 0.0
        else f"as they do where the delay of the model is {said} too long"
    )
    return (
        f"{what}, and without it {_left(test)} are left; correct "
        "the delay of the dynamics (converters, filters of the sensor), unless a short lag or "
        "plays that widen with the rate, which look alike, are the reason"
    )


def _left(test: RateTest) -> str:
    left = test.without_delay
    return f"{100.0 * left.distance / test.extent:.2g} % of range (p {_p(left.p_value)})"


def _area_percent(loop: RepeatedLoop) -> str:
    if loop.modelled_area == 0.0:
        return f"{loop.area:.4g}"
    return f"{100.0 * loop.area / loop.modelled_area:.4g} %"


def _p(value: float) -> str:
    return f"= {value:.2g}" if value >= 1e-12 else "< 1e-12"


def why_no_test(repeated: Sequence[RepeatedLoop], records: int) -> str:
    """Say why loops of several frequencies were not compared.

    Parameters
    ----------
    repeated
        Loops of inputs that repeat.
    records
        How many there are.
    """
    begin = "Whether the loop depends on the rate was not tested: "
    if not repeated:
        return (
            f"{begin}no input repeats, by two cycles of 12 samples or more after the first stroke; "
            "record sines of one amplitude at several frequencies, three periods each or more"
        ) + "."
    if len(repeated) == 1:
        one = repeated[0]
        return (
            f"{begin}there is one loop only, of {one.frequency:.4g} Hz; record a sine of the same "
            "amplitude and offset at another frequency."
        )
    assert not comparable(repeated)
    return (
        f"{begin}no two of the {len(repeated)} loops have other frequencies and inputs between the "
        "same ends, within 2 %; record one amplitude and offset at several frequencies."
    )


def sentence_of_differences(
    loops: Sequence[LoopOfRecord], far_off: Sequence[LoopOfRecord], limit: float
) -> str:
    """Say how far the loops are from the hysteresis of the model.

    Parameters
    ----------
    loops
        All.
    far_off
        Those missed by more than the limit.
    limit
        % of range.
    """
    worst = max(loops, key=lambda each: each.beside_noise_percent)
    errors = worst.metrics
    size = (
        f"{worst.beside_noise_percent:.3g} % of range rms beside noise (with noise "
        f"{errors.rms_percent:.3g} % rms, {errors.max_percent:.3g} % at most"
        + (f"; record {worst.name})" if len(loops) > 1 else ")")
    )
    if far_off:
        return (
            f"The model does not hold: its hysteresis misses the loop by {size}; "
            f"{limit:g} % or more describes nothing."
        )
    return f"The hysteresis of the model misses the loop by {size}."
