"""Ranks that each solve their piece of a lattice, or by discrete ordinates (Decomposition: blocks): the light of one rank,
and of the serial solve.

    python3 SolversByBlocks.py 1 3
"""
import sys

from pieces_of_ranks import Runs, difference

runs = Runs("SolversByBlocks")
CASES = ["lattice_wavelet", "lattice_even", "lattice_uneven", "lattice_lamps", "lattice_around",
         "lattice_photons", "lattice_photons_few", "lattice_photons_whole", "lattice_turns", "ordinates_even",
         "ordinates_uneven", "ordinates_faces", "ordinates_around", "ordinates_warm", "lattice_cosines",
         "ordinates_cosines", "blocks_cosines"]
LIKE = {"lattice_uneven": "lattice_even", "lattice_photons_few": "lattice_photons",
        "ordinates_uneven": "ordinates_even"}
WHOLE = ["lattice_exact", "lattice_whole", "ordinates_whole", "ordinates_faces_whole", "previews_whole"]

counts = [int(count) for count in sys.argv[1:]]
for ranks in counts:
    more = WHOLE if ranks == 1 else []
    previews = ["previews"] if ranks in (1, 3) else []
    code, said = runs.run(ranks, *CASES, *previews, *more)
    assert code == 0 and said.count("is done") == ranks and "ERR|" not in said, said
    for case in CASES:
        light, balance = runs.whole(ranks, case, "light")
        expected, wanted = runs.whole(1, LIKE.get(case, case), "light")
        error = difference(light, expected)
        print("%d ranks, %s: fluence differs by %.1e" % (ranks, case, error), flush=True)
        assert error < 1e-6, (ranks, case, error)
        assert abs(balance - wanted).max() < 1e-6 * wanted.max(), (ranks, case, balance, wanted)

blocks, whole = runs.whole(1, "lattice_exact", "light")[0], runs.whole(1, "lattice_whole", "light")[0]
print("blocks and the whole: %.1e" % difference(blocks, whole))
assert difference(blocks, whole) < 2e-6
blocks, whole = runs.whole(3, "lattice_photons", "light")[0], runs.whole(1, "lattice_photons_whole", "light")[0]
print("photons on a lattice in blocks and in the whole: %.1e" % difference(blocks, whole))
assert difference(blocks, whole) < 2e-6
for case, of_whole in (("ordinates_even", "ordinates_whole"), ("ordinates_faces", "ordinates_faces_whole")):
    ordinates, whole = runs.whole(1, case, "light")[0], runs.whole(1, of_whole, "light")[0]
    print("%s in blocks and in the whole: %.1e" % (case, difference(ordinates, whole)))
    assert difference(ordinates, whole) < 1e-6
for name in ("maps", "ordinates", "lattice"):
    for ranks in (1, 3):
        blocks, whole = runs.whole(ranks, "preview_" + name, "light"), runs.whole(1, "preview_%s_whole" % name, "light")
        print("%d ranks, a preview of %s in blocks and in the whole: %.1e" % (ranks, name, difference(blocks[0], whole[0])))
        assert difference(blocks[0], whole[0]) < 1e-6
        assert abs(blocks[1] - whole[1]).max() < 1e-6 * whole[1].max(), (ranks, name)
