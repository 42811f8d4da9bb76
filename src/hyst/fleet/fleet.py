"""What a fleet came to: models, a table, the odd ones and the failures."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hyst._loading import load
from hyst.errors import InputError
from hyst.fleet.choice import Choice
from hyst.fleet.device import Device
from hyst.fleet.folder import (
    STATE,
    ResultFolder,
    choice_from_dict,
    choice_to_dict,
    require_file_names,
)
from hyst.fleet.limits import as_limits
from hyst.fleet.outliers import Judged, Outlier, judge_fleet
from hyst.fleet.table import FAIL, PASS, FleetTable, table_of
from hyst.fleet.table_files import CSV, PARQUET, write_csv, write_parquet
from hyst.operators import Operator

Limits = Mapping[str, tuple[float | None, float | None]]


class Models(Mapping[str, Operator]):
    """Models by identifier; those that are in a folder are read when they are asked for.

    Parameters
    ----------
    models
        An operator or a file by identifier.
    """

    def __init__(self, models: Mapping[str, Operator | Path]) -> None:
        self._models = dict(models)

    def __getitem__(self, identifier: str) -> Operator:
        found = self._models[identifier]
        return found if isinstance(found, Operator) else load(found)

    def __iter__(self) -> Iterator[str]:
        return iter(self._models)

    def __len__(self) -> int:
        return len(self._models)


@dataclass(frozen=True, eq=False, repr=False)
class Fleet:
    """Many devices, each with its model, or with what is wrong with its record.

    Parameters
    ----------
    devices
        In the order of the records.
    choice
        Family, size, delay and creep that hold for all of them, and how they were chosen.
    limits
        Production limits of each device that has any, by identifier.
    judged
        Which devices are odd.
    table
        A row for each device: see ``docs/fleet.md``.
    models
        Operators by identifier, of all devices that have one.
    asked
        What was asked for, to tell whether a run goes on with another one.
    """

    devices: tuple[Device, ...]
    choice: Choice
    limits: Mapping[str, Limits]
    judged: Judged
    table: FleetTable
    models: Models
    asked: Mapping[str, Any]

    @property
    def outliers(self) -> tuple[Outlier, ...]:
        """Devices that are odd against the others, the oddest first."""
        return self.judged.outliers

    @property
    def failures(self) -> dict[str, str]:
        """A sentence for every device without a model, by identifier."""
        return {each.identifier: each.failure for each in self.devices if each.failure}

    @property
    def passed(self) -> bool | None:
        """Whether every device keeps its limits; None where no device has any."""
        told = [each for each in self.table["limits"] if each]
        return all(each == PASS for each in told) if told else None

    def counts(self) -> dict[str, int]:
        """Give how many devices there are, failed, are odd, of each verdict, and pass limits."""
        verdicts = Counter(each.verdict for each in self.devices if not each.failure)
        limits = Counter(self.table["limits"])
        return {
            "devices": len(self.devices),
            "failed": len(self.failures),
            "odd": len(self.outliers),
            **{level: verdicts[level] for level in ("good", "fair", "unfit")},
            PASS: limits[PASS],
            FAIL: limits[FAIL],
        }

    def sentences(self) -> tuple[str, ...]:
        """Say what was done and what came of it."""
        told = self.counts()
        done = (
            f"{told['devices']} devices: {told['good']} good, {told['fair']} fair, "
            f"{told['unfit']} unfit, {told['failed']} without a model."
        )
        limits = () if self.passed is None else (f"Limits: {told[PASS]} pass, {told[FAIL]} fail.",)
        many = told["fair"] + told["unfit"]
        doubt = (
            (
                f"{many} of them are not good: if what they leave is shape (see the sentences in "
                "the table), give --family or --plays for a richer model.",
            )
            if 4 * many > told["devices"] - told["failed"] > 0
            else ()
        )
        return (done, *self.choice.sentences, *doubt, self.judged.sentence, *limits)

    def summary(self) -> str:
        """Give what came of it for people, the odd ones and the failures by name."""
        lines = list(self.sentences())
        lines += [f"odd: {each.identifier}: {'; '.join(each.reasons)}" for each in self.outliers]
        lines += [f"failed: {name}: {sentence}" for name, sentence in self.failures.items()]
        return "\n".join(lines)

    def __repr__(self) -> str:
        return f"Fleet({self.sentences()[0]!r})"

    def save(self, folder: str | os.PathLike[str]) -> tuple[Path, ...]:
        """Write models, table and state into a folder, from which ``load`` and a next run read.

        Parameters
        ----------
        folder
            Made if it is not there.

        Returns
        -------
        tuple of pathlib.Path
            The table as CSV, as Parquet where pyarrow is installed, and the state.

        Raises
        ------
        InputError
            If it is a file, or identifiers can be no names of files.
        """
        require_file_names([each.identifier for each in self.devices])
        there = ResultFolder(Path(folder))
        there.begin_anew()
        for each in self.devices:
            model = self.models.get(each.identifier)
            there.keep(Device.from_dict(each.to_dict(), model), "")
        return self.write_tables(there)

    def write_tables(self, folder: ResultFolder) -> tuple[Path, ...]:
        """Write the table and the state; models and journal are there already.

        Parameters
        ----------
        folder
            Of the fleet.
        """
        limits = {
            name: {q: list(pair) for q, pair in own.items()} for name, own in self.limits.items()
        }
        order = [each.identifier for each in self.devices]
        state = {"asked": self.asked, "choice": choice_to_dict(self.choice)}
        folder.write_state({**state, "limits": limits, "order": order})
        write_csv(self.table, folder.path / CSV)
        written = [folder.path / CSV]
        if write_parquet(self.table, folder.path / PARQUET):
            written.append(folder.path / PARQUET)
        return (*written, folder.path / STATE)

    @classmethod
    def load(cls, folder: str | os.PathLike[str]) -> Fleet:
        """Read a fleet back that ``save`` or a run with a folder wrote.

        Parameters
        ----------
        folder
            Of the fleet.

        Raises
        ------
        InputError
            If there is none, it is not complete, or of another version.
        """
        there = ResultFolder(Path(folder))
        state = there.read_state()
        if state is None:
            raise InputError(
                f"{folder} holds no fleet: it has no {STATE}; give a folder of hyst fleet"
            )
        entries = there.entries()
        missing = [each for each in state.get("order", ()) if each not in entries]
        if missing or "order" not in state:
            raise InputError(f"the fleet in {folder} is not complete; run hyst fleet again first")
        devices = tuple(entries[each].device for each in state["order"])
        models = {e.identifier: there.model_file(e.identifier) for e in devices if not e.failure}
        limits = {name: as_limits(own) for name, own in state["limits"].items()}
        choice = choice_from_dict(state["choice"])
        return fleet_of(devices, choice, limits, models, state["asked"])


def fleet_of(
    devices: Sequence[Device],
    choice: Choice,
    limits: Mapping[str, Limits],
    models: Mapping[str, Operator | Path],
    asked: Mapping[str, Any],
) -> Fleet:
    """Judge the devices of a fleet against each other and against their limits.

    Parameters
    ----------
    devices, choice, limits, models, asked
        As of ``Fleet``.
    """
    judged = judge_fleet(devices)
    table = table_of(devices, judged, limits, (choice.input_unit, choice.output_unit))
    return Fleet(tuple(devices), choice, limits, judged, table, Models(models), asked)
