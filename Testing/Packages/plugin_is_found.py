"""plugin_is_found.py PREFIX: a ParaView in the prefix where the package is unpacked lists the plugin by itself.

Then it loads the plugin by its name and solves a small furnace; and the package tyndall lies where Python looks.
"""
import os
import pathlib
import shutil
import subprocess
import sys

IN_PARAVIEW = """
import math
from paraview import servermanager, simple
listed = servermanager.vtkSMProxyManager.GetProxyManager().GetPluginManager().GetLocalInformation()
names = [listed.GetPluginName(i) for i in range(listed.GetNumberOfPlugins())]
assert "Tyndall" in names, names
file = listed.GetPluginFileName(names.index("Tyndall"))
assert file.startswith(PREFIX), file
simple.LoadDistributedPlugin("Tyndall", ns=globals())
wavelet = simple.Wavelet(WholeExtent=[0, 8, 0, 8, 0, 8])
medium = ParticipatingMedium(Input=wavelet, MaximumDensity=300.0, Albedo=[1.0, 1.0, 1.0])
light = LightPropagationMaps(Input=medium, SkyColor=[1.0, 1.0, 1.0], Tolerance=1e-5)
light.UpdatePipeline()
low, high = light.CellData["fluence"].GetRange(0)
assert abs(low / (4.0 * math.pi) - 1.0) < 2e-3 and abs(high / (4.0 * math.pi) - 1.0) < 2e-3, (low, high)
for line in open("/proc/self/maps"):
    assert "libvtkTyndall" not in line or PREFIX in line, line
print("listed, loaded and solved")
"""
IN_PYTHON = """
import numpy, tyndall
assert tyndall.__file__.startswith(PREFIX), tyndall.__file__
assert tyndall.solve(numpy.ones((4, 4, 4)), sky=1.0).fluence.min() > 0.0
"""


prefix = pathlib.Path(sys.argv[1]).resolve()
programs = prefix / "usr/bin"
# Not a link: ParaView looks beside what the executable really is.
paraview = shutil.copy(pathlib.Path("/usr/bin/pvpython").resolve(), programs / "pvpython")
assert not list((prefix / "usr").glob("lib/python3.*")), "Debian's Python does not look there"
script = f"PREFIX = {str(prefix)!r}\n"
(prefix / "in_paraview.py").write_text(script + IN_PARAVIEW, encoding="utf-8")
done = subprocess.run([paraview, prefix / "in_paraview.py"], cwd=prefix, check=True, stdout=subprocess.PIPE, text=True)
assert "listed, loaded and solved" in done.stdout, done.stdout  # pvpython exits 0 after an exception
subprocess.run([sys.executable, "-c", script + IN_PYTHON], cwd=prefix, check=True,
               env={**os.environ, "PYTHONPATH": str(prefix / "usr/lib/python3/dist-packages")})
