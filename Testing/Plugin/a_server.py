"""A server that a test starts for itself, and that ends with it."""
import contextlib
import os
import socket
import subprocess


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


def without_mpi():
    """@return the environment, for mpiexec: pvpython is a rank of MPI itself, and what that leaves in it would make it fail"""
    return {name: value for name, value in os.environ.items() if not name.startswith(("OMPI_", "PMIX_"))}


@contextlib.contextmanager
def started(ranks, log_file):
    """
    @param ranks  of MPI, where more than one
    @param log_file  what the server says of errors goes there
    @return in a with statement, its port and its process
    """
    port = free_port()
    launcher = ["mpiexec", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
    with open(log_file, "w") as log:
        server = subprocess.Popen(launcher + ["pvserver", "--server-port=%d" % port], stdout=subprocess.PIPE,
                                  stderr=log, text=True, env=without_mpi())
        try:
            assert any("Accepting connection" in line for line in server.stdout), \
                "the server does not start, see " + log_file
            yield port, server
        finally:
            server.terminate()  # mpiexec takes its ranks with it
            try:
                server.wait(10)
            except subprocess.TimeoutExpired:  # a server does not always hear it
                server.kill()
