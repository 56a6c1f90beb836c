#ifndef vtkPropagationAlgorithm_h
#define vtkPropagationAlgorithm_h

#include "PropertyRange.h"
#include "vtkLitMediumAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

#include <string>
#include <vector>

namespace tyndall
{
struct IlluminationInput;
}

/**
 * @class vtkPropagationAlgorithm
 * @brief superclass of the filters that propagate light through a medium until little is left
 *
 * It has the properties of boundaries and of convergence that vtkScatteringSolver, which solves once, and
 * vtkSolverComparison, which solves with many settings, share.
 *
 * @sa vtkScatteringSolver vtkSolverComparison
 */
class TYNDALL_EXPORT vtkPropagationAlgorithm : public vtkLitMediumAlgorithm
{
public:
  vtkTypeMacro(vtkPropagationAlgorithm, vtkLitMediumAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  tyndallDeviceMacro();

  ///@{
  /// Relative error of fluence at which to stop. Default 1e-4, valid [1e-9, 0.5].
  tyndallRangeMacro(Tolerance, double, 1e-9, 0.5);
  ///@}

  ///@{
  /// Periodic axes: rays wrap around. Default off. If two axes are periodic and nothing varies along them,
  /// vtkLightPropagationMaps solves plane-parallel layers (numerics.md, section 10 d).
  tyndallFlagMacro(PeriodicX);
  tyndallFlagMacro(PeriodicY);
  tyndallFlagMacro(PeriodicZ);
  ///@}

  ///@{
  /// Diffuse radiance that enters through the faces -x, +x, -y, +y, -z, +z, W/(length^2 sr). Default 0, valid
  /// [0, infinity).
  tyndallSetRange6Macro(FaceRadiance, double, 0.0, tyndall::LargestFloat);
  vtkGetVector6Macro(FaceRadiance, double);
  ///@}

  ///@{
  /// Albedo of the faces -x, +x, -y, +y, -z, +z: the part of the outgoing light that each reflects, as a Lambertian
  /// surface, beside FaceRadiance. Default 0, valid [0, 1]; 0 on the faces of a periodic axis.
  tyndallSetRange6Macro(FaceAlbedo, double, 0.0, 1.0);
  vtkGetVector6Macro(FaceAlbedo, double);
  ///@}

  ///@{
  /// Colour of FaceAlbedo: its factors, red, green, blue of each face in turn. Default 1, valid [0, 1].
  void SetFaceAlbedoColor(const double values[18]);
  vtkGetVectorMacro(FaceAlbedoColor, double, 18);
  ///@}

  ///@{
  /// Isotropic incident radiance, red, green, blue, added to the environment, W/(length^2 sr). Default 0, valid
  /// [0, infinity).
  tyndallSetRange3Macro(SkyColor, double, 0.0, tyndall::LargestFloat);
  vtkGetVector3Macro(SkyColor, double);
  ///@}

  ///@{
  /// Whether a default sky lights a scene without any other light: no Lights, Environment or other light is connected,
  /// SkyColor and FaceRadiance are 0, and the medium does not emit. It is the sun of an untouched vtkLightRig
  /// (irradiance 1 W/length^2) and an isotropic grey sky of radiance 0.1 W/(length^2 sr); `left_out` reports it.
  /// Default on.
  tyndallFlagMacro(DefaultSky);
  ///@}

  ///@{
  /// Whether solvers estimate the error of fluence from coarser solves. Default: see the subclass.
  tyndallFlagMacro(EstimateError);
  ///@}

protected:
  vtkPropagationAlgorithm();
  ~vtkPropagationAlgorithm() override;

  /// Lights, environment, sky and boundary radiance, or else the default sky. Checked.
  /// @param emits  whether the medium does
  tyndall::IlluminationInput ReadAllIllumination(vtkInformationVector** inputs, bool emits);

  /// Reports the default sky first in a solve's `left_out`.
  static void TellOfDefaultSky(const tyndall::IlluminationInput& shining, std::vector<std::string>& leftOut);

  /// Warns if nothing lights the medium, or no light can enter.
  void WarnWhereDark(const tyndall::Illumination& illumination, bool emits);

  std::string Device;
  double Tolerance;
  bool PeriodicX;
  bool PeriodicY;
  bool PeriodicZ;
  double FaceRadiance[6] = { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 };
  double FaceAlbedo[6] = { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 };
  double FaceAlbedoColor[18] = { 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0,
    1.0 };
  double SkyColor[3] = { 0.0, 0.0, 0.0 };
  bool DefaultSky = true;
  bool EstimateError = false;

private:
  vtkPropagationAlgorithm(const vtkPropagationAlgorithm&) = delete;
  void operator=(const vtkPropagationAlgorithm&) = delete;
};

#endif
