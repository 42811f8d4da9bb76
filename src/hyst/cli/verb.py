"""What all verbs have in common: how much they say, from what options, and what they never do."""

from __future__ import annotations

import contextlib
import functools
import io
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperCommand

from hyst._files import keeping
from hyst.cli import console
from hyst.cli.config_file import options_from, write_options
from hyst.cli.protection import files_among, refuse_existing

_PANEL = "Options of every verb"
_GIVEN = "hyst.cli.verb"

_WRITING_ANEW = ("learn", "watch")
"""Verbs that replace their own files at each repetition, or go on from them."""


class Verb(TyperCommand):
    """A verb with the options that all have, unless it has one of that name itself."""

    def get_params(self, ctx: Any) -> list[Any]:
        """Give the parameters of the verb, then those of every verb, then --help."""
        own: list[Any] = [*super().get_params(ctx)]
        taken = {each for parameter in own for each in parameter.opts}
        common = [each for each in _common() if not taken.intersection(each.opts)]
        if self.name in _WRITING_ANEW:
            common = [each for each in common if each.name != "force"]
        return [*own[:-1], *common, *own[-1:]]

    def invoke(self, ctx: Any) -> Any:
        """Carry the verb out, unless it would replace what is there."""
        given = ctx.meta.get(_GIVEN, {})
        saved, is_forced = given.get("save_config"), given.get("force") or ctx.params.get("force")
        written = [each.name for each in self.params if "-o" in each.opts]
        read = {name: value for name, value in ctx.params.items() if name not in written}
        if "force" in given:  # the others look after their folders themselves
            target = ctx.params[written[0]] if written else None
            refuse_existing(read, None if target is None else Path(target), is_forced)
        if saved is not None:
            write_options(saved, self, ctx, is_forced)
        # A log that goes on from its own estimator replaces it.
        kept = [] if self.name == "watch" else files_among(read)
        with keeping(kept), _speaking(str(self.name), given) as ended:
            ended["exit_code"] = super().invoke(ctx) or 0
        return ended["exit_code"]


@contextlib.contextmanager
def _speaking(verb: str, given: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Say as much as was asked for, and as JSON if that was asked for."""
    ended: dict[str, Any] = {"verb": verb}
    if given.get("as_json"):
        told, said = console.Told(), io.StringIO()
        with console.speaking(told=told), contextlib.redirect_stdout(said):
            yield ended
        print(json.dumps(ended | told.collected(said.getvalue()), indent=1))
    elif given.get("quiet"):
        with console.speaking(is_quiet=True), contextlib.redirect_stdout(io.StringIO()):
            yield ended
    else:
        with console.speaking(is_verbose=bool(given.get("verbose"))):
            yield ended


def _keep(context: typer.Context, parameter: typer.CallbackParam, value: Any) -> None:
    context.meta.setdefault(_GIVEN, {})[parameter.name] = value


def _take(context: typer.Context, parameter: typer.CallbackParam, value: Path | None) -> None:
    """Take options from a file before the others are looked at; what is typed wins."""
    if value is not None:
        context.default_map = options_from(value, context.command, context)


def _option(*names: str, about: str, **more: Any) -> Any:
    more = {"callback": _keep, **more}
    return typer.Option(
        *names, help=about, expose_value=False, rich_help_panel=_PANEL, show_default=False, **more
    )


@functools.cache
def _common() -> tuple[Any, ...]:
    """Make the options, by what typer makes of a function that takes them."""

    def takes_them(
        quiet: Annotated[bool, _option("-q", "--quiet", about="Print nothing but errors.")] = False,
        verbose: Annotated[
            bool, _option("-v", "--verbose", about="Print each step with the time it came at.")
        ] = False,
        as_json: Annotated[
            bool, _option("--json", about="Print what is told as one JSON document.")
        ] = False,
        force: Annotated[
            bool, _option("--force", about="Replace files of an earlier run.")
        ] = False,
        config: Annotated[
            Path | None,
            _option(
                "--config",
                about="Take options from a TOML file; what is typed wins.",
                metavar="FILE",
                is_eager=True,
                callback=_take,
            ),
        ] = None,
        save_config: Annotated[
            Path | None,
            _option("--save-config", about="Write the options into such a file.", metavar="FILE"),
        ] = None,
    ) -> None:
        """Have these options."""

    program = typer.Typer(add_completion=False)
    program.command()(takes_them)
    made = typer.main.get_command(program).params
    return tuple(each for each in made if each.name != "help")
