"""Fixtures shared by all tests."""

from __future__ import annotations

import base64
import contextlib
import ctypes
import importlib.util
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

# The same examples every time, so that a red test is red again; `--hypothesis-profile=search` looks
# for new ones. Deadlines would only measure how busy the machine is.
_QUICK = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}
settings.register_profile("repeatable", **_QUICK, derandomize=True, max_examples=15)
settings.register_profile("search", **_QUICK, max_examples=2000)
settings.load_profile("repeatable")

REPOSITORY = Path(__file__).resolve().parent.parent


def _load_libraries_of_opensees() -> None:
    """Load what the wheel of OpenSees brings but finds only where a system has it too."""
    found = importlib.util.find_spec("openseespylinux")
    if found is None or found.origin is None:
        return
    for name in ("libquadmath.so.0", "libgfortran.so.4", "libblas.so.3"):
        with contextlib.suppress(OSError):
            ctypes.CDLL(str(Path(found.origin).parent / "lib" / name), mode=ctypes.RTLD_GLOBAL)


_load_libraries_of_opensees()


@pytest.fixture(scope="session")
def measured_data() -> Path:
    """Folder of the measured records, kept beside the repository and not inside it."""
    folder = REPOSITORY.parent / "shared" / "data"
    if not folder.is_dir():
        pytest.skip(f"measured records are not at {folder}")
    return folder


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave out matplotlib's work on figures that a test does not look at, most of its time.

    Figures are made as ever, only not laid out and turned into pixels: each is one white pixel.
    """
    pixel = base64.b64decode(
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR42mP4DwABAQEAHLCMmQAAAABJRU5ErkJggg=="
    )
    monkeypatch.setattr("hyst.report.canvas.png_of", lambda figure: pixel)


@pytest.fixture(scope="session")
def cases(measured_data: Path) -> Path:
    """Folder of the cases, each with the right answer in its README."""
    folder = measured_data.parent / "cases"
    if not folder.is_dir():
        pytest.skip(f"cases are not at {folder}")
    return folder
