"""Run models over records that none of them has seen, and measure how far each is off."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError, NotInvertibleError
from hyst.identification.choice.blocks import Block, blocks_of
from hyst.identification.comparison.common_samples import common_samples, lag_on
from hyst.identification.comparison.compared_model import ComparedModel, WorstPlace
from hyst.identification.comparison.comparison import Comparison
from hyst.identification.options import listed
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.part_of_a_sample import by_whole_samples
from hyst.identification.record_use.strokes import OUTERMOST
from hyst.identification.record_use.used_samples import Data, require_same_units
from hyst.identification.result.identified import Identified
from hyst.identification.result.late_output import late_output
from hyst.operators import Operator, data_hash
from hyst.signals import Record, error_metrics, units_differ

Array = NDArray[np.float64]

_TIMED_RUNS = 5
_TIMED_SECONDS = 0.05


def compare(
    models: Operator
    | Identified
    | Sequence[Operator | Identified]
    | Mapping[str, Operator | Identified],
    records: Record | Sequence[Record],
) -> Comparison:
    """Set models of one actuator beside each other on records that none of them has seen.

    Every model runs over each record from the state of rest, its output comes as late as its delay
    says, and all are judged on the same samples: those from where the input has passed its range.

    Parameters
    ----------
    models
        Operators or results of ``identify``, as a mapping from what they are to be called, or in a
        list, where they are called by their families. What they say of themselves (delay, range,
        verdict, origin) is taken from their descriptions.
    records
        One or more records of the actuator, in the units of the models.

    Returns
    -------
    Comparison

    Raises
    ------
    InputError
        If there is no model or no record, a model was made for another sample time or another unit
        than a record has, or refuses a sample.
    NotIdentifiableError
        If input or output of a record is constant, or its input does not turn.

    Examples
    --------
    >>> import numpy as np, hyst
    >>> u = np.sin(np.linspace(0.0, 20.0, 2000)) * np.linspace(1.0, 0.3, 2000)
    >>> true = hyst.PrandtlIshlinskii(p=[0.5, 0.3], r=[0.1, 0.3], p0=1.0)
    >>> rough = hyst.PrandtlIshlinskii(p=[0.7], r=[0.2], p0=1.0)
    >>> found = hyst.compare({"one play": rough, "two": true}, hyst.Record(u, true(u), dt=1e-3))
    >>> found.best.name, found["two"].metrics.rms, found["one play"].constants
    ('two', 0.0, 3)
    """
    named, given = _named(models), listed(records)
    if not given:
        raise InputError("there is no record; give at least one")
    _refuse_other_signals(named, given)
    data, used = common_samples(given, [each.description for each in named.values()])
    overview = Overview(data)
    blocks = blocks_of(overview)
    compared = tuple(_compared(name, each, overview, blocks) for name, each in named.items())
    line = _line(data, [lag_on(each.description, given[0]) for each in named.values()])
    return Comparison(given, compared, used, overview.shows_minor_loops, line)


def _named(
    models: Operator
    | Identified
    | Sequence[Operator | Identified]
    | Mapping[str, Operator | Identified],
) -> dict[str, Operator]:
    """Give the models by name; those of a list by family, numbered where one comes twice."""
    if isinstance(models, Operator | Identified):
        models = [models]
    if isinstance(models, Mapping):
        named = {str(name): _operator(each, str(name)) for name, each in models.items()}
    else:
        given = [_operator(each, f"model {k}") for k, each in enumerate(models, 1)]
        families = [each.description.family or each.kind for each in given]
        counts = [families[: k + 1].count(each) for k, each in enumerate(families)]
        named = {
            family if families.count(family) == 1 else f"{family} {count}": each
            for family, count, each in zip(families, counts, given, strict=True)
        }
    if not named:
        raise InputError("there is no model; give at least one")
    return named


def _operator(model: Operator | Identified, what: str) -> Operator:
    found = model.model if isinstance(model, Identified) else model
    if not isinstance(found, Operator):
        raise InputError(
            f"{what} is of type {type(found).__name__}; give an operator or a result of identify"
        )
    return found


def _refuse_other_signals(named: Mapping[str, Operator], records: Sequence[Record]) -> None:
    """Refuse units and sample times that a model does not have."""
    require_same_units(records)
    for name, model in named.items():
        about = model.description
        for number, record in enumerate(records, 1):
            model.require_possible_time(record.dt, f"record {number}, for {name},")
            for what in ("input", "output"):
                unit, own = (getattr(each, f"{what}_unit") for each in (record, about))
                if units_differ(unit, own):
                    raise InputError(
                        f"the {what} of record {number} is in {unit!r} but that of {name} in "
                        f"{own!r}; hyst converts no units, so convert the column, or correct its "
                        "header"
                    )


def _compared(
    name: str, model: Operator, overview: Overview, blocks: Sequence[Block]
) -> ComparedModel:
    data, about = overview.data, model.description
    outputs = tuple(_output(name, model, record) for record in data.records)
    measured = data.measured()
    modelled = data.joined([y[w] for y, w in zip(outputs, data.windows(), strict=True)])
    error, span = modelled - measured, _output_range(data)
    outer, minor = _by_strokes(error, overview)
    return ComparedModel(
        name=name,
        model=model,
        metrics=error_metrics(measured, modelled, output_range=span),
        free_offset=error_metrics(measured, modelled, free_offset=True, output_range=span),
        outer_strokes=outer,
        minor_loops=minor,
        worst=_worst(error, data),
        nanoseconds=_nanoseconds(model, data.records),
        not_invertible=_not_invertible(model),
        seen=_seen(model, data.records),
        extrapolated=_share_outside(about.input_low, about.input_high, data),
        outputs=outputs,
        block_errors=_by_blocks(error / span, blocks),
        centred_block_errors=_by_blocks((error - error.mean()) / span, blocks),
    )


def _output(name: str, model: Operator, record: Record) -> Array:
    try:
        at_its_time = model.at_sample_time(record.dt)
        return late_output(at_its_time, record.u, lag_on(model.description, record))
    except InputError as error:
        raise InputError(f"{name} cannot be run over the record: {error}") from error


def _output_range(data: Data) -> float:
    return float(max(r.y.max() for r in data.records) - min(r.y.min() for r in data.records))


def _by_blocks(error: Array, blocks: Sequence[Block]) -> Array:
    return np.array([np.mean(np.square(error[block.rows])) for block in blocks])


def _by_strokes(error: Array, overview: Overview) -> tuple[float | None, float | None]:
    """Root mean square error over the outermost strokes and over the others."""
    if not overview.shows_minor_loops:
        return None, None
    lengths = overview.stroke_lengths
    outer = lengths >= OUTERMOST * lengths.max()
    return _rms(error[outer]), _rms(error[~outer])


def _rms(error: Array) -> float:
    largest = float(np.abs(error).max())
    return 0.0 if largest == 0.0 else largest * float(np.sqrt(np.mean(np.square(error / largest))))


def _worst(error: Array, data: Data) -> WorstPlace:
    at = int(np.abs(error).argmax())
    samples = [np.arange(len(r), dtype=np.float64)[w] for r, w in _with_windows(data)]
    numbers = [np.full(each.size, float(k)) for k, each in enumerate(samples)]
    number, sample = int(data.joined(numbers)[at]), int(data.joined(samples)[at])
    record = data.records[number]
    return WorstPlace(
        number + 1, sample, sample * record.dt, float(record.u[sample]), float(error[at])
    )


def _with_windows(data: Data) -> list[tuple[Record, slice]]:
    return list(zip(data.records, data.windows(), strict=True))


def _nanoseconds(model: Operator, records: Sequence[Record]) -> float:
    """Time of a sample: the quickest of some runs over the longest record."""
    record = max(records, key=len)
    at_its_time, quickest = model.at_sample_time(record.dt), math.inf
    stop = time.perf_counter() + _TIMED_SECONDS
    for run in range(_TIMED_RUNS):
        start = time.perf_counter()
        at_its_time(record.u)
        quickest = min(quickest, time.perf_counter() - start)
        if run and time.perf_counter() > stop:
            break
    return 1e9 * quickest / len(record)


def _not_invertible(model: Operator) -> str:
    try:
        model.inverse()
    except NotInvertibleError as error:
        return str(error)
    return ""


def _seen(model: Operator, records: Sequence[Record]) -> tuple[int, ...]:
    """Numbers of the records that a model was identified from, alone or several in a row."""
    origin = model.description.provenance
    if origin is None:
        return ()
    count = len(records)
    for first in range(count):
        for stop in range(first + 1, count + 1):
            if data_hash(records[first:stop]) == origin.data_sha256:
                return tuple(range(first + 1, stop + 1))
    return ()


def _share_outside(low: float | None, high: float | None, data: Data) -> float | None:
    if low is None or high is None:
        return None
    u = np.concatenate([record.u for record in data.records])
    return float(np.mean((u < low) | (u > high)))


def _line(data: Data, lags: Sequence[float]) -> float:
    """Root mean square error of the straight line that fits best, with the best of these delays."""
    y = data.measured()
    y, errors = y - y.mean(), []
    for lag in dict.fromkeys(lags):
        late = data.delayed(lag)
        records = zip(late.records, late.whole_lags(), data.windows(), strict=True)
        u = data.joined([by_whole_samples(r.u, whole)[window] for r, whole, window in records])
        u = u - u.mean()
        u = u / (float(np.abs(u).max()) or 1.0)
        power = float(np.dot(u, u))
        errors.append(_rms(y - (float(np.dot(u, y)) / power if power else 0.0) * u))
    return min(errors)
