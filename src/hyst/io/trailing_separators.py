"""Drop the separator that some instruments write at the end of every line."""

from __future__ import annotations

from hyst.io.notation import SAMPLED, Writing


def drop_trailing_separators(lines: list[str], writing: Writing) -> list[str]:
    """Drop the separator at the end of every line.

    Parameters
    ----------
    lines
        Lines without comments and blank ones.
    writing
        How they are written.

    Returns
    -------
    list of str
        The lines as they were unless all of them, headers and footers aside, end with a separator.

    Examples
    --------
    >>> drop_trailing_separators(["u;y", "1;2;", "3;4;"], Writing(";", "."))
    ['u;y', '1;2', '3;4']
    """
    separator = writing.separator
    if separator is None:
        return lines
    blank = " " if separator == "\t" else " \t"
    if not lines[len(lines) // 2].rstrip(blank).endswith(separator):
        return lines
    odd = [k for k, line in enumerate(lines) if not line.rstrip(blank).endswith(separator)]
    if len(odd) > SAMPLED or any(_may_be_row(k, lines, writing) for k in odd):
        return lines
    return [line.rstrip(blank).removesuffix(separator) for line in lines]


def _may_be_row(index: int, lines: list[str], writing: Writing) -> bool:
    """Tell whether a line that ends otherwise needs its last cell; the last may break off."""
    kind = writing.kind(lines[index])
    separator, row = writing.separator or "", lines[len(lines) // 2]
    if kind == "text" and lines[index].count(separator) == row.count(separator):
        return True  # a header that names the last column, empty as it is
    if kind == "text" or (index == len(lines) - 1 and len(lines) > SAMPLED):
        return False
    return kind == "numeric" or index > SAMPLED
