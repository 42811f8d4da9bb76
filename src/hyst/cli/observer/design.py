"""How hyst observer designs: in continuous or in discrete time, of which order, at which noise."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import hyst
from hyst.cli.console import at_work, note
from hyst.cli.spec_section import Section

if TYPE_CHECKING:
    from hyst.cli.observer.spec import ObserverSpec

Time = Literal["continuous", "discrete"]

# Poles faster than this share of half the sample rate are not what the block does any more.
_HELD = 0.5


@dataclass(frozen=True)
class HowToDesign:
    """What ``[design]`` says: ``time``; ``order``, None is the paper's; ``jitter`` of v or None."""

    time: Time
    order: int | Literal["auto"] | None
    jitter: float | None


def read_design(spec: Section, sampled: bool) -> HowToDesign:
    """Read ``[design]``, which may be left out.

    Parameters
    ----------
    spec
        All of the spec.
    sampled
        Whether the plant is known at its samples only: then the design is in discrete time.
    """
    usual: Time = "discrete" if sampled else "continuous"
    if not spec.has("design"):
        return HowToDesign(usual, None, None)
    given = spec.section("design")
    time: Time = (
        "discrete"
        if given.text("time", usual, ("continuous", "discrete")) == ("discrete")
        else "continuous"
    )
    if sampled and time == "continuous":
        raise hyst.InputError(
            '[design] time is "continuous", and the plant is known at its samples; leave it out, '
            'or give [plant] form = "continuous"'
        )
    jitter = given.number("jitter", positive=True) if given.has("jitter") else None
    order = _order(given)
    given.done()
    return HowToDesign(time, order, jitter)


def _order(given: Section) -> int | Literal["auto"] | None:
    if not given.has("order"):
        return None
    if given.whole("order") == "auto":
        return "auto"
    return given.count("order")


def designed(spec: ObserverSpec) -> Any:
    """Design what the spec asks for.

    Parameters
    ----------
    spec
        What was asked for.

    Returns
    -------
    DisturbanceObserver or SampledDisturbanceObserver
    """
    if spec.design.time == "discrete":
        return _designed(spec, dt=spec.filter_dt, delay=spec.delay,
                         discretization=spec.filter_method)  # fmt: skip
    held = {"fastest_pole": _HELD * math.pi / spec.filter_dt}
    try:
        return _designed(spec, method="slpmm+descent", **held)
    except hyst.MissingExtraError as missing:
        note(f"{missing}; the descent alone is used, which needs neither")
        return _designed(spec, method="descent", **held)


def _designed(spec: ObserverSpec, **how: Any) -> Any:
    noise = spec.noise if spec.noise > 0.0 else None
    with at_work("designing the observer") as say:
        return hyst.control.design_disturbance_observer(
            spec.plant,
            spec.controller,
            spec.Wu,
            spec.Wp,
            spec.internal_model,
            perturbed_plant=spec.true_plant,
            order=spec.design.order,
            noise=noise,
            jitter=spec.design.jitter,
            progress=lambda stage, step, best: say(f"{stage} {step}, best norm {best:.4f}"),
            **how,
        )
