"""ParaView's status bar says that kernels are compiled, where OpenCL's cache is empty, in letters that are seen.

    python3 CompilingInWindow.py paraview [arguments...]    on an X display

A picture of the display at that time is CompilingInWindow.png in the output folder.
"""
import os
import re
import shutil
import subprocess
import sys
import time

import numpy

import pictures
from screen import Screen

folder = os.environ["TYNDALL_TEST_OUTPUT"]
log = os.path.join(folder, "CompilingInWindow.log")
cache = os.path.join(folder, "CompilingInWindow.cache")
session = os.path.join(os.path.dirname(os.path.abspath(__file__)), "FirstApply.xml")
WIDTH, HEIGHT = 1280, 1024  # of the display
SAYS = re.compile(r"vtkLightPropagationMaps is \S+ done(.*)")
PATIENCE = 300  # seconds after which something hangs, on the slowest machine


def logged():
    with open(log, errors="replace") as file:
        return file.read()


def seen(x, y, width, height):
    pixels = numpy.frombuffer(screen.pixels(x, y, width, height), numpy.uint8)
    return pixels.reshape(height, width, 4)[:, :, 2::-1]


def letters(bar):
    """How many columns from the first dark pixel to the last: blue and grey are no letters."""
    columns = numpy.flatnonzero((bar.max(axis=2) < 70).any(axis=0))
    return columns[-1] - columns[0] + 1 if len(columns) else 0


shutil.rmtree(cache, ignore_errors=True)
os.makedirs(cache)
if os.path.exists(log):
    os.remove(log)
environment = dict(os.environ, POCL_CACHE_DIR=cache)
paraview = subprocess.Popen(sys.argv[1:] + ["--log=%s,TRACE" % log, "--exit", "--test-script=" + session], env=environment)
screen, widths = Screen(), []
try:
    end = time.monotonic() + PATIENCE
    while len(widths) < 5:
        assert time.monotonic() < end and paraview.poll() is None, "nothing is said of compiling: %s" % widths
        time.sleep(0.3)
        said = logged() if os.path.exists(log) else ""
        reports = SAYS.findall(said)
        if not reports or reports[-1] != ": compiling kernels (once)":
            continue
        x, y = (int(number) for number in re.search(r"Maps can be aborted at \((\d+), (\d+)\)", said).groups())
        widths.append(letters(seen(x + 15, y - 8, 350, 16)))
        if len(widths) == 5:
            pictures.write(os.path.join(folder, "CompilingInWindow.png"), seen(0, 0, WIDTH, HEIGHT)[::-1])
finally:
    if paraview.poll() is None:
        paraview.kill()
        paraview.wait()
print("letters in the status bar, pixels from the first to the last: %s" % widths)
assert max(widths) > 120, "the status bar shows no words while kernels are compiled"
