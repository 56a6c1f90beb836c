"""Smoke that drifts past under a sun that sinks: the light of each step begins from that of the step before.

    pvpython time_series.py [OUTPUT FOLDER] [--steps 6]

Writes the smoke as a time series, smoke_0.vti, ..., and its light, light_0.vti, ...; prints how many sweeps each step took.
"""
import argparse
import os

from paraview.simple import *

LoadPlugin(os.environ["TYNDALL_PLUGIN"], remote=True, ns=globals())


def write_smoke(folder, steps):
    files = []
    for step in range(steps):
        waves = Wavelet(WholeExtent=[-16, 16, -12, 12, -14, 14], Center=[0.4 * step, 0, 0], Maximum=1, XMag=0.13, YMag=0.11,
                        ZMag=0.14, XFreq=17, YFreq=13, ZFreq=19, StandardDeviation=0.3)
        smoke = Calculator(Input=waves, ResultArrayName="density", Function="max(0,RTData-0.5)")
        files.append(os.path.join(folder, "smoke_%d.vti" % step))
        SaveData(files[-1], proxy=smoke)
    return files


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", default=os.environ.get("TYNDALL_TEST_OUTPUT", "."))
    parser.add_argument("--steps", type=int, default=6)
    options = parser.parse_args()
    smoke = XMLImageDataReader(FileName=write_smoke(options.folder, options.steps), PointArrayStatus=["density"])
    smoke.UpdatePipelineInformation()
    medium = ParticipatingMedium(Input=smoke, ExtinctionScale=0.8)
    sun = LightRig(SunElevation=40, SunAzimuth=180)
    light = LightPropagationMaps(Input=medium, Lights=sun, SkyColor=[0.2, 0.2, 0.2], WarmStart=1)
    saved = []
    for step, time in enumerate(smoke.TimestepValues):
        sun.SunElevation = 40 - 3 * step
        light.UpdatePipeline(time)
        light.UpdatePropertyInformation()
        print("step %d: %d sweeps, %d fewer than from darkness on, balance to %.1g" %
              (step, light.Orders, light.SweepsSaved, light.BalanceError))
        SaveData(os.path.join(options.folder, "light_%d.vti" % step), proxy=light)
        saved.append(light.SweepsSaved)
        assert light.BalanceError < 1e-5
    assert saved[0] == 0 and min(saved[1:]) > 0, saved


if __name__ == "__main__":
    main()
