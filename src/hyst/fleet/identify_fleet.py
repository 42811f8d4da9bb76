"""Identify many devices: one family for all, one model each."""

from __future__ import annotations

import inspect
import itertools
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import hyst
from hyst.errors import InputError
from hyst.fleet.choice import (
    LOOKED_AT,
    MOST_TRIED,
    Choice,
    Look,
    choose,
    look_at,
    spread_order,
    units_only,
)
from hyst.fleet.device import Device
from hyst.fleet.device_fit import Settled, failed, fit_device
from hyst.fleet.fleet import Fleet, fleet_of
from hyst.fleet.folder import (
    Entry,
    ResultFolder,
    choice_from_dict,
    choice_to_dict,
    require_file_names,
)
from hyst.fleet.limits import as_limits
from hyst.fleet.running.choose import PROCESSES, THREADS, running_on
from hyst.fleet.running.jobs import Run
from hyst.fleet.running.processes import NoProcessesError
from hyst.fleet.shape_of_fleet import SHARED_TOLD, as_shape, estimated_shape, to_start_from
from hyst.fleet.sources import Measurement, measurements_of
from hyst.identification import chosen_families
from hyst.identification.families.family import Family
from hyst.operators import Operator
from hyst.operators.plain_data import as_plain

Say = Callable[[str], None]

_GENERAL = set(inspect.signature(hyst.identification.identify).parameters) - {"options"}
"""Options of ``hyst.identify`` that are of no family."""

_NOT_HERE = ("records", "validation", "driver", "progress")


def identify(
    records: Any,
    *,
    shape: Any = None,
    scheduler: Any = PROCESSES,
    family: str | Family = "auto",
    identifiers: Sequence[str] | None = None,
    limits: Mapping[str, Any] | None = None,
    folder: str | os.PathLike[str] | None = None,
    force: bool = False,
    workers: int | None = None,
    progress: Say | None = None,
    **options: Any,
) -> Fleet:
    """Identify one model for each of many devices, and say which devices are odd.

    Family, size, delay and number of creeping lags are chosen once, on up to 16 records spread over
    the fleet: the simplest family and size whose pooled error on left-out blocks is not shown to be
    worse than the best, the records it suits worst left aside. What is given is not chosen.

    Parameters
    ----------
    records
        One record a device: a list of ``hyst.Record``, or of objects with ``identifier`` and
        ``load()`` that gives one (``MeasurementSource``), or a mapping of identifiers to either.
    shape
        A shape that all devices share, so that each needs few samples: ``"shared"``, estimated from
        up to 200 records of this fleet; a ``SharedShape`` of another one; a model, whose shape is
        held. None: each device has its own.
    scheduler
        ``"processes"``; ``"threads"``, which hardly share the work, as most of it is Python;
        ``"dask"``, a cluster made here for this run; ``"tcp://HOST:PORT"`` or a client of
        ``dask.distributed``. In a script, processes need its main part guarded by ``if __name__ ==
        "__main__":``; without it threads are taken.
    family
        As of ``hyst.identify``.
    identifiers
        Names of the devices in the order of records; by default those of the sources, else numbers.
    limits
        Production limits by quantity, as ``{"rms_percent": (None, 0.5)}``; ``"parameter NAME"``
        limits a parameter. Sources may have their own, in ``limits``.
    folder
        Where models, table and journal are written as they come. What is done there already, of
        the same data with the same options, is not done again.
    force
        Begin anew in a folder that holds a fleet with other options.
    workers
        Processes or threads; by default one a core.
    progress
        Called with a line of text as the work goes on.
    **options
        Of ``hyst.identify``, as ``plays=4``, ``delay=0`` or ``creep=None``.

    Returns
    -------
    Fleet
        A device whose record cannot be used is among its ``failures``; it stops nothing.

    Raises
    ------
    InputError
        If there is no record, identifiers are given twice, an option, a limit or the scheduler is
        not known, or the folder holds a fleet of other options.
    MissingExtraError
        If a cluster is asked for without dask.distributed.
    OSError
        If the cluster does not answer, or the disk is full: what is done is kept.

    Examples
    --------
    >>> import numpy as np, hyst
    >>> u = np.sin(np.linspace(0.0, 20.0, 300)) * np.linspace(1.0, 0.5, 300)
    >>> models = [hyst.PrandtlIshlinskii([0.5], [0.2], 1.0 + 0.01 * k) for k in range(3)]
    >>> records = {f"unit {k}": hyst.Record(u, each(u), 1e-3) for k, each in enumerate(models)}
    >>> found = identify(records, family="pi", plays=1, scheduler="threads", delay=0, creep=None)
    >>> found.counts()["good"], f"{found.table.row('unit 2')['gain']:.3f}"
    (3, '1.412')
    """
    for each in _NOT_HERE:
        if each in options:
            raise InputError(f"{each} is no option of a fleet; leave it out")
    measured = measurements_of(records, identifiers)
    own_limits = _limits(measured, as_limits(limits))
    chosen_families(family, {k: v for k, v in options.items() if k not in _GENERAL})
    shape = as_shape(shape)
    asked = {"family": family, **options}
    there = None if folder is None else ResultFolder(Path(folder))
    kept, choice = _resumed(there, measured, _asked(asked, shape), force)
    work = _Work(asked, shape, progress or _say_nothing, there, kept)
    try:
        with running_on(scheduler, workers) as run:
            return work.done(run, measured, choice, own_limits)
    except NoProcessesError as refusal:
        work.say(f"{refusal}; threads are used")
    with running_on(THREADS, workers) as run:
        return work.done(run, measured, choice, own_limits)


