"""The C preprocessor as far as the core asks for it: conditions, macros, no files.

It is no general one: it knows the macros that the text itself defines, so that no compiler of the
machine and no header of its takes part.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import final

from hyst.errors import HystError

_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)
_DIRECTIVE = re.compile(r"\s*#\s*(\w+)\s*(.*)", re.DOTALL)
_DEFINE = re.compile(r"(\w+)(\(([\w\s,]*)\))?\s*(.*)", re.DOTALL)
_TOKEN = re.compile(
    r"""0[xX][0-9a-fA-F]*\.?[0-9a-fA-F]*[pP][+-]?\d+[fFlL]?|\.?\d(?:[eE][+-]|[\w.])*"""
    r"""|[A-Za-z_]\w*|"(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*'|\#\#|\s+|.""",
    re.DOTALL,
)


@final
@dataclass(frozen=True)
class Macro:
    """A macro.

    Parameters
    ----------
    parameters
        Names; None for a macro that takes no arguments.
    body
        Tokens.
    """

    parameters: tuple[str, ...] | None
    body: tuple[str, ...]


# What the standard headers that are not read would define.
_STANDARD = {
    "UINT64_C": Macro(("literal",), ("literal", "##", "ull")),
    "UINT32_C": Macro(("literal",), ("literal", "##", "u")),
}


def preprocessed(text: str, defined: tuple[str, ...] = ()) -> str:
    r"""Give C without directives, comments and macros.

    Parameters
    ----------
    text
        C, all of it: an ``#include`` is left out.
    defined
        Macros that are defined from the start, as nothing.

    Returns
    -------
    str

    Raises
    ------
    HystError
        If a directive is unknown, or an ``#error`` is reached.

    Examples
    --------
    >>> preprocessed("#define REAL(x) x##f\n#ifdef SINGLE\na = REAL(1.0);\n#endif\n", ("SINGLE",))
    'a = 1.0f;\n'
    """
    reader = _Reader({**_STANDARD, **{name: Macro(None, ()) for name in defined}})
    code = _COMMENT.sub(" ", text).replace("\\\n", " ")
    pending: list[str] = []
    for line in code.split("\n"):
        if not line.lstrip().startswith("#"):
            if reader.is_kept:
                pending.append(line)
            continue
        reader.keep("\n".join(pending))
        pending = []
        reader.directive(line)
    reader.keep("\n".join(pending))
    return "".join(reader.parts)


class _Reader:
    """Macros, conditions and text so far."""

    def __init__(self, macros: dict[str, Macro]) -> None:
        self.macros = macros
        self.parts: list[str] = []
        # Of every open condition: whether its lines count, and whether a branch of it has.
        self.conditions: list[tuple[bool, bool]] = []

    @property
    def is_kept(self) -> bool:
        return all(kept for kept, _ in self.conditions)

    def keep(self, text: str) -> None:
        if text.strip():
            expanded = "".join(_expanded(_TOKEN.findall(text), self.macros, frozenset()))
            lines = (line.rstrip() for line in expanded.split("\n"))
            self.parts.append("".join(f"{line}\n" for line in lines if line))

    def directive(self, line: str) -> None:
        found = _DIRECTIVE.match(line)
        name, rest = (found[1], found[2].strip()) if found else ("", "")
        if name in ("ifdef", "ifndef", "if"):
            holds = self._holds(name, rest) if self.is_kept else False
            self.conditions.append((holds, holds))
        elif name in ("else", "elif", "endif"):
            self._next_branch(name, rest)
        elif self.is_kept:
            self._effect(name, rest)

    def _next_branch(self, name: str, rest: str) -> None:
        _, has_held = self.conditions.pop()
        if name == "endif":
            return
        holds = not has_held and self.is_kept and (name == "else" or self._holds("if", rest))
        self.conditions.append((holds, has_held or holds))

    def _effect(self, name: str, rest: str) -> None:
        if name == "define":
            found = _DEFINE.fullmatch(rest)
            if found is None:
                raise HystError(f"#define {rest} is no macro that can be translated")
            parameters = None
            if found[2] is not None:
                parameters = tuple(each.strip() for each in found[3].split(",") if each.strip())
            self.macros[found[1]] = Macro(parameters, tuple(_TOKEN.findall(found[4].strip())))
        elif name == "undef":
            self.macros.pop(rest, None)
        elif name == "error":
            raise HystError(f"the C to translate refuses itself: {rest}")
        elif name not in ("include", "pragma"):
            raise HystError(f"#{name} in the C to translate is not known")

    def _holds(self, name: str, rest: str) -> bool:
        if name == "ifdef":
            return rest.split()[0] in self.macros
        if name == "ifndef":
            return rest.split()[0] not in self.macros
        return _condition(rest, self.macros)


