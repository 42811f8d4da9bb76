"""Exports whose drive goes out, or comes in, as codes of a driver."""

from __future__ import annotations

import ctypes
import json
import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from c_builds import AS_C, AS_CXX, STRICT, Objects, build_library, compiler
from c_builds import compiled as built

import hyst
from hyst.errors import InputError
from hyst.export import c_project
from hyst.operators.driver.points import Points

PLAYS = hyst.PrandtlIshlinskii(p=[0.02, 0.03, 0.02], r=[5.0, 15.0, 40.0], p0=0.06)
TABLES = {
    "rising": hyst.Driver.from_table([-2048, -3, 0, 2047], [-9.7, 70.2, 70.35, 149.8]),
    "falling": hyst.Driver.from_table([0, 1000, 4095], [150.2, 99.9, -0.4]),
    "linear": hyst.Driver.linear(150.0 / 65535.0, 0.0, 0, 65535),
}


def described(driver: hyst.Driver | None = None) -> hyst.PrandtlIshlinskii:
    ranges = {"input_low": 0.3, "input_high": 149.7, "output_low": 0.0, "output_high": 20.0}
    about = hyst.ModelDescription(input_unit="V", driver=driver, **ranges)
    return PLAYS.with_description(about)


def wanted(samples: int = 20_000) -> np.ndarray:
    """Outputs within and beyond reach."""
    k = np.arange(samples)
    return 9.5 + 6.0 * np.sin(k / 71.0) + 5.0 * np.sin(k / 53.3)


class Codes:
    """The functions of codes of a compiled project."""

    def __init__(self, library: Path, header: str, single: bool) -> None:
        self._library = ctypes.CDLL(str(library))
        self.real = ctypes.c_float if single else ctypes.c_double
        self.low, self.high = (
            int(re.search(rf"LENS_CODE_{end} \(?(-?\d+)", header)[1])  # type: ignore[index]
            for end in ("MIN", "MAX")
        )
        self.u_low, self.u_high = (
            float(re.search(rf"LENS_U_{end} \(([-\d.e+]+)f?\)", header)[1])  # type: ignore[index]
            for end in ("MIN", "MAX")
        )

    def state(self) -> Any:
        state = ctypes.create_string_buffer(4096)
        self._library.lens_init(state)
        return state

    def function(self, name: str, result: Any, *arguments: Any) -> Any:
        found = getattr(self._library, f"lens_{name}")
        found.restype, found.argtypes = result, arguments
        return found


def compiled(
    model: Any, tmp_path: Path, objects: Objects, precision: str, language: Any = AS_C, **more: Any
) -> Codes:
    c_project(model, tmp_path / "lens", precision=precision, name="lens", **more)
    library = build_library(tmp_path / "lens", objects, "gcc", language)
    return Codes(library, (tmp_path / "lens" / "lens.h").read_text(), precision == "single")


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("table", TABLES)
def test_codes_are_those_nearest_to_the_step(
    table: str, precision: str, tmp_path: Path, objects: Objects
) -> None:
    driver, single = TABLES[table], precision == "single"
    language = AS_CXX if table == "falling" else AS_C
    lens = compiled(described(driver).inverse(), tmp_path, objects, precision, language)
    step = lens.function("step", lens.real, ctypes.c_void_p, lens.real)
    coded = lens.function("step_code", ctypes.c_int32, ctypes.c_void_p, lens.real)
    one, other, y = lens.state(), lens.state(), wanted()
    y[777] = np.nan  # answered with the drive before, and so its code
    drives = np.array([step(one, each) for each in y])
    codes = np.array([coded(other, each) for each in y])
    points = Points.of(driver.table_codes, driver.table_volts, single)
    assert codes.tolist() == points.codes_of(drives, lens.low, lens.high).tolist()
    assert codes[777] == codes[776]
    assert one.raw == other.raw
    # The limits are volts of the last codes within them, and both are reached.
    volts = points.volts_of(codes)
    assert (codes.min(), codes.max()) == (lens.low, lens.high)
    assert volts.min() == np.float64(lens.u_low) >= 0.3
    assert volts.max() == np.float64(lens.u_high) <= 149.7
    assert (lens.low, lens.high) == driver.codes_within(0.3, 149.7, single=single)
    # Half a step, and the rounding of both numbers.
    rounding = 2.0 * np.finfo(points.volts.dtype).eps * 150.0
    assert np.abs(volts - drives).max() <= 0.5 * driver.steps[1] + rounding


def test_codes_at_the_limits_are_the_same_in_either_precision(tmp_path: Path) -> None:
    """A record whose ends are volts of codes, which single precision rounds outwards or inwards."""
    volts = np.linspace(-7.3, 151.1, 4096)
    driver = hyst.Driver.linear(float(volts[1] - volts[0]), -7.3, 0, 4095)
    for low, high in ((100, 4001), (101, 4002), (102, 4003), (103, 4004)):
        ends = driver.volts([low, high])
        about = hyst.ModelDescription(
            input_unit="V", driver=driver, input_low=ends[0], input_high=ends[1]
        )
        for precision in ("double", "single"):
            name = f"a{low}_{precision}"
            project = c_project(
                PLAYS.with_description(about), tmp_path / name, precision=precision, name="lens"
            )
            assert project.codes.startswith(f"{low} to {high} "), precision
            assert project.drive.limits is not None
            # Volt, slope, product and sum are rounded to half a place of 151 or less each.
            assert np.abs(np.array(project.drive.limits) - ends).max() <= 4.0 * 2.0**-17