@dataclass(frozen=True, eq=False)
class _Work:
    """What is asked of every device, and what is done already."""

    asked: Mapping[str, Any]
    shape: Any
    say: Say
    folder: ResultFolder | None
    kept: dict[str, Device]

    def done(
        self,
        run: Run,
        measured: Sequence[Measurement],
        choice: Choice | None,
        limits: Mapping[str, Any],
    ) -> Fleet:
        """Choose for all, fit each, and compare."""
        asked = _asked(self.asked, self.shape)
        if choice is None:
            choice = self._chosen(run, measured)
            if self.folder is not None:
                self.folder.write_state({"asked": asked, "choice": choice_to_dict(choice)})
        for each in choice.sentences:
            self.say(each)
        settled = _settled(self.asked, choice)
        if isinstance(self.shape, str):
            self.say("shape")
            start = to_start_from(settled, self.asked)
            shared = estimated_shape(measured, start, self.folder)
            settled = replace(settled, shape=shared)
            if start is not settled and SHARED_TOLD not in choice.sentences:
                choice = replace(choice, sentences=(*choice.sentences, SHARED_TOLD))
        elif self.shape is not None:
            settled = replace(settled, shape=self.shape)
        devices = dict(self.kept)
        models: dict[str, Operator | Path] = {}
        for device in self._fitted(run, measured, settled):
            if device.model is not None:
                models[device.identifier] = device.model
            # In a folder are the models, and memory is for the numbers.
            devices[device.identifier] = replace(device, model=None)
        if self.folder is not None:
            models = {
                name: self.folder.model_file(name)
                for name, each in devices.items()
                if not each.failure
            }
        order = [devices[each.identifier] for each in measured]
        fleet = fleet_of(order, choice, limits, models, asked)
        if self.folder is not None:
            fleet.write_tables(self.folder)
        return fleet

    def _chosen(self, run: Run, measured: Sequence[Measurement]) -> Choice:
        """Look at records until as many as are wanted could be used."""
        options = self._options_to_choose_with()
        order = iter(spread_order(len(measured))[:MOST_TRIED])
        looks: list[Look] = []
        while missing := LOOKED_AT - sum(not each.failure for each in looks):
            batch = [measured[k] for k in itertools.islice(order, missing)]
            if not batch:
                break
            self.say(f"looking at {len(batch)} of {len(measured)} records")
            jobs = ((each.identifier, (each, options)) for each in batch)
            for done in run(look_at, jobs):
                looks.append(done.value or Look(done.name, done.failure))
        looks.sort(key=lambda each: each.identifier)
        if options is None:
            given = "as the shape given has it" if self.shape is not None else "as asked for"
            return units_only(looks, f"Family and size are {given}.")
        return choose(looks, len(measured), self.asked)

    def _options_to_choose_with(self) -> Mapping[str, Any] | None:
        """Give what records are looked at with; None where there is nothing to choose."""
        if self.shape is not None and not isinstance(self.shape, str):
            return None
        families = chosen_families(
            self.asked["family"], {k: v for k, v in self.asked.items() if k not in _GENERAL}
        )
        is_given = len(families) == 1 and len(families[0].sizes()) == 1
        return None if is_given and {"delay", "creep"} <= set(self.asked) else self.asked

    def _fitted(
        self, run: Run, measured: Sequence[Measurement], settled: Settled
    ) -> Iterator[Device]:
        """Fit what is not done, and keep each as it comes."""
        missing = [each for each in measured if each.identifier not in self.kept]
        by_name = {each.identifier: each for each in missing}
        failures, total = 0, len(measured)
        if len(missing) < total:
            self.say(f"{total - len(missing)} of {total} devices are done already")
        jobs = ((each.identifier, (each, settled)) for each in missing)
        for number, done in enumerate(run(fit_device, jobs), total - len(missing) + 1):
            device = done.value
            if device is None:
                device = failed(by_name[done.name], done.failure, is_final=False)
            if self.folder is not None:
                self.folder.keep(device, by_name[done.name].fingerprint())
            failures += bool(device.failure)
            self.say(f"{number} of {total} devices, {failures} failed")
            self.kept[device.identifier] = replace(device, model=None)
            yield device


