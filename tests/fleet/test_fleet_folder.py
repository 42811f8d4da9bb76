"""The folder of a fleet: what is done is kept, and not done again."""

from __future__ import annotations

import csv
import errno
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hyst
import hyst.fleet.folder
from fleet.lots import CHEAP, Fails, lot
from hyst.fleet import Fleet
from hyst.operators import Operator


@dataclass(frozen=True)
class Counted:
    """A source that writes down every time it is loaded, as a fit does."""

    identifier: str
    record: hyst.Record
    log: Path
    version: str = "1"

    def load(self) -> hyst.Record:
        with self.log.open("a") as log:
            log.write(f"{self.identifier}\n")
        return self.record

    def fingerprint(self) -> str:
        return self.version


def sources(log: Path, count: int = 6, version: str = "1") -> list[Counted]:
    log.write_text("")
    return [Counted(name, each, log, version) for name, each in lot(count).items()]


def loads(log: Path) -> list[str]:
    return sorted(log.read_text().split())


def run(records: Any, folder: Path, **options: Any) -> Fleet:
    options = {"scheduler": "threads", "workers": 1, **CHEAP, **options}
    return hyst.fleet.identify(records, folder=folder, **options)


def test_what_is_done_is_not_done_again(tmp_path: Path) -> None:
    log, out = tmp_path / "log", tmp_path / "out"
    first = run(sources(log), out)
    assert set(loads(log)) == set(lot(6))
    more = sources(log, 7)
    second = run(more, out)
    assert loads(log) == ["D06"]
    for name in first.models:
        assert second.models[name] == first.models[name]
    np.testing.assert_array_equal(second.table["gain"][:6], first.table["gain"])


def test_other_data_is_done_again_and_other_options_are_refused(tmp_path: Path) -> None:
    log, out = tmp_path / "log", tmp_path / "out"
    run(sources(log, 2), out)
    run(sources(log, 2, version="2"), out)
    assert loads(log) == ["D00", "D01"]
    with pytest.raises(hyst.InputError, match=r"other options \(plays\)"):
        run(sources(log, 2), out, plays=3)
    assert not run(sources(log, 2), out, plays=3, force=True).failures


def test_a_full_disk_is_one_sentence_and_the_next_run_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    log, out = tmp_path / "log", tmp_path / "out"
    saved, save = [], Operator.save

    def until_full(self: Operator, path: Path) -> None:
        if len(saved) == 3:
            raise OSError(errno.ENOSPC, "No space left on device")
        saved.append(path)
        save(self, path)

    monkeypatch.setattr(Operator, "save", until_full)
    with pytest.raises(OSError, match="No space left on device; what was done before is kept"):
        run(sources(log), out)
    monkeypatch.setattr(Operator, "save", save)
    with (out / "journal.jsonl").open("a") as journal:
        journal.write('{"fingerprint": "1", "identi')  # as a full disk leaves it
    done = [path.stem for path in saved]
    log.write_text("")
    fleet = run(sources(log), out)
    assert not set(loads(log)) & set(done)
    assert len(fleet.models) == 6
    assert len(Fleet.load(out).devices) == 6


def test_a_fleet_is_read_back_as_it_was(tmp_path: Path) -> None:
    records: dict[str, Any] = {**lot(3), "=cmd|x/..": Fails("x"), "torn": Fails("torn", OSError)}
    limits = {"gain": (1.2, None)}
    fleet = hyst.fleet.identify(records, scheduler="threads", limits=limits, **CHEAP)
    written = fleet.save(tmp_path / "kept")
    again = Fleet.load(tmp_path / "kept")
    assert again.sentences() == fleet.sentences()
    assert again.failures == fleet.failures
    assert [again.models[name] == fleet.models[name] for name in fleet.models] == [True] * 3
    assert {"fleet.csv", "fleet.json"} <= {each.name for each in written}
    for name in fleet.table.names:
        np.testing.assert_array_equal(again.table[name], fleet.table[name])


def test_table_holds_units_and_no_formula(tmp_path: Path) -> None:
    records: dict[str, Any] = {**lot(1), "=cmd()": Fails("x")}
    fleet = hyst.fleet.identify(records, scheduler="threads", **CHEAP)
    fleet.save(tmp_path)
    with (tmp_path / "fleet.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert rows[1]["identifier"] == "'=cmd()"
    assert rows[1]["gain"] == ""
    assert float(rows[0]["hysteresis_percent [%]"]) == fleet.table["hysteresis_percent"][0]
    parquet = pytest.importorskip("pyarrow.parquet")
    table = parquet.read_table(tmp_path / "fleet.parquet")
    assert table["identifier"].to_pylist() == ["D00", "=cmd()"]
    assert table["gain"].to_pylist() == [fleet.table["gain"][0], None]
    assert table.schema.field("rms_percent").metadata[b"unit"] == b"%"


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("{", "damaged"),
        ("[]", "no fleet of hyst"),
        (json.dumps({"format": "hyst fleet", "version": 99}), "version 99"),
    ],
)
def test_a_folder_of_something_else_is_refused(tmp_path: Path, content: str, said: str) -> None:
    (tmp_path / "fleet.json").write_text(content)
    with pytest.raises(hyst.InputError, match=said):
        Fleet.load(tmp_path)
    with pytest.raises(hyst.InputError, match="holds no fleet"):
        Fleet.load(tmp_path / "nothing")


def test_identifiers_that_no_file_tells_apart_are_refused(tmp_path: Path) -> None:
    records = dict(zip(("a", "A"), lot(2).values(), strict=True))
    with pytest.raises(hyst.InputError, match="differ in capitals"):
        run(records, tmp_path)
