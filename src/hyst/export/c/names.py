"""Names and texts of the user's, made safe for C, for CMake and for file systems."""

from __future__ import annotations

import re

from hyst.errors import InputError

LONGEST_NAME = 40

_C_KEYWORDS = """
    auto break case char const continue default do double else enum extern float for goto if inline
    int long register restrict return short signed sizeof static struct switch typedef union
    unsigned void volatile while
    alignas alignof bool complex imaginary noreturn nullptr static_assert thread_local typeof
    typeof_unqual constexpr true false asm fortran
"""
_CXX_KEYWORDS = """
    and and_eq atomic_cancel atomic_commit atomic_noexcept bitand bitor catch char8_t char16_t
    char32_t class co_await co_return co_yield compl concept const_cast consteval constinit
    decltype delete dynamic_cast explicit export final friend import module mutable namespace
    new noexcept not not_eq operator or or_eq override private protected public reflexpr
    reinterpret_cast requires static_cast synchronized template this throw try typeid typename
    using virtual wchar_t xor xor_eq
"""
# A file of such a name would hide the standard header from #include <...>.
_HEADERS = """
    assert complex ctype errno fenv float inttypes iso646 limits locale math memory setjmp signal
    stdalign stdarg stdatomic stdbit stdbool stdckdint stddef stdint stdio stdlib stdnoreturn string
    strings tgmath threads time uchar unistd wchar wctype
"""
# Targets that CMake keeps for itself, files that Windows keeps, and files of the export.
_TAKEN = """
    all clean depend edit_cache help install list_install_components package package_source
    rebuild_cache test
    aux com1 com2 com3 com4 com5 com6 com7 com8 com9 con lpt1 lpt2 lpt3 lpt4 lpt5 lpt6 lpt7 lpt8
    lpt9 nul prn
    core selftest
"""
# What a program that includes headers of the standard library has already: a state cannot be called
# so, and one called as a function that compilers call by themselves, memcpy, would be run.
_LIBRARY = """
    main std
    EOF FILE BUFSIZ L_ctermid L_tmpnam P_tmpdir FILENAME_MAX FOPEN_MAX TMP_MAX
    SEEK_CUR SEEK_END SEEK_SET NULL NAN INFINITY
    HUGE_VAL HUGE_VALF HUGE_VALL EXIT_FAILURE EXIT_SUCCESS RAND_MAX MB_CUR_MAX CHAR_BIT
    CLOCKS_PER_SEC offsetof stdin stdout stderr clearerr fclose feof ferror fflush fgetc fgetpos
    fgets fopen fprintf fputc fputs fread freopen fscanf fseek fsetpos ftell fwrite getc getchar
    gets perror printf putc putchar puts remove rename rewind scanf setbuf setvbuf snprintf sprintf
    sscanf tmpfile tmpnam ungetc vfprintf vfscanf vprintf vscanf vsnprintf vsprintf vsscanf
    abort abs atexit atof atoi atol atoll bsearch calloc div exit free getenv labs ldiv llabs lldiv
    malloc mblen mbstowcs mbtowc qsort rand realloc srand strtod strtof strtol strtold strtoll
    strtoul strtoull system wcstombs wctomb
    memchr memcmp memcpy memmove memset strcat strchr strcmp strcoll strcpy strcspn strerror strlen
    strncat strncmp strncpy strpbrk strrchr strspn strstr strtok strxfrm
    isalnum isalpha isblank iscntrl isdigit isgraph islower isprint ispunct isspace isupper isxdigit
    tolower toupper asctime clock ctime difftime gmtime localtime mktime strftime raise longjmp
    setjmp va_arg va_copy va_end va_start
    fpclassify isfinite isgreater isgreaterequal isinf isless islessequal islessgreater isnan
    isnormal isunordered signbit
"""
_MATHEMATICS = """
    acos acosh asin asinh atan atan2 atanh cbrt ceil copysign cos cosh erf erfc exp exp2 expm1 fabs
    fdim floor fma fmax fmin fmod frexp hypot ilogb ldexp lgamma llrint llround log log10 log1p log2
    logb lrint lround modf nan nearbyint nextafter nexttoward pow remainder remquo rint round
    scalbln scalbn sin sinh sqrt tan tanh tgamma trunc
"""
_OF_THE_LIBRARY = frozenset(
    _LIBRARY.split() + [each + kind for each in _MATHEMATICS.split() for kind in ("", "f", "l")]
)
_OF_STDINT = re.compile(
    r"\w+_t|(U?INT(\d+|_(LEAST|FAST)\d+|PTR|MAX)|PTRDIFF|SIZE|WCHAR|WINT|SIG_ATOMIC)_(MIN|MAX|C)"
)
_KEYWORDS = frozenset((_C_KEYWORDS + _CXX_KEYWORDS).split())
# What another export may define: lens has lens_core_..., lens_selftest and lens_clear_fault.
_OF_ANOTHER = re.compile(
    r"_core(_|$)|_(clear|selftest|selftest_vectors|step_response)$", re.IGNORECASE
)
_FILES = frozenset((_HEADERS + _TAKEN).split())