def _settled(asked: Mapping[str, Any], choice: Choice) -> Settled:
    """Give what every device is fitted with."""
    options = dict(asked)
    if choice.family:
        if not isinstance(options["family"], Family):
            options = _for_family(options, choice)
        if "creep" not in asked:
            options["creep"] = choice.creep
    return Settled(options, choice.delay, None, choice.input_unit, choice.output_unit)


def _for_family(options: dict[str, Any], choice: Choice) -> dict[str, Any]:
    """Give the options with the family chosen, and without those of others that were compared."""
    takes = hyst.families.option
    own = {
        name: value
        for name, value in options.items()
        if name in _GENERAL or takes(choice.family, name) is not None
    }
    own["family"] = choice.family
    if choice.plays is not None and takes(choice.family, "plays") is not None:
        own["plays"] = choice.plays
    return own


def _limits(measured: Sequence[Measurement], common: Mapping[str, Any]) -> dict[str, Any]:
    own = {
        each.identifier: {**common, **as_limits(each.limits, f"limits of {each.identifier}")}
        for each in measured
    }
    return {name: limits for name, limits in own.items() if limits}


def _asked(asked: Mapping[str, Any], shape: Any) -> dict[str, Any]:
    """Give what decides the result, as text, to compare runs by."""
    told = {name: _told(value) for name, value in sorted(asked.items())}
    if shape is not None:
        told["shape"] = repr(shape.to_dict()) if hasattr(shape, "to_dict") else repr(shape)
    return {"hyst": hyst.__version__, **told}


def _told(value: Any) -> Any:
    try:
        return as_plain("an option", value)
    except InputError:
        return repr(value)


def _resumed(
    folder: ResultFolder | None,
    measured: Sequence[Measurement],
    asked: Mapping[str, Any],
    force: bool,
) -> tuple[dict[str, Device], Choice | None]:
    """Give what is done in a folder already, and the choice it was done with."""
    if folder is None:
        return {}, None
    require_file_names([each.identifier for each in measured])
    if force:
        folder.begin_anew()
    state = folder.read_state()
    if state is None:
        folder.begin_anew()
        return {}, None
    if state.get("asked") != asked:
        before = state.get("asked")
        other = (
            [each for each in sorted({*asked, *before}) if asked.get(each) != before.get(each)]
            if isinstance(before, dict)
            else ["all"]
        )
        raise InputError(
            f"{folder.path} holds a fleet with other options ({', '.join(other)}); write to "
            "another folder, or begin anew with --force (force=True in Python)"
        )
    entries: dict[str, Entry] = folder.entries()
    kept = {
        each.identifier: replace(entries[each.identifier].device, file=each.file)
        for each in measured
        if folder.is_done(entries.get(each.identifier), each)
    }
    return kept, choice_from_dict(state["choice"])


def _say_nothing(_: str) -> None:
    """Tell nobody."""
