"""An example script at small size, its pictures against those of Data/Baseline.    pvbatch ScenePictures.py SCENE"""
import os
import runpy
import shutil
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import pictures

SOURCE, DATA = os.environ["TYNDALL_SOURCE"], os.environ["TYNDALL_FETCHED_DATA"]
SCENES = {
    "cloud": ("Plugin/Examples/cloud.py", "{output}", ["cloud"]),
    "glass": ("Plugin/Examples/glass.py", "{output}", ["glass"]),
    "demo": ("Plugin/Examples/demo.py", "--data {data} --output {output} --grid 40 --size 240 180",
             ["skull-multiple-scattering", "skull-single-scattering", "skull-on-the-square", "fluence-slice"]),
    "refraction": ("Plugin/Examples/refraction.py",
                   "--data {data} --output {output} --grid 128 --photons 300000 --size 240 180",
                   ["armadillo-in-glass", "elephant-in-a-sphere", "elephant-by-four-solvers"]),
    "adaptive": ("Plugin/Examples/adaptive.py",
                 "--output {output} --grid 64 --photons 20000 --rich 400000 --size 120 90",
                 ["adaptive", "adaptive-against-even", "estimators"]),
    "phasefunction": ("Plugin/Examples/phase_function.py", "{output} --directions 128 --size 450 300",
                      ["phase-function-error", "phase-function"]),
    "cumulus": ("Data/Scenes/cumulus.py", "--output {output}/cumulus.png --voxels 64 --size 240 150", ["cumulus"]),
    "plume": ("Data/Scenes/plume.py", "--output {output}/plume.png --voxels 64 --size 160 240", ["plume"]),
    "hall": ("Data/Scenes/hall.py", "--output {output}/hall.png --size 240 180", ["hall"]),
    "goblet": ("Data/Scenes/goblet.py", "--output {output}/goblet.png --voxels 112 --photons 300000 --size 240 225",
               ["goblet"]),
}

scene = sys.argv[1]
script, command, names = SCENES[scene]
if "{data}" in command and not os.path.exists(os.path.join(DATA, "sunset.exr")):
    print("There is nothing in %s; Data/fetch fetches it" % DATA)
    sys.exit(125)
output = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "scene-" + scene)
shutil.rmtree(output, ignore_errors=True)
os.makedirs(output)
script = os.path.join(SOURCE, script)
sys.argv = [script] + [word.format(data=DATA, output=output) for word in command.split()]
runpy.run_path(script, run_name="__main__")

faults = []
for name in names:
    faults += pictures.compare(name, pictures.read(os.path.join(output, name + ".png")))
assert not faults, "\n".join(faults)
