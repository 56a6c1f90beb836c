#pragma once

#include "vtkNew.h"
#include "vtkTimeStamp.h"

#include <vector>

class vtkAlgorithmOutput;
class vtkLightPropagationMaps;
class vtkMatrix4x4;
class vtkParticipatingMedium;
class vtkRenderer;
class vtkTrivialProducer;
class vtkVolumeProperty;

namespace tyndall
{
struct Light;

/// Lights of a renderer in the coordinates of a volume: headlight, camera and scene lights that are switched on. A
/// light of intensity I and colour c illuminates the volume's centre by the irradiance pi I c, divided by its
/// attenuation; that of positional lights falls off by the inverse square of the distance.
/// @param centre  of the volume, in its coordinates
std::vector<Light> LightsOfRenderer(vtkRenderer* renderer, vtkMatrix4x4* place, const double centre[3]);

/// A volume in scattered light: the medium of its transfer functions, lit by the lights of the renderer.
class VolumeLight
{
public:
  VolumeLight();
  ~VolumeLight();

  vtkParticipatingMedium* GetMedium() { return this->Medium; }
  vtkLightPropagationMaps* GetSolver() { return this->Solver; }
  /// Lights of the last solve, for shadow rays.
  vtkAlgorithmOutput* GetLights();

  /// Solves if anything has changed.
  /// @param scalars  the volume, with any scalars
  /// @param isStill  if not, light that was solved before is returned, whatever has changed
  /// @return the medium with its light
  vtkAlgorithmOutput* Update(
    vtkAlgorithmOutput* scalars, vtkVolumeProperty* property, const std::vector<Light>& lights, bool isStill);

private:
  vtkNew<vtkParticipatingMedium> Medium;
  vtkNew<vtkLightPropagationMaps> Solver;
  vtkNew<vtkTrivialProducer> Lights, Solved;
  std::vector<double> LightsInNumbers;
  vtkTimeStamp SolvedTime;
};
}
