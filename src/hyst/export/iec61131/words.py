"""Names that IEC 61131-3 leaves to the user."""

from __future__ import annotations

import re

from hyst.errors import InputError

# Keywords of the third edition, and of the vendors that are told apart from names by no prefix.
_KEYWORDS = """
    abstract action and any array at begin by case class configuration constant continue do else
    elsif end end_action end_case end_class end_configuration end_for end_function
    end_function_block end_if end_interface end_method end_namespace end_program end_property
    end_repeat end_resource end_step end_struct end_transition end_type end_union end_var
    end_while en eno exit extends f_edge false final for from function function_block get global
    goto if implements initial_step interface internal interval jmp method mod namespace
    non_retain not null of on or overlap override persistent pointer priority private program
    property protected public r_edge read_only read_write ref reference repeat resource retain
    return set single step struct super task then this to transition true type union until using
    var var_access var_config var_external var_global var_in_out var_inst var_input var_output
    var_stat var_temp volatile while with xor bit bool byte char date date_and_time dint dt
    dword ldate ldt lint lreal ltime ltod lword real sint string tod time time_of_day udint uint
    ulint usint wchar word wstring int ldate_and_time ltime_of_day pvoid uxint xint xword
    any_bit any_char any_chars any_date any_derived any_duration any_elementary any_int
    any_magnitude any_num any_real any_signed any_string any_unsigned var_generic
"""
# Standard functions and function blocks, operators of the vendors, and those of instruction lists.
_FUNCTIONS = """
    abs acos add adr and_then asin atan atan2 bitadr cal calc calcn ceil concat cos ctd ctu ctud
    delete div eq exp expt f_trig find floor ge gt indexof ini insert is_valid jmpc jmpcn ld ldn
    le left len limit ln log lower_bound lt max mid min move mul mux ne neg or_else r_trig
    replace ret retc retcn right rol ror round rs rtc sel sema shl shr sign sin sizeof sqrt sr
    st stn sub tan tof ton tp trunc trunc_int upper_bound xsizeof
"""
# What the block has inside beside its signals, which give way themselves.
_INSIDE = frozenset(["began", "i", "ignored", "numbers", "state"])
# One letter alone means something in sequential charts, instruction lists or literals of time.
_LETTERS = "d l n p r s t"
RESERVED = frozenset((_KEYWORDS + _FUNCTIONS + _LETTERS).split())
_ELEMENTARY = (
    "bool|byte|l?date|l?dt|d?word|lword|l?real|l?time|l?tod|u?[sdl]?int|string|wstring|w?char|bcd"
)
# Standard counters and functions of times by the type they are for: CTU_DINT, ADD_TIME.
_BY_TYPE = re.compile(
    r"ct(u|d|ud)_u?[sdl]?int|(add|sub|mul|div|concat|split)_l?(time|tod|dt|date)\w*"
)
_CONVERSION = re.compile(rf"({_ELEMENTARY})_(to|trunc|bcd)\w*|to_({_ELEMENTARY})")


def is_taken(name: str) -> bool:
    """Tell whether a name means something else in structured text, whatever its case."""
    low = name.lower()
    return low in RESERVED or any(each.fullmatch(low) for each in (_CONVERSION, _BY_TYPE))


def as_block_name(name: str) -> str:
    """Check the name of a function block, which is a C identifier already.

    Parameters
    ----------
    name
        Of the export.

    Returns
    -------
    str
        The name itself.

    Raises
    ------
    InputError
        If structured text keeps it for something else, or the block has it inside.
    """
    if is_taken(name):
        raise InputError(
            f"the name is {name!r}, a name that collides in the other language: structured text "
            "keeps it, in upper case or lower; give another, as stage"
        )
    if name.lower() in _INSIDE:
        raise InputError(
            f"the name is {name!r}, which a variable inside the block has; give another, as stage"
        )
    return name


class Names:
    """Names for one scope: none is kept by the language, no two differ by case alone."""

    def __init__(self, taken: frozenset[str] = frozenset()) -> None:
        self._taken = {each.lower() for each in taken}
        self._by_name: dict[str, str] = {}

    def of(self, name: str) -> str:
        """Give what a name of C is called, always the same."""
        if name not in self._by_name:
            self._by_name[name] = self.fresh(name)
        return self._by_name[name]

    def fresh(self, name: str) -> str:
        """Give a name that nothing has yet, as near to ``name`` as can be."""
        plain = re.sub("_+", "_", name).strip("_") or "x"
        if is_taken(plain):
            plain = f"the_{plain}"
        own, count = plain, 1
        while own.lower() in self._taken or is_taken(own):
            count += 1
            own = f"{plain}_{count}"
        self._taken.add(own.lower())
        return own
