"""The Python examples of README.md and the pages run as they are pasted, one after the other of a page, and cloud.py prints
what README.md and the guide say it does."""
import contextlib
import importlib.util
import io
import os
import pathlib
import re
import runpy

source = pathlib.Path(os.environ["TYNDALL_SOURCE"])
os.chdir(os.environ["TYNDALL_TEST_OUTPUT"])

blocks = 0
for page in [source / "README.md", *sorted((source / "Plugin/Documentation").glob("*.md"))]:
    text, names = page.read_text(encoding="utf-8"), {}
    for found in re.finditer(r"^```python\n(.*?)^```", text, re.DOTALL | re.MULTILINE):
        if "import tyndall" in found[1] and not importlib.util.find_spec("tyndall"):
            print("The package tyndall was not built: left out")
            continue
        line = text.count("\n", 0, found.start()) + 1
        print(f"{page.name}, line {line}", flush=True)
        exec(compile("\n" * line + found[1], str(page), "exec"), names)
        blocks += 1
assert blocks >= 3, blocks

printed = io.StringIO()
with contextlib.redirect_stdout(printed):
    runpy.run_path(str(source / "Plugin/Examples/cloud.py"))
PRINTED = re.compile(r"^ *(\d+) orders, energy balance to (\S+) in \S+ s$", re.MULTILINE)
(now,) = PRINTED.findall(printed.getvalue())
for page in "README.md", "Plugin/Documentation/guide.md":
    (told,) = PRINTED.findall((source / page).read_text(encoding="utf-8"))
    same = now[0] == told[0] and 0.1 < float(now[1]) / float(told[1]) < 10.0  # its balance is of rounding
    assert same, f"cloud.py prints {printed.getvalue()!r}, {page} says {told}: paste what it prints"
