"""Media of which each rank has only a piece: the light of the whole, whatever the number of ranks; what makes no whole is
one error on every rank; a rank that is aborted or killed ends the work of all.

    python3 PiecesOverRanks.py
"""
import glob
import os
import re
import shutil
import subprocess
import time

import numpy

here = os.path.dirname(os.path.abspath(__file__))
output = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "PiecesOverRanks")
shutil.rmtree(output, ignore_errors=True)
from_files = ["tetrahedra", "adaptive", "pvti"]
cut = ["even", "ghosts", "uneven", "alone"]


def run(ranks, *cases, timeout=240):
    """@return code and text of as many ranks, with what they wrote in a folder of their own"""
    folder = os.path.join(output, str(ranks))
    os.makedirs(folder, exist_ok=True)
    done = subprocess.run(["mpiexec", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks), "pvbatch",
                           "--symmetric", os.path.join(here, "light_of_pieces.py"), folder, *cases],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=timeout)
    return done.returncode, done.stdout


def whole(ranks, case, what):
    """@return the array of the whole, of each rank's piece, and the balance"""
    pieces = [numpy.load(file) for file in glob.glob(os.path.join(output, str(ranks), case + ".*.npz"))]
    pieces = [piece for piece in pieces if what in piece]
    extents = numpy.array([piece[what + "_extent"] for piece in pieces])
    low, high = extents[:, ::2].min(axis=0), extents[:, 1::2].max(axis=0)
    flat = 0 if what == "light" else 1  # of points there is one more
    found = numpy.full(numpy.maximum(high - low + flat, 1)[::-1], numpy.nan)
    for piece, extent in zip(pieces, extents):
        count = numpy.maximum(extent[1::2] - extent[::2] + flat, 1)
        start = extent[::2] - low
        place = tuple(slice(s, s + c) for s, c in zip(start[::-1], count[::-1]))
        values = piece[what].reshape(list(count[::-1]) + [-1])[..., 0]
        own = piece[what + "_ghosts"].reshape(count[::-1]) == 0
        there = found[place]
        assert flat or numpy.isnan(there[own]).all(), (ranks, case, "cells that two ranks have")
        there[own] = values[own]
    assert not numpy.isnan(found).any(), (ranks, case, what, "has holes")
    balances = [piece["balance"] for piece in pieces if "balance" in piece]
    assert all((balance == balances[0]).all() for balance in balances), "each rank tells that of the whole"
    return found, balances[0] if balances else None


for ranks in (1, 2, 3, 4, 8):
    cases = (from_files if ranks != 4 else []) + cut
    more = ["errors", "abort"] if ranks == 3 else []
    cases += ["no_file"] if ranks == 3 else []
    code, said = run(ranks, *cases, *more)
    assert code == 0 and said.count("is done") == ranks, said
    for case in cases:
        light, balance = whole(ranks, case, "light")
        expected, wanted = whole(1, case if case in from_files else "even", "light")
        assert light.shape == expected.shape, (ranks, case, light.shape)
        error = abs(light - expected).max() / abs(expected).max()
        print("%d ranks, %s: fluence differs by %.1e" % (ranks, case, error), flush=True)
        assert error < 1e-6, (ranks, case, error)
        assert abs(balance - wanted).max() < 1e-6 * wanted[0], (ranks, case, balance, wanted)
    if "tetrahedra" in cases:
        picture, expected = whole(ranks, "picture", "picture")[0], whole(1, "picture", "picture")[0]
        assert abs(picture - expected).max() < 1e-6 * expected.max(), ranks
    if more:
        print(said)

start = time.time()
os.environ["TYNDALL_RANKS_WAIT"] = "4"
code, said = run(3, "missing")
assert code == 0 and said.count("is done") == 3, said
print("a rank that does not come: %.0f s" % (time.time() - start))
code, said = run(3, "killed")
end = time.time() - float(re.search(r"killed at ([0-9.]+)", said)[1])
assert code != 0 and "is done" not in said, (code, said)
print("a killed rank: all ended after %.1f s, with code %d" % (end, code))
assert end < 30, end
