"""The filters are in the package, with their properties, enumerations and documentation. OpenCL of pip is used where
the system has none and the user names none."""
import os
import pathlib
import tempfile

import tyndall
from vtkmodules.vtkCommonDataModel import vtkImageData

for name in ("vtkParticipatingMedium", "vtkLightRig", "vtkLightPropagationMaps", "vtkDiscreteOrdinates",
             "vtkLatticeBoltzmannLighting", "vtkMediumRayCaster", "vtkMeshVoxelizer", "vtkRefractionOctree",
             "vtkPhotonEmitter", "vtkPhotonMarcher", "vtkPhotonImportance", "vtkPhotonReconstruction", "vtkVDBReader",
             "vtkVDBWriter", "vtkEnvironmentReader", "vtkSeparablePhaseFunction", "vtkSolverComparison", "vtkSun",
             "vtkPointLight", "vtkSpotLight", "vtkRectangleLight"):
    made = getattr(tyndall, name)()
    assert made.GetClassName() == name, made.GetClassName()

medium = tyndall.vtkParticipatingMedium()
medium.SetAlbedo(0.25, 0.5, 0.75)
assert medium.GetAlbedo() == (0.25, 0.5, 0.75), medium.GetAlbedo()
assert "Single-scattering albedo" in medium.SetAlbedo.__doc__
assert tyndall.vtkLightPropagationMaps.CONSERVATIVE == 1
# One VTK for both: an image made by vtkmodules goes in.
tyndall.vtkLightPropagationMaps().SetInputData(vtkImageData())

with tempfile.TemporaryDirectory() as folder:
    runtime, driver = pathlib.Path(folder, "lib", "libintelocl.so"), pathlib.Path(folder, "vendors", "pocl.icd")
    for file in (runtime, driver):
        file.parent.mkdir()
        file.touch()
    os.environ.pop("OCL_ICD_VENDORS", None)
    os.environ.pop("OPENCL_VENDOR_PATH", None)
    tyndall.host.find_opencl(folder, driver.parent)
    assert "OCL_ICD_VENDORS" not in os.environ
    driver.unlink()
    tyndall.host.find_opencl(driver.parent, driver.parent)  # has no runtime
    assert "OCL_ICD_VENDORS" not in os.environ
    tyndall.host.find_opencl(folder, driver.parent)
    assert os.environ["OCL_ICD_VENDORS"] == str(runtime)
    os.environ["OCL_ICD_VENDORS"] = "the user's"
    tyndall.host.find_opencl(folder, driver.parent)
    assert os.environ["OCL_ICD_VENDORS"] == "the user's"
