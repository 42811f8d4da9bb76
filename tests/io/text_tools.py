"""Text files as instruments and tools export them, one for each row of the table in docs."""

from __future__ import annotations

import datetime
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from lab_files import DT, cell, rows, signals

T, U, Y = signals(120)
START = datetime.datetime(2026, 11, 28, 12, 0, 0)


@dataclass(frozen=True)
class TextFile:
    """A file with the signals T, U, Y in it.

    Parameters
    ----------
    content
        What the tool writes.
    how
        What to tell ``read_record``.
    name
        Of the file.
    units
        Of input and output.
    notes
        How many sentences there are about it.
    """

    content: str | bytes
    how: dict[str, Any]
    name: str = "export.csv"
    units: tuple[str, str] = ("V", "um")
    notes: int = 0


def lines(*parts: str | Sequence[str], end: str = "\n") -> str:
    """Join lines and lists of lines."""
    flat = [line for part in parts for line in ([part] if isinstance(part, str) else part)]
    return end.join(flat) + end


def comma(value: float) -> str:
    return cell(value).replace(".", ",")


def exponent(value: float) -> str:
    return f"{value:+.7E}"


def named(input: str, output: str, time: str | None = None, **more: Any) -> dict[str, Any]:
    return {"input": input, "output": output} | ({} if time is None else {"time": time}) | more


def stamps(form: str, step: float = DT) -> list[str]:
    moments = [START + datetime.timedelta(seconds=step * k) for k in range(T.size)]
    return [m.strftime(form).replace("%", f"{m.microsecond // 1000:03d}") for m in moments]


def keysight() -> TextFile:
    body = rows((T, U, Y), write=exponent)
    text = lines("x-axis,1,2", "second,Volt,Volt", body)
    return TextFile(text, named("1", "2", "x-axis"), units=("Volt", "Volt"))


def rigol() -> TextFile:
    head = ["X,CH1,CH2,Start,Increment,", f"Sequence,Volt,Volt,0.0e+00,{DT:e}"]
    body = [f"{k},{u:.6e},{y:.6e}," for k, (u, y) in enumerate(zip(U, Y, strict=True))]
    return TextFile(lines(head, body), named("CH1", "CH2", "X"), units=("Volt", "Volt"), notes=1)


def siglent() -> TextFile:
    head = ["Record Length,Analog:120", f"Sample Interval,{DT}", "Vertical Units,V,V"]
    head += ["Horizontal Units,s", "Model Number,SDS1104", "Source,CH1,CH2", "Second,Volt,Volt"]
    text = lines(head, rows((T, U, Y)))
    return TextFile(text, named("CH1", "CH2", "Source"), units=("Volt", "Volt"))


def tektronix() -> TextFile:
    head = ["Model,MSO2024", "Firmware Version,1.52", "", "Point Format,Y", "Horizontal Units,S"]
    head += [f"Sample Interval,{DT}", "Record Length,120", "Probe Attenuation,1,1", ""]
    text = lines(head, "TIME,CH1,CH2", rows((T, U, Y)), end="\r\n")
    return TextFile(text, named("CH1", "CH2", "TIME"), units=("", ""))


def picoscope() -> TextFile:
    text = lines("Time,Channel A,Channel B", "(ms),(V),(um)", "", rows((1e3 * T, U, Y)))
    return TextFile(text, named("Channel A", "Channel B", "Time"))


def waveforms() -> TextFile:
    head = ["#Digilent WaveForms Oscilloscope Acquisition", "#Sample rate: 200Hz", "#Samples: 120"]
    text = lines(head, "", "Time (s),Channel 1 (V),Channel 2 (V)", rows((T, U, Y)))
    return TextFile(text, named("Channel 1", "Channel 2", "Time"), units=("V", "V"))


def lvm(separator: str, decimal: str, x: str) -> str:
    write: Callable[[float], str] = comma if decimal == "," else cell
    head = ["LabVIEW Measurement", "Writer_Version,2", "Reader_Version,2"]
    head += [f"Separator,{'Tab' if separator == chr(9) else 'Comma'}", "Multi_Headings,No"]
    top = [line.replace(",", separator) for line in head]
    top += [separator.join(["Decimal_Separator", decimal]), separator.join(["X_Columns", x])]
    units = [["Channels", "2"], ["Y_Unit_Label", "V", "um"], ["X_Dimension", "Time", "Time"]]
    units += [["Delta_X", write(DT), write(DT)]]
    body = rows((T if x == "One" else [""] * T.size, U, Y), separator, write)
    end = "***End_of_Header***"
    names = separator.join(["X_Value", "drive", "stroke", "Comment"])
    return lines(top, end, "", [separator.join(each) for each in units], end, names, body)


def labview() -> TextFile:
    return TextFile(lvm("\t", ".", "One"), named("drive", "stroke", "X_Value"), "run.lvm")


def labview_without_x() -> TextFile:
    return TextFile(lvm("\t", ",", "No"), named("drive", "stroke"), "run.lvm", notes=1)


def dspace() -> TextFile:
    text = lines("time;drive;stroke", "s;V;um", rows((T, U, Y), ";"))
    return TextFile(text, named("drive", "stroke", "time"))


