"""The program: its verbs, its global options, and how it ends."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Sequence
from typing import Annotated

import typer

import hyst
from hyst._typed_command import carrying_out
from hyst.cli.exit_codes import BAD_INPUT, DONE, FAILURE
from hyst.cli.verbs import VERBS, Verbs, is_carried_out

app = typer.Typer(
    cls=Verbs,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    help="From a measured hysteresis loop to a model, its exact inverse and a command.",
    epilog="Exit code: 0 done, 3 done but no command should come from the model, or devices fail, "
    "2 bad input, 1 failure.",
)
for verb, (_, about) in VERBS.items():
    app.command(verb, help=about)(is_carried_out)


def _show_version(wanted: bool) -> None:
    if wanted:
        print(f"hyst {hyst.__version__}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_show_version, is_eager=True, help="Show the version and exit."
        ),
    ] = False,
    debug: Annotated[bool, typer.Option("--debug", help="Show where an error came from.")] = False,
) -> None:
    """Take the options that come before the verb; each acts on its own."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the program; errors go to stderr in one sentence, with their origin after ``--debug``."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    debug = "--debug" in given
    # Whoever repeats a failed command appends the option, so it may stand anywhere.
    given = [each for each in given if each != "--debug"]
    try:
        with carrying_out(given):
            status = app(args=given, prog_name="hyst", standalone_mode=False)
    except typer.Abort:
        return _end("stopped", FAILURE)
    except Exception as error:
        if debug:
            traceback.print_exc()
        return _end(*_explain(error))
    return status if isinstance(status, int) else DONE


def _explain(error: Exception) -> tuple[str, int]:
    """Give the sentence and the exit code of an error."""
    if isinstance(error, hyst.HystError):
        # Bad input is a ValueError too; a solver that failed or a missing package is not.
        return str(error), BAD_INPUT if isinstance(error, ValueError) else FAILURE
    if hasattr(error, "format_message"):
        said = error.format_message() or "Missing verb."  # no arguments at all come without one
        return f"{said} (hyst --help shows what there is)", BAD_INPUT
    if isinstance(error, OSError):
        return str(error), FAILURE
    if isinstance(error, MemoryError):
        return f"the memory does not suffice ({error}); use a shorter record or drive", FAILURE
    what = f"{type(error).__name__}: {error}"
    return f"hyst itself failed, {what}; run it again with --debug and report it", FAILURE


def _end(message: str, status: int) -> int:
    print(f"error: {' '.join(message.split())}", file=sys.stderr)
    return status
