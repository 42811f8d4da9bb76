"""Two exports, of two precisions and models, in one program and in one folder."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from c_builds import AS_C, AS_CXX, STRICT, compiled, compiler
from fmu_runs import CONTROLLER, LIMITED_CONTROLLER, estimation
from readme_programs import pasted, program_of

import hyst
from hyst import InputError
from hyst.control import LimitedDrive
from hyst.export import c_project
from hyst.export.c.layout import LAYOUTS
from hyst.export.c.names import as_c_name
from hyst.operators import ModelDescription

LENS = hyst.PrandtlIshlinskii(p=[0.1, 0.05], r=[10.0, 30.0], p0=0.2).with_description(
    ModelDescription("Voltage", "V", "Position", "um", input_low=0.0, input_high=100.0)
)
STIFFER = hyst.PrandtlIshlinskii(p=[0.1, 0.05], r=[12.0, 33.0], p0=0.25)
MIRROR = hyst.RambergOsgood(c1=1.0, c2=0.02, c3=0.9).with_description(
    ModelDescription("Current", "mA", "Angle", "mrad", input_low=-40.0, input_high=40.0)
)
HISTORY = {"lens": [0.0, 100.0, 20.0], "mirror": [-40.0, 35.0]}
# More than the outputs of the records, so that both drives meet their limits.
ASKED = {"lens": (0.0, 40.0), "mirror": (-90.0, 90.0)}
BOTH = {"lens": (LENS, "double"), "mirror": (MIRROR, "single")}


def described(name: str) -> ModelDescription:
    """The signals of the inverse, with the range of outputs that is asked for."""
    about = BOTH[name][0].inverse().description
    low, high = ASKED[name]
    return ModelDescription(
        about.input_name, about.input_unit, about.output_name, about.output_unit,
        input_low=low, input_high=high, output_low=about.output_low, output_high=about.output_high,
    )  # fmt: skip


def export_both(folder: Path, **options: object) -> None:
    """Two inverses, limited to the drives of their records, after what drove them before."""
    for name, (model, precision) in BOTH.items():
        c_project(
            model.inverse(), folder, name=name, precision=precision, history=HISTORY[name],
            limits=drive_of(name).limits, description=described(name), **options,
        )  # fmt: skip


def drive_of(name: str) -> LimitedDrive:
    return LimitedDrive(BOTH[name][0].inverse())


def in_python(name: str, asked: np.ndarray) -> np.ndarray:
    """What the limited inverse answers after the history, in double."""
    drive = drive_of(name)
    step = drive.stepper(drive.state_after(HISTORY[name]))
    return np.array([step(float(each)) for each in asked])


def ran(program: Path) -> str:
    return subprocess.run([str(program)], capture_output=True, text=True, check=True).stdout


def columns(printed: str) -> tuple[np.ndarray, np.ndarray]:
    """Asked and answered, of what the README's program prints."""
    found = np.array(re.findall(r"^(\S+): (\S+), fault", printed, re.MULTILINE), dtype=float)
    return found[:, 0], found[:, 1]


@pytest.mark.parametrize(("driver", "language"), [("gcc", AS_C), ("clang++", AS_CXX)])
@pytest.mark.parametrize("shared_core", [False, True])
def test_the_programs_of_two_readmes_are_one_of_twenty_lines(
    shared_core: bool, driver: str, language: list[str], tmp_path: Path
) -> None:
    folder = tmp_path / "axes"
    export_both(folder, layout="flat", shared_core=shared_core)
    program = pasted([program_of(folder, name) for name in BOTH])
    assert len(program.splitlines()) <= 20
    (folder / "axes.c").write_text(program)
    sources = [each.name for each in folder.glob("*.c")]
    compiled([compiler(driver), *language, *STRICT, *sources, "-o", "axes"], folder)
    printed = ran(folder / "axes").splitlines()
    assert len(printed) == 18
    for name, lines in (("lens", printed[:9]), ("mirror", printed[9:])):
        asked, answered = columns("\n".join(lines))
        np.testing.assert_allclose(asked, np.linspace(*ASKED[name], 9), rtol=1e-5)
        # "%g" has six digits, and single precision seven; 100 and 40 are the largest drives.
        np.testing.assert_allclose(answered, in_python(name, asked), rtol=2e-5, atol=1e-5)
        low, high = drive_of(name).limits or (np.nan, np.nan)
        assert answered.max() == high
        assert answered.min() >= low
        assert lines[-1].endswith("fault 16")