def tester() -> TextFile:
    head = ["DynamicHysteresisResult", "", "SampleName: film", "Area [mm2]: 1.0"]
    table = lines("Time [s]\tV+ [V]\tP+ [um]", rows((T, U, Y), "\t", exponent))
    fast = lines("Time [s]\tV+ [V]\tP+ [um]", rows((T / 10, U, Y), "\t", exponent))
    one, two = "Table 1\nFrequency [Hz]: 1\n\n", "\nTable 2\nFrequency [Hz]: 10\n\n"
    text = lines(head, "") + one + table + two + fast
    return TextFile(text, named("V+", "P+", "Time", table=1), "film.dat")


def data_logger() -> TextFile:
    y = [cell(v) for v in Y]
    y[44:46] = ["-9999.0000"] * 2
    text = lines("timestamp,drive_V,stroke_um", rows((stamps("%Y-%m-%dT%H:%M:%S.%%Z"), U, y)))
    return TextFile(text, named("drive_V", "stroke_um", "timestamp", repair=True), notes=2)


def slow_clock() -> TextFile:
    t = np.floor(np.arange(T.size) / 5) * 5 * DT
    text = lines("t,drive [V],stroke [um]", rows((t, U, Y)))
    return TextFile(text, named("drive", "stroke", "t", repair=True), notes=1)


def scpi() -> TextFile:
    y = [exponent(v) for v in Y]
    y[17] = "+9.91000000E+37"
    text = lines("TIME,VOLT [V],POS [um]", rows((T, U, y), write=exponent))
    return TextFile(text, named("VOLT", "POS", "TIME", repair=True), notes=2)


def german_spreadsheet() -> TextFile:
    def thousands(value: float) -> str:
        return f"{value:,.1f}".replace(",", " ").replace(".", ",").replace(" ", ".")

    y = [thousands(1e4 * v) for v in Y]
    text = lines("Zeit [s];Spannung [V];Weg [µm]", rows((T, U, y), ";", comma))
    return TextFile(text, named("Spannung", "Weg", "Zeit"), units=("V", "µm"), notes=1)


def excel_unicode() -> TextFile:
    head = '"Time\n[s]"\t"Drive\n[V]"\t"Stroke\n[um]"'
    content = lines(head, rows((T, U, Y), "\t"), end="\r\n").encode("utf-16")
    return TextFile(content, named("Drive", "Stroke", "Time"), "book.txt")


def serial_plotter() -> TextFile:
    body = [f"t:{1e3 * t:.1f},u:{u:.4f},y:{y:.4f}" for t, u, y in zip(T, U, Y, strict=True)]
    return TextFile(lines(body), named("u", "y", "t", time_unit="ms"), "COM3.log", units=("", ""))


def microcontroller() -> TextFile:
    ticks = np.mod(2**32 - 100_000 + 5000 * np.arange(T.size), 2**32)
    body = rows((ticks, U, Y), write=lambda v: f"{v:.0f}" if v > 100 else cell(v))
    text = lines("=~=~ terminal log 2026.11.28 =~", "3.5,1.", "micros,u_V,y_um", body)
    return TextFile(text, named("u", "y", "micros"), "putty.log", notes=2)


def origin() -> TextFile:
    head = ["Time\tDrive\tStroke", "ms\tV\tum", "set\tmeasured\tmeasured"]
    text = lines(head, rows((1e3 * T, U, Y), "\t"))
    return TextFile(text, named("Drive", "Stroke", "Time"), "book.dat")


def matlab_table() -> TextFile:
    body = rows(([f"{t:g} sec" for t in T], U, Y))
    return TextFile(lines("Time,u_V,y_um", body), named("u_V", "y_um", "Time"))


def matlab_matrix() -> TextFile:
    text = lines(rows((T, U, Y), write=lambda v: f"{v:.15g}"))
    return TextFile(text, {"input": 1, "output": 2, "time": 0}, units=("", ""))


def numpy_savetxt() -> TextFile:
    text = lines("# t u y", rows((T, U, Y), " ", lambda v: f"{v:.18e}"))
    return TextFile(text, named("u", "y", "t"), "loop.txt", units=("", ""))


def pandas_to_csv() -> TextFile:
    index = [str(k) for k in range(T.size)]
    text = lines(",time_ms,drive_V,stroke_um", rows((index, 1e3 * T, U, Y)))
    return TextFile(text, named("drive", "stroke", "time"))


def fortran() -> TextFile:
    body = rows((T, U, Y), "  ", lambda v: f"{v:.7E}".replace("E", "D"))
    return TextFile(lines(body), {"input": 1, "output": 2, "time": 0}, "fort.12", units=("", ""))


TEXT_TOOLS: dict[str, Callable[[], TextFile]] = {
    "Keysight InfiniiVision": keysight,
    "Rigol DS1000, MSO1000": rigol,
    "Siglent SDS": siglent,
    "Tektronix MSO, DPO": tektronix,
    "PicoScope": picoscope,
    "Digilent WaveForms": waveforms,
    "LabVIEW measurement file": labview,
    "LabVIEW measurement file without X": labview_without_x,
    "dSPACE, text": dspace,
    "ferroelectric tester": tester,
    "data logger": data_logger,
    "logger with a slow clock": slow_clock,
    "SCPI instrument": scpi,
    "spreadsheet, German": german_spreadsheet,
    "Excel, Unicode text": excel_unicode,
    "serial plotter": serial_plotter,
    "microcontroller, terminal log": microcontroller,
    "Origin": origin,
    "MATLAB writetimetable": matlab_table,
    "MATLAB writematrix": matlab_matrix,
    "numpy.savetxt": numpy_savetxt,
    "pandas to_csv": pandas_to_csv,
    "Fortran": fortran,
}
