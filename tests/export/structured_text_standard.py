"""What the standard has of itself: types, conversions, names; and their equals in C."""

from __future__ import annotations

C_TYPES = {"BOOL": "int8_t", "DINT": "int32_t", "UDINT": "uint32_t", "DWORD": "uint32_t",
           "REAL": "float", "LREAL": "double"}  # fmt: skip
# name: argument, result, C. To a whole number is to the nearest, halves to the even one.
CONVERSIONS = {
    f"{a}_TO_{b}": (a, b, code)
    for a, b, code in [
        ("BOOL", "DINT", "(int32_t)({0})"),
        ("DINT", "LREAL", "(double)({0})"),
        ("DINT", "REAL", "(float)({0})"),
        ("REAL", "LREAL", "(double)({0})"),
        ("LREAL", "REAL", "(float)({0})"),
        ("LREAL", "DINT", "(int32_t)rint({0})"),
        ("REAL", "DINT", "(int32_t)rintf({0})"),
        ("DWORD", "UDINT", "({0})"),
        ("UDINT", "DWORD", "({0})"),
        ("DINT", "UDINT", "(uint32_t)({0})"),
        ("UDINT", "DINT", "(int32_t)({0})"),
    ]
}
# Functions and operators of other languages of the standard, which compilers know by these names.
_STANDARD = """
    abs acos add and asin atan cal calc calcn concat cos ctd ctu ctud delete div eq exp expt
    f_trig find ge gt insert jmp jmpc jmpcn ld ldn le left len limit ln log lt max mid min mod
    move mul mux ne not or r r_trig replace ret retc retcn right rol ror rs s sel shl shr sin
    sqrt sr st stn sub tan tof ton tp trunc xor time date tod dt string wstring bool byte word
    dword lword sint int dint lint usint uint udint ulint real lreal any on with to from end
"""
STANDARD_NAMES = {*_STANDARD.split(), *(name.lower() for name in CONVERSIONS)}
BITWISE = {"OR": "|", "XOR": "^", "AND": "&", "&": "&"}
PRELUDE = """
#include <math.h>
#include <setjmp.h>
#include <stdint.h>
#include <stddef.h>
#include <string.h>
#define TURNS 100000 /* of loops in one call; more is a loop without an end */
static jmp_buf stopped;
static int stopped_at;
static int32_t at(int32_t i, int32_t low, int32_t high, int line)
{
    if (i < low || i > high) { stopped_at = line; longjmp(stopped, 1); }
    return i - low;
}
static int64_t fuel;
static int burn(int line)
{
    if (--fuel < 0) { stopped_at = line; longjmp(stopped, 1); }
    return 1;
}
static int32_t divisor(int32_t i, int line)
{
    if (i == 0) { stopped_at = line; longjmp(stopped, 1); }
    return i;
}
"""
