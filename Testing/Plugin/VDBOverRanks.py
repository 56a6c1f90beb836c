"""A .vdb file is the same, byte for byte, whether one rank writes it or several do, in batch or on a server.

    python3 VDBOverRanks.py
"""
import os
import shutil
import subprocess

import a_server

here = os.path.dirname(os.path.abspath(__file__))
script = os.path.join(here, "vdb_saves.py")
output = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "VDBOverRanks")
mpiexec = ["mpiexec", "--allow-run-as-root", "--oversubscribe", "-n"]
shutil.rmtree(output, ignore_errors=True)


def new_folder(name):
    folder = os.path.join(output, name)
    os.makedirs(folder)
    with open(os.path.join(folder, "kept.vdb"), "w") as kept:
        kept.write("what was there")
    return folder


def batch(ranks, *options):
    folder = new_folder("batch%d%s" % (ranks, "".join(options)))
    done = subprocess.run(mpiexec + [str(ranks), "pvbatch", *options, script, folder], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True)
    assert done.returncode == 0, done.stdout
    speaking = ranks if options else 1
    assert done.stdout.count("is done") == speaking, done.stdout
    # Each rank tells the same; without --symmetric ranks but the first have no Python, yet they tell it too.
    said = done.stdout
    assert said.count("exceeds 65504") == ranks, said
    assert said.count("no/such/folder.vdb\" cannot be written") == ranks, said
    if options and ranks > 1:
        assert said.count("fewer cells than its extent") == ranks, said
    return folder


def on_server(ranks):
    folder = new_folder("server%d" % ranks)
    with a_server.started(ranks, os.path.join(folder, "server.log")) as (port, _):
        done = subprocess.run(["pvpython", script, folder, str(port)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True)
        assert done.returncode == 0 and "is done" in done.stdout, done.stdout
    return folder


def content(file):
    """A file's bytes but the number that OpenVDB draws for each."""
    with open(file, "rb") as stream:
        data = stream.read()
    return data[:21] + data[21 + 36:]


one = batch(1, "--symmetric")
expected = {"points.vdb", "cells.vdb", "medium.vdb", "half.vdb", "thin.vdb", "flat.vdb", "ghosts.vdb", "last.vdb"}
assert set(os.listdir(one)) == expected | {"kept.vdb"}, os.listdir(one)
for folder in (batch(2, "--symmetric"), batch(3, "--symmetric"), batch(2), on_server(2)):
    files = set(os.listdir(folder)) - {"kept.vdb", "server.log"}
    assert files == (expected if "symmetric" in folder else expected - {"ghosts.vdb", "last.vdb"}), (folder, files)
    for name in sorted(files):
        found, wanted = content(os.path.join(folder, name)), content(os.path.join(one, name))
        assert found == wanted, (folder, name, len(found), len(wanted))
    with open(os.path.join(folder, "kept.vdb")) as kept:
        assert kept.read() == "what was there", folder
