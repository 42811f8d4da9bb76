"""How hyst observer designs: in continuous or in discrete time, of which order, at which noise."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import hyst
from hyst.checks.numbers import said
from hyst.cli.console import at_work, note
from hyst.cli.spec_section import Section

if TYPE_CHECKING:
    from hyst.cli.observer.spec import ObserverSpec

Time = Literal["continuous", "discrete"]

_TIMES = ("continuous", "discrete")
_GAIN, _Q_FILTER, _NONE = "gain", "q-filter", "none"
_OBSERVERS = (_GAIN, _Q_FILTER, _NONE)

# Poles faster than this share of half the sample rate are not what the block does any more.
_HELD = 0.5


@dataclass(frozen=True)
class HowToDesign:
    """What ``[design]`` says.

    Parameters
    ----------
    observer
        ``"gain"``, the observer of the paper; ``"q-filter"``, the classical one; or ``"none"``.
    time
        Of the design by a gain.
    order
        Of the observer or filter; None is the usual one.
    jitter
        What the sensor's noise may make of v; None leaves that to the design.
    """

    observer: str
    time: Time
    order: int | Literal["auto"] | None
    jitter: float | None


@dataclass(frozen=True)
class NoObserver:
    """The design of a block that has none.

    Parameters
    ----------
    dt
        Sample time of the block, s.
    observer, gain, message
        None, none, and one sentence that says so.
    """

    dt: float
    observer: None = None
    gain: None = None
    message: str = "there is no observer"

    def to_dict(self) -> dict[str, Any]:
        """Give nothing but the message."""
        return {"message": self.message}


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
        return HowToDesign(_GAIN, usual, None, None)
    given = spec.section("design")
    observer = given.text("observer", _GAIN, _OBSERVERS)
    if observer == _NONE:
        given.done()
        return HowToDesign(observer, usual, None, None)
    order = _order(given, observer)
    if observer == _Q_FILTER:
        given.done()
        return HowToDesign(observer, "discrete", order, None)
    time: Time = "discrete" if given.text("time", usual, _TIMES) == "discrete" else "continuous"
    if sampled and time == "continuous":
        raise hyst.InputError(
            '[design] time is "continuous", and the plant is known at its samples; leave it out, '
            'or, of a model file, give [plant] form = "continuous"'
        )
    jitter = given.number("jitter", positive=True) if given.has("jitter") else None
    given.done()
    return HowToDesign(observer, time, order, jitter)


def _order(given: Section, observer: str) -> int | Literal["auto"] | None:
    if not given.has("order"):
        return None
    if observer == _GAIN and isinstance(given.whole("order"), str):
        if given.whole("order") == "auto":
            return "auto"
        raise hyst.InputError(
            f'[design] order is {said(given.whole("order"))}; give a whole number or "auto"'
        )
    return given.count("order")


def designed(spec: ObserverSpec) -> Any:
    """Design what the spec asks for.

    Parameters
    ----------
    spec
        What was asked for.

    Returns
    -------
    DisturbanceObserver, SampledDisturbanceObserver, SampledQFilterObserver or NoObserver
    """
    if spec.design.observer == _NONE:
        return NoObserver(spec.filter_dt)
    if spec.design.observer == _Q_FILTER:
        return _classical(spec)
    if spec.design.time == "discrete":
        return _designed(spec, dt=spec.filter_dt, delay=spec.delay,
                         discretization=spec.filter_method)  # fmt: skip
    held = {"fastest_pole": _HELD * math.pi / spec.filter_dt}
    try:
        return _designed(spec, method="slpmm+descent", **held)
    except hyst.MissingExtraError as missing:
        note(f"{missing}; the descent alone is used, which needs neither")
        return _designed(spec, method="descent", **held)


def _classical(spec: ObserverSpec) -> Any:
    order = spec.design.order
    return hyst.control.design_sampled_q_filter(
        spec.plant,
        spec.controller,
        spec.Wu,
        spec.Wp,
        dt=spec.filter_dt,
        delay=spec.delay,
        order=order if isinstance(order, int) else None,
        method=spec.filter_method,
    )


def _designed(spec: ObserverSpec, **how: Any) -> Any:
    noise = spec.Wn if spec.Wn is not None else spec.noise if spec.noise > 0.0 else None
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
