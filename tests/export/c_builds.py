"""Compile exported C projects and call them from Python."""

from __future__ import annotations

import ctypes
import hashlib
import json
import os
import shutil
import subprocess
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

STRICT = ["-Wall", "-Wextra", "-Wconversion", "-Werror", "-pedantic", "-ffp-contract=off"]
AS_C = ["-std=c99"]
AS_CXX = ["-x", "c++", "-std=c++17"]


def compiler(name: str) -> str:
    """The compiler, or a skip that says what is missing."""
    found = shutil.which(name)
    if found is None:
        pytest.skip(f"{name} is not installed")
    return found


def compiled(command: list[str], folder: Path) -> None:
    finished = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert finished.returncode == 0, finished.stderr


class Objects:
    """Objects of core files, compiled once for each content, compiler and precision."""

    def __init__(self, home: Path) -> None:
        self._home = home

    def of(self, source: Path, project: Path, build: list[str]) -> Path:
        # Headers of the same name and precision are the same in every export, which a test of its
        # own makes sure; real.h tells the precision.
        (real,) = source.parent.glob("*_real.h")
        content = repr(build).encode() + source.read_bytes() + real.read_bytes()
        key = hashlib.sha256(content).hexdigest()
        result = self._home / f"{source.stem}-{key[:16]}.o"
        if not result.exists():
            # In one step, for another process may want the same.
            unfinished = result.with_suffix(f".{os.getpid()}")
            command = [*build, "-c", str(source), "-o", str(unfinished)]
            compiled(command, project)
            unfinished.replace(result)
        return result


def build_library(
    project: Path, objects: Objects, driver: str = "gcc", language: list[str] = AS_C
) -> Path:
    """Compile a project into a shared library; by gcc, one that needs nothing from elsewhere."""
    build = [compiler(driver), *language, "-O1", "-fPIC", *STRICT]
    sources = sorted(project.glob("core/src/*.c"))
    parts = [str(objects.of(each, project, build)) for each in sources]
    name = project_name(project)
    own = project / f"{name}-{driver}.o"
    compiled([*build, "-c", f"{name}.c", "-o", str(own)], project)
    library = project / f"lib{name}-{driver}.so"
    # Clang takes memcpy and memset for granted wherever it compiles.
    alone = ["-nostdlib"] if driver == "gcc" else []
    link = [compiler(driver), "-shared", *alone, "-Wl,--no-undefined", str(own), *parts]
    compiled([*link, "-o", str(library)], project)
    return library


def check_syntax(project: Path, driver: str, language: list[str]) -> None:
    """Compile the header and the source of a project, without a result."""
    flags = [*STRICT, "-fsyntax-only", f"{project_name(project)}.c"]
    compiled([compiler(driver), *language, *flags], project)


def run_selftest(project: Path, objects: Objects) -> subprocess.CompletedProcess[str]:
    """Compile and run the self-test; the core's objects may come from an earlier project."""
    # As for a library, so that they have the objects in common.
    build = [compiler("gcc"), *AS_C, "-O1", "-fPIC", *STRICT]
    sources = sorted(project.glob("core/src/*.c"))
    parts = [str(objects.of(each, project, build)) for each in sources]
    own = sorted(each.name for each in project.glob("*.c"))
    compiled([*build, *own, *parts, "-o", "selftest"], project)
    return subprocess.run(
        [str(project / "selftest")], cwd=project, capture_output=True, text=True, check=False
    )


def project_name(project: Path) -> str:
    return str(json.loads((project / "manifest.json").read_text())["name"])


