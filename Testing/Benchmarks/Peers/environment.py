"""A virtual environment with other people's programs of PyPI, made once; and the LLVM that two of them compile with."""
import glob
import os
import re
import subprocess
import sys

WANTED_LLVM = 16  # Dr.Jit's kernels need instructions that LLVM 15 cannot select


def environment(folder, programs, install=True):
    """The python of the environment in `folder` and those of `programs` that are in it; others are told of on stderr.

    install: whether what is missing is fetched from PyPI; else only what is there already is used."""
    python = os.path.join(folder, "bin", "python")
    there = []
    for program in programs:
        complete = os.path.join(folder, "complete-" + program)
        try:
            if not os.path.exists(complete):
                if not install:
                    raise OSError("it is not in %s, and nothing is fetched in a quick run" % folder)
                if not os.path.exists(os.path.join(folder, "bin", "pip")):
                    subprocess.run([sys.executable, "-m", "venv", folder], check=True, stdout=sys.stderr)
                subprocess.run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check",
                                "--only-binary", ":all:", program], check=True, stdout=sys.stderr, timeout=300)
                open(complete, "w").close()
            there.append(program)
        except subprocess.SubprocessError as error:
            print("Without %s: no python3 -m venv, or PyPI is not reached, or has no package for this machine (%s)" % (program, error),
                  file=sys.stderr)
        except OSError as error:
            print("Without %s: %s" % (program, error), file=sys.stderr)
    return python, there


def newest_llvm():
    """Path and version of the newest shared library of LLVM, or (None, 0)."""
    found = [(None, 0)]
    for path in glob.glob("/usr/lib/*/libLLVM*.so*") + glob.glob("/usr/lib64/libLLVM*.so*"):
        version = re.search(r"libLLVM(?:-(\d+)[.\d]*\.so|\.so\.(\d+))", path)
        if version:
            found.append((path, int(version[1] or version[2])))
    return max(found, key=lambda each: each[1])


def rerun(python, file, *arguments, **more):
    """Runs the same script by the environment's python; its exit code."""
    return subprocess.run([python, "-B", "-W", "ignore", os.path.abspath(file), *arguments],
                          env=dict(os.environ, **more)).returncode
