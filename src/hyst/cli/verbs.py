"""The verbs of the program: where each is, and what its help says first.

A verb is imported when it is typed, so that ``hyst --help`` loads no numerics and each verb only
its own. Its sentence stands here once more for that; a test watches that both are the same.
"""

from __future__ import annotations

import importlib
from typing import Any

import typer
from typer.core import TyperGroup

VERBS: dict[str, tuple[str, str]] = {
    "diagnose": (
        "hyst.cli.diagnose",
        "Say what records show before any model, the worst first, and what to record next.",
    ),
    "excite": (
        "hyst.cli.excite",
        "Design an input within limits; write it with a figure, and say what it can determine.",
    ),
    "columns": (
        "hyst.cli.columns",
        "List the columns of a data file, and guess which are input, output and time.",
    ),
    "identify": (
        "hyst.cli.identify",
        "Identify a model from measured records, and write model, numbers, figures and a report.",
    ),
    "fleet": (
        "hyst.cli.fleet.command",
        "Identify one model for each of many records, and name the odd ones.",
    ),
    "fit": (
        "hyst.cli.fit",
        "Fit the constants of a model to records, from its own values, and report as identify "
        "does.",
    ),
    "compare": (
        "hyst.cli.compare",
        "Set models of one actuator side by side on a record that none of them has seen.",
    ),
    "adapt": (
        "hyst.cli.adapt.command",
        "Estimate a model's constants sample by sample along a record; write them over time.",
    ),
    "watch": (
        "hyst.cli.watch.command",
        "Follow an actuator through a growing file; report estimates, errors and alarms.",
    ),
    "simulate": (
        "hyst.cli.simulate",
        "Compute the output of a model for an input, sample by sample.",
    ),
    "loop": (
        "hyst.cli.loop",
        "See the loop behind the dynamics of a model in new sines, and test if rate moves it.",
    ),
    "compensate": (
        "hyst.cli.compensate",
        "Turn a wanted output into the input that produces it, and predict how well.",
    ),
    "learn": (
        "hyst.cli.learn.command",
        "Give the next command of a motion that repeats, learnt from the measured repetitions.",
    ),
    "observer": (
        "hyst.cli.observer.command",
        "Design a disturbance observer; say if the loop is safe, and write what to implement.",
    ),
    "export": (
        "hyst.cli.export.command",
        "Write a model as code for other tools: the numbers of Python, bit for bit in double.",
    ),
    "waveform": (
        "hyst.cli.waveform",
        "Write a command as a table at a controller's sample time, checked for limits and slew.",
    ),
    "info": (
        "hyst.cli.info",
        "Show what a model file holds: meaning, errors, origin, constants, traits, invertibility.",
    ),
    "studio": (
        "hyst.cli.studio",
        "Do the whole job in a browser: look, identify, follow a reference, export; no typing.",
    ),
    "reproduce": (
        "hyst.cli.reproduce",
        "Compute the papers' tables again, and print them beside the papers' numbers.",
    ),
    "demo": (
        "hyst.cli.demo",
        "Tell the whole story on a simulated stage: measure, identify, invert, track, compare.",
    ),
}
"""For each verb its module and the first line of its help, in the order of the help."""

# Verbs whose options are not all in their own file.
_KINDS = dict.fromkeys(("identify", "fleet"), ("hyst.cli.family_options", "FamilyCommand"))


class Verbs(TyperGroup):
    """The program, which imports a verb when it is carried out."""

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Find the verb that was typed, with all its options."""
        name, command, rest = super().resolve_command(ctx, args)
        return name, command and command_of(str(command.name)), rest


def command_of(verb: str) -> Any:
    """Import a verb and give its command.

    Parameters
    ----------
    verb
        Its name.
    """
    module = importlib.import_module(VERBS[verb][0])
    home, name = _KINDS.get(verb, ("hyst.cli.verb", "Verb"))
    kind = getattr(importlib.import_module(home), name)
    app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)
    app.command(verb, cls=kind)(getattr(module, verb))
    return typer.main.get_command(app)


def is_carried_out() -> None:
    """Stand for a verb in the list of them."""
