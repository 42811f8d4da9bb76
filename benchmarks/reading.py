"""Reading text against NumPy and, where it is installed, pandas: a million rows of three columns.

Each way of writing is read by `read_table`, by `read_record`, by `numpy.loadtxt` and by
`pandas.read_csv`, in turn; printed is the time of each and the ratio to the fastest peer there is.
hyst also finds out how the file is written and checks every line, and a record's time and signals
are checked too.
"""

from __future__ import annotations

import importlib.util
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from benchmarks.timing import interleaved, report_times
from hyst.io import read_record, read_table

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
