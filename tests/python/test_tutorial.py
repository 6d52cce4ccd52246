"""docs/tutorial.ipynb runs, and says what is stored in it: words exactly, numbers to three digits.

`test_tutorial.py write` runs it and stores what it says, pictures included.
"""

import os
import re
import sys
import tempfile
import unittest
from base64 import b64decode, b64encode
from importlib import import_module
from importlib.util import find_spec
from io import BytesIO
from itertools import groupby
from pathlib import Path
from typing import Any

FILE = Path(__file__).parents[2] / "docs" / "tutorial.ipynb"
DIGITS = 1e-3
# Other on every machine: times, addresses, temporary files.
VARIES = re.compile(r"[\d.]+\s(?:ms|s|min)\b|0x[0-9a-f]+|/tmp/\S+|computing time")
NUMBER = re.compile(r"[-−]?\d+(?:\.\d+)?(?:e[-+]\d+)?")


def run() -> Any:
    """The notebook, executed."""
    nbformat: Any = import_module("nbformat")

    notebook = nbformat.read(FILE, as_version=4)
    with tempfile.TemporaryDirectory() as folder:
        os.environ.update(JUPYTER_RUNTIME_DIR=folder, IPYTHONDIR=folder, MPLCONFIGDIR=folder)
        os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # else debugpy prints warnings
        place = {"metadata": {"path": folder}}
        import_module("nbclient").NotebookClient(
            notebook, timeout=300, kernel_name="python3", resources=place, record_timing=False
        ).execute()
    return notebook


def compressed(picture: str) -> str:
    """A PNG in base64, with a palette: a third of the size."""
    from PIL import Image

    image = Image.open(BytesIO(b64decode(picture))).convert("RGB")
    content = BytesIO()
    image.quantize(256, kmeans=1, dither=Image.Dither.NONE).save(content, format="png", optimize=True)
    return b64encode(content.getvalue()).decode()


def write() -> None:
    """Stores what the notebook says."""
    nbformat: Any = import_module("nbformat")
    notebook = run()
    for cell in notebook.cells:
        for output in cell.get("outputs", ()):
            if "image/png" in output.get("data", {}):
                output.data["image/png"] = compressed(output.data["image/png"])
    nbformat.write(notebook, FILE)


def is_stream(output: Any) -> bool:
    return bool(output.output_type == "stream")


def said(cell: Any) -> list[str]:
    """The texts of a cell's outputs; of a picture only that it is one. What is printed comes in pieces as it is made."""
    texts = []
    for is_printed, outputs in groupby(cell.get("outputs", ()), is_stream):
        if is_printed:
            texts.append(VARIES.sub("", "".join(output.text for output in outputs)))
            continue
        for output in outputs:
            kind = next(kind for kind in ("image/png", "text/html", "text/plain") if kind in output.data)
            texts.append(kind if kind == "image/png" else VARIES.sub("", output.data[kind]))
    return texts


def differences(expected: str, found: str) -> str | None:
    """What differs first, or None."""
    if NUMBER.sub("#", expected) != NUMBER.sub("#", found):
        return f"words differ: {expected!r} is stored, {found!r} is found"
    for stored, now in zip(NUMBER.findall(expected), NUMBER.findall(found)):
        a, b = (float(word.replace("−", "-")) for word in (stored, now))
        if abs(a - b) > DIGITS * max(abs(a), abs(b)):
            return f"{stored} is stored, {now} is found"
    return None


@unittest.skipUnless(
    all(map(find_spec, ("nbclient", "ipykernel", "matplotlib", "pandas"))), "no Jupyter, matplotlib, pandas"
)
class Tutorial(unittest.TestCase):
    def test_says_what_is_stored(self) -> None:
        nbformat: Any = import_module("nbformat")
        stored = nbformat.read(FILE, as_version=4)
        for number, (before, after) in enumerate(zip(stored.cells, run().cells)):
            expected, found = said(before), said(after)
            with self.subTest(cell=number, source=before.source[:60]):
                self.assertEqual(len(found), len(expected))
                for texts in zip(expected, found):
                    self.assertIsNone(differences(*texts))

    def test_notices_differences(self) -> None:
        self.assertIsNone(differences("bound 1.234e-05 of 10", "bound 1.2345e-05 of 10"))
        self.assertRegex(differences("bound 0.87 %", "bound 0.88 %") or "", "0.87 is stored")
        self.assertRegex(differences("certified 1", "budget 1") or "", "words differ")
        self.assertRegex(differences("-2.5", "2.5") or "", "-2.5 is stored")


if __name__ == "__main__":
    if sys.argv[1:] == ["write"]:
        write()
    else:
        unittest.main()
