"""Fleets on a Dask cluster: a worker that is killed, one that always is, and nobody there."""

from __future__ import annotations

import socket
from pathlib import Path
from typing import Any

import pytest

import hyst
from fleet.lots import CHEAP, Kills, device, lot

distributed = pytest.importorskip("distributed")

pytestmark = pytest.mark.filterwarnings("default")


def test_workers_that_are_killed_cost_only_the_device_that_kills_them(tmp_path: Path) -> None:
    import dask

    records: dict[str, Any] = lot(2)
    records["once"] = Kills("once", device(50), str(tmp_path / "killed"))
    records["always"] = Kills("always")
    impatient = {"distributed.scheduler.allowed-failures": 0}
    quiet = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with (
        dask.config.set(impatient),
        distributed.LocalCluster(**quiet, silence_logs=50) as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
    ):
        options = {**CHEAP, "scheduler": client}
        fleet = hyst.fleet.identify(records, **options)
    assert (tmp_path / "killed").exists()
    assert list(fleet.failures) == ["always"]
    assert "died" in fleet.failures["always"]
    assert set(fleet.models) == set(lot(2)) | {"once"}


def test_a_scheduler_that_does_not_answer_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("hyst.fleet.running.cluster.SECONDS", 1)
    with socket.socket() as silent:
        silent.bind(("127.0.0.1", 0))
        port = silent.getsockname()[1]
        with pytest.raises(OSError, match="does not answer within 1 s"):
            hyst.fleet.identify(lot(2), **CHEAP, scheduler=f"tcp://127.0.0.1:{port}")
