"""In ParaView's window a long solve shows its progress and stops at a click; Apply runs it again, as the status bar says;
a short one then ends well.

    python3 AbortInWindow.py paraview [arguments...]    on an X display, with xdotool

That it stops at once is measured in reports of progress, of which there may be one more from when the filter heard of the
click. How long that takes is printed, and no claim: it depends on the machine.
"""
import os
import re
import subprocess
import sys
import time

from screen import Screen

log = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "AbortInWindow.log")
session = os.path.join(os.path.dirname(os.path.abspath(__file__)), "SolveInWindow.xml")


SOLVER = "vtkLightPropagationMaps"
PATIENCE = 300  # seconds after which something hangs, on the slowest machine


def wait_for(pattern):
    """What the log says, as soon as it says it."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        if os.path.exists(log):
            with open(log, errors="replace") as file:
                found = re.search(pattern, file.read(), re.DOTALL)
            if found:
                return found
        assert paraview.poll() is None, "ParaView has gone"
        time.sleep(0.005)
    raise AssertionError("not within %g s: %s" % (PATIENCE, pattern))


def abort(solver):
    """A click on the button while the solver runs, which is the pattern of what the log says of it."""
    begin = time.monotonic()
    subprocess.run(["xdotool", "mousemove", str(x), str(y), "click", "1"], check=True)
    heard = wait_for(r"%s is aborted(.*?)%s has ended" % (solver, SOLVER)).group(1)
    print("from the click to the end: %.3f s" % (time.monotonic() - begin))
    reports = heard.count(SOLVER + " is ") - heard.count(SOLVER + " is 1 done")  # which VTK says of all that has ended
    assert reports <= 1, "%d reports of progress after the abort:%s" % (reports, heard)


if os.path.exists(log):
    os.remove(log)
paraview = subprocess.Popen(sys.argv[1:] + ["--log=%s,TRACE" % log, "--exit", "--test-script=" + session])
try:
    x, y = (int(number) for number in wait_for(SOLVER + r" can be aborted at \((\d+), (\d+)\)").groups())

    screen = Screen()
    progress = set()
    end = time.monotonic() + PATIENCE
    while len(progress) < 4:
        assert time.monotonic() < end, "the status bar shows no progress"
        progress.add(screen.pixels(x + 15, y - 3, 200, 6))
        time.sleep(0.1)

    abort(SOLVER)
    # Pressed, with nothing changed, when the window has said so:
    stopped = "status bar: %s1: stopped; Apply runs it again" % SOLVER[3:]
    wait_for("%s.*%s can be aborted" % (stopped, SOLVER))
    abort("%s.*%s" % (stopped, SOLVER))

    assert paraview.wait(PATIENCE) == 0, paraview.returncode
    wait_for("%s.*status bar is cleared" % stopped)  # when the last one has ended well
finally:
    if paraview.poll() is None:
        paraview.kill()
