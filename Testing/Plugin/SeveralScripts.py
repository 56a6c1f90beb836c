"""Runs scripts one after the other in one ParaView, each in a session of its own: to start one takes 2 s.

    pvpython SeveralScripts.py SCRIPT...

Each ends as alone: by an exception where it fails, by exit(125) where it is skipped. Of TYNDALL_SCRIPT, a part of a name,
only those run whose names have it.
"""
import os
import runpy
import sys
import time
import traceback

from paraview import simple

wanted, ended = os.environ.get("TYNDALL_SCRIPT", ""), {}
for script in sys.argv[1:]:
    name = os.path.basename(script)
    if wanted not in name:
        continue
    start = time.time()
    print("== " + name, flush=True)
    sys.argv = [script]
    sys.path.insert(0, os.path.dirname(script))
    try:
        runpy.run_path(script, run_name="__main__")
        ended[name] = 0
    except SystemExit as end:
        ended[name] = end.code or 0
    except BaseException:
        traceback.print_exc()
        ended[name] = 1
    del sys.path[0]
    print("== %s: %.1f s, code %s" % (name, time.time() - start, ended[name]), flush=True)
    simple.ResetSession()

failed = [name for name, code in ended.items() if code not in (0, 125)]
assert not failed, failed
if all(code == 125 for code in ended.values()):
    sys.exit(125)
