"""What the README of an export says is true, and what it prints compiles."""

from __future__ import annotations

import re
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from c_builds import AS_C, AS_CXX, STRICT, compiled, compiler
from fmu_runs import CONTROLLER, LIMITED_CONTROLLER, estimation
from readme_programs import program_of, readme_of, run_readme

import hyst
from hyst.control import LimitedDrive
from hyst.export import c_project
from hyst.export.c.layout import LAYOUTS
from hyst.export.c.signal_names import variables
from hyst.operators import ModelDescription
from hyst.operators.provenance import Provenance
from hyst.operators.verdict import Verdict

ABOUT = ModelDescription(
    input_name="Voltage",
    input_unit="V",
    output_name="Position",
    output_unit="\N{MICRO SIGN}m",
    input_low=0.0,
    input_high=150.0,
    output_low=0.0,
    output_high=40.0,
    family="pi",
    errors={
        "training": {"rms": 0.0123, "rms_percent": 0.031, "max_abs": 0.05},
        "validation": {"rms": 0.02},
    },
    provenance=Provenance(
        "2026-01-31T12:00:00+00:00", "ab" * 32, {"hyst": "0.1.0"}, {}, "hyst identify lens.csv"
    ),
    verdict=Verdict("good", ("What is left is the record's own noise.",)),
)
MODEL = hyst.PrandtlIshlinskii(p=[0.05, 0.02], r=[10.0, 30.0], p0=0.2).with_description(ABOUT)
SCHEDULED = hyst.Scheduled(
    [MODEL, hyst.PrandtlIshlinskii(p=[0.06, 0.02], r=[10.0, 30.0], p0=0.25)],
    [20.0, 60.0],
    name="Temperature",
    unit="\N{DEGREE SIGN}C",
)
STRICTLY = [each for each in STRICT if each != "-ffp-contract=off"]


def columns(printed: str) -> np.ndarray:
    """Input and output that an example has printed, six digits each."""
    found = re.findall(r"^(\S+): (\S+), .*fault (?:0|16)$", printed, re.MULTILINE)
    assert len(found) == len(printed.splitlines())
    return np.array(found, dtype=float)


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("precision", ["double", "single"])
def test_the_program_prints_what_python_computes(
    precision: str, layout: str, tmp_path: Path
) -> None:
    inverse = MODEL.inverse()
    folder = c_project(
        inverse, tmp_path / "out", precision=precision, name="lens", layout=layout, limits=None
    ).path
    program = program_of(folder)
    assert "voltage_V = lens_step(&lens, position_um);" in program
    assert "lens_init(&lens);" in program
    printed = columns(run_readme(folder, "example", program, *STRICTLY))
    np.testing.assert_array_equal(printed[:, 0], np.arange(0.0, 41.0, 5.0))
    if layout != "folder":  # else Arduino's builder would compile it with the sketch
        assert not [each for each in folder.glob("*.c") if "int main" in each.read_text()]
    # "%g" prints six digits, and single precision has seven.
    np.testing.assert_allclose(printed[:, 1], inverse(printed[:, 0]), rtol=1.1e-5)


@pytest.mark.parametrize("precision", ["double", "single"])
def test_the_program_starts_after_the_sweep_it_tells_of(precision: str, tmp_path: Path) -> None:
    drive = LimitedDrive(MODEL.inverse())
    folder = c_project(MODEL.inverse(), tmp_path / "out", precision=precision, name="lens").path
    told = readme_of(folder)
    assert "## How to start the actuator" in told
    assert "| limits of the drive | `LENS_U_MIN` to `LENS_U_MAX`: 0 to 150 V" in told
    printed = columns(run_readme(folder, "example", program_of(folder), *STRICTLY))
    # Up from the lowest drive after the highest: not what it would be without a history.
    expected = drive.run(printed[:, 0], drive.state_after([150.0, 0.0]))[0]
    assert abs(expected[1] - drive(printed[:, 0])[1]) > 1.0
    # "%g" prints six digits, and single precision has seven.
    np.testing.assert_allclose(printed[:, 1], expected, rtol=1.1e-5)


def test_an_export_with_a_history_starts_after_it(tmp_path: Path) -> None:
    drive, history = LimitedDrive(MODEL.inverse()), [0.0, 120.0, 30.0]
    folder = c_project(MODEL.inverse(), tmp_path / "out", name="lens", history=history).path
    assert "| start | after drives of 0, 120, 30 V |" in readme_of(folder)
    printed = columns(run_readme(folder, "example", program_of(folder), *STRICTLY))
    expected = drive.run(printed[:, 0], drive.state_after(history))[0]
    # Of six digits.
    np.testing.assert_allclose(printed[:, 1], expected, rtol=1e-5)
    assert "the state after those drives" in readme_of(folder)


