"""Ranks that each solve their piece, by themselves or as they are told (Decomposition): the light of one rank, of which
none has more than its part.

    python3 BlocksOverRanks.py 1 3
"""
import glob
import os
import sys

import numpy
from pieces_of_ranks import Runs, difference

runs = Runs("BlocksOverRanks")
WRONG = ["arrays", "components", "spacing", "g", "gap", "short"]
CASES = ["blocks_wavelet", "blocks_photons", "blocks_scattered", "blocks_plain", "blocks_turbid", "blocks_ghosts", "blocks_given_all", "blocks_warm", "blocks_even",
         "blocks_uneven", "untouched_even", "untouched_uneven", "untouched_lit", "untouched_thick", "untouched_given", "blocks_absorbing"]
LIKE = {"blocks_ghosts": "blocks_wavelet", "blocks_given_all": "blocks_even", "blocks_uneven": "blocks_even",
        "untouched_even": "blocks_even", "untouched_uneven": "blocks_even"}


def ghost_cells_are_the_neighbours(ranks):
    """Flagged cells have the light of the cells of the same place."""
    found, _ = runs.whole(ranks, "blocks_ghosts", "light")
    for file in glob.glob(os.path.join(runs.output, str(ranks), "ghost_cells.*.npz")):
        piece = numpy.load(file)
        low = numpy.array([-8, -7, -6])
        begin, end = piece["extent"][::2] - low, piece["extent"][1::2] - low
        there = found[begin[2]:end[2], begin[1]:end[1], begin[0]:end[0]].ravel()
        assert (there == piece["fluence"].astype(there.dtype)).all(), (ranks, file)


def same_facts(ranks, what, tolerance):
    """Field data that each rank tells of all."""
    expected = numpy.load(os.path.join(runs.output, "1", what + ".0.npz"))["facts"]
    for rank in range(ranks):
        facts = numpy.load(os.path.join(runs.output, str(ranks), "%s.%d.npz" % (what, rank)))["facts"]
        assert abs(facts - expected).max() < tolerance * abs(expected).max(), (ranks, rank, what)


for ranks in (int(count) for count in sys.argv[1:]):
    more = ["whole_plain", "whole_turbid", "whole_photons", "whole_scattered", "whole_thick", "whole_absorbing", "blocks_estimated", "whole_estimated"] if ranks == 1 else \
        ["whole_where_better", "whole_where_few", "blocks_errors", "blocks_of_wrong_pieces", "blocks_abort", "blocks_ignored", "photons_abort", "photons_differ", "blocks_estimated", "blocks_budget"] if ranks == 3 else []
    code, said = runs.run(ranks, *CASES, "first_published", "first_compares", *more)
    assert code == 0 and said.count("is done") == ranks, said
    ghost_cells_are_the_neighbours(ranks)
    for case in WRONG if ranks == 3 else []:
        words = {open(file).read() for file in glob.glob(os.path.join(runs.output, "3", "error.%s.*" % case))}
        assert len(words) == 1, (case, words)
        print("%s: %s" % (case, words.pop()))
    for case in CASES:
        light, balance = runs.whole(ranks, case, "light")
        expected, wanted = runs.whole(1, LIKE.get(case, case), "light")
        error = difference(light, expected)
        print("%d ranks, %s: fluence differs by %.1e" % (ranks, case, error), flush=True)
        if case == "untouched_lit":  # of 255; where rounding falls
            assert abs(light - expected).max() <= 1, (ranks, case)
            continue
        assert error < 1e-6 and (error == 0 or case not in ("blocks_photons", "blocks_scattered")), (ranks, case, error)
        entered = wanted[0].max()  # of the channels
        assert abs(balance - wanted).max() < 1e-6 * entered, (ranks, case, balance, wanted)
        assert abs(balance[0] + balance[1] - balance[2:].sum(axis=0)).max() < 1e-5 * entered, (ranks, case, balance)
    same_facts(ranks, "surface", 1e-6)
    same_facts(ranks, "lit_facts", 1e-5)

published = [runs.whole(ranks, "first_published", "light")[0] for ranks in (1, int(sys.argv[-1]))]
assert difference(*published) == 0, "the first rank's light is not that of one rank"
blocks, whole = runs.whole(1, "blocks_plain", "light")[0], runs.whole(1, "whole_plain", "light")[0]
print("blocks and the whole, order by order: %.1e" % difference(blocks, whole))
assert difference(blocks, whole) < 1e-5
blocks, whole = runs.whole(1, "blocks_turbid", "light")[0], runs.whole(1, "whole_turbid", "light")[0]
print("blocks and the whole, of moments, round an axis, before a bright face: %.1e" % difference(blocks, whole))
assert difference(blocks, whole) < 1e-5
blocks, whole = runs.whole(1, "untouched_thick", "light")[0], runs.whole(1, "whole_thick", "light")[0]
print("blocks and the whole, thick voxels: %.1e" % difference(blocks, whole))
assert difference(blocks, whole) < 1e-4
blocks, whole = runs.whole(1, "blocks_absorbing", "light")[0], runs.whole(1, "whole_absorbing", "light")[0]
print("blocks and the whole, thick voxels that absorb: %.1e" % difference(blocks, whole))
assert difference(blocks, whole) < 1e-6
for case in ("estimated", "target"):  # differences of light, which agree as that does
    whole, brightest = runs.whole(1, "whole_" + case, "light")[0], runs.whole(1, "blocks_plain", "light")[0].max()
    for ranks in (1, 3):
        error = abs(runs.whole(ranks, "blocks_" + case, "light")[0] - whole).max() / brightest
        print("%d ranks, error %s: differs from the whole's by %.1e of fluence" % (ranks, case, error))
        assert error < 1e-6 and whole.min() > 0, (ranks, case, error)

for what in ("photons", "scattered"):
    marched = runs.whole(1, "blocks_" + what, "light")[0]
    assert marched.max() > 0 and difference(marched, runs.whole(1, "whole_" + what, "light")[0]) == 0, what

for case in ("blocks_killed", "photons_killed"):
    runs.end_with_the_killed(3, case)
