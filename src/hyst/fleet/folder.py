"""The folder of a fleet: models, a journal of what is done, and what was asked for.

A device is done once its line is in the journal, and its model is written whole before that. So a
run that was interrupted, anywhere, is gone on with by running it again.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import quote

import hyst
from hyst._files import read_small, replacing, require_folder
from hyst.errors import InputError
from hyst.fleet.choice import Choice
from hyst.fleet.device import Device
from hyst.fleet.sources import Measurement

STATE, JOURNAL, MODELS = "fleet.json", "journal.jsonl", "models"
FORMAT, VERSION = "hyst fleet", 1

_MOST_BYTES = 200
_MOST_OF_A_STATE = 2_000_000_000


class FullDiskError(OSError):
    """What is done could not be written; what was written before is kept."""


@dataclass(frozen=True, eq=False)
class Entry:
    """A line of the journal.

    Parameters
    ----------
    fingerprint
        Of the data.
    device
        What came of them, without its model.
    """

    fingerprint: str
    device: Device


class ResultFolder:
    """The folder that a fleet is written to while it is identified.

    Parameters
    ----------
    path
        The folder; made if it is not there.

    Raises
    ------
    InputError
        If it is a file.
    """

    def __init__(self, path: Path) -> None:
        require_folder(path)
        self.path = path

    def model_file(self, identifier: str) -> Path:
        """Give the file of the model of a device."""
        return self.path / MODELS / f"{file_name(identifier)}.json"

    def read_state(self) -> dict[str, Any] | None:
        """Give what was asked for and chosen by the run before; None if there was none.

        Raises
        ------
        InputError
            If the file is of another kind or version, or damaged.
        """
        file = self.path / STATE
        if not file.exists():
            return None
        try:
            state = json.loads(read_small(file, _MOST_OF_A_STATE))
        except ValueError as error:
            raise InputError(f"{file} is damaged ({error}); write to another folder") from None
        if not isinstance(state, dict) or state.get("format") != FORMAT:
            raise InputError(f"{file} is no fleet of hyst; write to another folder")
        if state.get("version") != VERSION:
            raise InputError(
                f"{file} is of version {state.get('version')!r}, and this hyst reads {VERSION}; "
                "write to another folder"
            )
        return state

    def write_state(self, state: Mapping[str, Any]) -> None:
        """Write what was asked for and chosen."""
        whole = {"format": FORMAT, "version": VERSION, "hyst": hyst.__version__, **state}
        text = json.dumps(whole, indent=2, allow_nan=False, ensure_ascii=False)
        with replacing(self.path / STATE) as temporary:
            temporary.write_text(text + "\n", encoding="utf-8")

    def begin_anew(self) -> None:
        """Forget what an earlier run did; its models are replaced one by one."""
        for name in (STATE, JOURNAL, "shape.json"):
            (self.path / name).unlink(missing_ok=True)

    def entries(self) -> dict[str, Entry]:
        """Give what is done, by identifier; the last line of a device counts, half a line does not.

        Raises
        ------
        InputError
            If a line is of another version.
        """
        file, found = self.path / JOURNAL, dict[str, Entry]()
        if not file.exists():
            return found
        content = read_small(file, _MOST_OF_A_STATE)
        whole = content[: content.rfind(b"\n") + 1]
        if len(whole) < len(content):
            # What a full disk or a killed run has left would spoil the next line.
            with file.open("r+b") as journal:
                journal.truncate(len(whole))
        for line in whole.splitlines():
            try:
                told = json.loads(line)
                fingerprint = told.pop("fingerprint")
            except (ValueError, KeyError, AttributeError):
                continue  # torn by a disk that was full: the device is done again
            device = Device.from_dict(told)
            found[device.identifier] = Entry(fingerprint, device)
        return found

    def is_done(self, entry: Entry | None, measurement: Measurement) -> bool:
        """Tell whether a device need not be done again.

        Parameters
        ----------
        entry
            Its line in the journal, if there is one.
        measurement
            Its data now.
        """
        if entry is None or not entry.fingerprint or not entry.device.is_final:
            return False
        if entry.fingerprint != measurement.fingerprint():
            return False
        return bool(entry.device.failure) or self.model_file(measurement.identifier).exists()

    def keep(self, device: Device, fingerprint: str) -> None:
        """Write a device: first its model, then its line in the journal.

        Parameters
        ----------
        device
            With its model, if it has one.
        fingerprint
            Of its data.

        Raises
        ------
        FullDiskError
            If that fails.
        """
        told = {"fingerprint": fingerprint, **device.to_dict()}
        line = json.dumps(told, allow_nan=False, ensure_ascii=False) + "\n"
        try:
            if device.model is not None:
                device.model.save(self.model_file(device.identifier))
            with (self.path / JOURNAL).open("a", encoding="utf-8") as journal:
                journal.write(line)
        except OSError as error:
            why = error.strerror or str(error)
            raise FullDiskError(
                f"{device.identifier} could not be written to {self.path}: {why}; what was done "
                "before is kept: make room, and run the same again to go on"
            ) from error


def file_name(identifier: str) -> str:
    """Give an identifier as the name of a file on any system, different ones differently.

    Parameters
    ----------
    identifier
        Of a device.
    """
    return quote(identifier, safe=" +,=@()")


def require_file_names(identifiers: Sequence[str]) -> None:
    """Refuse identifiers whose files some systems cannot have or tell apart.

    Parameters
    ----------
    identifiers
        Of the devices.

    Raises
    ------
    InputError
        If one is too long, or two differ in capitals only.
    """
    seen = dict[str, str]()
    for each in identifiers:
        if len(file_name(each)) > _MOST_BYTES:
            raise InputError(
                f"the identifier {each[:40]!r}... is too long for the name of a file; shorten it"
            )
        other = seen.setdefault(each.casefold(), each)
        if other != each:
            raise InputError(
                f"identifiers {other!r} and {each!r} differ in capitals only, which names of "
                "files on some systems do not; name one otherwise"
            )


def choice_to_dict(choice: Choice) -> dict[str, Any]:
    """Give a choice as values of JSON."""
    return {**vars(choice), "sentences": list(choice.sentences)}


def choice_from_dict(data: Any) -> Choice:
    """Rebuild a choice from ``choice_to_dict``.

    Raises
    ------
    InputError
        If an entry is missing or unknown.
    """
    try:
        return Choice(**{**data, "sentences": tuple(data["sentences"])})
    except (TypeError, KeyError) as error:
        raise InputError(f"the choice in {STATE} is damaged ({error}); use --force") from None
