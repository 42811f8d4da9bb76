"""What was recorded last: ratios of every benchmark, with the machine they are of."""

from __future__ import annotations

import importlib.metadata
import json
import os
import platform
import subprocess
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from benchmarks.comparison import Ratio

FILE = Path(__file__).with_name("recorded.json")
PEERS = Path(__file__).with_name("peers.txt")
FORMAT = 1


def machine() -> dict[str, Any]:
    """Say what the ratios of this run are of."""
    from hyst import _engine

    return {
        "processor": _processor(),
        "processors": os.cpu_count(),
        "instruction_set": _engine.instruction_set(),
        "compiler": _compiler(),
        "python": platform.python_version(),
        "peers": {name: _installed(name) for name in pinned(PEERS)},
    }


def pinned(path: Path) -> dict[str, str]:
    """Read the versions of the peers that ratios are recorded against."""
    lines = [line.split("#")[0].strip() for line in path.read_text().splitlines()]
    return dict(line.split("==") for line in lines if line)


def other_peers(pins: Mapping[str, str]) -> list[str]:
    """Name the peers whose version is not the pinned one, one line each."""
    return [
        f"{name} is {_installed(name) or 'not installed'}, pinned is {version}"
        for name, version in pins.items()
        if _installed(name) != version
    ]


def read(path: Path = FILE) -> dict[str, dict[str, Any]]:
    """Read what was recorded: of every benchmark its machine and its ratios."""
    if not path.exists():
        return {}
    saved = json.loads(path.read_text())
    if saved.get("format") != FORMAT:
        raise SystemExit(f"{path} is of format {saved.get('format')}; record it anew")
    return {
        name: {
            "machine": each["machine"],
            "ratios": {key: Ratio(**ratio) for key, ratio in each["ratios"].items()},
        }
        for name, each in saved["benchmarks"].items()
    }


def write(found: Mapping[str, Mapping[str, Ratio]], path: Path = FILE) -> None:
    """Put the ratios of some benchmarks in the place of what was recorded of them."""
    kept = read(path)
    here = machine()
    for name, ratios in found.items():
        kept[name] = {"machine": here, "ratios": dict(ratios)}
    benchmarks = {
        name: {
            "machine": each["machine"],
            "ratios": {key: _rounded(ratio) for key, ratio in each["ratios"].items()},
        }
        for name, each in sorted(kept.items())
    }
    path.write_text(json.dumps({"format": FORMAT, "benchmarks": benchmarks}, indent=1) + "\n")


def differences(before: Mapping[str, Any], now: Mapping[str, Any]) -> list[str]:
    """Say in what the machine of a record is another one, peers left out."""
    return [
        f"{name} was {before.get(name)}, is {value}"
        for name, value in now.items()
        if name != "peers" and before.get(name) != value
    ]


def _rounded(ratio: Ratio) -> dict[str, Any]:
    """Keep the digits that mean something, so that recording anew changes few lines."""
    kept = asdict(ratio)
    return kept | {"value": float(f"{ratio.value:.4g}"), "spread": float(f"{ratio.spread:.2g}")}


def _installed(name: str) -> str | None:
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return None


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    models = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return models[0] if models else platform.machine()


def _compiler() -> str:
    """Name the compiler that builds the engine here."""
    try:
        said = subprocess.run(
            [os.environ.get("CXX", "c++"), "--version"], capture_output=True, text=True, check=False
        ).stdout
    except OSError:
        return "none"
    return said.splitlines()[0] if said else "unknown"
