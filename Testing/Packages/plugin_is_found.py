"""plugin_is_found.py PREFIX WITH_DISPLAY: a ParaView in the prefix where the package is unpacked finds the plugin by
itself, and there it works (plugin_works.py); its window, told to load it, starts the program that compiles kernels.
"""
import os
import pathlib
import shutil
import subprocess
import sys

here = pathlib.Path(__file__).resolve().parent
prefix = pathlib.Path(sys.argv[1]).resolve() / "usr"
(prefix / "bin").mkdir(exist_ok=True)
# ParaView 5.13 looks in /usr/share/paraview/plugins, and in the same way in a folder beside its executable.
if (prefix / "share/paraview/plugins").exists() and not (prefix / "bin/plugins").exists():
    (prefix / "bin/plugins").symlink_to("../share/paraview/plugins")
# Not links: ParaView looks beside what the executable really is.
pvpython, paraview = (shutil.copy(pathlib.Path("/usr/bin", name).resolve(), prefix / "bin" / name)
                      for name in ("pvpython", "paraview"))

done = subprocess.run([sys.argv[2], pvpython, here / "plugin_works.py", prefix], cwd=prefix, check=True,
                      stdout=subprocess.PIPE, text=True)
assert "listed, loaded, solved, seen, and prepared" in done.stdout, done.stdout
print(done.stdout)

folder = next(prefix.glob("lib/paraview-*/plugins/Tyndall"))
subprocess.run([sys.argv[2], sys.executable, here.parent / "Plugin/PreparationEndsWithParaView.py", paraview, "--dr",
                "--plugin-search-paths=%s" % folder, "--plugins=Tyndall",
                "--test-directory=" + os.environ["TYNDALL_TEST_OUTPUT"]], check=True)
