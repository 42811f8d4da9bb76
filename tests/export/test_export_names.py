"""Names that prefix C, and texts of the user's in comments."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from c_builds import AS_C, AS_CXX, Objects, check_syntax, compiler, run_selftest
from hypothesis import given
from hypothesis import strategies as st

from hyst import InputError, PrandtlIshlinskii
from hyst.export import c_project
from hyst.export.c.names import as_c_name, plain_text
from hyst.operators import ModelDescription

MODEL = PrandtlIshlinskii([0.5, 0.2], [0.1, 0.3], 1.0)


@pytest.mark.parametrize(
    "name",
    [
        "stage",
        "Stage_2",
        "u",
        "y",
        "k",
        "state",
        "samples",
        "place",
        "pi_1",
        "check",
        "lens_pi",
        "HIGH",
        "loop",
    ],
)
def test_names_that_are_c_compile(name: str, tmp_path: Path, objects: Objects) -> None:
    # Among them names that the generated code uses itself.
    project = c_project(MODEL, tmp_path / "out", name=name)
    assert f"{name}.c" in project.files
    check_syntax(project.path, "g++", AS_CXX)
    assert run_selftest(project.path, objects).stdout == "10000 samples, max difference 0\n"


@pytest.mark.parametrize(
    "name",
    [
        "", "2stage", "my stage", "sta-ge", "stäge", "stage;", "stage\n", "a/b", "../up", "a.b",
        "int", "float", "restrict", "inline", "class", "template", "new", "bool", "nullptr", "Int",
        "_stage", "__stage", "stage_", "my__stage", "hyst", "hyst_stage", "HYST", "hystage",
        "math", "string", "stdint", "stdio", "time", "core", "selftest", "test", "all", "CON",
        "memory", "x" * 41, "lens_core", "lens_core_pi", "LENS_CORE", "lens_clear", "lens_selftest",
        "lens_selftest_vectors", "main", "std", "EOF", "NULL", "NAN", "stdin", "printf", "puts",
        "memcpy", "log2", "fabsf", "size_t", "uint8_t",
    ],
)  # fmt: skip
def test_other_names_are_refused(name: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="the name is"):
        c_project(MODEL, tmp_path / "out", name=name)
    assert not list(tmp_path.iterdir())


def test_no_state_has_a_name_of_the_headers_it_stands_below() -> None:
    """The program of a README calls the state as the export is called."""
    headers = "".join(f"#include <{each}.h>\n" for each in ("stdio", "stddef", "stdint"))
    gcc = [compiler("gcc"), "-std=c99", "-x", "c", "-E", "-"]
    macros, text = (
        subprocess.run(
            [*gcc, *more], input=headers, text=True, capture_output=True, check=True
        ).stdout
        for more in (["-dM"], [])
    )
    names = re.findall(r"#define ([A-Za-z]\w*)", macros)
    names += re.findall(r"^extern\b.*?\b([a-z]\w*) ?\(", text, re.MULTILINE)
    assert {"EOF", "stdin", "NULL", "INT8_C", "printf", "remove"} < set(names)
    for name in names:
        with pytest.raises(InputError):
            as_c_name(name)


@pytest.mark.parametrize("nonsense", [None, 3, b"stage", ["stage"]])
def test_what_is_no_text_is_refused(nonsense: object) -> None:
    with pytest.raises(InputError, match="the name is"):
        as_c_name(nonsense)  # type: ignore[arg-type]


@pytest.mark.parametrize("language", ["c", "c++"])
def test_compilers_take_no_keyword_that_is_let_through(language: str) -> None:
    """Every word that a compiler refuses as a name of a variable is refused here too."""
    words = "auto break case char const continue default do double else enum extern float for goto "
    words += "if inline int long register restrict return short signed sizeof static struct switch "
    words += "typedef union unsigned void volatile while _Bool _Complex asm typeof "
    words += "and bitand bool catch class compl concept consteval const_cast co_await decltype "
    words += "delete dynamic_cast explicit export false friend mutable namespace new noexcept "
    words += "nullptr operator private protected public reinterpret_cast requires static_assert "
    words += "template this thread_local throw true try typeid typename using virtual wchar_t xor"
    standard = "c99" if language == "c" else "c++20"
    for word in words.split():
        refused = subprocess.run(
            [compiler("gcc"), "-x", language, f"-std={standard}", "-fsyntax-only", "-"],
            input=f"int {word} = 0;\n",
            text=True,
            capture_output=True,
            check=False,
        )
        if refused.returncode:
            with pytest.raises(InputError):
                as_c_name(word)


WICKED = '*/ #error "x"\n#include </etc/passwd>\\\n??/ $(rm) `id` <b>|&amp; \u202e µm² -->'


@pytest.mark.parametrize("field", ["input_name", "output_name", "input_unit", "output_unit"])
def test_texts_of_the_user_s_stay_comments(field: str, tmp_path: Path, objects: Objects) -> None:
    about = ModelDescription(**{field: WICKED})
    project = c_project(MODEL, tmp_path / "out", description=about)
    for file in project.files:
        text = (project.path / file).read_bytes()
        assert text.isascii()
        if not file.startswith("core/"):
            # "#include <stdio.h>" is there, so whole pieces are looked for.
            pieces = (b'#error "x', b"#include </", b"\\\n", b"??/", b"$(rm)", b"`id`", b"<b>")
            assert not [piece for piece in pieces if piece in text]
    check_syntax(project.path, "g++", AS_CXX)
    assert run_selftest(project.path, objects).returncode == 0


@given(st.text(max_size=200))
def test_plain_text_is_one_short_line_that_ends_no_comment(text: str) -> None:
    plain = plain_text(text)
    assert (plain.isascii() and plain.isprintable()) or plain == ""
    assert not set(plain) & set("*\\?`<>|&$#\"'{}[]@;\n\r\t")
    assert len(plain) <= 200


def test_units_stay_readable() -> None:
    assert [plain_text(each) for each in ("µm", "μm", "°C", "kΩ", "m/s²", "V")] == [
        "um", "um", "degC", "kOhm", "m/s^2", "V",
    ]  # fmt: skip


def test_fast_math_is_stopped(tmp_path: Path) -> None:
    project = c_project(MODEL, tmp_path / "out")
    finished = subprocess.run(
        [compiler("gcc"), *AS_C, "-ffast-math", "-fsyntax-only", "stage.c"],
        cwd=project.path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert finished.returncode != 0
    assert "-ffast-math" in finished.stderr
