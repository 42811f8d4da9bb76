"""Options of the families of models, as the registry has them.

They are made when a verb is parsed or explained, not when the program starts: the registry loads
the numerics of all families.
"""

from __future__ import annotations

import functools
import inspect
from typing import Annotated, Any

import typer

import hyst
from hyst.cli.option_files import FILE, opened
from hyst.cli.verb import Verb

_PANEL = "Options of the families"
_TYPED = "hyst.cli.family_options"


class FamilyCommand(Verb):
    """A verb with the options of all families beside its own; its ``--family`` lists them."""

    def get_params(self, ctx: Any) -> list[Any]:
        """Give the parameters of the verb, then the options of the families."""
        own: list[Any] = [*super().get_params(ctx)]
        for each in own:
            if each.name == "family":
                each.help = _families_in_words()
        return [*own, *_options_of_families()]


def options_given(context: typer.Context, family: str) -> dict[str, Any]:
    """Read the options of families that were typed.

    Parameters
    ----------
    context
        Of the verb.
    family
        What was typed after ``--family``.

    Returns
    -------
    dict
        Values by the names they have in Python.

    Raises
    ------
    InputError
        If a family is unknown, or an option is of none of those named or cannot be read.
    """
    names = hyst.identification.names_of(family)
    values: dict[str, Any] = {}
    own_names = {_as_parameter(name): name for name in _names()}
    for parameter, text in context.meta.get(_TYPED, {}).items():
        name = own_names[parameter]
        said = _as_typed(name)
        hyst.identification.require_taken(name, names, said=said, of="--family")
        for each in names:
            option = hyst.families.option(each, name)
            if option is not None:
                is_file = option.metavar == FILE
                values[name] = opened(text, said) if is_file else option.read(text, said)
                option.check(values[name], said)
    return values


def _as_typed(name: str) -> str:
    """Give an option as it is typed: by its own name, unless that means something else there."""
    option = hyst.families.option(hyst.families.takers(name)[0], name)
    typed = option.typed if option is not None else ""
    return f"--{typed or name.replace('_', '-')}"


def _as_parameter(name: str) -> str:
    """Give the name under which typer knows an option, beside those of the verbs."""
    return _as_typed(name).removeprefix("--").replace("-", "_")


def _names() -> tuple[str, ...]:
    return tuple(dict.fromkeys(name for each in hyst.families.values() for name in each.options()))


def _families_in_words() -> str:
    listed = ", ".join(f"{name} ({each.words.full_name})" for name, each in hyst.families.items())
    compared = ", ".join(hyst.families.compared())
    reserve = ", ".join(hyst.families.in_reserve())
    return (
        f"auto (compares {compared}, and where these leave more than noise and no option of a "
        f"family is given, also {reserve}), one, or several with commas between them: {listed}."
    )


@functools.cache
def _options_of_families() -> tuple[Any, ...]:
    """Make the options, by what typer makes of a function that takes them."""

    def takes_them() -> None:
        """Have the signature below."""

    names = {_as_parameter(name): name for name in _names()}
    hints = {typed: Annotated[str | None, _option(name)] for typed, name in names.items()}
    takes_them.__annotations__ = hints
    takes_them.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
        [
            inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=hint)
            for name, hint in hints.items()
        ]
    )
    program = typer.Typer(add_completion=False)
    program.command()(takes_them)
    made = typer.main.get_command(program).params
    return tuple(each for each in made if each.name in names)


def _option(name: str) -> Any:
    takers = hyst.families.takers(name)
    first = hyst.families.option(takers[0], name)
    assert first is not None, "its takers have it"
    return typer.Option(
        _as_typed(name),
        metavar=first.metavar,
        help=f"{first.help} ({', '.join(takers)})",
        show_default=_default_in_words(name, takers),
        expose_value=False,
        callback=_keep,
        rich_help_panel=_PANEL,
    )


def _default_in_words(name: str, takers: tuple[str, ...]) -> str | bool:
    """Give the default, or those of single families where they differ; nothing for None."""
    families = {each: hyst.families[each] for each in takers}
    defaults = {
        each: getattr(family, name) for each, family in families.items() if name in family.options()
    }
    most = next(iter(defaults.values()))
    if most is None:
        return False
    others = [f"{each}: {value}" for each, value in defaults.items() if value != most]
    most = getattr(most, "name", most)  # of a family that is in front by default
    return "; ".join([str(most), *others])


def _keep(context: typer.Context, parameter: typer.CallbackParam, text: str | None) -> None:
    """Keep the text of an option that was typed."""
    if text is not None:
        context.meta.setdefault(_TYPED, {})[parameter.name] = text
