"""The front end of other languages: what it makes of C, and what it refuses."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hyst import HystError
from hyst.export.translate.conversions import real_literal, whole_literal
from hyst.export.translate.facts import facts_of
from hyst.export.translate.pointers import split
from hyst.export.translate.preprocessor import preprocessed
from hyst.export.translate.program import (
    DOUBLE,
    FLOAT,
    INT,
    SIZE,
    UNSIGNED,
    WIDE,
    Array,
    Assign,
    Binary,
    Comparison,
    Conditional,
    Convert,
    Declare,
    Element,
    FromBits,
    If,
    Logical,
    Name,
    Number,
    Pointer,
    Program,
    Return,
    ToBits,
    Variable,
)
from hyst.export.translate.reading import read_program
from hyst.export.translate.refusal import UntranslatableError

HEAD = """
typedef double hyst_real;
typedef struct { size_t count; const hyst_real *p; } bank;
typedef struct { hyst_real u, y; } point;
typedef union { hyst_real value; uint64_t bits; } pattern;
enum { FIRST, SECOND = 5, THIRD };
"""


def program(code: str, *entries: str) -> Program:
    return read_program(HEAD + code, entries or ("f",))


def body_of(code: str) -> tuple[object, ...]:
    return program(code).functions["f"].body


def _tokens(text: str) -> list[str]:
    """White space between tokens is of no account."""
    return re.findall(r"[\w.-]+|\S", text)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("#define A 2\n#ifdef A\nx A;\n#else\ny;\n#endif\n", "x 2;\n"),
        ("#ifndef A\nx;\n#elif 1\ny;\n#else\nz;\n#endif\n", "x;\n"),
        ("#if 0\n#if 1\nx;\n#endif\n#elif defined(B) || 1\ny;\n#else\nz;\n#endif\n", "y;\n"),
        ("#define S(c, a, b) ((c) ? (a) : (b))\nS(x < y, (1, 2), z)\n",
         "((x < y) ? ((1, 2)) : (z))\n"),
        ("#define R(x) x##f\n#define HALF R(0.5)\nHALF /* half */ + R(1e-3)\n", "0.5f + 1e-3f\n"),
        ("#define A B\n#define B A\nA\n", "A\n"),
        ("#define F(x) x + 1\nF * F(F(2))\n#undef F\nF(2)\n", "F * 2 + 1 + 1\nF(2)\n"),
        ("a = UINT64_C(0x3ff0);\n#include <stdint.h>\n", "a = 0x3ff0ull;\n"),
    ],
)  # fmt: skip
def test_the_preprocessor_does_what_c_says(text: str, expected: str) -> None:
    assert _tokens(preprocessed(text)) == _tokens(expected)


def test_an_error_of_the_text_and_unknown_directives_are_told() -> None:
    with pytest.raises(HystError, match="refuses itself: no"):
        preprocessed("#ifdef X\n#error yes\n#else\n#error no\n#endif\n")
    with pytest.raises(HystError, match="#line"):
        preprocessed("#line 7\n")


# numpy reads a decimal text as single by way of double, which misses at most a tie; the texts with
# more digits than a tie has are decided by hand: 1 + 2^-24 is half way between 1 and its neighbour.
@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0.0f", 0.0),
        ("0.1f", float(np.float32(0.1))),
        ("1.000000059604644775390625f", 1.0),
        ("1.00000005960464477539062500000001f", 1.0 + 2.0**-23),
        ("1e-45f", 2.0**-149),
        ("3.4028235e38f", float(np.finfo(np.float32).max)),
        ("0x1.8p-3", 0.1875),
    ],
)
def test_real_constants_are_rounded_once(text: str, value: float) -> None:
    number = real_literal(text)
    assert number.value == value
    assert number.type == (FLOAT if text.endswith("f") else DOUBLE)


@given(st.floats(0.0, allow_infinity=False, width=32))
def test_single_constants_are_read_back_to_the_bit(value: float) -> None:
    assert real_literal(f"{value!r}f").value == value
    assert real_literal(f"{value.hex()}f").value == value


@pytest.mark.parametrize(
    ("text", "value", "kind"),
    [("7", 7, INT), ("0x10u", 16, UNSIGNED), ("4294967296", 2**32, WIDE), ("1ull", 1, WIDE)],
)
def test_whole_constants_have_the_type_of_c(text: str, value: int, kind: object) -> None:
    assert whole_literal(text) == Number(value, kind)


def test_conversions_are_made_explicit() -> None:
    code = "double f(double x, int n, unsigned k) { return x * (n + k) - n / 2; }"
    (statement,) = body_of(code)
    x, n, k = (Name(*each, "parameter") for each in (("x", DOUBLE), ("n", INT), ("k", UNSIGNED)))
    whole = Binary("+", Convert(n, UNSIGNED), k, UNSIGNED)
    half = Binary("/", n, Number(2, INT), INT)
    product = Binary("*", x, Convert(whole, DOUBLE), DOUBLE)
    assert statement == Return(Binary("-", product, Convert(half, DOUBLE), DOUBLE))


def test_conditions_are_comparisons() -> None:
    code = "int f(int a, double x) { if (a && !(x > 0.0)) { return THIRD; } return a == SECOND; }"
    first, last = body_of(code)
    assert isinstance(first, If)
    assert isinstance(first.condition, Logical)
    assert first.condition.left == Comparison(
        "!=", Name("a", INT, "parameter"), Number(0, INT), INT
    )
    assert first.then == (Return(Number(6, INT)),)
    assert last == Return(Comparison("==", Name("a", INT, "parameter"), Number(5, INT), INT))


def test_a_local_pointer_becomes_an_index() -> None:
    code = """
    double f(const bank *b, size_t k)
    {
        const double *row = b->p + 4u * k;
        row += 2;
        return row[1];
    }
    """
    first, second, last = body_of(code)
    place = Name("row_at", SIZE, "local")
    assert isinstance(first, Declare)
    assert first.variable == Variable("row_at", SIZE, False)
    assert second == Assign(place, Binary("+", place, Number(2, SIZE), SIZE))
    assert isinstance(last, Return)
    assert isinstance(last.value, Element)
    assert last.value.index == Binary("+", place, Number(1, SIZE), SIZE)
    assert split(last.value.of)[1] == Number(0, SIZE)


def test_a_union_of_a_number_and_its_bits_becomes_the_bits() -> None:
    code = "double f(double x) { pattern p; p.value = x; p.bits = p.bits >> 1; return p.value; }"
    declared, taken, shifted, given_back = body_of(code)
    bits = Name("p", WIDE, "local")
    assert isinstance(declared, Declare)
    assert declared.variable.type == WIDE
    assert taken == Assign(bits, ToBits(Name("x", DOUBLE, "parameter"), WIDE))
    assert shifted == Assign(bits, Binary(">>", bits, Number(1, INT), WIDE))
    assert given_back == Return(FromBits(bits, DOUBLE))


def test_a_switch_becomes_comparisons_and_names_stay_apart() -> None:
    code = """
    int f(int k)
    {
        int y = 0;
        switch (k) {
        case FIRST:
        case SECOND: { int k = 2; y = k; break; }
        default: y = 3;  break;
        }
        return y;
    }
    """
    function = program(code).functions["f"]
    choice = function.body[1]
    assert isinstance(choice, If)
    assert isinstance(choice.condition, Logical)
    assert [each.name for each in function.locals] == ["y", "k_2"]
    assert choice.other == (Assign(Name("y", INT, "local"), Number(3, INT)),)


def test_tables_functions_and_members_that_nothing_reads() -> None:
    code = """
    static const double weights[2] = {1.0, 0x1p-1};
    static const bank both = {2u, weights};
    static const double unused[1] = {3.0};
    static double sum(const bank *b) { return b->p[0] + b->p[1]; }
    static double other(const bank *b) { return (double)b->count; }
    double f(void) { return sum(&both); }
    """
    read = program(code)
    assert list(read.tables) == ["weights", "both"]
    assert list(read.functions) == ["sum", "f"]
    assert read.tables["weights"].type == Array(DOUBLE, 2)
    assert read.structures["bank"].members["p"] == Pointer(DOUBLE, is_const=True)
    assert list(program(code, "other").structures["bank"].members) == ["count"]


def test_facts_tell_what_is_written_null_and_where_it_lies() -> None:
    code = """
    static const double weights[2] = {1.0, 0.5};
    typedef struct { double memory[4]; } state;
    static void set(double *z, double u) { z[1] = u; }
    static double one(const point *p, double *slope)
    {
        *slope = 1.0;
        return p == NULL ? 0.0 : p->u;
    }
    static double first(const double *w) { return w[0]; }
    double f(state *s, double u)
    {
        double slope;
        set(s->memory + 1, u);
        return one(NULL, &slope) + first(weights) + slope;
    }
    """
    read = program(code)
    facts = facts_of(read)
    assert facts.written == {("set", "z"), ("one", "slope"), ("f", "s")}
    assert facts.nullable == {("one", "p")}
    assert facts.lies["set", "z"] == {"memory"}
    assert facts.lies["one", "slope"] == {"local"}
    assert facts.lies["first", "w"] == {"table"}
    assert facts.is_one_number(read, "one", "slope")
    assert not facts.is_one_number(read, "set", "z")


@pytest.mark.parametrize(
    ("code", "said"),
    [
        ("double f(double x) { again: if (x > 1.0) { x = x - 1.0; goto again; } return x; }",
         "a Label"),
        ("int f(int k) { do { --k; } while (k > 0); return k; }", "a DoWhile"),
        ("int f(int k) { while (k > 0) { --k; if (k == 3) { continue; } } return k; }",
         "a continue"),
        ("int f(int k) { return k > 0 ? f(k - 1) : 0; }", "f, which calls itself"),
        ("int f(int k) { return k++; }", r"p\+\+ inside an expression"),
        ("double f(double x) { return sin(x); }", "a call of sin, which the text does not define"),
        ("int f(int k) { static int n = 0; n = n + k; return n; }", "a static variable"),
        ("int f(int k) { switch (k) { case 1: k = 2; case 2: k = 3; break; } return k; }",
         "goes on with the next one"),
        ("double f(double *a, double *b, int k) { double *p = a; if (k) { p = b; } return *p; }",
         "now here, now there"),
        ("long double f(long double x) { return x; }", "the type long double"),
        ("typedef union { float a; int b; } pun; float f(pun p) { return p.a; }", "a union"),
        ("int f(const double *a, const double *b) { return a < b; }", "< of pointers"),
        ("int f(double x) { return sizeof(x) > 4; }", "sizeof"),
        ("typedef struct { int (*g)(int k); } row; static int a(int k) { return k; }\n"
         "static int b(int k) { return -k; } static const row first = {a}, last = {b};\n"
         "int f(int k) { return k ? first.g(k) : last.g(k); }", "which points to a or b"),
        ("double f(double x) { return x * 0.1L; }", "the constant 0.1L of extended precision"),
        ("double f(int k) { return (double)(k * 5L); }", "the constant 5L of type long"),
        ("int f(unsigned k) { return k > 3000000000; }", "3000000000 of type long"),
        ("int f(int k) { return k + 010; }", "the octal constant 010"),
        ("static double g = 0.0; double f(double x) { g = x; return g; }",
         "the variable g of the file"),
        ("static const double *g = 0; double f(double x) { return g[0] * x; }",
         "the variable g of the file"),
        ("static int g(int *p) { *p = *p + 1; return *p; }\n"
         "double f(double x) { int k = 0; double a[3] = {0.0}; a[g(&k)] += x; return a[1]; }",
         "a call inside a place that is changed"),
        ("int f(int k) { switch (k) { int n; case 1: n = k; return n; } return k; }",
         "before the cases"),
        ("int f(int k) { switch (k) case 1: return 2; return k; }", "a switch without a block"),
        ("int f(int k, ...) { return k; }", "any number of arguments"),
    ],
)  # fmt: skip
def test_what_is_not_known_is_refused_by_function_and_construct(code: str, said: str) -> None:
    with pytest.raises(HystError, match=said) as refused:
        program(code)
    if isinstance(refused.value, UntranslatableError) and "union" not in said:
        assert str(refused.value).startswith("in f: ")
        assert "\n" not in str(refused.value)


def test_a_member_of_some_bits_is_refused() -> None:
    with pytest.raises(HystError, match="a member of some bits"):
        program("typedef struct { int a : 3; } row; int f(row of) { return of.a; }")


def test_a_structure_may_be_named_by_its_tag_alone() -> None:
    code = "struct pair { double a; double b; }; double f(const struct pair *of) { return of->b; }"
    assert list(program(code).structures) == ["pair"]


def test_constants_of_whole_numbers_are_cut_off_towards_zero() -> None:
    code = "enum { A = -7, B = A / 2, C = 7 / 2 }; double f(double x) { return x; }"
    constants = program(code).constants
    assert (constants["A"], constants["B"], constants["C"]) == (-7, -3, 3)


def test_pointers_to_one_of_two_may_be_chosen_once() -> None:
    code = """
    double f(const bank *a, const bank *b, int k)
    {
        const double *p = k > 0 ? a->p : b->p;
        return p[2];
    }
    """
    (last,) = body_of(code)
    assert isinstance(last, Return)
    assert isinstance(last.value, Element)
    assert isinstance(last.value.of, Conditional)
