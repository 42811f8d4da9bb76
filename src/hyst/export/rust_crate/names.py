"""Names of C as names of Rust."""

from __future__ import annotations

from hyst.errors import InputError

# Words of Rust; those after the first line are kept for it.
_WORDS = """
    as async await break const continue dyn else enum extern false fn for if impl in let loop match
    mod move mut pub ref return static struct trait true type unsafe use where while
    abstract become box do final gen macro override priv try typeof unsized virtual yield
    union macro_rules raw safe
"""
_NEVER_RAW = frozenset(["crate", "self", "super", "Self", "_"])
KEYWORDS = frozenset(_WORDS.split()) | _NEVER_RAW

# Crates that the compiler brings, and names every module sees or the crate uses itself.
_CRATES = frozenset(["alloc", "core", "proc_macro", "std", "test"])
_TYPES = """
    AsMut AsRef BadHistory BadState Box Cell Clone Copy Debug Default DoubleEndedIterator
    Drop Eq Err ExactSizeIterator Extend Fn FnMut FnOnce From FromIterator Into
    IntoIterator Iterator None Ok Option Ord PartialEq PartialOrd Real Result Self Send
    Sized Some String Sync ToOwned ToString TryFrom TryInto Unpin Vec
"""
_TAKEN_TYPES = frozenset(_TYPES.split())


def rust_name(name: str) -> str:
    """Give a name of C as one of Rust: a word of Rust becomes raw, as ``r#loop``."""
    if name in _NEVER_RAW:
        return f"{name}_"
    return f"r#{name}" if name in KEYWORDS else name


def type_name(name: str) -> str:
    """Give the name of a type, as Rust writes such names.

    Examples
    --------
    >>> type_name("hyst_dead_zone")
    'HystDeadZone'
    """
    return "".join(part[:1].upper() + part[1:] for part in name.split("_") if part)


def constant_name(name: str) -> str:
    """Give the name of a constant, as Rust writes such names."""
    return name.upper()


def refuse_for_rust(name: str) -> None:
    """Refuse the name of an export that Rust has itself.

    Parameters
    ----------
    name
        A C identifier; the crate and its type are called after it.

    Raises
    ------
    InputError
        If it is a word of Rust, the name of a crate of the compiler, or its type would hide one
        that every module sees.
    """
    reason = ""
    if name in KEYWORDS or name.lower() in KEYWORDS:
        reason = "a word of Rust"
    elif name.lower() in _CRATES:
        reason = "a crate that comes with the compiler"
    elif type_name(name) in _TAKEN_TYPES:
        reason = f"whose type {type_name(name)} would hide that of Rust"
    elif name != name.lower():
        reason = "and names of crates have no capitals"
    if reason:
        raise InputError(f"the name is {name!r}, {reason}; give another, as stage")
