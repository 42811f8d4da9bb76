"""Codes on the command line: in at the front of identification, out behind the inverse."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command_runs import Run, write_csv

import hyst

# Pictures are looked at elsewhere.
pytestmark = pytest.mark.usefixtures("undrawn")

DT = 1e-3
PLAYS = hyst.PrandtlIshlinskii(p=[0.02, 0.03], r=[8.0, 30.0], p0=0.06)
DRIVER = hyst.Driver.from_table([0, 1500, 4095], [-0.4, 54.1, 150.3])
ASKED = ("--input", "code", "--output", "y", "--time", "t", "--family", "pi", "--plays", 2)


@pytest.fixture
def measured(folder: Path) -> Path:
    """A 12-bit driver moves a stage over falling strokes; the file has codes, not volts."""
    write_csv(
        folder / "driver.csv",
        "code,volt",
        np.array(DRIVER.table_codes),
        np.array(DRIVER.table_volts),
    )
    k = np.arange(2000)
    codes = DRIVER.codes(75.0 + 74.0 * np.sin(0.02 * k) * np.linspace(1.0, 0.3, k.size))
    y = PLAYS(DRIVER.volts(codes)) + 0.001 * np.random.default_rng(0).standard_normal(k.size)
    return write_csv(folder / "record.csv", "t,code,y [um]", k * DT, codes, y)


def reference(folder: Path) -> tuple[Path, np.ndarray]:
    k = np.arange(1500)
    y_ref = PLAYS(75.0 + 55.0 * np.sin(0.03 * k))
    return write_csv(folder / "ref.csv", "t,y [um]", k * DT, y_ref), y_ref


def test_round_trip_of_a_12_bit_driver(run: Run, folder: Path, measured: Path) -> None:
    ended = run("identify", measured, *ASKED, "--driver", "driver.csv", "-o", "out")
    assert ended.code == 0, ended.err
    assert "not its codes: codes 0 to 4095 give -0.4 to 150.3 V" in ended.out
    found = hyst.load(folder / "out" / "model.json")
    assert found.description.driver == DRIVER
    assert found.description.input_unit == "V"
    # Volts and not codes: the output is that of the stage, within some of the noise.
    drive = 75.0 - 70.0 * np.cos(0.01 * np.arange(900))
    assert np.abs(found(drive) - PLAYS(drive))[400:].max() < 0.005
    told = json.loads((folder / "out" / "metrics.json").read_text())["driver"]
    assert told["codes"] == [0, 1500, 4095]
    assert "not its codes" in (folder / "out" / "report.html").read_text()
    assert "codes 0 to 4095" in run("info", "out/model.json").out

    path, y_ref = reference(folder)
    ended = run("compensate", "out/model.json", path, "--column", "y", "-o", "c.csv")
    assert ended.code == 0, ended.err
    assert "as codes" in ended.out
    assert (folder / "c.csv").read_text().startswith("t,reference [um],command [V],code,predicted")
    rows = np.loadtxt(folder / "c.csv", delimiter=",", skiprows=1)
    command, codes, predicted = rows[:, 2], rows[:, 3], rows[:, 4]
    assert np.array_equal(codes, DRIVER.codes(command))
    reached = PLAYS(DRIVER.volts(codes))
    half_a_step = 0.5 * DRIVER.steps[1]
    slopes = 0.06 + 0.02 + 0.03
    # Half a code through all plays at once, and what the model's constants are off by.
    assert np.abs(reached - y_ref).max() < half_a_step * slopes + 0.005
    assert np.abs(predicted - reached).max() < 0.005
    assert np.abs(predicted - y_ref).max() > 0.2 * half_a_step * slopes


def test_a_scale_on_the_command_line_and_in_learning(
    run: Run, folder: Path, measured: Path
) -> None:
    run("identify", measured, *ASKED, "--driver", "driver.csv", "-o", "out")
    path, _ = reference(folder)
    other = ("--driver", "linear:0.05,0,0,3000")
    ended = run("compensate", "out/model.json", path, "--column", "y", "-o", "c.csv", *other)
    assert ended.code == 0, ended.err
    rows = np.loadtxt(folder / "c.csv", delimiter=",", skiprows=1)
    assert np.array_equal(rows[:, 3], np.rint(rows[:, 2] / 0.05))
    ended = run("learn", "out/model.json", path, "--column", "y", "-o", "l.csv", *other)
    assert ended.code == 0, ended.err
    assert "as codes" in ended.out
    learnt = np.loadtxt(folder / "l.csv", delimiter=",", skiprows=1)
    assert np.array_equal(learnt[:, 3], np.rint(learnt[:, 2] / 0.05))


def test_a_command_beyond_the_codes_is_refused_or_clipped(
    run: Run, folder: Path, measured: Path
) -> None:
    run("identify", measured, *ASKED, "--driver", "driver.csv", "-o", "out")
    path, _ = reference(folder)
    asked = ("compensate", "out/model.json", path, "--column", "y", "-o", "c.csv")
    short = ("--driver", "linear:0.05,0,0,2400")
    ended = run(*asked, *short)
    assert ended.code == 2
    assert "its range" in ended.err
    ended = run(*asked, *short, "--outside", "clip")
    assert ended.code == 0, ended.err
    assert np.loadtxt(folder / "c.csv", delimiter=",", skiprows=1)[:, 3].max() == 2400.0
    ended = run(*asked, "--driver", "linear:0.05,500,0,2400", "--force")
    assert ended.code == 2
    assert "no code of the driver" in ended.err


@pytest.mark.parametrize(
    ("driver", "said"),
    [
        ("linear:0.05,0,0", "--driver is 'linear:0.05,0,0'"),
        ("linear:0.05,0,0,1.5", "--driver is"),
        ("linear:0,0,0,4095", "volts_per_code is 0"),
        ("linear:0.05,0,0,1000", "record.csv: input 'code': the code at index"),
        ("none.csv", "none.csv"),
        ("bad.csv", "bad.csv: row 3 of the driver's table has the volt 1 after 2"),
    ],
)
def test_what_is_no_driver_of_the_record_is_refused(
    run: Run, folder: Path, measured: Path, driver: str, said: str
) -> None:
    (folder / "bad.csv").write_text("code,volt\n0,0\n1000,2\n2000,1\n")
    ended = run("identify", measured, *ASKED, "--driver", driver, "-o", "out")
    assert ended.code == 2
    assert said in ended.err
    assert not (folder / "out").exists()


def test_an_input_in_volts_is_no_input_in_codes(run: Run, folder: Path) -> None:
    k = np.arange(500)
    path = write_csv(folder / "r.csv", "t,u [V],y", k * DT, np.rint(9 * np.sin(0.1 * k)), k * 1.0)
    asked = ("--input", "u", "--output", "y", "--time", "t", "--driver", "linear:1,0,-10,10")
    ended = run("identify", path, *asked, "-o", "out")
    assert ended.code == 2
    assert "is in 'V', and a driver's table is for an input in codes" in ended.err


def test_fit_and_label_take_codes_too(run: Run, folder: Path, measured: Path) -> None:
    asked = ("--driver", "driver.csv", "--input-label", "piezo")
    ended = run("identify", measured, *ASKED, *asked, "-o", "out")
    assert ended.code == 0, ended.err
    about = hyst.load(folder / "out" / "model.json").description
    assert (about.input_name, about.input_unit) == ("piezo", "V")
    columns = ("--input", "code", "--output", "y", "--time", "t", "--driver", "driver.csv")
    ended = run("fit", "out/model.json", measured, *columns, "-o", "fitted")
    assert ended.code == 0, ended.err
    assert hyst.load(folder / "fitted" / "model.json").description.driver == DRIVER
    wrong = ("--driver", "driver.csv", "--input-label", "piezo [mV]")
    assert "the driver gives 'V'" in run("identify", measured, *ASKED, *wrong, "-o", "o2").err


def test_python_takes_codes_as_the_command_line_does() -> None:
    k = np.arange(2000)
    codes = DRIVER.codes(75.0 + 74.0 * np.sin(0.02 * k) * np.linspace(1.0, 0.3, k.size))
    record = hyst.Record(codes, PLAYS(DRIVER.volts(codes)), DT, input_name="code")
    found = hyst.identify(record, family="pi", plays=2, driver=DRIVER)
    assert found.description.driver == DRIVER == found.model.description.driver
    assert "driver" not in found.description.provenance.options  # type: ignore[union-attr]
    # Simulated without noise: what is left is where radii fall between two samples.
    assert np.abs(found.model(DRIVER.volts(codes)) - record.y)[500:].max() < 0.01
    assert found.description.input_high == DRIVER.volts(codes).max()


def test_exports_step_in_codes(run: Run, folder: Path, measured: Path) -> None:
    run("identify", measured, *ASKED, "--driver", "driver.csv", "-o", "out")
    asked = ("export", "out/model.json", "--inverse", "--name", "lens")
    ended = run(*asked, "-o", "lens")
    assert ended.code == 0, ended.err
    assert "codes 0 to 4095 give -0.4 to 150.3 V" in ended.out
    assert "lens_step_code(lens_state *state" in (folder / "lens" / "lens.h").read_text()
    ended = run(*asked, "--driver", "linear:0.1,0,0,1200", "-o", "other")
    assert ended.code == 0, ended.err
    assert "#define LENS_CODE_MAX 1200" in (folder / "other" / "lens.h").read_text()
    ended = run(*asked, "--driver", "none", "-o", "plain")
    assert ended.code == 0, ended.err
    assert "step_code" not in (folder / "plain" / "lens.h").read_text()
    ended = run(*asked, "--target", "fmu", "--driver", "driver.csv", "-o", "lens.fmu")
    assert ended.code == 2
    assert "--driver" in ended.err


def test_columns_that_say_codes_are_taken_as_the_model_s_driver_has_them(
    run: Run, folder: Path, measured: Path
) -> None:
    """Codes taken for volts would be another drive: a wrong number that looks like a right one."""
    run("identify", measured, *ASKED, "--driver", "driver.csv", "-o", "out")
    codes = np.arange(0, 4096, 13)
    output = PLAYS(DRIVER.volts(codes))
    named = write_csv(folder / "named.csv", "t,code,y [um]", codes * DT, codes, output)
    unit = write_csv(folder / "unit.csv", "t,drive [counts],y [um]", codes * DT, codes, output)
    other = write_csv(folder / "other.csv", "t,drive,y [um]", codes * DT, codes, output)
    told = (("--driver", "driver.csv"),)
    for path, column, more in ((named, "code", ()), (unit, "drive", ()), (other, "drive", *told)):
        out = ("-o", "s.csv", "--force")
        ended = run("simulate", "out/model.json", path, "--input", column, *more, *out)
        assert ended.code == 0, ended.err
        rows = np.loadtxt(folder / "s.csv", delimiter=",", skiprows=1)
        assert np.array_equal(rows[:, 1], DRIVER.volts(codes))
        # What the constants of a fit in noise of 1 nm are off by, at rest before the first turn.
        assert np.abs(rows[:, 2] - output)[120:].max() < 0.05
    asked = ("--input", "code", "--output", "y", "--time", "t")
    ended = run("compare", "out/model.json", measured, *asked, "--json")
    assert ended.code in (0, 3), ended.err
    assert '"rms"' in ended.out
    rms = float(ended.out.split('"rms": ')[1].split(",")[0])
    assert rms < 0.005
    assert run("diagnose", measured, *asked, "--driver", "driver.csv").code == 0


def test_learning_takes_measured_codes(run: Run, folder: Path, measured: Path) -> None:
    run("identify", measured, *ASKED, "--driver", "driver.csv", "-o", "out")
    path, y_ref = reference(folder)
    asked = ("out/model.json", path)
    run("learn", *asked, "--column", "y", "-o", "c.csv")
    rows = np.loadtxt(folder / "c.csv", delimiter=",", skiprows=1)
    codes = rows[:, 3].astype(int)
    stage = hyst.Affine(1.02, 0.0) @ PLAYS
    y = stage(DRIVER.volts(codes))
    run_1 = write_csv(folder / "run1.csv", "t,code,y [um]", rows[:, 0], codes, y)
    columns = ("--column", "y", "--input", "code", "--output", "y", "--time", "t")
    ended = run("learn", *asked, run_1, *columns, "-o", "next.csv")
    assert ended.code == 0, ended.err
    learnt = np.loadtxt(folder / "next.csv", delimiter=",", skiprows=1)[:, 3].astype(int)
    missed = [np.abs(stage(DRIVER.volts(each)) - y_ref).max() for each in (codes, learnt)]
    # A gain of 2 % is taken back in one repetition, but for its square and half a code.
    assert missed[1] < 0.1 * missed[0]


def test_a_model_over_temperature_keeps_the_driver_and_gives_codes(run: Run, folder: Path) -> None:
    k = np.arange(700)
    drive = 75.0 - 74.0 * np.cos(0.03 * k) * np.linspace(1.0, 0.4, k.size)
    codes = DRIVER.codes(drive)
    for name, gain in (("cold", 1.0), ("warm", 1.1)):
        y = gain * PLAYS(DRIVER.volts(codes))
        write_csv(folder / f"{name}.csv", "t,code,y [um]", k * DT, codes, y)
    write_csv(
        folder / "driver.csv",
        "code,volt",
        np.array(DRIVER.table_codes),
        np.array(DRIVER.table_volts),
    )
    schedule = ("--schedule", "20,50", "--schedule-name", "temperature")
    asked = ("cold.csv", "warm.csv", *ASKED, *schedule, "--driver", "driver.csv", "-o", "out")
    ended = run("identify", *asked)
    assert ended.code in (0, 3), ended.err
    found = hyst.load(folder / "out" / "model.json")
    assert found.description.driver == DRIVER
    assert hyst.load(folder / "out" / "at_20" / "model.json").description.driver == DRIVER
    y_ref = 1.05 * PLAYS(75.0 + 50.0 * np.sin(0.05 * k))
    path = write_csv(folder / "ref.csv", "t,T,y [um]", k * DT, np.full(k.size, 35.0), y_ref)
    more = ("--schedule-column", "T", "--despite-verdict", "-o", "c.csv")
    ended = run("compensate", "out/model.json", path, "--column", "y", *more)
    assert ended.code == 0, ended.err
    assert "as codes" in ended.out
    rows = np.loadtxt(folder / "c.csv", delimiter=",", skiprows=1)
    assert np.array_equal(rows[:, 3], DRIVER.codes(rows[:, 2]))
    # Identified without noise; half a code through all plays is 0.002.
    assert np.abs(1.05 * PLAYS(DRIVER.volts(rows[:, 3])) - y_ref)[100:].max() < 0.01


def test_what_follows_an_actuator_takes_no_codes_for_volts(
    run: Run, folder: Path, measured: Path
) -> None:
    PLAYS.save(folder / "m.json", hyst.ModelDescription(input_unit="V", driver=DRIVER, dt=DT))
    columns = ("--input", "code", "--output", "y", "--time", "t")
    ended = run("adapt", "m.json", measured, *columns, "-o", "adapted")
    assert ended.code == 0, ended.err
    adapted = hyst.load(folder / "adapted" / "model.json")
    assert isinstance(adapted, hyst.Operator)
    drive = np.linspace(160.0, 0.0, 50)  # 160 wipes out what the record left
    # Noise of 0.001 in 2000 samples; codes for volts would be off by several um.
    assert np.abs(adapted(drive) - PLAYS(drive)).max() < 0.01
    ended = run("watch", "m.json", measured, *columns, "--stop-after", "at-end")
    assert ended.code == 2
    assert "is in codes and the model takes V" in ended.err


def test_codes_of_models_with_other_drivers_are_refused(
    run: Run, folder: Path, measured: Path
) -> None:
    other = hyst.Driver.linear(0.036, 0.0, 0, 4095)
    for name, driver in (("a.json", DRIVER), ("b.json", other)):
        PLAYS.save(folder / name, hyst.ModelDescription(input_unit="V", driver=driver))
    columns = ("--input", "code", "--output", "y", "--time", "t")
    ended = run("compare", "a.json", "b.json", measured, *columns)
    assert ended.code == 2
    assert "'code' is in codes and the models have 2 different drivers" in ended.err
    ended = run("compare", "a.json", "b.json", measured, *columns, "--driver", "driver.csv")
    assert ended.code in (0, 3), ended.err
