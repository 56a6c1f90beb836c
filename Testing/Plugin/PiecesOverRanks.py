"""Media of which each rank has only a piece: the light of the whole, whatever the number of ranks; what makes no whole is
one error on every rank; a rank that is aborted or killed ends the work of all.

    python3 PiecesOverRanks.py 1 3
"""
import os
import sys
import time

from pieces_of_ranks import Runs

runs = Runs("PiecesOverRanks")
run, whole = runs.run, runs.whole
from_files = ["tetrahedra", "adaptive", "pvti"]
from_turned = ["turned", "turned_down"]
from_series = ["series_%s_%d" % (name, time) for name in ("whole", "blocks", "lattice") for time in range(3)]
cut = ["even", "ghosts", "uneven", "alone"]


for ranks in (int(count) for count in sys.argv[1:]):
    cases = (from_files if ranks != 4 else []) + cut
    more = ["errors", "abort", "elsewhere"] if ranks == 3 else []
    cases += ["no_file"] if ranks == 3 else []
    code, said = run(ranks, *cases, *more)
    assert code == 0 and said.count("is done") == ranks, said
    if ranks != 4:
        code, told = run(ranks, "turned", "series")
        assert code == 0 and told.count("is done") == ranks and "ERR" not in told, told
        cases += from_turned + from_series
    for case in cases:
        light, balance = whole(ranks, case, "light")
        expected, wanted = whole(1, case if case in from_files + from_turned + from_series else "even", "light")
        assert light.shape == expected.shape, (ranks, case, light.shape)
        error = abs(light - expected).max() / abs(expected).max()
        print("%d ranks, %s: fluence differs by %.1e" % (ranks, case, error), flush=True)
        assert error < 1e-6, (ranks, case, error)
        assert abs(balance - wanted).max() < 1e-6 * wanted[0], (ranks, case, balance, wanted)
    if "tetrahedra" in cases:
        picture, expected = whole(ranks, "picture", "picture")[0], whole(1, "picture", "picture")[0]
        assert abs(picture - expected).max() < 1e-6 * expected.max(), ranks
    if more:
        print(said)

start = time.time()
os.environ["TYNDALL_RANKS_WAIT"] = "4"
code, said = run(3, "missing")
assert code == 0 and said.count("is done") == 3, said
print("a rank that does not come: %.0f s" % (time.time() - start))
runs.end_with_the_killed(3, "killed")
