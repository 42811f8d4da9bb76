"""Options of a verb in a TOML file: ``--config`` reads it and ``--save-config`` writes it."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import hyst
from hyst._files import read_small, replacing

_LEFT_OUT = ("config", "save_config", "force", "quiet", "verbose", "as_json", "help")


def options_from(path: Path, command: Any, context: Any) -> dict[str, Any]:
    """Read options by their long names, and arguments by theirs.

    Parameters
    ----------
    path
        The file.
    command, context
        Of the verb.

    Returns
    -------
    dict
        Values by the names of the verb's parameters.

    Raises
    ------
    InputError
        If it is no TOML, or of another verb, or holds what is no option or no value of one.
    """
    try:
        read = tomllib.loads(read_small(path, 1_000_000).decode())
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise hyst.InputError(f"{path} cannot be read as TOML: {error}") from None
    verb = read.pop("verb", command.name)
    if verb != command.name:
        raise hyst.InputError(f"{path} has the options of hyst {verb}, not of {command.name}")
    known = _names(command, context)
    found = {}
    for name, value in read.items():
        if name.replace("_", "-") not in known:
            raise hyst.InputError(f"{path}: {name} is no option of hyst {command.name}")
        if isinstance(value, dict):
            raise hyst.InputError(f"{path}: {name} is a table; give a value")
        found[known[name.replace("_", "-")].name] = value
    return found


def write_options(path: Path, command: Any, context: Any, is_forced: bool) -> None:
    """Write the options that were given, typed or by a file.

    Parameters
    ----------
    path
        The file.
    command, context
        Of the verb; its parameters have been read.
    is_forced
        Whether a file that is there is replaced.

    Raises
    ------
    InputError
        If it exists, and that was not asked for.
    """
    if path.exists() and not is_forced:
        raise hyst.InputError(f"{path} exists; name another, or replace it with --force")
    texts = {name: text for each in context.meta.values() for name, text in _texts(each)}
    lines = [f"verb = {json.dumps(command.name)}"]
    for name, parameter in _names(command, context).items():
        source = context.get_parameter_source(parameter.name)
        if source is None or source.name not in ("COMMANDLINE", "DEFAULT_MAP"):
            continue
        value = context.params.get(parameter.name, texts.get(parameter.name))
        if parameter.name not in _LEFT_OUT and value is not None:
            lines.append(f"{name} = {_toml(value)}")
    with replacing(path) as temporary:
        temporary.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _names(command: Any, context: Any) -> dict[str, Any]:
    """Give the parameters by the names they have in a file."""
    found = {}
    for each in command.get_params(context):
        name = max(each.opts, key=len).lstrip("-").replace("_", "-")
        if name not in _LEFT_OUT and each.name not in _LEFT_OUT:
            found[name] = each
    return found


def _texts(kept: Any) -> list[tuple[str, Any]]:
    return list(kept.items()) if isinstance(kept, dict) else []


def _toml(value: Any) -> str:
    """Write a value; a JSON string is a TOML string."""
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml(each) for each in value) + "]"
    if isinstance(value, (bool, int, float)):
        return str(value).lower()
    return json.dumps(str(value))