def as_c_name(name: str) -> str:
    """Check the name that prefixes everything an export defines.

    Parameters
    ----------
    name
        A C identifier, at most 40 characters.

    Returns
    -------
    str
        The name itself.

    Raises
    ------
    InputError
        If it is no C identifier, is a word of C or C++ or reserved there, is in the standard
        library, starts with "hyst", or would name a file, a target or a function that something
        else has.

    Examples
    --------
    >>> as_c_name("stage")
    'stage'
    """
    if not isinstance(name, str) or not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name, re.ASCII):
        raise InputError(
            f"the name is {name!r}; give a C identifier: letters, digits and underscores, no digit "
            "first"
        )
    reason = _objection(name)
    if reason:
        raise InputError(f"the name is {name!r}, {reason}; give another, as stage")
    return name


def _objection(name: str) -> str:
    if len(name) > LONGEST_NAME:
        return f"which has more than {LONGEST_NAME} characters"
    if name.startswith("_") or name.endswith("_") or "__" in name:
        return "and C or C++ reserves names with an underscore first, last or twice"
    if is_word(name):
        return "a word of C or C++"
    if name in _OF_THE_LIBRARY or _OF_STDINT.fullmatch(name):
        return "which the standard library of C or C++ has or keeps for itself"
    if name.lower().startswith("hyst"):
        return "but names that start with hyst are those of the core"
    if name.lower() in _FILES:
        return "which a standard header, CMake, Windows or another file of the export has"
    part = _OF_ANOTHER.search(name)
    if part:
        return f"but an export named {name[: part.start()]} may define the same with {part[0]}"
    return ""


# The micro sign and the Greek letter, the Ohm sign and the Greek letter look alike.
_SPELLED = {
    "\N{MICRO SIGN}": "u",
    "\N{GREEK SMALL LETTER MU}": "u",
    "\N{DEGREE SIGN}": "deg",
    "\N{OHM SIGN}": "Ohm",
    "\N{GREEK CAPITAL LETTER OMEGA}": "Ohm",
    "\N{SUPERSCRIPT TWO}": "^2",
    "\N{SUPERSCRIPT THREE}": "^3",
    "\N{MIDDLE DOT}": ".",
    "\N{MINUS SIGN}": "-",
}
_LONGEST_TEXT = 60


def is_word(name: str) -> bool:
    """Tell whether a ``name`` is a word of C or C++."""
    return name in _KEYWORDS or name.lower() in _KEYWORDS


def spelled(text: str) -> str:
    """Give a ``text`` with the signs of units as letters: um, degC, Ohm."""
    for special, word in _SPELLED.items():
        text = text.replace(special, word)
    return text


def plain_text(text: str, longest: int = _LONGEST_TEXT) -> str:
    """Give a text that means nothing to C, CMake, XML or Markdown, wherever it stands.

    Parameters
    ----------
    text
        Any, as the unit in a column's header.
    longest
        What is longer is cut.

    Returns
    -------
    str
        At most so many ASCII characters, one line; what is not letter, digit or harmless is "_".

    Examples
    --------
    >>> plain_text("µm"), plain_text("V */ #error")
    ('um', 'V _/ _error')
    """
    return re.sub(r"[^A-Za-z0-9 .,:+/()%^=-]", "_", spelled(text)[:longest])
