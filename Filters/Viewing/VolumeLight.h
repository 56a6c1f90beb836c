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
/// Lights of a renderer in the coordinates of a volume: headlight, camera and scene lights that are switched on. A
/// light of intensity I and colour c illuminates the volume's centre by the irradiance pi I c, divided by its
/// attenuation; that of positional lights falls off by the inverse square of the distance.
struct RendererLights
{
  vtkRenderer* renderer;
  vtkMatrix4x4* place;      ///< of the volume in the world
  double centre[3];         ///< of the volume, in its coordinates
  bool followCamera = true; ///< if not, a moved camera leaves the lights where they were in the world
};

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
    vtkAlgorithmOutput* scalars, vtkVolumeProperty* property, const RendererLights& lights, bool isStill);

private:
  void PlaceLights(const RendererLights& lights);

  vtkNew<vtkParticipatingMedium> Medium;
  vtkNew<vtkLightPropagationMaps> Solver;
  vtkNew<vtkTrivialProducer> Lights, Solved;
  std::vector<double> LightsInNumbers, LightSettings;
  vtkTimeStamp SolvedTime;
};
}
