"""python_is_found.py PREFIX BUILD_PATH: the package tyndall, unpacked in the prefix, gives what the build's gives.

BUILD_PATH: the folder of the build's package, and where VTK's own Python modules are, as PYTHONPATH has them.
LD_LIBRARY_PATH stands in for an installation in /usr.
"""
import os
import pathlib
import subprocess
import sys

prefix = pathlib.Path(sys.argv[1]).resolve() / "usr"
assert not list(prefix.glob("lib/python3.*")), "Debian's Python does not look there"
built, *of_vtk = sys.argv[2].split(":")


def solves(folder, python_path, **environment):
    python_path = ":".join([str(python_path)] + of_vtk)
    done = subprocess.run([sys.executable, pathlib.Path(__file__).with_name("python_solves.py"), folder], check=True,
                          env={**os.environ, **environment, "PYTHONPATH": python_path}, stdout=subprocess.PIPE, text=True)
    assert "fluence" in done.stdout, done.stdout
    return done.stdout


packaged = solves(prefix, prefix / "lib/python3/dist-packages", LD_LIBRARY_PATH=str(prefix / "lib"))
print(packaged)
assert packaged == solves(pathlib.Path(built).parents[2], built), "the package gives other numbers than the build"
