"""ParaView's window starts TyndallPreparation, quits well while that compiles, and takes it along.

    python3 PreparationEndsWithParaView.py paraview [arguments...]    on an X display
"""
import glob
import os
import shutil
import subprocess
import sys
import time

cache = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "empty_cache")
session = os.path.join(os.path.dirname(os.path.abspath(__file__)), "LightRigFromMenu.xml")


def preparations(parent):
    """Processes that work for ParaView of this number, each as its words."""
    found = []
    for path in glob.glob("/proc/[0-9]*/cmdline"):
        try:
            with open(path) as file:
                words = file.read().split("\0")[:-1]
        except OSError:  # it has ended
            continue
        if words and words[0].endswith("TyndallPreparation") and words[-1] == str(parent):
            found.append(words)
    return found


shutil.rmtree(cache, ignore_errors=True)
paraview = subprocess.Popen(sys.argv[1:] + ["--exit", "--test-script=" + session],
                            env={**os.environ, "POCL_CACHE_DIR": cache, "TYNDALL_PREPARE": "1"})
seen = []
while paraview.poll() is None:
    seen = seen or preparations(paraview.pid)
    time.sleep(0.05)
assert paraview.returncode == 0, paraview.returncode
assert seen, "it was not started"
time.sleep(1)
assert not preparations(paraview.pid), "it goes on"
