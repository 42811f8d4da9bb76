"""The main job of hyst: from records to a model that can be inverted."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Literal

from numpy.typing import ArrayLike

from hyst.diagnosis import Diagnosis
from hyst.diagnosis.diagnose_records import diagnose_all_but_delay
from hyst.identification.blas_threads import one_blas_thread
from hyst.identification.creep.creeping import Creeping
from hyst.identification.creep.found_creep import with_creep
from hyst.identification.creep.wanted import Wanted as Creeps
from hyst.identification.creep.wanted import as_creep, creeping_inside, require_place
from hyst.identification.families.family import Family
from hyst.identification.families.registry import chosen_families, families_in_reserve
from hyst.identification.lag.found_lag import Wanted as Lagging
from hyst.identification.lag.found_lag import as_lag, found_with_lag, search_beside_lag
from hyst.identification.options import Options, listed, records_of
from hyst.identification.progress import Progress, Step, silent
from hyst.identification.record_use.cleaned import Cleaned, as_drift, cleaned
from hyst.identification.record_use.coded_input import all_in_volts, with_driver
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import beside_level, require_same_units
from hyst.identification.result.identified import Identified
from hyst.identification.result.identified_from_fit import identified_from_fit, traced
from hyst.identification.search import Found, find
from hyst.identification.stream.identify_stream import UNTIL_FIT_OF_ALL, identify_stream
from hyst.operators import Driver, Operator
from hyst.operators.provenance import options_asked
from hyst.signals import Record, RecordStream


def identify(
    records: Record | Sequence[Record] | RecordStream | ArrayLike,
    y: ArrayLike | None = None,
    *,
    dt: float | None = None,
    family: str | Family = "auto",
    delay: float | Literal["auto"] = "auto",
    start: int | Literal["auto"] = "auto",
    drift: Literal["auto", False] = "auto",
    creep: int | Literal["auto"] | None = "auto",
    lag: float | Literal["auto"] | None = None,
    validation: Record | Sequence[Record] = (),
    driver: Driver | None = None,
    max_iterations: int = 200,
    allow_unconverged: bool = False,
    progress: Callable[[Step], object] | None = None,
    **options: Any,
) -> Identified:
    """Identify a model of a family, or choose among families, from records.

    Families are in ``hyst.families``, each with its words and options: ``linear``, ``pi``, ``gpi``,
    ``mpi``, ``ramberg-osgood``, ``rdpi``, ``hammerstein`` and more.

    Parameters
    ----------
    records
        One or more records of one actuator, each with its own memory and its own sample time; with
        dynamics one that divides them all is taken. What ``hyst.diagnose`` finds in them is acted
        on: samples that are no measurements do not count. A record that stays in its file, as of
        ``hyst.io.open_record``: the constants are fitted to all of its samples, what else there is
        to find on half a million of them. Or the input u of one record, shape (N,), with ``y`` and
        ``dt``.
    y
        Output, shape (N,), finite, where ``records`` is an input.
    dt
        Time between these samples, s, > 0. Names and units have records only.
    family
        A name; several with commas between them, which are compared by cross-validation, the
        simplest that it does not show to be worse than the best being taken; ``"auto"``: those that
        suit most actuators, and, unless options are given, those of materials of other kinds where
        the first leave more than noise; or a family with its options, as
        ``hyst.families.RateDependent(spacing="free")``.
    delay
        Samples by which the output lags the input, parts of one included and negative where it is
        ahead, or ``"auto"``: 0 unless the records exclude it. The model is identified without it;
        ``Identified.predict`` adds it. With dynamics it is part of the model, and whole.
    start
        First sample to use. ``"auto"``: the first at which the memory is known whatever was before,
        because the input has passed its range; all samples with no memory before them if that would
        leave less than half of the record.
    drift
        ``"auto"``: slow drift of the output, and sines in it that are none of its drive, as mains
        hum, are taken out before the fit where ``hyst.diagnose`` finds them; ``False``: the output
        is left as it is.
    creep
        Number of first-order lags that follow the output of the hysteresis and add to it, 1 to 5;
        ``"auto"``: as many as the records pay for, none unless what the model leaves shows them
        beyond drift, noise and loops of another shape; ``None``: none. What settles since a
        record began, or drifts whatever the drive does, is no creep. With dynamics after it a
        number only: ``"auto"`` looks for none.
    lag
        Time constant, s, of a first-order lag of the drive before the hysteresis, as of an
        amplifier: it is a stage of the model then, which its inverse undoes. ``"auto"``: estimated
        where the records show a lag, and told from a pure delay where they can; a number: held;
        None: the model has none, and what comes late is the delay beside it.
    validation
        Records to judge the model by; they do not take part in the fit.
    driver
        Table of the drive's converter, where the input of all these records is in its codes: they
        are made volts before anything else, the model is one from volts, and its description keeps
        the driver.
    max_iterations
        Of the final fit, for each of its starts.
    allow_unconverged
        Give the result with its status instead of raising if the fit did not converge.
    progress
        Called before each step with words for it, as ``"delay"`` or ``"final fit: pi with 4
        plays"``: a string whose ``share``, 0 to 1, says how much of the way is behind. The steps
        are diagnosis, delay, each size of each family, the final fit, lag and creep where they are
        looked for, and the verdict. What it raises ends the search and reaches the caller, with
        nothing left behind; it is called between fits, not inside one. The result does not depend
        on it.
    **options
        Options of the families that are named, as ``plays=4`` or ``memory="last-reversal"``; each
        goes to those that have it. ``help(hyst.families.RambergOsgood)`` explains them.

    Returns
    -------
    Identified

    Raises
    ------
    InputError
        If an argument or a record cannot be used, ``y`` comes without ``dt`` or either with a
        record, a family is not known, or an option is of none of the families that are named.
    NotIdentifiableError
        If input or output is constant, the input does not turn or the output is noise, or there are
        fewer samples than parameters.
    SolverError
        If the fit did not converge and ``allow_unconverged`` is false.

    Examples
    --------
    >>> import numpy as np, hyst
    >>> u = np.sin(np.linspace(0.0, 20.0, 2000)) * np.linspace(1.0, 0.5, 2000)
    >>> true = hyst.PrandtlIshlinskii(p=[0.5, 0.3], r=[0.1, 0.3], p0=1.0)
    >>> found = hyst.identify(hyst.Record(u, true(u), dt=1e-3), family="pi", plays=2)
    >>> bool(np.abs(found.model(u) - true(u))[500:].max() < 1e-6)
    True
    >>> hyst.identify(u, true(u), dt=1e-3, family="pi", plays=2).model == found.model
    True
    """
    arguments = {name: each for name, each in locals().items() if name in _KEYWORDS}
    say, source = Progress(progress or silent), records_of(records, y, dt)
    if isinstance(source, RecordStream):
        arguments["progress"] = say.part(0.0, UNTIL_FIT_OF_ALL)
        return identify_stream(source, partial(identify, **arguments, **options), say)
    asked = options_asked(identify, arguments | {"driver": None}) | options
    measured = listed(source)
    given = all_in_volts(measured, driver)
    judged = all_in_volts(listed(validation, "validation record"), driver)
    require_same_units((*given, *judged))
    wanted = Options(judged, say, delay, start, max_iterations, allow_unconverged)
    families, about_drift = chosen_families(family, options), as_drift(drift)
    families, lags = creeping_inside(families, as_creep(creep))
    require_place(families, lags)
    reserve = families_in_reserve(family, options)
    say("diagnosis")
    with one_blas_thread():
        diagnosis = diagnose_all_but_delay(given)
        reserve = tuple(each for each in reserve if _is_called_for(each, diagnosis))
        clean = cleaned(given, diagnosis, about_drift)
        search = _Search(clean, families, as_lag(lag), lags, about_drift == "auto", wanted)
        creeping = search.best(reserve)
        found = creeping.found
        diagnosis = creeping.judged(diagnosis, given)
        _require_possible(found.fit.operator, judged)
        if found.delay is not None:
            diagnosis = diagnosis.with_delay(found.delay, given[0].dt)  # the same in any unit
        say("verdict")
        identified = _identified(found, judged, diagnosis)
        used = found.fit.family.records_to_use(given, start)[0]
        identified = replace(creeping.told(identified), records=used.records)
        told = found.fit.family.result(identified, found.fit, Overview(found.data, delay))
    return with_driver(traced(told, measured, asked), driver)


def _identified(found: Found, judged: Sequence[Record], diagnosis: Diagnosis) -> Identified:
    """Judge what was found, on its own records and on those of validation."""
    return identified_from_fit(
        found.data,
        found.fit,
        found.candidates,
        beside_level(judged, found.data),
        found.notes,
        diagnosis,
        [each.operator for each in found.rivals],
        found.delay,
    )


def _require_possible(model: Operator, judged: Sequence[Record]) -> None:
    """Refuse validation records of a sample time that the model cannot have."""
    for number, record in enumerate(judged, 1):
        model.require_possible_time(record.dt, f"validation record {number}")


_KEYWORDS = frozenset(identify.__kwdefaults__ or ()) - {"dt"}
"""Arguments of ``identify`` but for what makes the records, and the options of families."""


@dataclass(frozen=True, eq=False)
class _Search:
    """One way to search records: for families, with lag, creep and drift as asked for."""

    records: Cleaned
    families: Sequence[Family]
    lag: Lagging
    creep: Creeps
    drifts: bool
    wanted: Options

    def best(self, reserve: Sequence[Family]) -> Creeping:
        """Give the best, with creep before families in reserve: they take up what is creep."""
        if self.creep is None or not reserve:
            return self.among(reserve)
        first = self.among(())
        return first if first.leaves_noise() else first.or_better(self.among(reserve))

    def among(self, reserve: Sequence[Family]) -> Creeping:
        """Give the best with these families in reserve."""

        def without_lag(records: Cleaned, asked_of: Options) -> Found:
            return find(records, self.families, asked_of, reserve)

        with_lag = self.lag, self.wanted, self.families
        found = found_with_lag(without_lag, self.records, *with_lag)
        again, how = search_beside_lag(without_lag, found, *with_lag)
        drifting = self.records.with_drift()
        return with_creep(found, drifting, self.creep, self.drifts, again, how)


def _is_called_for(family: Family, diagnosis: Diagnosis) -> bool:
    """Tell whether a family in reserve is for any records, or for such as these are found to be."""
    asked = family.in_reserve
    return not isinstance(asked, str) or bool(diagnosis.named(asked))
