"""Loops wired from the parts of a design, for tests of Q-filters."""

from __future__ import annotations

from typing import Any

import control
from hyst.control import QFilterObserver


def as_control(system: Any) -> Any:
    return control.ss(system.A, system.B, system.C, system.D)


def loop_by_control(design: QFilterObserver, plant: Any) -> Any:
    """Observer, controller and a plant wired by python-control: from d and n to v and d_hat."""
    observer, C = as_control(design.observer), as_control(design.controller)
    blocks = [
        control.ss(observer, inputs=["v", "ym"], outputs=["dhat"], name="observer"),
        control.ss(C, inputs=["e"], outputs=["u"], name="C"),
        control.ss(plant, inputs=["w"], outputs=["y"], name="plant"),
        control.summing_junction(["u", "-dhat"], "v", name="sum_v"),
        control.summing_junction(["v", "d"], "w", name="sum_w"),
        control.summing_junction(["y", "n"], "ym", name="sum_y"),
        control.summing_junction(["-ym"], "e", name="sum_e"),
    ]
    return control.interconnect(blocks, inputs=["d", "n"], outputs=["v", "dhat", "w"])
