"""Runs scripts of pieces over ranks, and puts together what they wrote."""
import glob
import os
import re
import shutil
import subprocess
import time

import numpy

here = os.path.dirname(os.path.abspath(__file__))


def difference(light, expected):
    """@return the largest, over the largest value"""
    assert light.shape == expected.shape, (light.shape, expected.shape)
    return abs(light - expected).max() / abs(expected).max()


class Runs:
    """Of one test, in a folder of its own, which begins empty."""

    def __init__(self, test, script="light_of_pieces.py"):
        self.script = os.path.join(here, script)
        self.output = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], test)
        shutil.rmtree(self.output, ignore_errors=True)

    def run(self, ranks, *cases, timeout=240):
        """@return code and text of as many ranks, with what they wrote in a folder of their own"""
        folder = os.path.join(self.output, str(ranks))
        os.makedirs(folder, exist_ok=True)
        done = subprocess.run(["mpiexec", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks), "pvbatch",
                               "--symmetric", self.script, folder, *cases],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=timeout)
        return done.returncode, done.stdout

    def end_with_the_killed(self, ranks, case):
        """Checks that a case in which a rank is killed ends on all, soon."""
        code, said = self.run(ranks, case)
        end = time.time() - float(re.search(r"killed at ([0-9.]+)", said)[1])
        assert code != 0 and "is done" not in said, (case, code, said)
        print("%s, a killed rank: all ended after %.1f s, with code %d" % (case, end, code))
        assert end < 30, (case, end)

    def whole(self, ranks, case, what):
        """@return the array of the whole, of each rank's piece, and the balance"""
        pieces = [numpy.load(file) for file in glob.glob(os.path.join(self.output, str(ranks), case + ".*.npz"))]
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
