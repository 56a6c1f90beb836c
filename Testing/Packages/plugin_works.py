"""Run by a ParaView that found the package's plugin by itself, in pvpython with a display:

    pvpython plugin_works.py PREFIX    of /usr: where the package lies

The plugin is listed, and loaded by its name; a furnace is even, and a small cloud is seen by its light in the 3D view.
The program that compiles kernels lies beside the plugin, and does so. Then one line is printed: pvpython exits with 0
after an exception, too.
"""
import math
import os
import subprocess
import sys
import tempfile

from paraview import servermanager, simple

sys.path.append(os.path.join(os.environ["TYNDALL_SOURCE"], "Testing/Plugin"))
import lit_view

prefix = sys.argv[1]
listed = servermanager.vtkSMProxyManager.GetProxyManager().GetPluginManager().GetLocalInformation()
names = [listed.GetPluginName(i) for i in range(listed.GetNumberOfPlugins())]
assert "Tyndall" in names, names
plugin = os.path.realpath(listed.GetPluginFileName(names.index("Tyndall")))
assert plugin.startswith(prefix + "/lib"), plugin
simple.LoadDistributedPlugin("Tyndall", ns=vars(lit_view))
with open("/proc/self/maps") as maps:
    ours = [line for line in maps if "libvtkTyndall" in line]
assert ours and all(prefix + "/lib" in line for line in ours), ours

medium = lit_view.ParticipatingMedium(Input=simple.Wavelet(WholeExtent=[0, 8, 0, 8, 0, 8]), MaximumDensity=300.0,
                                      Albedo=[1.0, 1.0, 1.0])
furnace = lit_view.LightPropagationMaps(Input=medium, SkyColor=[1.0, 1.0, 1.0], Tolerance=1e-5)
furnace.UpdatePipeline()
for fluence in furnace.CellData["fluence"].GetRange(0):
    assert abs(fluence / (4.0 * math.pi) - 1.0) < 2e-3, fluence

light = lit_view.solved()
view = lit_view.black_view()
assert simple.Show(light, view).Representation == "Lit Volume", "it is how a solver's light is shown at first"
lit_view.show_lit(light, view)
lit_view.check_same(lit_view.drawn(view), lit_view.cast(light, view))

program = os.path.join(os.path.dirname(plugin), "TyndallPreparation")
with tempfile.TemporaryDirectory() as cache:
    subprocess.run([program, "1"], check=True, env={**os.environ, "POCL_CACHE_DIR": cache})
    kept = [name for _, _, files in os.walk(cache) for name in files if name.endswith(".so")]
assert kept, "no kernel was compiled"
print("listed, loaded, solved, seen, and prepared: %d kernels" % len(kept))
