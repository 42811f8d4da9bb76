"""Models as code for other tools: C for firmware, FMU for simulation, MEX for MATLAB and Octave."""

from __future__ import annotations

from hyst.export.firmware import CProject, c_project
from hyst.export.inverses import explicit_inverse, reversed_description

__all__ = ["CProject", "c_project", "explicit_inverse", "reversed_description"]
