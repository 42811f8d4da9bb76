"""Models as code for other tools: C for firmware, FMU for simulation, MEX for MATLAB and Octave."""

from __future__ import annotations

from hyst.export.c.firmware import CProject, c_project
from hyst.export.fmi.archive import Fmu, fmu
from hyst.export.iec61131.project import StructuredText, structured_text
from hyst.export.inverses import explicit_inverse, inverse_of
from hyst.export.mex_folder import MexFolder, mex
from hyst.export.rust_crate.crate import RustCrate, rust
from hyst.export.wave_table.table import Waveform, waveform

__all__ = [
    "CProject",
    "Fmu",
    "MexFolder",
    "RustCrate",
    "StructuredText",
    "Waveform",
    "c_project",
    "explicit_inverse",
    "fmu",
    "inverse_of",
    "mex",
    "rust",
    "structured_text",
    "waveform",
]


def __dir__() -> list[str]:
    return __all__
