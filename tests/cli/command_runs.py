"""A simulated stage for the tests of the command line, and how to write it into files."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hyst.models import PrandtlIshlinskii
from hyst.operators import Affine, ModelDescription, Operator


@dataclass(frozen=True)
class Ended:
    """How a run ended."""

    code: int
    out: str
    err: str


Run = Callable[..., Ended]

STAGE = Affine(1.0, 2.0) @ PrandtlIshlinskii(p=[0.5, 0.3], r=[0.4, 1.1], p0=1.0)
"""Simulated stage of the tests: 0..4 V in, some um out."""


def drive(samples: int = 700) -> np.ndarray:
    """Full strokes and smaller ones between 0 and 4."""
    t = np.linspace(0.0, 1.0, samples)
    return 2.0 - 2.0 * np.cos(10.0 * math.pi * t) * (1.0 - 0.5 * t * (t > 0.4))


def write_csv(path: Path, header: str, *columns: np.ndarray) -> Path:
    rows = [",".join(repr(float(x)) for x in row) for row in zip(*columns, strict=True)]
    path.write_text("\n".join([header, *rows]) + "\n")
    return path


def describe(model: Operator, **changes: object) -> ModelDescription:
    about: dict[str, object] = {
        "input_name": "drive",
        "output_name": "stroke",
        "input_unit": "V",
        "output_unit": "um",
        "input_low": 0.0,
        "input_high": 4.0,
        "dt": 0.01,
        "delay": 2,
        "family": "pi",
    }
    return ModelDescription(**(about | changes))  # type: ignore[arg-type]


def snapshot(folder: Path) -> dict[str, bytes]:
    """Everything in a folder with its content."""
    return {
        str(path.relative_to(folder)): path.read_bytes() if path.is_file() else b""
        for path in sorted(folder.rglob("*"))
    }
