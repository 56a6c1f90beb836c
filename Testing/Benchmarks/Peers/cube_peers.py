"""Solves the cubes of scenes.py by other people's programs: what ./run bench peers sets beside light propagation maps.

    python3 cube_peers.py FOLDER [--quick] SCENE...

FOLDER gets a virtual environment with Mitsuba (and Dr.Jit, which it brings) once; --quick fetches nothing, and runs few
samples. A line of JSON a setting: scene, program with its version, setting, seconds of each of some runs, and the fluence
of the blocks that each found. What cannot be run is told of on stderr."""
import json
import sys
import time

sys.dont_write_bytecode = True
from environment import WANTED_LLVM, environment, newest_llvm, rerun  # noqa: E402

RUNS = 3
PATIENCE = {"forward": 1.5, "adjoint": 3.0}  # seconds that a run may be foreseen to take
MORE = 4  # times the samples of the setting before
FIRST = {"forward": 1 << 13, "adjoint": 1}   # histories; paths a block


def measure(program, setting, solve, scene, version):
    """Runs with other random numbers each time, after one that does not count; the seconds of the longest."""
    solve(0)
    runs = []
    for seed in range(1, RUNS + 1):
        start = time.perf_counter()
        fluence = solve(seed)
        runs.append((time.perf_counter() - start, fluence.ravel().tolist()))
    print(json.dumps({"scene": scene, "program": program, "version": version, "setting": setting,
                      "seconds": [seconds for seconds, _ in runs], "fluence": [fluence for _, fluence in runs]}), flush=True)
    return max(seconds for seconds, _ in runs)


def solve_all(names, quick):
    import importlib.metadata

    import adjoint
    import forward
    from scenes import SCENES

    mitsuba, drjit = ("%s %s" % (name, importlib.metadata.version(name)) for name in ("mitsuba", "drjit"))
    for name in names:
        _, extinction, albedo = SCENES[name]
        loaded = adjoint.load(extinction, albedo)
        for program, version, unit, solve in (
                ("forward", drjit, "histories", lambda n, seed: forward.block_fluence(extinction, albedo, n, seed)[0]),
                ("adjoint", mitsuba, "paths a block", lambda n, seed: adjoint.block_fluence(loaded, n, seed))):
            samples, longest = FIRST[program], 0.0
            while MORE * longest < PATIENCE[program]:
                longest = measure(program, "%d %s" % (samples, unit), lambda seed: solve(samples, seed), name, version)
                samples *= MORE
                if quick:
                    break


def main(folder, *arguments):
    quick = "--quick" in arguments
    llvm, version = newest_llvm()
    python, there = environment(folder, ("mitsuba",), install=not quick)
    if not there:
        return 0
    if version < WANTED_LLVM:
        print("Without mitsuba: its kernels need LLVM %d or newer as a shared library (Debian 12: libllvm19); here is %s"
              % (WANTED_LLVM, version or "none"), file=sys.stderr)
        return 0
    return rerun(python, __file__, "--inside", *arguments, DRJIT_LIBLLVM_PATH=llvm)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    if sys.argv[1] == "--inside":
        solve_all([each for each in sys.argv[2:] if each != "--quick"], "--quick" in sys.argv)
    else:
        sys.exit(main(*sys.argv[1:]))