SKETCH = """
#include <stdio.h>
#include "lens.h"
#include "mirror.h"
static lens_state lens;
static mirror_state mirror;
void setup() { lens_init(&lens); mirror_init(&mirror); }
void loop() {
    for (float y = 0.0f; y <= 40.0f; y += 5.0f)
        printf("%a %a\\n", lens_step(&lens, y), (double)mirror_step(&mirror, y));
    printf("%d %d\\n", lens_selftest(), mirror_selftest());
}
"""
BOARD = "void setup(); void loop();\nint main() { setup(); loop(); return 0; }\n"
AS_ARDUINO = ["-Os", "-Wall", "-Wextra", "-Werror", "-ffunction-sections", "-fdata-sections"]


@pytest.mark.parametrize(
    ("layout", "shared_core"), [("flat", False), ("flat", True), ("single-file", False)]
)
def test_a_sketch_of_arduino_with_two_exports(
    layout: str, shared_core: bool, tmp_path: Path
) -> None:
    """Its builder compiles what lies in the sketch's folder, one by one, and knows no options."""
    sketch, made = tmp_path / "sketch", tmp_path / "made"
    made.mkdir()
    export_both(sketch, layout=layout, shared_core=shared_core)
    if layout == "single-file":  # the self-test for the target is apart there
        for name in BOTH:
            text = (sketch / "extras" / f"{name}_step_response.c").read_text()
            (sketch / f"{name}_step_response.c").write_text(text.replace('"../', '"'))
    (sketch / "sketch.cpp").write_text(SKETCH)
    (made / "main.cpp").write_text(BOARD)
    for source in sorted([*sketch.glob("*.c"), *sketch.glob("*.cpp"), made / "main.cpp"]):
        is_c = source.suffix == ".c"
        by = [compiler("gcc"), "-std=gnu11"] if is_c else [compiler("g++"), "-std=gnu++17"]
        compiled([*by, *AS_ARDUINO, "-ffp-contract=off", "-c", str(source)], made)
    objects = sorted(each.name for each in made.glob("*.o"))
    compiled([compiler("g++"), "-Wl,--gc-sections", *objects, "-o", "sketch"], made)
    *lines, tests = ran(made / "sketch").splitlines()
    assert tests == "0 0"
    answered = np.array([[float.fromhex(each) for each in line.split()] for line in lines])
    asked = 5.0 * np.arange(9)
    assert answered[:, 0].tolist() == in_python("lens", asked).tolist()
    # The inverse of a power law in single, of drives up to 40.
    np.testing.assert_allclose(answered[:, 1], in_python("mirror", asked), rtol=0, atol=1e-4)


@pytest.mark.parametrize(("driver", "language"), [("gcc", AS_C), ("clang++", AS_CXX)])
def test_single_files_may_be_included_in_one_source(
    driver: str, language: list[str], tmp_path: Path
) -> None:
    """As tools of PLCs and sketches do; two precisions, one of them twice."""
    export_both(tmp_path, layout="single-file")
    c_project(MIRROR.inverse(), tmp_path, name="third", precision="double", layout="single-file")
    names = (*BOTH, "third")
    (tmp_path / "all.c").write_text(
        "".join(f'#include "{x}.c"\n#include "extras/{x}_step_response.c"\n' for x in names)
        + f"int main(void) {{ return {' + '.join(f'{x}_selftest()' for x in names)}; }}\n"
    )
    compiled([compiler(driver), *language, *STRICT, "all.c", "-o", "all"], tmp_path)
    assert subprocess.run([str(tmp_path / "all")], check=False).returncode == 0


def symbols(objects: list[Path]) -> set[str]:
    """Names that the linker sees defined."""
    listed = subprocess.run(
        [compiler("nm"), "-P", "--defined-only", "-g", *map(str, objects)],
        capture_output=True, text=True, check=True,
    ).stdout  # fmt: skip
    return {line.split()[0] for line in listed.splitlines() if len(line.split()) > 2}


AXIS = """
#include "@.h"
static @_state state;
void start_@(void);
double drive_@(double y);
void start_@(void) { @_init(&state); }
double drive_@(double y) { return (double)@_step(&state, (NUMBER)y); }
"""
PROGRAM = """
#include <stdio.h>
void start_x(void);
void start_s(void);
double drive_x(double y);
double drive_s(double y);
int main(void) {
    start_x();
    start_s();
    for (int k = 0; k <= 8; ++k) printf("%a %a\\n", drive_x(3.0 * k), drive_s(3.0 * k));
    return 0;
}
"""


