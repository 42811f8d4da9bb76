"""The loops of new records behind the dynamics of a model, and whether they depend on the rate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_not_negative, as_positive
from hyst.compensation.loop_check.chosen_inverse import Inverses, inverse_for_loop
from hyst.compensation.loop_check.input_noise import doubt_by_input_noise
from hyst.compensation.loop_check.loop_shape import HARMONICS, shape_of
from hyst.compensation.loop_check.loops import LoopOfRecord, LoopsBehind
from hyst.compensation.loop_check.rate_test import RepeatedLoop, comparable, rate_test
from hyst.compensation.loop_check.repeated_cycles import LEAST_SAMPLES, repeated_cycles
from hyst.compensation.noncausal import split_at_dynamics
from hyst.errors import InputError
from hyst.models import LinearDynamics
from hyst.operators import Composition, Operator
from hyst.signals import Record, estimate_noise

Array = NDArray[np.float64]

_MOSTLY = 0.5  # of a record: where less of it repeats, all of its samples tell the error

LEVEL = 0.01
LEAST_DIFFERENCE = 0.5
"""% of range."""


def loops_behind(
    model: Operator,
    records: Record | Sequence[Record],
    *,
    band: float | None = None,
    level: float = LEVEL,
    tolerance: float = LEAST_DIFFERENCE,
    names: Sequence[str] | None = None,
) -> LoopsBehind:
    """See the loops of new records through the inverse of a model's dynamics.

        v_hat = G^-1 y,    the loop is (u, v_hat),    G from the model, u and y from the records

    Where the hysteresis does not depend on the rate and G is right, sines of one amplitude give one
    loop at all frequencies. Loops whose inputs turn at the same values (within 2 %) are compared
    over the phase of the input, by the first three harmonics of ``v_hat`` beside the model's
    hysteresis, which takes back that sines are sampled at other places; means are left out. The
    noise is the scatter between cycles, whatever its colour; the first stroke is left out.

    Parameters
    ----------
    model
        One ``LinearDynamics`` with the hysteresis in front, and maps with an exact inverse behind,
        if anything.
    records
        One or several, of the model's sample time; several stretches may follow each other in one.
    band
        Highest frequency to invert, Hz; None for all, or as high as zeros on the unit circle and
        the noise allow.
    level
        Chance to call loops different that differ by noise alone, 0 to 0.5.
    tolerance
        Largest distance of two loops that does not matter, % of the range of v, >= 0.
    names
        What the records are called; numbers from 1 by default.

    Returns
    -------
    LoopsBehind

    Raises
    ------
    InputError
        If the model has no dynamics or more than one stage of them, or hysteresis behind them, or a
        record has another sample time, a constant input, or is shorter than the inverse needs.
    NotInvertibleError
        If the dynamics have no stable inverse in the band, or what stands behind them has none.

    Source
    ------
    S0 sec. V-B, fig. 6; the test is ours.

    Examples
    --------
    >>> import hyst
    >>> G = hyst.LinearDynamics.from_zeros_poles_gain([1.6], [0.5, 0.3], 1.0, dt=1e-3)
    >>> stage = G @ hyst.PrandtlIshlinskii([0.5], [1.0], p0=1.0)
    >>> sines = [4.0 * np.sin(2.0 * np.pi * f * np.arange(1500) / 1000.0) for f in (5.0, 20.0)]
    >>> records = [hyst.Record(u, stage(u), dt=1e-3) for u in sines]
    >>> found = hyst.compensation.loops_behind(stage, records)
    >>> found.holds, [round(each.frequency, 6) for each in found.repeated]
    (True, [5.0, 20.0])
    """
    as_positive(level, "level", "a chance", most=0.5)
    as_not_negative(tolerance, "tolerance")
    if band is not None:
        as_positive(band, "band", "a frequency in Hz")
    given = (records,) if isinstance(records, Record) else tuple(records)
    if not given:
        raise InputError("there is no record; give one or more")
    before, dynamics, after = _stages(model)
    called = tuple(names) if names is not None else tuple(str(k + 1) for k in range(len(given)))
    if len(called) != len(given):
        raise InputError(f"there are {len(called)} names for {len(given)} records; give one each")
    for name, record in zip(called, given, strict=True):
        model.require_sample_time(record.dt, f"record {name}")
        if np.ptp(record.u) == 0.0:
            raise InputError(f"the input of record {name} is {record.u[0]:.6g} throughout")
    y = [_behind(after, record.y) for record in given]
    modelled = [record.u if before is None else before(record.u) for record in given]
    inverses = Inverses(dynamics)
    loops = tuple(
        _loop(*each, inverses, band) for each in zip(called, given, y, modelled, strict=True)
    )
    repeated = tuple(
        each for number, loop in enumerate(loops) for each in _repeated(number, loop, before)
    )
    loops = tuple(_with_noise(number, loop, repeated) for number, loop in enumerate(loops))
    groups = comparable(repeated)
    tests = tuple(
        rate_test(group, _extent(group, loops), level / len(groups), tolerance, given[0].dt)
        for group in groups
    )
    rate_free = before is None or bool(before.traits().rate_independent)
    return LoopsBehind(
        model=model,
        loops=loops,
        repeated=repeated,
        tests=tests,
        level=float(level),
        tolerance=float(tolerance),
        rate_independent_model=rate_free,
    )


def _stages(model: Operator) -> tuple[Operator | None, LinearDynamics, Operator | None]:
    stages = list(model.parts) if isinstance(model, Composition) else [model]
    count = sum(isinstance(stage, LinearDynamics) for stage in stages)
    if count != 1:
        said = "no linear dynamics" if count == 0 else f"{count} stages of linear dynamics"
        more = (
            "its loop is that of input and output, as hyst identify and hyst compare draw it"
            if count == 0
            else "give one with a single stage"
        )
        raise InputError(
            f"the model has {said}, and a loop is looked for behind one stage of them; {more}"
        )
    around = split_at_dynamics(model)
    at = next(i for i, each in enumerate(around) if isinstance(each, LinearDynamics))
    dynamics = around[at]
    assert isinstance(dynamics, LinearDynamics), "it was looked for"
    before = Composition(around[:at]) if at else None
    after = Composition(around[at + 1 :]) if at + 1 < len(around) else None
    if after is not None and not after.traits().memoryless:
        raise InputError(
            "what stands behind the dynamics has memory, and this sees hysteresis in front of "
            "dynamics only; give a model of hysteresis, then dynamics"
        )
    late = round(model.description.delay)
    if late > 0:
        G = dynamics
        dynamics = LinearDynamics(G.A, G.B, G.C, G.D, G.dt, G.delay + late)
    return before, dynamics, after


def _behind(after: Operator | None, y: Array) -> Array:
    return y if after is None else after.inverse()(y)


def _loop(
    name: str,
    record: Record,
    y: Array,
    modelled: Array,
    inverses: Inverses,
    band: float | None,
) -> LoopOfRecord:
    if np.ptp(modelled) == 0.0:
        raise InputError(
            f"the hysteresis of the model does not move on record {name}, whose input goes from "
            f"{record.u.min():.6g} to {record.u.max():.6g}; drive it further"
        )
    dynamics = inverses.dynamics
    # Without what moves, whose curvature would count as noise.
    noise = estimate_noise(y - dynamics(modelled))
    drives = repeated_cycles(record.u, record.dt, slice(0, len(record)))
    highest = max((each.frequency for each in drives), default=0.0)
    extent = float(np.ptp(modelled))
    chosen = inverse_for_loop(inverses, band, noise, extent, highest, len(record))
    inverse = chosen.inverse
    valid = inverse.valid(len(record))
    if valid.stop - valid.start < LEAST_SAMPLES:
        raise InputError(
            f"record {name} has {len(record)} samples, and the inverse of the dynamics needs "
            f"{inverse.memory} before and {inverse.preview} after each; record longer, or give a "
            "band to invert"
        )
    # Seen through the same band, a corner of the model is as round as one of the record.
    expected = modelled if chosen.band is None else inverse(dynamics(modelled))
    return LoopOfRecord(
        name, record, inverse(y), expected, valid, noise * inverse.noise_gain, chosen
    )


def _repeated(number: int, loop: LoopOfRecord, front: Operator | None) -> list[RepeatedLoop]:
    found, band = [], loop.seen_through.band
    for cycles in repeated_cycles(loop.record.u, loop.record.dt, loop.valid):
        most = HARMONICS if band is None else min(HARMONICS, int(band / cycles.frequency))
        if most >= 1:
            doubt = np.zeros(cycles.phase.size)
            if front is not None:
                doubt = doubt_by_input_noise(front, loop.record.u, cycles)
            shape = shape_of(loop.v, loop.modelled, cycles, most, doubt)
            found.append(RepeatedLoop(number, cycles, shape))
    return found


def _with_noise(number: int, loop: LoopOfRecord, repeated: Sequence[RepeatedLoop]) -> LoopOfRecord:
    """Tell noise from what repeats, where there is something that does."""
    stretches = [each for each in repeated if each.record == number]
    told = sum(each.cycles.phase.size for each in stretches)
    if told <= _MOSTLY * (loop.valid.stop - loop.valid.start):
        return loop
    own = [each.shape for each in stretches]
    noise, repeats = (
        float(np.sqrt(np.mean(np.square(values))))
        for values in ([each.noise for each in own], [each.repeats for each in own])
    )
    return replace(loop, noise=noise, repeats=repeats)


def _extent(group: Sequence[RepeatedLoop], loops: Sequence[LoopOfRecord]) -> float:
    return max(float(np.ptp(loops[each.record].modelled[each.cycles.window])) for each in group)