def test_codes_of_python_track_as_the_target_does(tmp_path: Path, objects: Objects) -> None:
    """Within reach the actuator misses the reference by half a code, at the end as before."""
    driver = TABLES["linear"]
    lens = compiled(described(driver).inverse(), tmp_path, objects, "double")
    coded = lens.function("step_code", ctypes.c_int32, ctypes.c_void_p, lens.real)
    y, state = 9.0 + 0.7 * (wanted() - 9.5), lens.state()
    codes = np.array([coded(state, each) for each in y])
    missed = np.abs(PLAYS(driver.volts(codes)) - y)
    assert missed.max() <= 0.13 * 0.5 * driver.steps[1] + 1e-11
    assert missed[-4000:].max() > 0.3 * missed.max()


@pytest.mark.parametrize("precision", ["double", "single"])
def test_a_model_takes_codes(precision: str, tmp_path: Path, objects: Objects) -> None:
    driver = TABLES["falling"]
    lens = compiled(described(driver), tmp_path, objects, precision)
    step = lens.function("step", lens.real, ctypes.c_void_p, lens.real)
    coded = lens.function("step_of_code", lens.real, ctypes.c_void_p, ctypes.c_int32)
    volt = lens.function("volt", lens.real, ctypes.c_int32)
    one, other = lens.state(), lens.state()
    codes = np.rint(2047.0 + 2100.0 * np.sin(np.arange(3000) / 31.0)).astype(int)
    points = Points.of(driver.table_codes, driver.table_volts, precision == "single")
    volts = points.volts_of(np.clip(codes, lens.low, lens.high))
    assert [volt(int(each)) for each in codes] == volts.tolist()
    assert [coded(other, int(each)) for each in codes] == [step(one, each) for each in volts]
    assert one.raw == other.raw


def test_where_the_driver_comes_from_and_what_is_said(tmp_path: Path) -> None:
    known = described(TABLES["rising"]).inverse()
    project = c_project(known, tmp_path / "auto", name="lens")
    assert "to whole codes" in project.drive.said()
    assert project.codes.endswith("(table of 4 points))")
    told = json.loads((tmp_path / "auto" / "manifest.json").read_text())["driver"]
    assert hyst.Driver(tuple(told["codes"]), tuple(told["volts"]), "V") == TABLES["rising"]
    assert "lens_step_code" in (tmp_path / "auto" / "README.md").read_text()
    for without in (None, "none"):
        folder = tmp_path / f"no_{without}"
        plain = c_project(known, folder, name="lens", driver=without)
        assert plain.codes == ""
        assert "code" not in (folder / "lens.c").read_text()
    other = c_project(known, tmp_path / "other", name="lens", driver=TABLES["linear"])
    assert other.codes.startswith("132 to 65403")
    # A model that knows no range has that of the codes.
    bare = c_project(PLAYS, tmp_path / "bare", name="lens", driver=TABLES["linear"])
    assert bare.drive.source == "the range of the driver's codes"
    assert bare.drive.limits == (0.0, 150.0)


@pytest.mark.parametrize(
    ("model", "given", "said"),
    [
        (described().inverse(), {"driver": "linear"}, "give a hyst.Driver"),
        (described().inverse(), {"driver": TABLES["linear"], "limits": "none"}, "has no limits"),
        (described().inverse(), {"driver": TABLES["linear"], "limits": (200, 300)}, "no code"),
        (
            described().inverse(),
            {"driver": hyst.Driver.linear(1.0, 0.0, 0, 150, "mV")},
            "gives 'mV' but the drive is in 'V'",
        ),
        (
            described().inverse(),
            {"driver": hyst.Driver.linear(2.0**-20, 100.0, 0, 2**24), "precision": "single"},
            "single precision does not resolve",
        ),
        (
            hyst.online.ScaleEstimator(described()),
            {"driver": TABLES["linear"]},
            "no driver can be given here",
        ),
    ],
    ids=["word", "no-limits", "beyond", "unit", "single", "estimator"],
)
def test_what_has_no_codes_is_refused(
    model: Any, given: dict[str, Any], said: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=said):
        c_project(model, tmp_path / "lens", name="lens", **given)
    assert not (tmp_path / "lens").exists()


def test_two_axes_with_drivers_live_in_one_folder(tmp_path: Path) -> None:
    known = described(TABLES["rising"])
    c_project(known.inverse(), tmp_path / "axes", name="lens", layout="flat")
    c_project(known, tmp_path / "axes", name="axis", layout="flat", precision="single", force=True)
    (tmp_path / "axes" / "main.c").write_text(
        '#include <stdio.h>\n#include "lens.h"\n#include "axis.h"\n'
        "int main(void)\n{\n    lens_state lens;\n    axis_state axis;\n    int k;\n"
        "    lens_init(&lens);\n    axis_init(&axis);\n    for (k = 0; k < 4; ++k) {\n"
        "        const int32_t code = lens_step_code(&lens, 3.0 + k);\n"
        '        printf("%ld %.4f\\n", (long)code, (double)axis_step_of_code(&axis, code));\n'
        "    }\n    return 0;\n}\n"
    )
    sources = sorted(each.name for each in (tmp_path / "axes").glob("*.c"))
    built([compiler("gcc"), *AS_C, *STRICT, *sources, "-o", "main"], tmp_path / "axes")
    program = [str(tmp_path / "axes" / "main")]
    said = subprocess.run(program, capture_output=True, text=True, check=True).stdout.split()
    # The model in single answers to the codes of its inverse in double: half a code of 39 mV.
    reached = np.array(said[1::2], dtype=float)
    assert np.abs(reached - [3.0, 4.0, 5.0, 6.0]).max() < 0.13 * 0.5 * 0.0391 + 1e-4
