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
 * @brief superclass of filters that solve for the light in a medium to a given tolerance
 *
 * Defines the properties of boundaries and of convergence that are common to vtkScatteringSolver, which solves once,
 * and vtkSolverComparison, which solves with many settings.
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
  /// Relative error of fluence at which iteration stops. Default 1e-4, valid [1e-9, 0.5].
  tyndallRangeMacro(Tolerance, double, 1e-9, 0.5);
  ///@}

  ///@{
  /// Whether the x, y and z axes are periodic: rays wrap around. Default off. If two axes are periodic and medium and
  /// light do not vary along them, vtkLightPropagationMaps solves plane-parallel layers (numerics.md, section 10 d).
  tyndallFlagMacro(PeriodicX);
  tyndallFlagMacro(PeriodicY);
  tyndallFlagMacro(PeriodicZ);
  ///@}

  ///@{
  /// Incident isotropic radiance at the faces -x, +x, -y, +y, -z, +z, W/(length^2 sr). Default 0, valid [0, infinity).
  tyndallSetRange6Macro(FaceRadiance, double, 0.0, tyndall::LargestFloat);
  vtkGetVector6Macro(FaceRadiance, double);
  ///@}

  ///@{
  /// Albedo of the faces -x, +x, -y, +y, -z, +z: the fraction of the outgoing partial current that a face reflects, as
  /// a Lambertian surface, in addition to FaceRadiance. Default 0, valid [0, 1]; must be 0 on the faces of a periodic
  /// axis.
  tyndallSetRange6Macro(FaceAlbedo, double, 0.0, 1.0);
  vtkGetVector6Macro(FaceAlbedo, double);
  ///@}

  ///@{
  /// Factors of FaceAlbedo for red, green and blue: three values per face, faces from -x to +z. Default 1, valid [0,
  /// 1].
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
  /// Whether a default sky illuminates a scene without any other light: no Lights, Environment or other light is
  /// connected, SkyColor and FaceRadiance are 0, and the medium does not emit. The default sky is the default sun of
  /// vtkLightRig (irradiance 1 W/length^2) and an isotropic grey sky of radiance 0.1 W/(length^2 sr); `left_out`
  /// reports it. Default on.
  tyndallFlagMacro(DefaultSky);
  ///@}

  ///@{
  /// Whether solvers estimate the error of fluence, from additional coarser solves. Default: see the subclass.
  tyndallFlagMacro(EstimateError);
  ///@}

protected:
  vtkPropagationAlgorithm();
  ~vtkPropagationAlgorithm() override;

  /// Reads and checks lights, environment, sky and boundary radiance; without any, returns the default sky if it is on.
  /// @param emits  whether the medium emits
  tyndall::IlluminationInput ReadAllIllumination(vtkInformationVector** inputs, bool emits);

  /// Inserts an entry for the default sky, if it was used, at the start of `leftOut`, a solve's field data `left_out`.
  static void TellOfDefaultSky(const tyndall::IlluminationInput& shining, std::vector<std::string>& leftOut);

  /// Warns if there is no light source, or if no light can enter the medium.
  /// @param emits  whether the medium emits
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
