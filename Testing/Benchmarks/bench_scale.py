"""Time, memory and messages of a solve as the grid grows and as it is spread over ranks.

    ./run bench scale [--grids 64 128 256 512] [--ranks 1 2 4 8] [--orders 3 0] [--decompositions whole blocks]
                      [--repeats 3] [--quick]

Each case is a run of its own of pvbatch --symmetric under mpiexec, on as many ranks as it says, of ParaView's Wavelet as a cloud of
optical thickness 20 under a sun and a sky, by Light Propagation Maps: three orders of scattering, or (orders 0) until it converges. The
machine's cores are shared out among the ranks. Grids first, on one rank; then ranks, on the second grid, where each rank solves the whole
(decomposition whole) or its piece (blocks; on one rank as well, whose light is that of all others then).

  seconds          of the solver (its property Seconds) on the slowest rank, median of the repeats
  ns_per_voxel     that, for each voxel of the whole grid;  ratio: over that of the second grid (128^3), same orders; goal 1.3
  peak_bytes       the most resident memory of a rank beyond what it had with the plugin loaded, as the kernel counted it (VmHWM)
  peak_of_one      the same over that of one rank
  bytes_sent, messages   of the rank that sends most, in all, as Open MPI's own monitoring counts them: ParaView's own are among them
  difference       largest of the fluence from that of one rank, over its largest value; only of grids up to 128^3
  balance          the energy balance's relative error, by rank the worst

A grid whose memory cannot be had (by what the smaller grid took) is left out, and the line says so.
"""
import argparse
import glob
import json
import os
import statistics
import subprocess
import sys
import tempfile

WORKER = "TYNDALL_BENCH_SCALE"  # for what runs on each rank: its arguments, as JSON
GOAL, MOST_COMPARED = 1.3, 128
WORDS = {"whole": "Whole on the first rank", "blocks": "Blocks"}


def report(**values):
    print(json.dumps({"bench": "scale", **values}), flush=True)


def peak_bytes():
    with open("/proc/self/status") as status:
        for line in status:
            if line.startswith("VmHWM:"):
                return 1024 * int(line.split()[1])


