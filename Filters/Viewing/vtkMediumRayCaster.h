#ifndef vtkMediumRayCaster_h
#define vtkMediumRayCaster_h

#include "PropertyRange.h"
#include "vtkLitMediumAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

#include <array>
#include <memory>
#include <optional>
#include <string>

class vtkImageData;

namespace tyndall
{
class BlocksOfRanks;
class Device;
class Domain;
struct AskedView;
struct Camera;
struct CasterScene;
struct InputsKey;
struct Picture;
struct SceneSource;
struct ViewSettings;
}

/**
 * @class vtkMediumRayCaster
 * @brief renders a picture of a medium and its solved light, by ray casting
 *
 * Marches a ray through every pixel of the picture and integrates scattered and emitted radiance along it, attenuated
 * by the medium in front; the background is attenuated by the whole medium. The source is interpolated linearly between
 * voxel centres. Where the refractive index n varies, rays follow d/ds(n dx/ds) = grad n, surfaces of refractive
 * objects may reflect, and the background is evaluated along the direction in which a ray leaves the box. If the index
 * is constant, none of this is computed.
 *
 * Input 0, the medium with its light: vtkImageData with cell arrays (point arrays: see SetPointData)
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `sigma_a` | 1 or 3 | 1/length | absorption coefficient |
 * | `sigma_s` | 1 or 3 | 1/length | scattering coefficient |
 * | `emission` | 1 or 3 | W/(length^3 sr) | emitted radiance per unit length; optional |
 * | `fluence` | 1 or 3 | W/length^2 | fluence, as every solver writes it; optional |
 * | `fluence_direct` | 1 or 3 | W/length^2 | uncollided part of `fluence`; needed only to separate that part |
 * | `ior` | 1 | 1 | refractive index n, above 0; optional |
 * | `mean_direction` | 3 | 1 | power-weighted mean direction; its length is the anisotropy; optional |
 *
 * or the arrays chosen by SetInputArrayToProcess 0 to 6, the phase function (see below), and, optional, field data
 * `surface_radiance`, as vtkLightPropagationMaps writes it if voxels at the faces of the box are optically thick: where
 * rays enter such voxels, it replaces the light at the voxels' centres (not with ShadowRays and lights,
 * SingleScatteringOnly, `mean_direction`, TableFace, or bent rays). It is used only with the array `fluence` of the
 * same image, not if another array is chosen as fluence.
 * Input 1, optional: lights as vtkLightRig makes them, for shadow rays.
 * Input 2, optional: the environment behind the medium, vtkImageData in latitude-longitude layout, point array
 * `radiance`.
 *
 * The incident light in a voxel, per steradian, that is scattered towards the camera:
 *
 * |  | with SingleScatteringOnly | without SingleScatteringOnly |
 * |---|---|---|
 * | without ShadowRays | `fluence_direct` / 4 pi | `fluence` / 4 pi |
 * | with ShadowRays | attenuated lights, with the phase function | these, and the rest of `fluence` / 4 pi |
 *
 * The phase function is that of the medium, per channel and voxel: field data `phase_function` and `g`, or cells `g`.
 * If there is `mean_direction` m, the terms that are divided by 4 pi are multiplied by f: 4 pi times the phase
 * function, averaged over a distribution of directions about m. Collimated light (|m| = 1) is thus scattered by the
 * phase function, isotropic light (|m| = 0) isotropically, and the total scattered power does not depend on f. Without
 * `mean_direction`, with ShadowRays, or if scattering is isotropic, f is 1.
 *
 * Where the input has `scattered_moments`, `straight_on` and field data `lamps_apart`, as vtkLightPropagationMaps
 * writes them if it solves in angular moments, and SingleScatteringOnly is off, the picture is computed from these:
 * multiply scattered light from its angular moments, the first scattering of lamps by shadow rays and the full phase
 * function; no property and no Lights are needed. These arrays are used only with the array `fluence` of the same
 * image, not if another array is chosen as fluence.
 *
 * The rest of `fluence` is `fluence` without the light that shadow rays show. If there are lights but no `fluence`,
 * shadow rays are used even if ShadowRays is off.
 *
 * Output: vtkImageData of ImageSize pixels (x to the right, y upwards), point arrays
 *
 * | array | type | unit | meaning |
 * |---|---|---|---|
 * | `color` | uint8 x 4 | sRGB | the picture for display, active scalars; see ShowBackground |
 * | `radiance` | float x 3 | W/(length^2 sr) | radiance that arrives at the camera |
 * | `alpha` | float | 1 | 1 - transmittance (mean of the channels) |
 * | `depth` | float | length | distance along the view direction where the channels' mean transmittance is 1/2 |
 * | `picture_error` | float x 3 | W/(length^2 sr) | standard error of `radiance` (if EstimateError) |
 *
 * and field data `exposure` (the factor by which radiance was multiplied), `left_out` (computations that the scene did
 * not need), `settings_used` ("Name = value" of the properties that Quality chooses), `device`.
 *
 * Medium, light and illumination stay on the device, so that a picture from another camera, of another size, or with
 * another display mapping only requires casting rays. The device memory is freed when an input changes, another input
 * is connected, a changed setting requires it, another device is chosen, or the filter is deleted.
 *
 * If CameraPosition and CameraFocalPoint are equal, which is the default, the camera frames the whole medium, seen from
 * above, z upwards.
 *
 * If ranks of a parallel pipeline run the filter together, each requests its piece of the medium with one layer of
 * ghost cells, casts rays through it, and returns the requested part of the picture, which equals that of a serial run,
 * to rounding. Rays that bend, are reflected or meet the table (TableFace) continue from rank to rank, and lamps cast
 * shadows across pieces; data that a piece needs beyond its ghost cells (for the index, angular moments, light at the
 * surface of thick voxels) are gathered from other ranks. Every rank gathers the whole medium if properties differ
 * between ranks, or pieces overlap without ghost flags.
 *
 * @sa vtkLightPropagationMaps vtkPhotonMarcher vtkLightRig vtkEnvironmentReader
 * @par Thanks
 * M. Pfeuti, Real-time Rendering of Refractive Objects in Participating Media, 2009, section 3.1.6 (bent rays). P.
 * Blasi, B. Le Saec, C. Schlick: A Rendering Algorithm for Discrete Volume Density Objects, Computer Graphics Forum 12
 * (1993). Tone mapping: K. Narkowicz, ACES Filmic Tone Mapping Curve, 2015; E. Reinhard et al., Photographic Tone
 * Reproduction for Digital Images, SIGGRAPH 2002 (exposure).
 */