def test_where_time_counts_the_start_takes_every_sample(tmp_path: Path) -> None:
    creeping = hyst.Creep([0.1], [0.5], 1e-3) @ MODEL
    told = readme_of(c_project(creeping.inverse(), tmp_path / "out", name="lens").path)
    assert "at every sample" in told


def test_what_cannot_be_told_a_history_says_so(tmp_path: Path) -> None:
    model = hyst.Delay(2.7, 1e-3).inverse(preview=4)
    told = readme_of(c_project(model, tmp_path / "out", name="lens").path)
    assert "This code can be told no history: the model in front of it is not known" in told
    assert "init_after" not in told
    assert "no delay read backwards, keep the Delay" in told


def test_a_history_wipes_out_only_what_is_within_it(tmp_path: Path) -> None:
    """After 100 and 80 V, one that was at 150 V before is another than one that was not."""
    drive = LimitedDrive(MODEL.inverse())
    before = [drive.state_after([*had, 100.0, 80.0]) for had in ([], [150.0])]
    asked = np.array([22.0])  # about where it is
    assert not np.array_equal(*(drive.run(asked, each)[0] for each in before))
    told = readme_of(
        c_project(MODEL.inverse(), tmp_path / "out", name="lens", history=[100.0, 80.0]).path
    )
    assert "without effect, if it was never driven beyond" in told


@pytest.mark.parametrize("shared_core", [False, True])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_the_command_of_the_test_is_true(layout: str, shared_core: bool, tmp_path: Path) -> None:
    if shared_core and layout == "single-file":
        pytest.skip("a single file has its core within it")
    project = c_project(
        MODEL, tmp_path / "out", name="lens", layout=layout, shared_core=shared_core
    )
    assert run_readme(project.path, "test") == "10000 samples, max difference 0\n"


OTHERS = {
    "model": MODEL,
    "without description": hyst.Play(0.5),
    "second signal": SCHEDULED,
    "controller": CONTROLLER,
    "limited controller": LIMITED_CONTROLLER,
    "estimator": estimation()[0],
}


@pytest.mark.parametrize("name", OTHERS)
def test_programs_of_other_blocks_compile_as_printed(name: str, tmp_path: Path) -> None:
    folder = c_project(OTHERS[name], tmp_path / "out", name="lens").path
    program = program_of(folder)
    assert "&lens" in program
    assert len(columns(run_readme(folder, "example", program, *STRICTLY))) > 1
    (folder / "example.cpp").write_text(program)
    flags = [*AS_CXX, *STRICT, "-fsyntax-only"]
    compiled([compiler("clang++"), *flags, "example.cpp"], folder)


def test_the_table_says_what_is_known(tmp_path: Path) -> None:
    readme = readme_of(c_project(MODEL, tmp_path / "out", name="lens").path)
    for row in (
        "| u, `voltage_V` | Voltage in V, 0 to 150 in the record |",
        "| y, `position_um` | Position in um, 0 to 40 in the record |",
        "| error, training | rms 0.0123 um, 0.031 % of the range, at most 0.05 um |",
        "| error, validation | rms 0.02 um |",
        "| verdict | good: What is left is the record's own noise. |",
        "| sample time | any |",
    ):
        assert row in readme
    inverse = readme_of(c_project(MODEL.inverse(), tmp_path / "i", name="lens").path)
    assert "| error of the model it inverts, validation | rms 0.02 um |" in inverse
    (origin,) = [line for line in readme.splitlines() if line.startswith("| origin")]
    for part in ("as pi", "2026-01-31", "hyst 0.1.0", "abababab", "hyst identify lens.csv"):
        assert part in origin


HARMFUL = [
    ("", ""),
    ("double", ""),
    ("class", "V"),
    ("lens", ""),
    ("lens_step", ""),
    ("1st sensor", "1/s"),
    ("stdin", ""),
    ("size", "t"),
    ("*/ #error", "%"),
    ("\N{GREEK SMALL LETTER ALPHA}", "\N{OHM SIGN}"),
    ("printf", ""),
    ("V", "V"),
    ("a" * 200, "N m/rad^2"),
]


