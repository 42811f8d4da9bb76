"""A stage that is watched: its lines of measurement, its model, and what the program tells."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from command_runs import STAGE, Ended, describe

DT = 0.01
NOISE = 0.005
COLUMNS = ("--input", "drive", "--output", "stroke")
END = ("--stop-after", "at-end")
HEADER = "t [s],drive [V],stroke [um]\n"


def strokes(seconds: float, gain: float = 1.0, start: float = 0.0) -> list[str]:
    """Lines of full strokes of the stage, two a second, with a little noise."""
    t = np.arange(round(start / DT), round((start + seconds) / DT)) * DT
    u = 2.0 - 2.0 * np.cos(2.0 * np.pi * 2.0 * t)
    y = gain * STAGE(u) + np.random.default_rng(len(t)).normal(0.0, NOISE, t.size)
    return [f"{a:.2f},{b:.6f},{c:.6f}\n" for a, b, c in zip(t, u, y, strict=True)]


def text_of(*parts: list[str]) -> str:
    return HEADER + "".join(line for part in parts for line in part)


def saved_stage(folder: Path) -> Path:
    """Write the stage's model with its range and error, without delay."""
    u = np.array([0.0, 4.0, 0.0])
    about = describe(
        STAGE,
        delay=0,
        errors={"training": {"rms": NOISE}},
        output_low=float(STAGE(u).min()),
        output_high=float(STAGE(u).max()),
    )
    path = folder / "model.json"
    STAGE.save(path, about)
    return path


def lines(ended: Ended) -> list[dict[str, object]]:
    return [json.loads(line) for line in ended.out.splitlines()]


def reports(ended: Ended) -> list[dict[str, object]]:
    return [each for each in lines(ended) if "estimate" in each]


def alarms(ended: Ended) -> list[str]:
    return [each["alarm"] for each in lines(ended) if each.get("event") == "start"]


def counts(ended: Ended) -> dict[str, int]:
    return reports(ended)[-1]["counts"]
