"""The controller of a spec: written, or designed for the plant; and feedforward beside it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

import hyst
from hyst.checks.numbers import said
from hyst.cli.spec_section import Section

if TYPE_CHECKING:
    from hyst.control import ControllerDesign, LinearSystem

_DEMANDS = ("peak_sensitivity", "gain_margin", "phase_margin", "noise_gain", "mismatch")


@dataclass(frozen=True, eq=False)
class SpecifiedController:
    """C, in continuous time; the design it comes from, or None; and the feedforward beside it.

    Parameters
    ----------
    system
        C(s).
    design
        What came of the design; None if C was written.
    feedforward
        None, True or a system, as ``TrackingController.from_continuous`` takes it.
    """

    system: LinearSystem
    design: ControllerDesign | None
    feedforward: Any


def read_controller(
    given: Section, plant: LinearSystem, Wu: Any, dt: float, delay: float, method: str
) -> SpecifiedController:
    """Read the section of the controller, and design C if it asks for that.

    Parameters
    ----------
    given
        The section.
    plant, Wu
        What C is designed for.
    dt, delay, method
        Of the block that runs: sample time and dead time, s, and how it is sampled.

    Returns
    -------
    SpecifiedController

    Raises
    ------
    InputError
        If an entry is wrong, or as ``design_controller``.
    """
    feedforward = _feedforward(given)
    if not given.has("kind"):
        return SpecifiedController(given.system(), None, feedforward)
    if method != "tustin":
        raise hyst.InputError(
            f"[filter] method is {method!r}, and a designed controller is sampled by 'tustin'; "
            "give that, or write the controller"
        )
    kind = given.text("kind", choices=("auto", "i", "pi", "pid"))
    notch = given.whole("notch") if given.has("notch") else "auto"
    demands = {name: given.number(name) for name in _DEMANDS if given.has(name)}
    given.done()
    try:
        design = hyst.control.design_controller(
            plant, cast("Any", kind), notch=cast("Any", notch), dt=dt, delay=delay, Wu=Wu, **demands
        )
    except hyst.InputError as error:
        raise hyst.InputError(f"[controller] cannot be designed: {error}") from None
    return SpecifiedController(design.continuous, design, feedforward)


def _feedforward(given: Section) -> Any:
    if not given.has("feedforward"):
        return None
    value = given.whole("feedforward")
    if isinstance(value, bool):
        return True if value else None
    if isinstance(value, dict):
        return given.section("feedforward").system()
    raise hyst.InputError(
        f"[controller] feedforward is {said(value)}; give true, or a system from y_ref to v"
    )
