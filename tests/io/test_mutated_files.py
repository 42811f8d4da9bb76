"""A thousand mutated files of instruments and tools: the right signals, or one sentence."""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tool_files as files
from tool_files import KINDS, T, U, Y

from hyst.errors import InputError
from hyst.io import read_table

CASES = 90


def channel_isf(path: Path) -> None:
    files.isf(path, U, "V")


def channel_isf_as_text(path: Path) -> None:
    files.isf(path, U, "V", text=True)


def channel_wfm(path: Path) -> None:
    files.wfm(path, U, "V")


def matrix(path: Path) -> None:
    np.save(path, np.column_stack((T, U, Y)))


def archive(path: Path) -> None:
    np.savez(path, u=U, u_mask=U > 1e9, y=Y + 0j)


def with_an_object(path: Path) -> None:
    files.with_object(path, "timetable")


WRITERS: dict[str, tuple[str, Callable[[Path], Any]]] = {
    **{kind: (name, write) for kind, (name, write, *_) in KINDS.items() if kind != "compound"},
    "ISF": ("a.isf", channel_isf),
    "ISF as text": ("a.isf", channel_isf_as_text),
    "WFM": ("a.wfm", channel_wfm),
    "NPY": ("a.npy", matrix),
    "NPZ": ("a.npz", archive),
    "object of MATLAB": ("a.mat", with_an_object),
}
# Apart, in a process of their own: the HDF5 library is written in C, and a crash must not end
# the tests without a word.
WRITERS_OF_HDF5: dict[str, tuple[str, Callable[[Path], Any]]] = {
    "compound": ("a.h5", files.compound),
    "packed": ("a.nc", files.packed),
    "MATLAB 7.3": ("a.mat", files.struct_array_of_7_3),
}


def mutated(whole: bytes, seed: int, count: int) -> Iterator[tuple[str, bytes]]:
    """Cut, flip, take out and repeat bytes, half of the flips near the start."""
    rng = random.Random(seed)
    for _ in range(count):
        content, how = bytearray(whole), rng.choice(("cut", "flip", "head", "delete", "repeat"))
        place = rng.randrange(1, len(content))
        if how == "cut":
            del content[place:]
        elif how == "flip":
            for _ in range(rng.randrange(1, 6)):
                content[rng.randrange(len(content))] = rng.randrange(256)
        elif how == "head":
            content[rng.randrange(min(len(content), 600))] = rng.choice((0, 1, 127, 128, 255))
        elif how == "delete":
            del content[place : place + rng.randrange(1, 40)]
        else:
            content[place:place] = content[place : place + rng.randrange(1, 40)]
        yield how, bytes(content)


def outcome(path: Path, content: bytes, right: dict[str, np.ndarray] | None) -> str:
    """Read a file and hold it to what is allowed; ``right`` is what it held before."""
    path.write_bytes(content)
    try:
        table = read_table(path)
    except InputError as refusal:
        said = str(refusal)
        assert "\n" not in said
        assert str(path) in said
        assert said[-1] not in " .!?"
        return "refused"
    for column, flaw in zip(table.columns, table.flaws, strict=True):
        assert column.dtype == np.float64
        assert column.ndim == 1
        assert (flaw is None) == bool(np.isfinite(column).all())
    if right is not None:
        for header, column in zip(table.headers, table.columns, strict=True):
            assert np.array_equal(column, right[header]), header
    return "read"


def outcomes(name: str, write: Callable[[Path], Any], folder: Path, seed: int) -> dict[str, int]:
    """Mutate a file of a kind; what was cut off must not change what is read of the rest."""
    path = folder / name
    write(path)
    whole = path.read_bytes()
    table = read_table(path)
    before = dict(zip(table.headers, table.columns, strict=True))
    counts = {"read": 0, "refused": 0}
    for how, content in mutated(whole, seed, CASES):
        counts[outcome(path, content, before if how == "cut" else None)] += 1
    return counts


@pytest.mark.parametrize("kind", WRITERS)
def test_mutated_files_give_the_right_signals_or_one_sentence(tmp_path: Path, kind: str) -> None:
    counts = outcomes(*WRITERS[kind], tmp_path, seed=len(kind))
    assert counts["refused"] > 0
    assert sum(counts.values()) == CASES


def test_so_do_mutated_files_of_hdf5(tmp_path: Path) -> None:
    program = (
        "import json, pathlib, sys; import test_mutated_files as here; "
        "print(json.dumps([here.outcomes(*each, pathlib.Path(sys.argv[1]), 5) "
        "for each in here.WRITERS_OF_HDF5.values()]))"
    )
    paths = [str(Path(__file__).parent), *filter(None, sys.path)]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}
    done = subprocess.run(
        [sys.executable, "-c", program, str(tmp_path)],
        capture_output=True, text=True, check=False, env=environment, timeout=120,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-2000:]
    for counts in json.loads(done.stdout):
        assert counts["refused"] > 0
        assert sum(counts.values()) == CASES
