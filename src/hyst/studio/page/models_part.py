"""The models found so far: verdicts, loops over each other, and which one makes commands."""

from __future__ import annotations

from functools import partial
from html import escape
from typing import Any

from nicegui import ui

from hyst.studio.page.pieces import button, picture, say, section, show, text
from hyst.studio.session import StudioSession
from hyst.studio.work.identifying import FoundModel


def draw_models(session: StudioSession, remembered: dict[str, Any]) -> None:
    """Draw the part.

    Parameters
    ----------
    session
        Of the page.
    remembered
        Not used here.
    """
    with section("models", "5. Models so far"):
        say(session, "models", "Drawing ...")
        if not session.models:
            text("None yet.", "small")
            return
        if session.pictures is not None:
            with ui.element("div").classes("plots"):
                picture(session.pictures[0], "Loops over each other")
                picture(session.pictures[1], "What each model leaves")
        for each in session.models:
            _draw_model(session, each)


def _draw_model(session: StudioSession, model: FoundModel) -> None:
    used = model.name == session.chosen
    with ui.element("article").classes("model used" if used else "model"):
        ui.html(
            f"{escape(model.name)}: {escape(model.full_name)} "
            f'<span class="badge {model.level}">{model.level}</span>',
            tag="h3",
            sanitize=False,
        )
        for sentence in model.sentences:
            text(sentence)
        with ui.element("details"):
            ui.html("More of it", tag="summary", sanitize=False)
            for sentence in model.short:
                text(sentence, "small")
            show(model.errors)
        with ui.element("div").classes("fields"):
            if used:
                text("Makes the command below.", "small")
            else:
                label = f"Make commands with {model.name}"
                button(label, partial(session.choose_model, model.name), f"use-{model.name}")
            button(
                f"Remove {model.name}", partial(session.remove, model.name), f"remove-{model.name}"
            )