def _condition(text: str, macros: dict[str, Macro]) -> bool:
    """Give the value of an ``#if`` made of ``defined``, names, whole numbers, &&, || and !."""
    known = re.sub(
        r"\bdefined\s*\(?\s*(\w+)\s*\)?", lambda found: str(int(found[1] in macros)), text
    )
    expanded = "".join(_expanded(_TOKEN.findall(known), macros, frozenset()))
    numbers = re.sub(r"\b[A-Za-z_]\w*", "0", re.sub(r"(\d)[uUlL]+", r"\1", expanded))
    words = numbers.replace("&&", " and ").replace("||", " or ")
    words = re.sub(r"!(?!=)", " not ", words)
    if re.fullmatch(r"(?:[\d\s()<>=!+*-]|and|or|not)*", words) is None or not words.strip():
        raise HystError(f"#if {text} in the C to translate is not known")
    return bool(eval(words, {"__builtins__": {}}))


def _expanded(tokens: list[str], macros: dict[str, Macro], hidden: frozenset[str]) -> list[str]:
    """Give tokens with every macro replaced; ``hidden`` ones are being replaced."""
    result: list[str] = []
    place = 0
    while place < len(tokens):
        token = tokens[place]
        place += 1
        macro = macros.get(token) if token not in hidden else None
        if macro is None:
            result.append(token)
            continue
        body = list(macro.body)
        if macro.parameters is not None:
            arguments, after = _arguments(tokens, place)
            if arguments is None:
                result.append(token)
                continue
            place = after
            body = _substituted(macro, arguments, macros, hidden)
        result += _expanded(body, macros, hidden | {token})
    return result


def _arguments(tokens: list[str], place: int) -> tuple[list[list[str]] | None, int]:
    """Give the arguments of a macro, and where the text goes on; None where there are none."""
    while place < len(tokens) and tokens[place].isspace():
        place += 1
    if place == len(tokens) or tokens[place] != "(":
        return None, place
    depth, arguments = 1, [[]]  # type: tuple[int, list[list[str]]]
    while depth:
        place += 1
        if place == len(tokens):
            raise HystError("a macro in the C to translate has no closing parenthesis")
        token = tokens[place]
        depth += {"(": 1, ")": -1}.get(token, 0)
        if token == "," and depth == 1:
            arguments.append([])
        elif depth:
            arguments[-1].append(token)
    return arguments, place + 1


def _substituted(
    macro: Macro, arguments: list[list[str]], macros: dict[str, Macro], hidden: frozenset[str]
) -> list[str]:
    """Give the body of a macro with its arguments, two of its tokens pasted where it asks."""
    given = dict(zip(macro.parameters or (), arguments, strict=True))
    body = [token for token in macro.body if not token.isspace()]
    result: list[str] = []
    for place, token in enumerate(body):
        if token == "##":
            continue
        pasted = "##" in (body[place - 1 : place] + body[place + 1 : place + 2])
        if token in given:
            raw = given[token]
            tokens = raw if pasted else _expanded(raw, macros, hidden)
            written = "".join(tokens).strip()
        else:
            written = token
        if place and body[place - 1] == "##":
            result[-1] += written
        else:
            result += [*(_TOKEN.findall(written) if not pasted else [written]), " "][:-1]
            if not pasted:
                result.append(" ")
    return [each for each in result if each]
