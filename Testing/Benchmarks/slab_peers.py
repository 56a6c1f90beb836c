"""Solves plane-parallel slabs by other people's programs: what ./run bench slab sets beside light propagation maps.

    python3 slab_peers.py FOLDER < cases

A case a line: optical thickness, albedo, mean cosine g (Henyey and Greenstein), light (diffuse, mu1, mu05: cosine of a beam). An answer a
line: program, its version, number of the case, reflectance, transmittance, seconds (median of repeated solves). FOLDER gets a virtual
environment with disortpp and PythonicDISORT of PyPI, once. Where it cannot be made, nothing is printed but a message to stderr.
"""
import os
import statistics
import subprocess
import sys
import time

PROGRAMS = ("disortpp", "PythonicDISORT")
STREAMS = 32
COSINES = {"mu1": 1.0, "mu05": 0.5}


def environment(folder):
    """The python of the environment; None where PyPI, or a package for this machine, is not to be had."""
    python = os.path.join(folder, "bin", "python")
    complete = os.path.join(folder, "complete")
    if os.path.exists(complete):
        return python
    try:
        subprocess.run([sys.executable, "-m", "venv", folder], check=True, stdout=sys.stderr)
        subprocess.run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--only-binary", ":all:", *PROGRAMS],
                       check=True, stdout=sys.stderr, timeout=300)
    except (OSError, subprocess.SubprocessError) as error:
        print("Without %s: PyPI is not reached, or has no packages for this machine (%s)" % (" and ".join(PROGRAMS), error), file=sys.stderr)
        return None
    open(complete, "w").close()
    return python


def timed(solve):
    """What it returns, and the median of seconds of some runs after the first."""
    answer = solve()
    seconds = []
    while len(seconds) < 3 or (sum(seconds) < 0.02 and len(seconds) < 100):
        start = time.perf_counter()
        solve()
        seconds.append(time.perf_counter() - start)
    return answer, statistics.median(seconds)


def by_disortpp(tau, albedo, g, light):
    import disortpp

    config = disortpp.DisortFluxConfig(1, STREAMS, 2 * STREAMS)
    config.allocate()
    config.delta_tau = [tau]
    config.single_scat_albedo = [albedo]
    config.set_henyey_greenstein(g)
    config.use_delta_m_plus = False
    if light in COSINES:
        config.direct_beam_flux, config.direct_beam_mu = 1.0 / COSINES[light], COSINES[light]
    else:
        config.isotropic_flux_top = 1.0 / 3.141592653589793
    solver = disortpp.create_flux_solver(STREAMS)
    found, seconds = timed(lambda: solver.solve(config))
    return found.flux_up[0], found.total_flux_down(1), seconds


def by_PythonicDISORT(tau, albedo, g, light):
    import numpy
    from PythonicDISORT import pydisort

    moments = g ** numpy.arange(STREAMS + 1.0)
    beam = dict(mu0=COSINES[light], I0=1.0 / COSINES[light]) if light in COSINES else dict(mu0=0.5, I0=0.0, b_neg=1.0 / numpy.pi)
    # It refuses what absorbs nothing.
    arguments = (tau, min(albedo, 1.0 - 1e-9), STREAMS, moments[None, :])

    def solve():
        _, up, down, *_ = pydisort(*arguments, phi0=0.0, only_flux=True, NLeg=STREAMS, f_arr=moments[STREAMS], **beam)
        return float(up(0.0)), float(sum(down(tau)))

    (reflected, transmitted), seconds = timed(solve)
    return reflected, transmitted, seconds


def answer_all():
    import importlib.metadata

    for number, line in enumerate(sys.stdin):
        *numbers, light = line.split()
        for program, solve in zip(PROGRAMS, (by_disortpp, by_PythonicDISORT)):
            try:
                found = solve(*map(float, numbers), light)
            except Exception as error:  # theirs: one case less
                print("%s, %s: %s" % (program, line.strip(), error), file=sys.stderr)
                continue
            print("%s %s %d %.8g %.8g %.3g" % (program, importlib.metadata.version(program), number, *found), flush=True)


if __name__ == "__main__":
    if len(sys.argv) == 2:
        python = environment(sys.argv[1])
        sys.exit(subprocess.run([python, "-W", "ignore", os.path.abspath(__file__)]).returncode if python else 0)
    answer_all()
