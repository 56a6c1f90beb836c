"""The filters are in the package, with their properties, enumerations and documentation."""
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
