"""Text in and out against NumPy and, where it is installed, pandas: a million rows of 3 columns.

Each way of writing is read by `read_table`, by `read_record`, by `numpy.loadtxt` and by
`pandas.read_csv`, in turn; printed is the time of each and the ratio to the fastest peer there is.
hyst also finds out how the file is written and checks every line, and a record's time and signals
are checked too. Then a record is read in chunks, the table is written with all its digits, and
`hyst simulate` reads an input and writes time, input and output, against `read_csv` and `to_csv` of
the same table.
"""

from __future__ import annotations

import contextlib
import importlib.util
import io
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

import hyst
import hyst.cli
from benchmarks.timing import interleaved, ratio, report_times
from hyst.io import open_record, read_record, read_table, write_columns

ROWS = 1_000_000
FORMS = {
    "fixed decimals, commas": ("{:.4f}", ","),
    "exponents, tabs": ("{:.7e}", "\t"),
    "nine digits, semicolons": ("{:.9g}", ";"),
    "all digits, commas": ("{!r}", ","),
}


def main() -> None:
    """Print the table."""
    print(f"seconds of processor time for {ROWS} rows of three columns")
    peer = "pandas" if importlib.util.find_spec("pandas") else "loadtxt"
    head = ("read_table", "read_record", "loadtxt", "pandas", "table/peer", "record/peer")
    print(f"  {'written with':26s}" + "".join(f"{each:>13s}" for each in head))
    with tempfile.TemporaryDirectory() as folder:
        for name, (form, separator) in FORMS.items():
            path = Path(folder) / "loop.csv"
            write(path, form, separator)
            times = interleaved(works(path, separator), seconds=6.0, rounds=7)
            row = [
                f"{np.median(times[each]):13.3f}" if each in times else f"{'-':>13s}"
                for each in head[:4]
            ]
            for each in head[:2]:
                told = f"{each} over {peer}, written with {name}"
                row.append(f"{report_times(told, times, each, peer, better='smaller'):13.2f}")
            print(f"  {name:26s}{''.join(row)}")
        if peer == "pandas":
            print_writing(Path(folder))


def print_writing(folder: Path) -> None:
    """Compare chunks, writing and simulation with pandas."""
    import pandas

    source, target, model = (folder / each for each in ("loop.csv", "out.csv", "model.json"))
    hyst.PrandtlIshlinskii([0.5, 0.4], [1.0, 5.0], 1.0).save(model, hyst.ModelDescription())
    table = pandas.read_csv(source)
    columns = [table[name].to_numpy() for name in "tuy"]
    typed = ["simulate", str(model), str(source), "--input", "u", "--rate", "10000"]
    works: dict[str, Callable[[], object]] = {
        "open_record and chunks": lambda: [*open_record(source, "u", "y", time="t").chunks(65_536)],
        "write_columns": lambda: write_columns(target, list("tuy"), columns),
        "hyst simulate": lambda: simulated([*typed, "-o", str(target)]),
        "read_csv": lambda: pandas.read_csv(source),
        "to_csv": lambda: table.to_csv(target, index=False),
        "read_csv and to_csv": lambda: pandas.read_csv(source).to_csv(target, index=False),
    }
    times = interleaved(works, seconds=30.0, rounds=5)
    pairs = zip(list(works)[:3], list(works)[3:], strict=True)
    for work, other in pairs:
        spent = f"{np.median(times[work]):.3f} s, {ratio(times, work, other):.2f} of {other}"
        print(f"  {work:26s}{spent}")


def simulated(typed: list[str]) -> None:
    """Run the program without what it prints."""
    with contextlib.redirect_stdout(io.StringIO()):
        status = hyst.cli.main(typed)
    assert status == 0, "the program failed"


def works(path: Path, separator: str) -> dict[str, Callable[[], object]]:
    """What is compared."""
    found: dict[str, Callable[[], object]] = {
        "read_table": lambda: read_table(path),
        "read_record": lambda: read_record(path, "u", "y", time="t"),
        "loadtxt": lambda: np.loadtxt(path, delimiter=separator, skiprows=1),
    }
    if importlib.util.find_spec("pandas"):
        import pandas

        found["pandas"] = lambda: pandas.read_csv(path, sep=separator)
    return found


def write(path: Path, form: str, separator: str) -> None:
    """A drive of some turns, and an output behind it."""
    t = np.arange(ROWS) * 1e-4
    u = 50.0 * np.sin(t)
    y = 0.5 * u + np.random.default_rng(1).standard_normal(ROWS)
    line = separator.join([form] * 3)
    body = "\n".join(
        line.format(*row) for row in zip(t.tolist(), u.tolist(), y.tolist(), strict=True)
    )
    path.write_text(f"{separator.join('tuy')}\n{body}\n")
