"""Changes to a text file: some that keep its meaning, some that damage it."""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from lab_files import DT, signals

from hyst.io import LONGEST_GAP

SAMPLES = 120
T, U, Y = signals(SAMPLES, seed=5)


@dataclass(frozen=True)
class Sheet:
    """A file in the making: what is above the rows, the rows, and how all is to be joined."""

    top: list[str]
    head: list[str]
    units: list[str] | None
    rows: list[list[str]]
    bottom: list[str]
    separator: str = ","
    decimal: str = "."
    end: str = "\n"

    def names(self) -> list[str]:
        names = [self.head] if self.units is None else [self.head, self.units]
        return [self.separator.join(each) for each in names]

    def text(self) -> str:
        rows = [self.separator.join(each) for each in self.rows]
        return self.end.join([*self.top, *self.names(), *rows, *self.bottom]) + self.end


def plain_sheet(rng: random.Random) -> tuple[Sheet, float]:
    """A file as somebody may write it, and the seconds in its unit of time."""
    separator = rng.choice([",", ";", "\t", "|", " "])
    decimal = "," if separator in ";\t" and rng.random() < 0.5 else "."
    unit, factor = rng.choice([("s", 1.0), ("ms", 1e3), ("us", 1e6)])
    header, row_of_units = ["time", "u", "y"], None
    style = rng.choice(["row", "brackets", "underscore", "slash"])
    if style == "row":
        row_of_units = [unit, "V", "um"]
    else:
        form = {"brackets": "{}[{}]", "underscore": "{}_{}", "slash": "{}/{}"}[style]
        header = [form.format(n, v) for n, v in zip(header, [unit, "V", "um"], strict=True)]
    form = rng.choice(["{:.4f}", "{:.7e}", "{:+.5f}"])
    rows = [[form.format(v) for v in row] for row in zip(T * factor, U, Y, strict=True)]
    rows = [[cell.replace(".", decimal) for cell in row] for row in rows]
    top = rng.choice([[], ["Rig five"], ["# by hand"], ["Model: X1", "Gain: high"]])
    return Sheet(top, header, row_of_units, rows, [], separator, decimal), factor


def harmless(sheet: Sheet, rng: random.Random) -> tuple[Sheet, Callable[[str], bytes]]:
    """The same record written otherwise."""
    rows = sheet.rows
    kind = rng.randrange(9)
    if kind == 0:
        rows = [[f'"{cell}"' for cell in row] for row in rows]
    elif kind == 1 and "e" not in rows[0][0]:
        rows = [[f"{cell}E+00" for cell in row] for row in rows]
    elif kind == 2 and "e" in rows[0][0]:
        rows = [[cell.replace("e", "D") for cell in row] for row in rows]
    elif kind == 3 and sheet.separator != " ":
        rows = [[f" {cell} " for cell in row] for row in rows]
    bottom = ["End of file"] if kind == 4 else []
    top = [*sheet.top, "", "Station = B"] if kind == 5 else sheet.top
    if kind == 6 and sheet.separator not in " ":
        rows = [[*row, ""] for row in rows]
    encode = rng.choice(["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "latin-1"])
    changed = Sheet(
        top,
        sheet.head,
        sheet.units,
        rows,
        bottom,
        sheet.separator,
        sheet.decimal,
        rng.choice(["\n", "\r\n", "\r"]),
    )
    return changed, lambda text: text.encode(encode)


def damaged(data: bytes, rng: random.Random) -> bytes:
    """A file after an accident."""
    lines = data.split(b"\n")
    row = rng.randrange(len(lines))
    kind = rng.randrange(12)
    if kind == 0:
        return data[: rng.randrange(1, len(data))]
    if kind == 1:
        place = rng.randrange(len(data))
        return data[:place] + bytes([rng.randrange(256)]) + data[place + 1 :]
    if kind == 2:
        del lines[row]
    elif kind == 3:
        lines.insert(row, lines[row])
    elif kind == 4:
        other = rng.randrange(len(lines))
        lines[row], lines[other] = lines[other], lines[row]
    elif kind == 5:
        lines[row] = lines[row][: rng.randrange(len(lines[row]) + 1)]
    elif kind == 6:
        scraps = [b"*** lost ***", b"err,err,err", b"1,2", b"x", b";;", b"\0"]
        lines.insert(row, rng.choice(scraps))
    elif kind == 7:
        lines[row] = re.sub(
            rb"\d+", rng.choice([b"", b"nan", b"x", b"9.9E37", b"1e999"]), lines[row]
        )
    elif kind == 8:
        return data + data[rng.randrange(len(data)) :]
    elif kind == 9:
        start = rng.randrange(len(data))
        return data[:start] + data[start + rng.randrange(1, 200) :]
    elif kind == 10:
        lines[row] = lines[row].replace(rng.choice([b".", b",", b"\t", b";"]), b"")
    else:
        return data.replace(rng.choice([b",", b";", b"\t", b" "]), rng.choice([b",", b";", b" "]))
    return b"\n".join(lines)


def agrees(u: np.ndarray, y: np.ndarray, dt: float, known_unit: bool) -> bool:
    """Whether a record is that of the file but for what a single accident can do to it.

    The record may begin or end at another sample, and so many samples as repair may fill in may
    have other values. The step is as it was unless the accident took the unit away.
    """
    steps = [DT] if known_unit else [DT, 1e3 * DT, 1e6 * DT]
    if not any(np.isclose(dt, step, rtol=0.05) for step in steps):
        return False
    away = np.maximum(np.abs(u[:, None] - U), np.abs(y[:, None] - Y)).min(axis=1)
    return int((away > 1e-6).sum()) <= LONGEST_GAP + 1  # a row is damaged beside a gap