class TYNDALL_EXPORT vtkMediumRayCaster : public vtkLitMediumAlgorithm
{
public:
  static vtkMediumRayCaster* New();
  vtkTypeMacro(vtkMediumRayCaster, vtkLitMediumAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  tyndallDeviceMacro();

  enum ToneCurves
  {
    LINEAR = 0, ///< radiance times exposure, clipped at 1 (white)
    FILMIC = 1  ///< compresses bright pixels as film does (Narkowicz)
  };

  enum SurfaceReflections
  {
    NONE = 0,
    FRESNEL = 1, ///< Fresnel reflectance of unpolarised light
    FIXED = 2    ///< reflectance SurfaceReflectance at all angles
  };

  enum Qualities
  {
    DRAFT = 0, ///< fast and inaccurate, for moving cameras
    USUAL = 1, ///< uses all properties as they are set
    FINE = 2,
    REFERENCE = 3 ///< most accurate and slowest, for comparison with other settings
  };

  ///@{
  /// Accuracy of the picture: DRAFT, USUAL (default), FINE or REFERENCE. Chooses StepSize and RectangleSamples if they
  /// have their default values; USUAL changes neither.
  tyndallRangeMacro(Quality, int, DRAFT, REFERENCE);
  ///@}

  ///@{
  /// Picture and camera (tyndallCameraMacro). Defaults: ImageSize 800 x 600, CameraPosition and CameraFocalPoint (0, 0,
  /// 0), CameraViewUp (0, 0, 1), CameraViewAngle 30. If position and focal point are equal, the camera frames the
  /// medium. Both are valid up to 1e15 voxels from the medium.
  tyndallCameraMacro();
  ///@}

  ///@{
  /// Whether rays are parallel (CameraParallelProjection, default off), and half the height of the picture for parallel
  /// rays, a length (CameraParallelScale, default 1, valid (0, infinity)). If the camera frames the medium,
  /// CameraParallelScale is not used.
  tyndallFlagMacro(CameraParallelProjection);
  tyndallRangeMacro(CameraParallelScale, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Distance between two samples on a ray, in voxels. Default 0.5, valid [0.01, 10]. The error is proportional to the
  /// square of the distance.
  tyndallRangeMacro(StepSize, double, 0.01, 10.0);
  ///@}

  ///@{
  /// Whether to estimate the error of radiance, as the array `picture_error`, from further pictures of every second
  /// pixel: one with half as many samples, and others of the error of the light (`fluence_error`, `error_length`,
  /// `surface_radiance_error`). Without `fluence_error`, `left_out` says that the light's part is missing. The error of
  /// interpolation between voxel centres is not included. Default off.
  tyndallFlagMacro(EstimateError);
  ///@}

  ///@{
  /// Whether to show only singly scattered light. Default off.
  tyndallFlagMacro(SingleScatteringOnly);
  ///@}

  ///@{
  /// Whether to compute the uncollided light of Lights by shadow rays and scatter it by the medium's phase function.
  /// Default off: the uncollided light is taken from `fluence`, scattered isotropically or according to
  /// `mean_direction`. Without lights the property has no effect and takes no time; `left_out` reports it.
  tyndallFlagMacro(ShadowRays);
  ///@}

  ///@{
  /// Number of shadow rays along each edge of a rectangle light. Default 3, valid [1, 32].
  tyndallRangeMacro(RectangleSamples, int, 1, 32);
  ///@}

  ///@{
  /// Whether the environment, or else BackgroundRadiance or BackgroundColor, is visible behind the medium. Default on:
  /// `color` is opaque. Off: `color` blended over black looks like the picture with a black background; the alpha of
  /// `color` is the array `alpha`, or larger where bright thin smoke would exceed white.
  tyndallFlagMacro(ShowBackground);
  ///@}

  ///@{
  /// Display colour behind the medium if there is no environment, red, green, blue, sRGB as in the array `color`,
  /// independent of exposure and tone curve: the background's radiance is computed from this colour. Automatic exposure
  /// treats the background as black. Default (0, 0, 0), valid [0, 1].
  tyndallSetRange3Macro(BackgroundColor, double, 0.0, 1.0);
  vtkGetVector3Macro(BackgroundColor, double);
  ///@}

  ///@{
  /// Radiance behind the medium if there is no environment, red, green, blue, W/(length^2 sr). Used instead of
  /// BackgroundColor if it is not 0. Default 0, valid [0, 1e37].
  tyndallSetRange3Macro(BackgroundRadiance, double, 0.0, 1e37);
  vtkGetVector3Macro(BackgroundRadiance, double);
  ///@}

  ///@{
  /// Reflection at the surface of refractive objects, for rays that meet the surface from the side of the smaller
  /// index: NONE (default), FRESNEL or FIXED. Without a varying `ior` there is no surface.
  tyndallRangeMacro(SurfaceReflection, int, NONE, FIXED);
  ///@}

  ///@{
  /// Refractive index at the surface of refractive objects, which is an isosurface of n. Default 0: midway between the
  /// smallest and the largest n. Valid [0, infinity).
  tyndallRangeMacro(SurfaceIndex, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Reflectance of the surface of refractive objects if SurfaceReflection is FIXED. Default 0.1, valid [0, 1].
  tyndallRangeMacro(SurfaceReflectance, double, 0.0, 1.0);
  ///@}

  ///@{
  /// Face of the box that is a table, a reflecting surface on the inside of the face: 0 to 5 for -x, +x, -y, +y, -z,
  /// +z. Default -1: none.
  tyndallRangeMacro(TableFace, int, -1, 5);
  ///@}

  ///@{
  /// Diffuse reflectance of the table (TableFace), red, green, blue; the table is illuminated by the light in adjacent
  /// voxels. Default (0.6, 0.6, 0.6), valid [0, 1].
  tyndallSetRange3Macro(TableColor, double, 0.0, 1.0);
  vtkGetVector3Macro(TableColor, double);
  ///@}

  ///@{
  /// Specular reflectance of the table (TableFace). Default 0.1, valid from 0 to 1 minus TableColor.
  tyndallRangeMacro(TableReflectance, double, 0.0, 1.0);
  ///@}

  ///@{
  /// Device memory that the filter may use, MiB, including memory that it keeps between updates; a scene that needs
  /// more is an error, which states the required memory. Default 0: all memory of the device. Valid [0, 2^31).
  tyndallRangeMacro(MemoryBudget, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Whether to skip computations that the scene does not need. Default on; off computes everything, for comparison:
  /// the picture is the same in more time.
  tyndallFlagMacro(LeaveOut);
  ///@}

  ///@{
  /// Factor by which radiance is multiplied for `color`. Default 0: chosen such that the mean of the picture's lit
  /// pixels becomes a medium grey. Valid [0, 1e30].
  tyndallRangeMacro(Exposure, double, 0.0, 1e30);
  ///@}

  enum AutoExposures
  {
    EACH_PICTURE = 0,
    FIRST_PICTURE = 1
  };

  ///@{
  /// Picture from which the exposure is computed if Exposure is 0: EACH_PICTURE (default), or FIRST_PICTURE, the first
  /// one after this value was set: its exposure is used for all later pictures, so that an animation does not flicker.
  tyndallRangeMacro(AutoExposure, int, EACH_PICTURE, FIRST_PICTURE);
  ///@}

  ///@{
  /// Tone curve from radiance to `color`: LINEAR, or FILMIC (default).
  tyndallRangeMacro(ToneCurve, int, LINEAR, FILMIC);
  ///@}

  ///@{
  /// Results of the last update: run time in seconds; the exposure used; estimated relative error of radiance (0
  /// without EstimateError); whether medium and light were on the device from an earlier picture; the device's name;
  /// and the computations that the scene did not need, one per line.
  tyndallSecondsMacro();
  vtkGetMacro(UsedExposure, double);
  vtkGetMacro(EstimatedError, double);
  vtkGetMacro(SceneKept, bool);
  vtkGetCharFromStdStringMacro(DeviceName);
  tyndallLeftOutMacro();
  vtkGetCharFromStdStringMacro(SettingsUsed); ///< "Name = value" of the properties that Quality chooses, one per line
  ///@}

  using Superclass::SetInputConnection;
  void SetInputConnection(int port, vtkAlgorithmOutput* input) override;

protected:
  vtkMediumRayCaster();
  ~vtkMediumRayCaster() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;
  int FillOutputPortInformation(int port, vtkInformation* information) override;
  int RequestInformation(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkMediumRayCaster(const vtkMediumRayCaster&) = delete;
  void operator=(const vtkMediumRayCaster&) = delete;

  friend class vtkLitVolumeMapper;
  /// Renders a picture with another camera and size, without updating the inputs. Called by vtkLitVolumeMapper, which
  /// updates the inputs.
  /// @return false after an error, which is reported once and not again until an input or property has changed
  bool See(const tyndall::AskedView& view, tyndall::Picture& picture);

  /// Whether the background counts for automatic exposure: environment and BackgroundRadiance count, BackgroundColor
  /// does not, because its display is independent of exposure.
  bool SeesRadianceBehind();

  void ForgetOldScene();
  tyndall::InputsKey KeyOf(vtkInformationVector** inputs, const tyndall::SceneSource& source);
  std::unique_ptr<tyndall::CasterScene> TakeKept(const tyndall::InputsKey& key, const tyndall::ViewSettings& settings);
  std::unique_ptr<tyndall::CasterScene> FindScene(vtkInformationVector** inputs, const tyndall::SceneSource& source);
  void SayDoubts(tyndall::CasterScene& scene);

  struct Shot;
  bool PiecesFit(const tyndall::BlocksOfRanks& blocks, vtkImageData* image);
  std::optional<Shot> See(const tyndall::BlocksOfRanks& blocks, vtkInformationVector** inputs, double exposure,
    const std::array<int, 6>& asked);
  void Estimate(const tyndall::Domain& domain, const tyndall::Camera& camera, Shot& shot);
  void CropToRequest(Shot&& shot, vtkInformationVector* outputs);

  std::string Device;
  int Quality = USUAL;
  int ImageSize[2];
  double CameraPosition[3] = { 0.0, 0.0, 0.0 };
  double CameraFocalPoint[3] = { 0.0, 0.0, 0.0 };
  double CameraViewUp[3] = { 0.0, 0.0, 1.0 };
  double CameraViewAngle = 30.0;
  bool CameraParallelProjection = false;
  double CameraParallelScale = 1.0;
  double StepSize;
  bool EstimateError = false;
  bool SingleScatteringOnly;
  bool ShadowRays;
  int RectangleSamples;
  bool ShowBackground;
  double BackgroundColor[3] = { 0.0, 0.0, 0.0 };
  double BackgroundRadiance[3];
  double Exposure = 0.0;
  int AutoExposure = EACH_PICTURE;
  double FirstExposure = 0.0; ///< automatic exposure of the first picture; 0: not known yet
  int ToneCurve = FILMIC;
  int SurfaceReflection = NONE;
  double SurfaceIndex;
  double SurfaceReflectance;
  int TableFace;
  double TableColor[3];
  double TableReflectance;
  bool LeaveOut;
  int MemoryBudget = 0;

  std::shared_ptr<tyndall::Device> Within;    ///< device limited by MemoryBudget; null if that is 0; outlives Kept
  std::unique_ptr<tyndall::CasterScene> Kept; ///< cached scene of the last picture; null after an error

  double UsedExposure = 0.0;
  double EstimatedError = 0.0;
  bool SceneKept = false;
  std::string DeviceName;
  std::string SettingsUsed;
};

#endif
