"""Options that say nothing about what was chosen are refused, not passed over."""

from __future__ import annotations

from collections.abc import Collection, Mapping

import typer

import hyst


def refuse_irrelevant(
    context: typer.Context,
    takers: Mapping[str, Collection[str]],
    chosen: Collection[str],
    option: str,
) -> None:
    """Refuse an option that was typed although nothing of what was chosen takes it.

    Parameters
    ----------
    context
        Of the verb.
    takers
        For each parameter of the verb, by its name in Python, the choices that take it.
    chosen
        What was chosen; one that takes the parameter is enough.
    option
        The option by which it was chosen, as it is typed.

    Raises
    ------
    InputError
        If so; the option, what takes it and what was chosen are named.
    """
    for parameter, those in takers.items():
        if given(context, parameter) and not set(those) & set(chosen):
            raise hyst.InputError(
                f"{typed(context, parameter)} is for {option} {_listed(sorted(those))}, not for "
                f"{_listed(sorted(chosen))}; leave it out, or choose another {option}"
            )


def given(context: typer.Context, parameter: str) -> bool:
    """Tell whether a parameter of the verb, by its name in Python, was typed.

    Parameters
    ----------
    context
        Of the verb.
    parameter
        Its name in Python.

    Returns
    -------
    bool
    """
    source = context.get_parameter_source(parameter)
    return source is not None and source.name == "COMMANDLINE"


def typed(context: typer.Context, parameter: str) -> str:
    """Give the option of a parameter of the verb as it is typed.

    Parameters
    ----------
    context
        Of the verb.
    parameter
        Its name in Python.

    Returns
    -------
    str
    """
    return {each.name: each.opts[-1] for each in context.command.params}[parameter]


def _listed(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} or {names[-1]}"
