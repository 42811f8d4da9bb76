"""A reference to drag, its command, and how it is predicted to be followed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from nicegui import ui

from hyst.studio.drawing.extremes import extreme_samples
from hyst.studio.drawing.plot import Line, Plot
from hyst.studio.page.pieces import picture, say, section, text
from hyst.studio.session import StudioSession
from hyst.studio.work.reference import SHAPES, Reference


def draw_reference(session: StudioSession, remembered: dict[str, Any]) -> None:
    """Draw the part.

    Parameters
    ----------
    session
        Of the page.
    remembered
        Of this tab: who is told here when the command changes.
    """
    _forget(session, remembered.pop("update", None))
    with section("reference", "6. A wanted motion, and its command"):
        if not session.chosen or session.reference is None or session.measured is None:
            say(session, "reference")
            if "reference" not in session.said:
                text("Identify a model first.", "small")
            return
        text(
            "Drag the points, or move them with the arrow keys; the sliders set the rest. The "
            "command and the prediction follow.",
            "small",
        )
        _draw_sliders(session, session.reference)
        editor = ui.html("", tag="div", sanitize=False).classes("editor")
        place = ui.element("div")

        def update(part: str) -> None:
            if editor.is_deleted or part not in ("points", "tracking"):
                return
            editor.set_content(_editor(session))
            if part == "tracking":
                place.clear()
                with place:
                    _draw_followed(session)

        update("tracking")
        _listen(session, remembered, update, editor)


def _listen(
    session: StudioSession,
    remembered: dict[str, Any],
    update: Callable[[str], None],
    editor: ui.html,
) -> None:
    """Let points be moved while this part is on the page."""

    async def moved(event: Any) -> None:
        if session.reference is None or editor.is_deleted:
            return
        point, value = int(event.args["point"]), float(event.args["value"])
        if 0 <= point < len(session.reference.points) and np.isfinite(value):
            session.reference = session.reference.moved(point, value)
            update("points")
            await session.follow()

    _forget(session, remembered.get("update"))  # of what was drawn here before
    remembered["update"] = update
    session.listeners.append(update)
    editor.on("moved", moved, js_handler="(event) => emit(event.detail)")
    editor.client.on_delete(lambda: _forget(session, update))


def _forget(session: StudioSession, update: Callable[[str], None] | None) -> None:
    if update is not None and update in session.listeners:
        session.listeners.remove(update)


def _draw_sliders(session: StudioSession, reference: Reference) -> None:
    measured = session.measured
    assert measured is not None
    low, high = measured.output_range
    span = high - low
    unit = measured.output_label
    length = measured.samples * measured.dt

    def set_to(name: str) -> Callable[[Any], Any]:
        async def change(event: Any) -> None:
            if session.reference is not None and event.value is not None:
                value = 10.0**event.value if name == "frequency" else float(event.value)
                await session.follow(session.reference.with_number(name, value))

        return change

    async def set_shape(event: Any) -> None:
        if session.reference is not None:
            await session.follow(session.reference.shaped(event.value))

    with ui.element("div").classes("fields"):
        ui.radio(list(SHAPES), value=reference.shape, on_change=set_shape).props(
            'inline id="shape" aria-label="Shape"'
        )
        _slider("amplitude", f"Amplitude, {unit}", 0.0, 0.5 * span, reference, set_to)
        _slider("middle", f"Middle, {unit}", low, high, reference, set_to)
        floor, top = np.log10(1.0 / length), np.log10(0.02 / measured.dt)
        _slider("frequency", "Frequency, Hz", floor, max(top, floor + 0.5), reference, set_to)


def _slider(
    name: str, label: str, low: float, high: float, reference: Reference, set_to: Any
) -> None:
    value = getattr(reference, name)
    with ui.element("div").classes("setting"):
        shown = ui.html(f"{label}: {value:.4g}", tag="span", sanitize=False)
        logarithmic = name == "frequency"

        def tell(event: Any) -> None:
            now = 10.0**event.value if logarithmic else event.value
            shown.set_content(f"{label}: {now:.4g}")

        at = float(np.log10(value)) if logarithmic else value
        made = ui.slider(
            min=float(low), max=float(high), step=(high - low) / 200, value=at, on_change=tell
        )
        made.on_value_change(set_to(name))
        made.props(f'id="slider-{name}" aria-label="{label}" throttle="80"')


def _editor(session: StudioSession) -> str:
    """Draw the first period of the reference with its points."""
    reference, measured = session.reference, session.measured
    if reference is None or measured is None:
        return ""
    low, high = measured.output_range
    period = 1.0 / reference.frequency
    time = np.linspace(0.0, period, 401)[:-1]
    y = reference.middle + reference.amplitude * reference.through_points(time / period)
    at = extreme_samples(400, y)
    edges = Line(np.array([0.0, period]), np.array([low, high]), "", 8)  # not seen
    plot = Plot(
        (edges, Line(time[at], y[at], "", 0)),
        "time [s]",
        measured.output_label,
        f"Wanted {measured.output_label} over one period of {period:.3g} s, with points to move",
        height=260,
    )
    across, up = plot.axes()
    parts = []
    times, values = reference.at_points()
    centres = zip(across.pixels(times), up.pixels(values), strict=True)
    step = (high - low) / 50.0
    for k, (x, y_pixel) in enumerate(centres):
        parts.append(
            f'<circle class="point" id="point-{k}" tabindex="0" role="slider" cx="{x:.1f}" '
            f'cy="{y_pixel:.1f}" r="9" data-point="{k}" data-value="{values[k]:.9g}" '
            f'data-step="{step:.6g}" aria-label="Point {k + 1} at {times[k]:.3g} s" '
            f'aria-valuemin="{low:.4g}" aria-valuemax="{high:.4g}" aria-valuenow="{values[k]:.4g}" '
            'aria-orientation="vertical"/>'
        )
    scale = (
        f'data-low="{up.low:.12g}" data-high="{up.high:.12g}" data-begin="{up.begin:g}" '
        f'data-end="{up.end:g}"'
    )
    group = f'<g class="points" {scale}>{"".join(parts)}</g>'
    return replace(plot, more=group).svg().replace('role="img"', 'role="group"')


def _draw_followed(session: StudioSession) -> None:
    say(session, "reference")
    followed = session.followed
    if followed is None:
        return
    with ui.element("div").classes("plots"):
        picture(followed.tracking, "Wanted and predicted output, with its band")
        picture(followed.command, f"The command ({followed.method})")
    for each in followed.sentences:
        text(each)
