"""example_builds.py PREFIX ROOT FOLDER: the guide's commands for the C++ example, word for word, with the packages that
are unpacked in the prefix: CMAKE_PREFIX_PATH stands in for their installation in /usr.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

prefix, root, folder = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
guide = (root / "Plugin/Documentation/guide.md").read_text(encoding="utf-8")
found = re.search(r"<!-- run by a test: Testing/Packages/example_builds.py -->\n+((?:    .*\n)+)", guide)
assert found, "guide.md has no commands for the example"
shutil.rmtree(folder, ignore_errors=True)
folder.mkdir(parents=True)
(folder / "Plugin").symlink_to(root / "Plugin")
environment = {**os.environ, "CMAKE_PREFIX_PATH": str(prefix / "usr")}
done = subprocess.run(["bash", "-e", "-c", found[1]], cwd=folder, env=environment, check=True, stdout=subprocess.PIPE,
                      text=True)
print(done.stdout)

# The guide's numbers, within what another processor's rounding changes; so no rest and no count of orders.
watts = [re.search(r"entered (\S+) W, absorbed (\S+) W, escaped (\S+) W", text) for text in (done.stdout, guide)]
for now, told in zip(watts[0].groups(), watts[1].groups()):
    assert abs(float(now) / float(told) - 1.0) < 1e-3, f"{now} W, the guide says {told} W"
assert (folder / "light.vdb").stat().st_size > 0
cache = (folder / "build/cxx/CMakeCache.txt").read_text(encoding="utf-8")
assert f"Tyndall_DIR:PATH={prefix}" in cache, "another Tyndall was found"
