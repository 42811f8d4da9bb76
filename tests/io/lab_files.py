"""Signals of known shape, and the ways in which laboratories write them into text files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

DT = 0.005
SAMPLES = 60


def signals(samples: int = SAMPLES, seed: int = 0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time in seconds, a triangle of whole steps, and an output behind it, to four decimals."""
    k = np.arange(samples)
    u = 10.0 - np.abs(k % 20 - 10.0)
    y = 0.6 * np.roll(u, 2) + 0.01 * np.random.default_rng(seed).standard_normal(samples)
    return k * DT, u, np.round(y, 4)


def cell(value: float) -> str:
    return f"{value:.4f}"


def rows(
    columns: Sequence[Sequence[object]],
    separator: str = ",",
    write: Callable[[float], str] = cell,
) -> list[str]:
    """Lines of cells; what is text already stays so."""
    return [
        separator.join(each if isinstance(each, str) else write(each) for each in row)  # type: ignore[arg-type]
        for row in zip(*columns, strict=True)
    ]


def write(folder: Path, lines: Sequence[str] | str | bytes, name: str = "loop.csv") -> Path:
    path = folder / name
    if isinstance(lines, bytes):
        path.write_bytes(lines)
        return path
    text = lines if isinstance(lines, str) else "\n".join(lines) + "\n"
    path.write_text(text, encoding="utf-8", newline="")
    return path
