"""Makes slab_over_ground.csv with disortpp of PyPI: python3 -m venv v; v/bin/pip install disortpp; v/bin/python make_slab_over_ground.py"""
import importlib.metadata
import itertools

import disortpp

STREAMS = 64
HEAD = """# Plane-parallel slabs above a ground of Lambert's law: what leaves at the top and what the ground takes, over what comes in at the top.
# disortpp %s of PyPI (DISORT: discrete ordinates, %d streams, delta-M), make_slab_over_ground.py. With ground of albedo 0 and isotropic
# scattering it agrees with slab.csv, with g = 0.85 and 32 streams with 64 to 1e-5.
# cosine: of the sun from the zenith; 0: diffuse light. reflected + taken + what the slab absorbs = 1.
tau,albedo,g,ground,cosine,reflected,taken""" % (importlib.metadata.version("disortpp"), STREAMS)


def solve(tau, albedo, g, ground, cosine, streams=STREAMS):
    config = disortpp.DisortFluxConfig(1, streams, 2 * streams)
    config.allocate()
    config.delta_tau = [tau]
    config.single_scat_albedo = [albedo]
    config.set_henyey_greenstein(g)
    config.use_delta_m_plus = False
    config.surface_albedo = ground
    if cosine == 0:
        config.isotropic_flux_top = 1.0 / 3.141592653589793
    else:
        config.direct_beam_flux, config.direct_beam_mu = 1.0 / cosine, cosine
    found = disortpp.create_flux_solver(streams).solve(config)
    return found.flux_up[0], (1.0 - ground) * found.total_flux_down(1)


if __name__ == "__main__":
    print(HEAD)
    for case in itertools.product((0.5, 5, 50), (0.9, 1), (0, 0.85), (0, 0.3, 0.8, 1), (0, 1, 0.5)):
        reflected, taken = solve(*case)
        less = solve(*case, streams=32)
        assert abs(reflected - less[0]) < 2e-5 and abs(taken - less[1]) < 2e-5, (case, reflected, taken, less)
        print("%g,%g,%g,%g,%g,%.6f,%.6f" % (*case, reflected, max(taken, 0.0)))
