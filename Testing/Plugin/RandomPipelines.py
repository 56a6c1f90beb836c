"""Random scenes, solved through proxies on one rank and on three: each is finite and conserves power, is linear in power and
in what illuminates it, repeats bit for bit, and does not depend on how the grid is cut.

    python3 RandomPipelines.py COUNT SECONDS [SEED]

Half of the seconds are for one rank, half for three. The seed is the day's; TYNDALL_SEED sets another, to see a finding
again. Each finding names its scene.
"""
import datetime
import os
import shutil
import subprocess
import sys

import numpy

here = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, here)
from random_scene import Scene  # noqa: E402

RANKS = 3
OVER_RANKS = 1e-4  # of the largest fluence
count, seconds = int(sys.argv[1]), float(sys.argv[2])
seed = int(sys.argv[3] if len(sys.argv) > 3 else os.environ.get("TYNDALL_SEED", datetime.date.today().toordinal()))
folder = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "RandomPipelines%d" % count)
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)


def run(ranks, scenes):
    """@return what as many ranks print about so many scenes"""
    start = ["mpiexec", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
    done = subprocess.run([*start, "pvbatch", *(["--symmetric"] if ranks > 1 else []),
                           os.path.join(here, "random_pipelines.py"), folder, str(seed), str(scenes), str(seconds / 2)],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          env={**os.environ, "TYNDALL_PIECES_FROM": "0"})
    print(done.stdout, flush=True)
    assert done.returncode == 0, "%d ranks ended with code %d" % (ranks, done.returncode)
    return [line for line in done.stdout.splitlines() if "FINDING " in line]


def count_of(ranks):
    with open(os.path.join(folder, "done.%d" % ranks)) as file:
        return int(file.read())


def put_together(scene, number):
    """@return fluence of all ranks' pieces, [voxel][channel]"""
    fluence = None
    for rank in range(RANKS):
        piece = numpy.load(os.path.join(folder, "%d.%d.npz" % (number, rank)))
        if "fluence" not in piece:
            continue
        extent = piece["extent"]
        shape = [extent[2 * a + 1] - extent[2 * a] for a in (2, 1, 0)]
        channels = piece["fluence"].shape[1]
        if fluence is None:
            fluence = numpy.full([*scene.size[::-1], channels], numpy.nan)
        there = fluence[tuple(slice(extent[2 * a], extent[2 * a + 1]) for a in (2, 1, 0))]
        own = piece["own"].reshape(shape)
        there[own] = piece["fluence"].reshape([*shape, channels])[own]
    return fluence if fluence is None else fluence.reshape(-1, fluence.shape[-1])


def over_ranks(number):
    """@return findings of one scene on several ranks against one"""
    file = os.path.join(folder, "%d.npz" % number)
    if not os.path.exists(file):
        return []  # it was a finding on one rank
    scene = Scene(seed, number)
    expected, found = numpy.load(file)["fluence"], put_together(scene, number)
    if found is None or found.shape != expected.shape:
        return ["FINDING %s | no light on %d ranks" % (scene.describe(), RANKS)]
    off = abs(found - expected).max() / max(expected.max(), 1e-300)
    if off <= OVER_RANKS:
        return []
    return ["FINDING %s | %d ranks against one: %.3g of the largest, at most %.0e is right" %
            (scene.describe(), RANKS, off, OVER_RANKS)]


findings = run(1, count)
findings += run(RANKS, count_of(1))
shared = min(count_of(1), count_of(RANKS))
for number in range(shared):
    findings += over_ranks(number)
assert shared > 0, "no scene was solved"
print("seed %d: %d scenes on one rank, %d of them on %d, %d findings" % (seed, count_of(1), shared, RANKS, len(findings)))
for finding in findings:
    print(finding)
sys.exit(1 if findings else 0)