def work(folder, grid, orders, repeats, decomposition):
    """What each rank runs; its figures go to a file of its own."""
    import numpy
    from paraview import servermanager, simple
    from paraview.vtk.util.numpy_support import vtk_to_numpy

    simple.LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())
    rank = servermanager.vtkProcessModule.GetProcessModule().GetPartitionId()
    before = peak_bytes()
    low = -(grid // 2)
    wavelet = simple.Wavelet(WholeExtent=[low, low + grid - 1] * 3)  # a voxel around each point
    medium = ParticipatingMedium(Input=wavelet, MinimumDensity=37, MaximumDensity=277, ExtinctionScale=20.0 / grid)
    light = LightPropagationMaps(Input=medium, Lights=LightRig(), SkyColor=[0.1, 0.15, 0.2], MaximumOrders=orders,
                                 Decomposition=WORDS[decomposition])
    seconds = []
    for i in range(repeats):
        light.SkyColor = [0.1, 0.15, 0.2 + 1e-4 * (repeats - 1 - i)]
        light.UpdatePipeline()
        light.UpdatePipelineInformation()
        seconds.append(light.Seconds)
    piece = light.GetClientSideObject().GetOutputDataObject(0)
    balance = vtk_to_numpy(piece.GetFieldData().GetArray("energy_balance")).reshape(5, -1)
    found = {"seconds": seconds, "peak_bytes": peak_bytes() - before, "voxels": piece.GetNumberOfCells(), "extent": list(piece.GetExtent()),
             "balance": float((abs(balance[:2].sum(0) - balance[2:].sum(0)) / balance[:2].sum(0)).max())}
    if grid <= MOST_COMPARED:
        numpy.save(os.path.join(folder, "fluence%d.npy" % rank), vtk_to_numpy(piece.GetCellData().GetArray("fluence")))
    with open(os.path.join(folder, "rank%d.json" % rank), "w") as file:
        json.dump(found, file)


def sent_by_ranks(folder):
    """@return bytes and messages by each rank, as Open MPI's monitoring wrote them"""
    sent = []
    for path in glob.glob(os.path.join(folder, "sent.*.prof")):
        with open(path) as file:
            rows = [line.split("\t") for line in file if line[:1] in "EI"]
        sent.append((sum(int(row[3].split()[0]) for row in rows), sum(int(row[4].split()[0]) for row in rows)))
    return sent


def run(grid, ranks, orders, repeats, decomposition):
    """@return what each rank found; the whole fluence; bytes and messages of the rank that sent most"""
    import numpy

    sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../Plugin"))
    import a_server

    with tempfile.TemporaryDirectory() as folder:
        what = {"folder": folder, "grid": grid, "orders": orders, "repeats": repeats, "decomposition": decomposition}
        environment = {**a_server.without_mpi(), WORKER: json.dumps(what),
                       "POCL_MAX_PTHREAD_COUNT": str(max(1, (os.cpu_count() or 1) // ranks)), "TYNDALL_PREPARE": "0"}
        command = ["mpiexec", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks), "--mca", "pml_monitoring_enable", "2", "--mca",
                   "pml_monitoring_enable_output", "3", "--mca", "pml_monitoring_filename", os.path.join(folder, "sent"), "pvbatch",
                   "--symmetric", os.path.abspath(__file__)]
        done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != 0:
            raise RuntimeError("%d^3 on %d ranks ended with status %d:\n%s" % (grid, ranks, done.returncode, done.stdout[-2000:]))
        found = []
        for rank in range(ranks):
            with open(os.path.join(folder, "rank%d.json" % rank)) as file:
                found.append(json.load(file))
        fluence = None
        if grid <= MOST_COMPARED:
            fluence = numpy.empty([grid] * 3 + [3])
            for rank, one in enumerate(found):
                first = [end + grid // 2 for end in one["extent"]]
                part = numpy.load(os.path.join(folder, "fluence%d.npy" % rank))
                place = tuple(slice(first[2 * a], first[2 * a + 1]) for a in (2, 1, 0))
                fluence[place] = part.reshape(fluence[place].shape)
        return found, fluence, max(sent_by_ranks(folder), default=(None, None))


class Bench:
    def __init__(self, repeats):
        self.repeats = repeats
        self.middle = None  # the grid that others are held against
        self.costs, self.alone = {}, {}  # seconds a voxel of it, by orders; what runs of one rank found

    def fits(self, grid, ranks, orders):
        """Whether the memory is there, as far as a smaller grid tells."""
        known = [(n, of) for (n, o, d), of in self.alone.items() if o == orders and d == "whole"]
        if not known:
            return True
        smaller, of = max(known)
        needed = ranks * of["peak_bytes"] * (grid / smaller) ** 3
        with open("/proc/meminfo") as file:
            there = [1024 * int(line.split()[1]) for line in file if line.startswith("MemAvailable:")][0]
        if needed > 0.9 * there:
            report(case="left out", method="maps", grid="%dx%dx%d" % ((grid,) * 3), ranks=ranks, orders=orders, bytes_needed=int(needed),
                   bytes_there=there)
        return needed <= 0.9 * there

    def measure(self, case, grid, ranks, orders, decomposition="whole"):
        if not self.fits(grid, ranks, orders):
            return
        found, fluence, (sent, messages) = run(grid, ranks, orders, self.repeats, decomposition)
        seconds = statistics.median(max(of_ranks) for of_ranks in zip(*(one["seconds"] for one in found)))
        peak = max(one["peak_bytes"] for one in found)
        row = {"ns_per_voxel": 1e9 * seconds / grid**3, "balance": max(one["balance"] for one in found)}
        if ranks == 1:
            self.alone[grid, orders, decomposition] = {"peak_bytes": peak, "fluence": fluence, "seconds": seconds}
        else:
            alone = self.alone.get((grid, orders, decomposition))
            row.update(bytes_sent=sent, messages=messages)
            if alone:
                row.update(peak_of_one=peak / alone["peak_bytes"], speedup=alone["seconds"] / seconds)
                if fluence is not None:
                    row["difference"] = float(abs(fluence - alone["fluence"]).max() / alone["fluence"].max())
        if case == "grids":
            against = self.costs.get(orders)
            if against:
                row.update(ratio=seconds / grid**3 / against, against="%d^3" % self.middle, goal=GOAL, met=seconds / grid**3 <= GOAL * against)
        report(case=case, method="maps", grid="%dx%dx%d" % ((grid,) * 3), ranks=ranks, decomposition=decomposition, orders=orders,
               seconds=seconds, peak_bytes=peak,
               bytes_per_voxel=peak / grid**3, **row)
        return seconds / grid**3

    def run(self, grids, ranks, orders, decompositions):
        middle = self.middle = grids[min(1, len(grids) - 1)]
        for order in orders:
            self.costs[order] = self.measure("grids", middle, 1, order)
            for grid in grids:
                if grid != middle:
                    self.measure("grids", grid, 1, order)
            for decomposition in decompositions:
                for count in ranks if decomposition == "blocks" else [count for count in ranks if count > 1]:
                    self.measure("ranks", middle, count, order, decomposition)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    quick = "TYNDALL_BENCH_QUICK" in os.environ
    parser.add_argument("--grids", type=int, nargs="+")
    parser.add_argument("--ranks", type=int, nargs="+")
    parser.add_argument("--orders", type=int, nargs="+", help="of scattering; 0: until the light converges")
    parser.add_argument("--decompositions", nargs="+", choices=list(WORDS), default=list(WORDS))
    parser.add_argument("--repeats", type=int)
    parser.add_argument("--quick", action="store_true", default=quick)
    given = parser.parse_args()
    quick = given.quick
    bench = Bench(given.repeats or (1 if quick else 3))
    bench.run(given.grids or ([8, 16] if quick else [64, 128, 256, 512]), given.ranks or ([1, 2] if quick else [1, 2, 4, 8]),
              given.orders or ([2] if quick else [3, 0]), given.decompositions)


if WORKER in os.environ:
    work(**json.loads(os.environ[WORKER]))
else:
    main()
