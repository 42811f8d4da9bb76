"""What is said where C cannot be translated."""

from __future__ import annotations

from typing import Any

from hyst.errors import HystError


class UntranslatableError(HystError):
    """A construct of C that the translation does not know; it refuses instead of guessing."""


def refused(what: str, node: Any = None) -> UntranslatableError:
    """Give the error for a construct; the function it is in is added where it is known.

    Parameters
    ----------
    what
        The construct, with its article.
    node
        Of the syntax tree, for its text.

    Returns
    -------
    UntranslatableError
    """
    return UntranslatableError(f"{what}{_text(node)} cannot be translated")


def _text(node: Any) -> str:
    if node is None:
        return ""
    from pycparser import c_generator

    text = " ".join(c_generator.CGenerator().visit(node).split())
    return f" in '{text if len(text) < 80 else text[:77] + '...'}'"
