"""Lines of Rust, indented and of a width that people read."""

from __future__ import annotations

from textwrap import wrap

_WIDTH = 100


def laid_out(code: str) -> str:
    r"""Give code whose lines are indented by the braces around them.

    Parameters
    ----------
    code
        Without strings and comments that hold braces.

    Returns
    -------
    str
        The same at any machine, whether it has a formatter or not.

    Examples
    --------
    >>> print(laid_out("fn f() {\nreturn;\n}"))
    fn f() {
        return;
    }
    <BLANKLINE>
    """
    lines: list[str] = []
    depth = 0
    for raw in code.split("\n"):
        line = raw.strip()
        before = depth - line.startswith(("}", ")"))
        depth += line.count("{") + line.count("(") - line.count("}") - line.count(")")
        space = "    " * before
        if len(space) + len(line) > _WIDTH and not line.startswith("//"):
            lines += wrap(
                line,
                _WIDTH,
                initial_indent=space,
                subsequent_indent=f"{space}    ",
                break_long_words=False,
                break_on_hyphens=False,
            )
        else:
            lines.append((space + line).rstrip())
    return "\n".join(lines).rstrip("\n") + "\n"
