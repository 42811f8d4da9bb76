"""A simulated stage, and the whole story of hyst told on it without any file."""

from __future__ import annotations

from hyst.demo.stage import SimulatedStage
from hyst.demo.story import BANNER, Story, Tracking, tell

__all__ = ["BANNER", "SimulatedStage", "Story", "Tracking", "tell"]
