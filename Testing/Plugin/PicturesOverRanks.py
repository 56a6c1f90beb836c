"""Pictures of media of which each rank has only a piece: that of the whole, whatever the number of ranks, and no rank is
given more than its piece; a rank that is killed amid a picture ends all.

    python3 PicturesOverRanks.py 1 3
"""
import glob
import os
import sys

import numpy
from pieces_of_ranks import Runs

runs = Runs("PicturesOverRanks", "pictures_of_pieces.py")
pieces = ["even", "coloured", "inside", "uneven", "alone", "bare", "bare_uneven", "bare_points", "phase", "ground", "reader",
          "solved", "glass", "glass_coloured", "glass_bare", "mirror", "shadows", "estimate", "table", "moments", "surface", "turned"]
of_even = ["uneven", "alone", "bare", "bare_uneven"]  # other pieces of the same


def whole(ranks, case):
    """@return the arrays of the whole picture by name, with its facts, and what each rank was given"""
    parts = [dict(numpy.load(file)) for file in sorted(glob.glob(os.path.join(runs.output, str(ranks), case + ".*.npz")))]
    seen = [part for part in parts if "extent" in part]
    extents = numpy.array([part["extent"] for part in seen])
    size = extents.max(axis=0)[[3, 1]] + 1
    picture = {name: seen[0][name] for name in ("exposure", "left_out")}
    for name in ("color", "radiance", "alpha", "depth", *(["picture_error"] if case == "estimate" else [])):
        found = numpy.full([*size, seen[0][name].reshape(len(seen[0][name]), -1).shape[1]], numpy.nan)
        for part, (x0, x1, y0, y1, _, _) in zip(seen, extents):
            found[y0:y1 + 1, x0:x1 + 1] = part[name].reshape(y1 - y0 + 1, x1 - x0 + 1, -1)
        assert not numpy.isnan(found).any(), (ranks, case, name, "has holes")
        picture[name] = found
    assert all((part["exposure"] == picture["exposure"]).all() for part in seen), (ranks, case, "exposure")
    return picture, parts


def check(ranks, case, expected):
    picture, parts = whole(ranks, case)
    apart = {name: abs(picture[name] - expected[name]).max() for name in ("color", "radiance", "alpha", "depth")}
    bright = expected["radiance"].max()
    print("%d ranks, %s: radiance differs by %.1e, alpha by %.1e, depth by %.1e, color by %d; bytes of ranks %s" % (
        ranks, case, apart["radiance"] / bright, apart["alpha"], apart["depth"], apart["color"],
        [int(part["bytes"]) for part in parts]), flush=True)
    assert apart["radiance"] < 1e-5 * bright and apart["alpha"] < 1e-5 and apart["color"] <= 1, (ranks, case, apart)
    if case == "estimate":
        assert abs(picture["picture_error"] - expected["picture_error"]).max() < 1e-3 * expected["picture_error"].max() > 0
    assert apart["depth"] < 1e-5 * expected["depth"].max(), (ranks, case, apart)
    assert abs(picture["exposure"] / expected["exposure"] - 1) < 1e-4, (ranks, case)
    assert (picture["left_out"] == expected["left_out"]).all(), (ranks, case, picture["left_out"])
    return parts


def taken(ranks, case):
    """@return bytes of the rank that takes most for its picture"""
    return max(int(numpy.load(os.path.join(runs.output, str(ranks), "%s.%d.npz" % (case, rank)))["taken"]) for rank in range(ranks))


def check_memory(ranks, case, most):
    """@param most  of what one rank takes, by their number"""
    code, said = runs.run(ranks, case)
    assert code == 0, said
    part = taken(ranks, case) / taken(1, case)
    print("%d ranks, %s: one takes %.0f MiB, %.2f of what one alone takes" % (ranks, case, taken(ranks, case) / 2**20, part), flush=True)
    assert part < most[ranks], (ranks, case)


for ranks in (int(count) for count in sys.argv[1:]):
    more = ["properties", "errors", "abort"] if ranks == 3 else []
    code, said = runs.run(ranks, *pieces, *more, timeout=480)
    assert code == 0 and said.count("is done") == ranks, said
    check_memory(ranks, "memory", {1: 1.01, 2: 0.9, 3: 0.75, 4: 0.6})
    check_memory(ranks, "memory_of_shadows", {1: 1.01, 2: 0.85, 3: 0.7, 4: 0.55})
    for case in pieces:
        expected, alone = whole(1, "even" if case in of_even else case)
        assert expected["color"].std() > 5, (case, "there is nothing to compare")
        parts = check(ranks, case, expected)
        if case in ("reader", "solved"):  # these could give all
            cells = [numpy.prod(part["given"][1::2] - part["given"][::2]) for part in parts]
            largest = max(cells) / numpy.prod(alone[0]["given"][1::2] - alone[0]["given"][::2])
            print("%d ranks: one is given %.3f of the cells, %.3f of the bytes" % (
                ranks, largest, max(int(part["bytes"]) for part in parts) / int(alone[0]["bytes"])), flush=True)
            assert largest < {1: 1.01, 2: 0.61, 3: 0.5, 4: 0.36}[ranks], (ranks, largest)
    if more:
        print(said)

runs.end_with_the_killed(3, "killed")
