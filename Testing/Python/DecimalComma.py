"""tyndall.solve in a program that has set a locale with a decimal comma, as locale.setlocale(LC_ALL, "") does in Germany."""
import locale
import os
import subprocess
import tempfile

import numpy
import tyndall

SOURCE = 'comment_char %\nescape_char /\nLC_NUMERIC\ndecimal_point ","\nthousands_sep "."\ngrouping 3;3\nEND LC_NUMERIC\n'

lamp = tyndall.vtkLightRig()
lamp.SetSun(False)
lamp.AddPointLight(2.1, 2.9, 4.2, 10.0, 10.0, 10.0)


def solve():
    density = 4.0 * 10.0 ** -numpy.random.default_rng(1).uniform(0.0, 4.0, (5, 6, 7))  # lamps treat thick voxels apart
    return tyndall.solve(density, 1.0, albedo=0.75, lights=lamp, Tolerance=2.5e-4)


with tempfile.TemporaryDirectory() as folder:
    with open(os.path.join(folder, "source"), "w") as source:
        source.write(SOURCE)
    # It exits 1 for the categories that the source leaves out.
    subprocess.run(["localedef", "-c", "-f", "ANSI_X3.4-1968", "-i", source.name, os.path.join(folder, "comma")],
                   capture_output=True)
    os.environ["LOCPATH"] = folder
    locale.setlocale(locale.LC_ALL, "comma")
    assert locale.localeconv()["decimal_point"] == ","
    under_comma = solve()
    locale.setlocale(locale.LC_ALL, "C")
numpy.testing.assert_array_equal(under_comma.fluence, solve().fluence)
used = under_comma.image.GetFieldData().GetAbstractArray("settings_used")
used = [used.GetValue(i) for i in range(used.GetNumberOfValues())]
assert "Tolerance = 0.00025" in used, used
