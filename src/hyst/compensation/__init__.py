"""Compensation: the input that makes a model follow a wanted output."""

from __future__ import annotations

from hyst.compensation.compensation import Compensation
from hyst.compensation.trajectory_inversion import invert_trajectory

__all__ = ["Compensation", "invert_trajectory"]
