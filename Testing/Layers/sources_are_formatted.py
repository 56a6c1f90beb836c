#!/usr/bin/env python3
"""Fails where clang-format would change a C++ or OpenCL source, or where a line of one is longer than .clang-format's limit.

  sources_are_formatted.py CLANG_FORMAT FOLDER...

clang-format breaks code but, as configured here, no comments: it would join lines of tables and lists. So lengths are
looked at apart from it.
"""
import pathlib
import re
import subprocess
import sys

SUFFIXES = {".h", ".cxx", ".cl"}


def column_limit(folder):
    for parent in [folder, *folder.parents]:
        if (parent / ".clang-format").exists():
            return int(re.search(r"^ColumnLimit: (\d+)", (parent / ".clang-format").read_text(), re.M).group(1))
    sys.exit(f"No .clang-format above {folder}")


def main(clang_format, *folders):
    if clang_format.endswith("-NOTFOUND"):
        sys.exit("clang-format is missing: apt install clang-format, then configure again")
    sources = sorted(file for folder in folders for file in pathlib.Path(folder).resolve().rglob("*")
                     if file.suffix in SUFFIXES)
    if not sources:
        sys.exit(f"No sources in {' '.join(folders)}")
    limit = column_limit(sources[0].parent)
    wrong = 0
    for file in sources:
        for number, line in enumerate(file.read_text().splitlines(), 1):
            if len(line) > limit:
                print(f"{file}:{number}: {len(line)} columns, {limit} at most")
                wrong += 1
    result = subprocess.run([clang_format, "--dry-run", "-Werror", *map(str, sources)], capture_output=True, text=True)
    print(result.stderr, end="")
    if wrong or result.returncode:
        sys.exit("Format them: clang-format -i FILE; break comments by hand")
    print(f"{len(sources)} sources are formatted")


main(*sys.argv[1:])
