"""Ranks that each solve their piece of a lattice, by discrete ordinates, or by maps as published (Decomposition: blocks):
the light of one rank, and of the whole.

    python3 SolversByBlocks.py
"""
import math

from pieces_of_ranks import Runs, difference

runs = Runs("SolversByBlocks")
CASES = ["lattice_wavelet", "lattice_even", "lattice_uneven", "lattice_lamps", "lattice_around",
         "lattice_steps", "lattice_photons", "lattice_turns", "ordinates_even",
         "ordinates_uneven", "ordinates_faces", "ordinates_around", "ordinates_warm",
         "published_even", "published_uneven", "published_shown"]
LIKE = {"published_uneven": "published_even", "lattice_uneven": "lattice_even", "ordinates_uneven": "ordinates_even"}

for ranks in (1, 2, 3, 8):
    more = ["lattice_exact", "lattice_whole", "lattice_photons_whole", "lattice_turns_whole", "ordinates_whole", "ordinates_faces_whole", "published_whole"] if ranks == 1 else \
        ["lattice_errors"] if ranks == 2 else []
    code, said = runs.run(ranks, *CASES, *more)
    assert code == 0 and said.count("is done") == ranks, said
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
blocks, whole = runs.whole(3, "lattice_turns", "light")[0], runs.whole(1, "lattice_turns_whole", "light")[0]
print("photons beside the steps of a lattice in blocks and in the whole: %.1e" % difference(blocks, whole))
assert difference(blocks, whole) < 1e-6
for case, of_whole in (("ordinates_even", "ordinates_whole"), ("ordinates_faces", "ordinates_faces_whole")):
    ordinates, whole = runs.whole(1, case, "light")[0], runs.whole(1, of_whole, "light")[0]
    print("%s in blocks and in the whole: %.1e" % (case, difference(ordinates, whole)))
    assert difference(ordinates, whole) < 1e-6
blocks, whole = runs.whole(1, "published_even", "light")[0], runs.whole(1, "published_whole", "light")[0]
print("maps as published in blocks and in the whole: %.1e" % difference(blocks, whole))
assert difference(blocks, whole) < 1e-6
for ranks in (2, 3, 8):  # differences of light, which agree as that does
    error, expected = (runs.whole(count, "published_estimated", "light")[0] for count in (ranks, 1))
    off = abs(error - expected).max() / (4 * math.pi * runs.whole(1, "published_shown", "light")[0].max())
    print("%d ranks, the error of maps as published differs by %.1e of the light" % (ranks, off))
    assert off < 1e-6, (ranks, off)