@pytest.mark.parametrize(("name", "unit"), HARMFUL)
def test_any_name_makes_a_program_that_compiles(name: str, unit: str, tmp_path: Path) -> None:
    """Input and output alike, which C would not let be one variable."""
    about = ModelDescription(input_name=name, input_unit=unit, output_name=name, output_unit=unit)
    folder = c_project(MODEL, tmp_path / "out", name="lens", description=about).path
    (folder / "example.c").write_text(program_of(folder))
    for driver, language in (("gcc", AS_C), ("g++", AS_CXX), ("gcc", ["-std=gnu99"])):
        compiled([compiler(driver), *language, *STRICT, "-c", "example.c"], folder)
        assert (folder / "example.o").stat().st_size > 0
        (folder / "example.o").unlink()


@pytest.mark.parametrize(
    ("meant", "expected"),
    [
        ([("u", "Position", "\N{MICRO SIGN}m")], ["position_um"]),
        ([("u", "Drive (V)", "V")], ["drive_V"]),
        ([("u", "", "V"), ("y", "", "")], ["u_V", "y"]),
        ([("u", "x", ""), ("y", "x", "")], ["x", "y_x"]),
        ([("u", "speed", "m/s")], ["speed_m_per_s"]),
        ([("u", "int", "")], ["u_int"]),
    ],
)
def test_variables_are_called_by_name_and_unit(
    meant: list[tuple[str, str, str]], expected: list[str]
) -> None:
    assert list(variables(meant, "lens").values()) == expected


@pytest.mark.parametrize("precision", ["double", "single"])
def test_the_short_test_finds_one_bit_of_one_constant(precision: str, tmp_path: Path) -> None:
    """The last bit of the inverse's gain: the first sample away from 0 is another."""
    inverse, place = MODEL.inverse(), tmp_path / "out"
    folder = c_project(inverse, place, name="lens", precision=precision, limits=None).path
    source = (folder / "lens.c").read_text()
    (gain,) = re.findall(r"lens_core_pi pi_1 = \{2u, ([^,f]*)", source)
    number = np.float64 if precision == "double" else np.float32
    beside = float(np.nextafter(number(float.fromhex(gain)), number(np.inf))).hex()
    (folder / "main.c").write_text(
        '#include "lens.h"\nint main(void) { return lens_selftest(); }\n'
    )
    build = [compiler("gcc"), *AS_C, *STRICT, "main.c", "lens.c"]
    core = [str(each) for each in folder.glob("core/src/*.c")]
    results = []
    for text in (source, source.replace(gain, beside)):
        (folder / "lens.c").write_text(text)
        compiled([*build, "lens_step_response.c", *core, "-o", "main"], folder)
        results.append(exit_code(folder / "main"))
    # The first level is the lower end, 0, which any slope answers with 0.
    assert results == [0, 5]


def exit_code(program: Path) -> int:
    return subprocess.run([str(program)], check=False).returncode


def test_a_long_delay_is_waited_for(tmp_path: Path) -> None:
    """64 samples after a delay of 200 would all be 0: the test holds its levels longer."""
    model = hyst.Delay(200, 1e-3)
    text = (
        c_project(model, tmp_path / "out", name="lens").path / "lens_step_response.c"
    ).read_text()
    answers = text.split("answer[64] = {")[1].split("}")[0].split(",")
    assert len({each.strip() for each in answers}) > 8
    assert "i < 1u" not in text


def test_ranges_between_which_single_precision_has_no_number(tmp_path: Path) -> None:
    """The loop of the program ends nevertheless."""
    about = replace(ABOUT, input_low=1e8, input_high=1e8 + 1.0)
    model, place = MODEL.with_description(about), tmp_path / "out"
    folder = c_project(model, place, precision="single", limits=None).path
    assert len(columns(run_readme(folder, "example", program_of(folder)))) >= 1


@pytest.mark.parametrize(
    ("model", "constants", "kept"),
    [
        (MODEL, 8 * (64 + 16), "stack"),  # outputs, and the levels of one signal
        (estimation()[0], 8 * (64 + 2 * 16), "memory"),  # too large for a stack
    ],
)
def test_what_the_short_test_costs_is_told(
    model: Any, constants: int, kept: str, tmp_path: Path
) -> None:
    project = c_project(model, tmp_path / "out", name="lens")
    assert f"{constants} bytes of constants and {project.state_bytes} of {kept}" in readme_of(
        project.path
    )
    source = (project.path / "lens_step_response.c").read_text()
    assert ("static lens_state state;" in source) == (kept == "memory")
