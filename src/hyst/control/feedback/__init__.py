"""The loop that people use: its margins, a designed controller, feedforward, and a comparison."""

from __future__ import annotations

from hyst.control.feedback.controller_design import design_controller
from hyst.control.feedback.designed_controller import ControllerDesign
from hyst.control.feedback.margins import LoopMargins, loop_margins

__all__ = ["ControllerDesign", "LoopMargins", "design_controller", "loop_margins"]
