"""The C of an exported block as a program."""

from __future__ import annotations

import re

from hyst.export.c.c_sources import header, places, source
from hyst.export.c.core_copy import CoreCopy
from hyst.export.c.core_sources import core_files
from hyst.export.c.exported import Block
from hyst.export.c.numbers import Precision
from hyst.export.c.one_file import in_one_file
from hyst.export.translate.program import Program
from hyst.export.translate.reading import read_program
from hyst.operators import ModelDescription

_ENTRIES = ("init", "init_after", "step", "update", "command", "reset")


def entries_of(text: str, name: str) -> tuple[str, ...]:
    """Give the functions of an export called ``name`` that are translated, as far as it has them.

    Saving and loading a state is left to every language, for it is about bytes.

    Parameters
    ----------
    text
        C.
    name
        Its name.
    """
    return tuple(f"{name}_{each}" for each in _ENTRIES if re.search(rf"\b{name}_{each}\(.*;", text))


def c_text(block: Block, name: str, precision: Precision, about: ModelDescription) -> str:
    """Give all C of an export, the core's part included, as one text.

    Parameters
    ----------
    block
        What is exported.
    name
        Its name.
    precision
        Of the target.
    about
        What the numbers mean.
    """
    common = places(block, name, precision, about)
    declared, stage = header(block, common), source(block, common, precision)
    copy = CoreCopy("hyst", precision)
    own = {f"{name}.h": copy.renamed(declared), f"{name}.c": copy.renamed(stage)}
    return in_one_file(copy.files(core_files(stage + declared)), own)


def program_of(block: Block, name: str, precision: Precision, about: ModelDescription) -> Program:
    """Give the program of a block.

    Parameters
    ----------
    block
        What is exported.
    name
        The prefix of its functions.
    precision
        Of the target.
    about
        What the numbers mean.

    Returns
    -------
    Program

    Raises
    ------
    HystError
        If something in it cannot be translated.
    MissingExtraError
        If pycparser is not installed.
    """
    text = c_text(block, name, precision, about)
    return read_program(text, entries_of(text, name))
