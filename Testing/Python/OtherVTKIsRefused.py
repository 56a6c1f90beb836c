"""Beside another VTK's Python modules the package says which it was built for, where Python would crash else."""
import os
import subprocess
import sys
import tempfile

import tyndall

# A folder in front of all others, with a VTK as pip's.
with tempfile.TemporaryDirectory() as folder:
    os.mkdir(os.path.join(folder, "vtkmodules"))
    open(os.path.join(folder, "vtkmodules", "__init__.py"), "w").close()
    with open(os.path.join(folder, "vtkmodules", "vtkCommonCore.py"), "w") as module:
        module.write("class vtkVersion:\n    @staticmethod\n    def GetVTKVersion():\n        return '9.9.0'\n")
    paths = os.pathsep.join([folder, os.environ["PYTHONPATH"]])
    run = subprocess.run([sys.executable, "-c", "import tyndall"], env={**os.environ, "PYTHONPATH": paths},
                         capture_output=True, text=True)
assert run.returncode == 1, run
assert "ImportError: this package tyndall was built for " + tyndall.host.HOST in run.stderr, run.stderr
assert "those of VTK 9.9.0, in " + folder in run.stderr, run.stderr
