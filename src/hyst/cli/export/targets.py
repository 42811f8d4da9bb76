"""The targets by the names the command line gives them, and which options are theirs alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from hyst.cli.export.c import c
from hyst.cli.export.fmu import fmu
from hyst.cli.export.mex import mex
from hyst.cli.export.order import Done, Order
from hyst.cli.export.rust import rust
from hyst.cli.export.structured_text import structured_text


@dataclass(frozen=True)
class Target:
    """A target.

    Parameters
    ----------
    write
        What writes it.
    purpose
        What it is for.
    takes
        Those parameters of the verb that not all targets take.
    """

    write: Callable[[Order], Done]
    purpose: str
    takes: tuple[str, ...] = ()


TARGETS = {
    "c": Target(c, "for firmware", ("precision", "layout", "shared_core", "driver", "history_at")),
    "fmu": Target(fmu, "for simulation tools", ("fmi", "binary")),
    "mex": Target(mex, "for MATLAB and Octave", ("history_at",)),
    "rust": Target(rust, "a crate", ("precision", "history_at")),
    "st": Target(structured_text, "IEC 61131-3 for PLCs", ("precision", "history_at")),
}


def takers() -> dict[str, list[str]]:
    """Give, for each parameter of the verb that not all targets take, those that do."""
    parameters = sorted({each for target in TARGETS.values() for each in target.takes})
    return {
        each: [name for name, target in TARGETS.items() if each in target.takes]
        for each in parameters
    }