def test_libraries_of_two_precisions_link_in_either_order(tmp_path: Path) -> None:
    """One model twice; once the linker took the first of two functions of one name, for both."""
    made: dict[str, set[str]] = {}
    for name, precision, number in (("x", "double", "double"), ("s", "single", "float")):
        folder = c_project(LENS.inverse(), tmp_path / name, name=name, precision=precision).path
        (folder / "axis.c").write_text(AXIS.replace("@", name).replace("NUMBER", number))
        sources = ["axis.c", f"{name}.c", *map(str, folder.glob("core/src/*.c"))]
        compiled([compiler("gcc"), *AS_C, *STRICT, "-c", *sources], folder)
        objects = sorted(folder.glob("*.o"))
        compiled([compiler("ar"), "rcs", f"../lib{name}.a", *map(str, objects)], folder)
        made[name] = symbols(objects)
        assert all(re.search(rf"(^|_){name}(_|$)", each) for each in made[name])
    assert not made["x"] & made["s"]
    (tmp_path / "main.c").write_text(PROGRAM)
    for order in (["-lx", "-ls"], ["-ls", "-lx"]):
        compiled([compiler("gcc"), *AS_C, "main.c", "-L.", *order, "-o", "main"], tmp_path)
        lines = [line.split() for line in ran(tmp_path / "main").splitlines()]
        answered = np.array([[float.fromhex(each) for each in line] for line in lines])
        assert np.array_equal(answered[:, 0], LimitedDrive(LENS.inverse())(3.0 * np.arange(9)))
        # Some ten roundings of drives of up to 100.
        np.testing.assert_allclose(answered[:, 1], answered[:, 0], rtol=0, atol=1e-4)


def exported(folder: Path, **options: object) -> list[str]:
    """Headers of all kinds of blocks."""
    blocks: dict[str, object] = {
        "operator": LENS, "inverse": LENS.inverse(), "controller": CONTROLLER,
        "limited": LIMITED_CONTROLLER, "estimator": estimation()[0],
        "scheduled": hyst.Scheduled([LENS, STIFFER], [0.0, 1.0], "load", "kg"),
        "preview": hyst.RateDependentPrandtlIshlinskii(
            [0.5, 0.3], [0.1, 0.4], 0.01, 0.001, 1.0
        ).inverse(preview=5),
    }  # fmt: skip
    return [
        (c_project(each, folder / name, **options).path / "stage.h").read_text()
        for name, each in blocks.items()
    ]


def test_no_name_is_one_of_the_core_or_of_another_export(tmp_path: Path) -> None:
    texts = "".join(exported(tmp_path)).lower()
    own = set(re.findall(r"\bstage_(\w+)", texts))
    assert {"init_after", "step", "update", "not_finite", "state_save", "selftest", "u_min"} < own
    assert not [each for each in own if each.startswith("core")]
    # lens_clear_fault is of lens and of lens_clear, unless there is no lens_clear.
    for name in own:
        for place in (found.start() for found in re.finditer("_", name)):
            if name[place + 1 :] in own:
                with pytest.raises(InputError, match="may define the same"):
                    as_c_name(f"lens_{name[:place]}")


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_header_needs_two_standard_headers(layout: str, tmp_path: Path) -> None:
    for text in exported(tmp_path, layout=layout):
        assert re.findall(r"#\s*include (.*)", text) == ["<stddef.h>", "<stdint.h>"]
        assert "hyst_" not in text
        assert "HYST_" not in text


CMAKE = """
cmake_minimum_required(VERSION 3.10)
project(axes LANGUAGES C)
include("some axes/lens.cmake")
include("some axes/mirror.cmake")
add_executable(axes main.c)
target_link_libraries(axes PRIVATE lens mirror)
"""


@pytest.mark.parametrize(("layout", "shared_core"), [("flat", False), ("folder", True)])
def test_cmake_includes_two_exports(layout: str, shared_core: bool, tmp_path: Path) -> None:
    export_both(tmp_path / "some axes", layout=layout, shared_core=shared_core)
    (tmp_path / "CMakeLists.txt").write_text(CMAKE)
    (tmp_path / "main.c").write_text(
        '#include "lens.h"\n#include "mirror.h"\n'
        "int main(void) { return lens_selftest() + mirror_selftest(); }\n"
    )
    compiled([compiler("cmake"), "-S", ".", "-B", "build"], tmp_path)
    targets = ["axes", "lens_selftest", "mirror_selftest"]
    compiled(["cmake", "--build", "build", "--target", *targets], tmp_path)
    assert subprocess.run([str(tmp_path / "build" / "axes")], check=False).returncode == 0
    for name in BOTH:
        said = ran(tmp_path / "build" / f"{name}_selftest")
        assert said == "10000 samples, max difference 0\n"
