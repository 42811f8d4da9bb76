"""A studio in a process of its own, and a Chromium that looks at it."""

from __future__ import annotations

import contextlib
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import hyst

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
_FLAGS = (
    *("--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-sync"),
    *("--disable-background-networking", "--disable-component-update"),
)
_PROGRAM = "import sys; from hyst.cli import main; sys.exit(main(sys.argv[1:]))"
TRUE = hyst.PrandtlIshlinskii(p=[0.15, 0.1], r=[8.0, 20.0], p0=0.4)


@dataclass
class Studio:
    """One that runs."""

    address: str
    process: subprocess.Popen[str]
    folder: Path

    @property
    def host(self) -> str:
        return self.address.partition("/?")[0]

    def stop(self) -> None:
        self.process.terminate()
        self.process.wait(20)


@contextlib.contextmanager
def running(folder: Path, *options: str) -> Iterator[Studio]:
    """Start a studio and stop it."""
    given = [sys.executable, "-c", _PROGRAM, "studio", str(folder), "--no-browser", *options]
    process = subprocess.Popen(given, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert process.stdout is not None
    try:
        line = process.stdout.readline()
        found = re.search(r"http://127\.0\.0\.1:\d+/\?token=\S+", line)
        assert found, line + process.stdout.read()
        yield Studio(found[0], process, folder)
    finally:
        process.terminate()
        process.wait(20)
        process.stdout.close()


@contextlib.contextmanager
def chromium() -> Iterator[Any]:
    """Start a browser and stop it."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=list(_FLAGS))
        try:
            yield browser
        finally:
            browser.close()


def write_loop(path: Path, samples: int = 3000) -> None:
    """Write the record of a stage with hysteresis."""
    t = np.arange(samples) / 1000.0
    u = 75.0 + 75.0 * np.sin(2.0 * np.pi * 2.0 * t) * np.linspace(1.0, 0.3, samples)
    y = TRUE(u) + 0.02 * np.random.default_rng(0).standard_normal(samples)
    header = "time [s],drive [V],position [um]"
    np.savetxt(path, np.column_stack([t, u, y]), "%.7g", ",", header=header, comments="")
