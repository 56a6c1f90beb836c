"""Solves plane-parallel slabs by other people's programs: what ./run bench slab and peers set beside light propagation maps.

    python3 slab_peers.py FOLDER [--quick] < cases

A case a line: optical thickness, albedo, mean cosine g (Henyey and Greenstein), light (diffuse, mu1, mu05: cosine of a
beam), optionally streams (32). An answer a line: program, its version, number of the case, reflectance, transmittance,
seconds (median of repeated solves). FOLDER gets a virtual environment with disortpp and PythonicDISORT of PyPI, once;
--quick fetches nothing. A program that cannot be had is left out, with a message to stderr.
"""
import statistics
import sys
import time

sys.dont_write_bytecode = True
from environment import environment, rerun  # noqa: E402

STREAMS = 32
COSINES = {"mu1": 1.0, "mu05": 0.5}


def timed(solve):
    """What it returns, and the median of seconds of some runs after the first."""
    answer = solve()
    seconds = []
    while len(seconds) < 3 or (sum(seconds) < 0.02 and len(seconds) < 100):
        start = time.perf_counter()
        solve()
        seconds.append(time.perf_counter() - start)
    return answer, statistics.median(seconds)


def by_disortpp(tau, albedo, g, light, streams):
    import disortpp

    config = disortpp.DisortFluxConfig(1, streams, 2 * streams)
    config.allocate()
    config.delta_tau = [tau]
    config.single_scat_albedo = [albedo]
    config.set_henyey_greenstein(g)
    config.use_delta_m_plus = False
    if light in COSINES:
        config.direct_beam_flux, config.direct_beam_mu = 1.0 / COSINES[light], COSINES[light]
    else:
        config.isotropic_flux_top = 1.0 / 3.141592653589793
    solver = disortpp.create_flux_solver(streams)
    found, seconds = timed(lambda: solver.solve(config))
    return found.flux_up[0], found.total_flux_down(1), seconds


def by_PythonicDISORT(tau, albedo, g, light, streams):
    import numpy
    from PythonicDISORT import pydisort

    moments = g ** numpy.arange(streams + 1.0)
    beam = dict(mu0=COSINES[light], I0=1.0 / COSINES[light]) if light in COSINES else dict(mu0=0.5, I0=0.0, b_neg=1.0 / numpy.pi)
    # It refuses what absorbs nothing.
    arguments = (tau, min(albedo, 1.0 - 1e-9), streams, moments[None, :])

    def solve():
        _, up, down, *_ = pydisort(*arguments, phi0=0.0, only_flux=True, NLeg=streams, f_arr=moments[streams], **beam)
        return float(up(0.0)), float(sum(down(tau)))

    (reflected, transmitted), seconds = timed(solve)
    return reflected, transmitted, seconds


def answer_all(programs):
    import importlib.metadata

    for number, line in enumerate(sys.stdin):
        tau, albedo, g, light, *streams = line.split()
        for program in programs:
            try:
                found = SOLVERS[program](float(tau), float(albedo), float(g), light, int(streams[0]) if streams else STREAMS)
            except Exception as error:  # theirs: one case less
                print("%s, %s: %s" % (program, line.strip(), error), file=sys.stderr)
                continue
            print("%s %s %d %.8g %.8g %.3g" % (program, importlib.metadata.version(program), number, *found), flush=True)


SOLVERS = {"disortpp": by_disortpp, "PythonicDISORT": by_PythonicDISORT}

if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    if sys.argv[1] == "--inside":
        answer_all(sys.argv[2:])
    else:
        python, there = environment(sys.argv[1], SOLVERS, install="--quick" not in sys.argv)
        sys.exit(rerun(python, __file__, "--inside", *there) if there else 0)
