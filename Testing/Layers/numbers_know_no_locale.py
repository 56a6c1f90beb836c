#!/usr/bin/env python3
"""Fails where a source writes or reads floating-point numbers by functions that obey the program's locale.

  numbers_know_no_locale.py NM OBJECTS FOLDER...

Kernels/Numerics/NumberText.h is there for it. Functions are found in the sources below the folders; std::to_string of a
float or double, which no name tells from that of an integer, by what it leaves in the objects, which the file OBJECTS
lists, a line each (- : none).
"""
import pathlib
import re
import subprocess
import sys

OBEYS = re.compile(r"\b(v?[fs]?n?printf\s*\(|strto(?:d|f|ld)\b|atof\b|sto(?:d|f|ld)\s*\(|o?stringstream\b|setprecision\b)")
LEFT_BY_TO_STRING = "__to_xstring"
OPENVDB = re.compile("/IO/(VDB/|vtkVDB)|/unity_VDB_")  # whose headers hold such a call


def main(nm, objects, *folders):
    faults = []
    sources = [file for folder in folders for file in sorted(pathlib.Path(folder).rglob("*"))
               if file.suffix in {".h", ".cxx"} and "Examples" not in file.parts]
    for file in sources:
        for number, line in enumerate(file.read_text().splitlines(), 1):
            for found in OBEYS.findall(line.split("//")[0]):
                faults.append(f"{file}:{number}: {found.rstrip('( ')} obeys the locale")
    listed = pathlib.Path(objects).read_text().split() if objects != "-" else []
    listed = [name for name in listed if name.endswith(".o") and not OPENVDB.search(name)]
    for first in range(0, len(listed), 200):
        symbols = subprocess.run([nm, "-A", *listed[first:first + 200]], check=True, capture_output=True, text=True).stdout
        faults += sorted({f"{line.split(':')[0]}: std::to_string of a floating-point number obeys the locale"
                          for line in symbols.splitlines() if LEFT_BY_TO_STRING in line})
    print("\n".join(faults))
    if faults or not sources + listed:
        sys.exit("Use Kernels/Numerics/NumberText.h" if faults else "Nothing was looked at")
    print(f"{len(sources)} sources and {len(listed)} objects know no locale")


main(*sys.argv[1:])
