"""A model as simulation tools step it: some inputs, one output, one call a sample."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from hyst.export.c.any_block import any_block
from hyst.export.c.block import Block, Model
from hyst.export.c.drive_options import DriveOptions
from hyst.online import JointEstimator, ScaleEstimator
from hyst.operators import ModelDescription


@final
@dataclass(frozen=True)
class ToolBlock:
    """A block of C, and what one call of it takes and gives.

    Parameters
    ----------
    block
        The C, in double precision.
    inputs
        Names of the signals it takes.
    output
        Name of the one it gives.
    estimates
        Names of the parameters it estimates.
    """

    block: Block
    inputs: tuple[str, ...]
    output: str
    estimates: tuple[str, ...] = ()

    def step(self, name: str, state: str, signals: tuple[str, ...], before: str = "") -> str:
        """Give the C expression of one call.

        Parameters
        ----------
        name
            The prefix of the block's functions.
        state
            Points to the state.
        signals
            Expressions of the inputs.
        before
            Further arguments of the step, each with a comma behind it.

        Returns
        -------
        str
        """
        if not self.block.is_estimator:
            return f"{name}_step({', '.join([state, before + signals[0], *signals[1:]])})"
        u, y, y_ref = signals
        # A command has no way to raise the fault for a reference that is not finite.
        fault = f"hyst_is_finite({y_ref}) ? 0u : {name.upper()}_NOT_FINITE"
        return (
            f"((void){name}_update({state}, {u}, {y}), ({state})->fault |= {fault}, \\\n"
            f"     {name}_command({state}, {y_ref}))"
        )


def tool_block(
    model: Model, options: DriveOptions, description: ModelDescription | None = None
) -> ToolBlock:
    """Give a model as tools step it.

    Parameters
    ----------
    model
        What ``c_project`` takes. A joint estimator takes in a sample of u and y and then gives the
        command for y_ref.
    options
        What it is told of the drive.
    description
        As given to the export; None for that of the model.

    Returns
    -------
    ToolBlock

    Raises
    ------
    InputError
        If it cannot be exported.
    """
    block = any_block(model, "double", options, description)
    if isinstance(model, JointEstimator | ScaleEstimator):
        return ToolBlock(block, ("u", "y", "y_ref"), "command", model.names)
    return ToolBlock(block, block.inputs, block.output)