class Exported:
    """An exported project in double, loaded from its shared library."""

    def __init__(self, library: Path, state_length: int, saved_bytes: int, inputs: int = 1) -> None:
        self._prepare(library, state_length, saved_bytes)
        step = self._function("step")
        step.restype = ctypes.c_double
        step.argtypes = [ctypes.c_void_p] + [ctypes.c_double] * inputs

    def _prepare(self, library: Path, state_length: int, saved_bytes: int) -> None:
        class State(ctypes.Structure):
            _fields_ = (
                ("memory", ctypes.c_double * max(state_length, 1)),
                ("y_last", ctypes.c_double),
                ("fault", ctypes.c_uint32),
                ("ready", ctypes.c_uint32),
            )

        self._name = library.name.removeprefix("lib").split("-")[0]
        self._library = ctypes.CDLL(str(library))
        self._length = state_length
        self._bytes = saved_bytes
        self.state_size = ctypes.sizeof(State)
        self._new = State

    def _function(self, suffix: str) -> Any:
        return getattr(self._library, f"{self._name}_{suffix}")

    def unset_state(self) -> Any:
        return self._new()

    def initial_state(self) -> Any:
        state = self._new()
        self._function("init")(ctypes.byref(state))
        return state

    def state_after(self, drives: Sequence[float] | np.ndarray, *second: float) -> tuple[Any, int]:
        """A state after a history of the drive, and what the call gave; with a second signal."""
        state, count = self._new(), len(drives)
        kept = np.ascontiguousarray(drives, dtype=np.float64)
        start = self._function("init_after")
        place = ctypes.c_void_p(kept.ctypes.data)
        more = map(ctypes.c_double, second)
        return state, int(start(ctypes.byref(state), place, ctypes.c_size_t(count), *more))

    def step(self, state: Any, *u: float) -> float:
        return float(self._function("step")(ctypes.byref(state), *u))

    def run(self, state: Any, *inputs: np.ndarray) -> np.ndarray:
        y = np.empty_like(inputs[0])
        kept = [np.ascontiguousarray(each) for each in inputs]
        pointers = [ctypes.c_void_p(each.ctypes.data) for each in (*kept, y)]
        self._function("run")(ctypes.byref(state), *pointers, ctypes.c_size_t(y.size))
        return y

    def fault(self, state: Any) -> int:
        return int(self._function("fault")(ctypes.byref(state)))

    def clear_fault(self, state: Any) -> None:
        self._function("clear_fault")(ctypes.byref(state))

    def save(self, state: Any) -> bytearray:
        saved = bytearray(self._bytes)
        buffer = (ctypes.c_ubyte * self._bytes).from_buffer(saved)
        self._function("state_save")(ctypes.byref(state), buffer)
        return saved

    def load(self, state: Any, saved: bytes | bytearray) -> int:
        buffer = (ctypes.c_ubyte * self._bytes).from_buffer_copy(bytes(saved))
        return int(self._function("state_load")(ctypes.byref(state), buffer))

    def memory(self, state: Any) -> np.ndarray:
        return np.array(state.memory[: self._length])


def same_bits(a: np.ndarray, b: np.ndarray) -> bool:
    return a.tobytes() == b.tobytes()


def stepped(step: Callable[..., float], *inputs: np.ndarray) -> np.ndarray:
    """What a stepper in Python gives for records."""
    signals = [each.tolist() for each in inputs]
    return np.array([step(*each) for each in zip(*signals, strict=True)])


@cache
def wandering(samples: int, seed: int = 7, size: float = 9.0) -> np.ndarray:
    """Runs of all lengths and rests, with numbers in between that are none."""
    rng = np.random.default_rng(seed)
    t = np.arange(samples)
    slow = np.sin(t / 97.0) * np.sin(t / 3001.0)
    u = size * slow + size * 0.2 * np.sin(t / 5.3) + 0.01 * rng.standard_normal(samples)
    held = rng.random(samples) < 0.1
    held[0] = False
    u = u[np.maximum.accumulate(np.where(held, 0, t))]
    places = rng.choice(samples, samples // 500, replace=False)
    u[places] = rng.choice([np.nan, np.inf, -np.inf, -np.nan], places.size)
    u.flags.writeable = False
    return u
