#ifndef vtkMediumRayCaster_h
#define vtkMediumRayCaster_h

#include "PropertyRange.h"
#include "vtkLitMediumAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

class vtkMultiProcessController;

namespace tyndall
{
class Device;
struct AskedView;
struct CasterScene;
struct GridBlock;
struct InputsKey;
struct Picture;
struct RankPieces;
struct ViewSettings;
struct VoxelBox;
class WholeInputs;
}

/**
 * @class vtkMediumRayCaster
 * @brief a picture of a medium whose light is known
 *
 * Marches a ray through every pixel of the picture, and gathers along it the light that the medium scatters towards the
 * camera and the light it emits, each dimmed by the medium before it; behind the medium the background is seen through
 * it. The source is interpolated linearly between voxel centres. Where the refractive index varies, rays bend as
 * d/ds(n dx/ds) = grad n says, surfaces of refractive objects may mirror, and the background is looked up along the
 * direction in which a ray leaves. Where it is constant none of that is computed.
 *
 * Input 0, the medium with its light: vtkImageData with cell arrays (point arrays: see SetPointData)
 *
 * | array | components | unit | meaning |
 * |---|---|---|---|
 * | `sigma_a` | 1 or 3 | 1/length | absorption coefficient |
 * | `sigma_s` | 1 or 3 | 1/length | scattering coefficient |
 * | `emission` | 1 or 3 | W/(length^3 sr) | emitted radiance per unit length; optional |
 * | `fluence` | 1 or 3 | W/length^2 | light, as every solver writes it; optional |
 * | `fluence_direct` | 1 or 3 | W/length^2 | its unscattered part; needed only to separate it |
 * | `ior` | 1 | 1 | refractive index n, above 0; optional |
 * | `mean_direction` | 3 | 1 | power-weighted mean direction, its length the anisotropy; optional |
 *
 * or those chosen by SetInputArrayToProcess 0 to 6, how the medium scatters, and, optional, `surface_radiance`,
 * as vtkLightPropagationMaps writes it where voxels at the faces of the box are thick: rays that come in there show it,
 * instead of the light at the voxels' centres (not with ShadowRays and lights, SingleScatteringOnly, `mean_direction`,
 * a table, or where rays bend). It belongs to the array `fluence` beside it; where another is chosen it is not used.
 * Input 1, optional: lights as vtkLightRig makes them, for shadow rays.
 * Input 2, optional: the environment behind the medium, vtkImageData in latitude-longitude layout, point array
 * `radiance`.
 *
 * What is scattered towards the camera, of the light in a voxel:
 *
 * |  | SingleScatteringOnly | else |
 * |---|---|---|
 * | without ShadowRays | `fluence_direct` / 4 pi | `fluence` / 4 pi |
 * | with ShadowRays | the lights behind the medium, with its phase function | that, and the rest of `fluence` / 4 pi |
 *
 * The phase function is the medium's own, of every channel and voxel: field data `phase_function` and `g`, or cells
 * `g`. Where there is `mean_direction` m, what is divided by 4 pi is multiplied by f: 4 pi times the phase function,
 * averaged over light that is spread about m. So light that all travels one way (|m| = 1) is scattered by the phase
 * function, light from everywhere alike (|m| = 0) evenly, and as much on the whole. Without `mean_direction`, with
 * ShadowRays, or where the medium is isotropic, f is 1.
 *
 * Where the input has `scattered_moments`, `straight_on` and field data `lamps_apart`, as vtkLightPropagationMaps
 * writes them of media that it solves in angular moments, and SingleScatteringOnly is off, the picture is made of these
 * instead: light that was scattered often by its moments, the lamps' first scattering by shadow rays and the whole
 * phase function, with no property and no Lights needed. They belong to the array `fluence` beside them; where another
 * is chosen they are not used.
 *
 * The rest of `fluence` is what the shadow rays do not show already, so that no light counts twice. Where there is no
 * `fluence` but there are lights, shadow rays are used without being asked for.
 *
 * Output: vtkImageData of ImageSize pixels (x to the right, y upwards), point arrays
 *
 * | array | type | unit | meaning |
 * |---|---|---|---|
 * | `color` | uint8 x 4 | sRGB | the picture for a screen, active scalars; see ShowBackground |
 * | `radiance` | float x 3 | W/(length^2 sr) | what arrives at the camera |
 * | `alpha` | float | 1 | 1 - transmittance (mean of the channels) |
 * | `depth` | float | length | along the view, to where the channels' mean transmittance falls to 1/2 |
 *
 * and field data `exposure` (what radiance was multiplied by), `left_out` (what the scene did not need),
 * `settings_used` ("Name = value" of what Quality chooses), `device`.
 *
 * Medium, light and illumination stay on the device, so that a picture from another camera, of another size, or of
 * other colours on the screen only casts its rays: until an input changes, another one is connected, a setting needs
 * it, the device is another one, or the filter goes. Then their memory is given back.
 *
 * While CameraPosition and CameraFocalPoint are equal, as they are untouched, the camera frames the whole medium, from
 * above, z upwards.
 *
 * Where ranks of a parallel pipeline run it together each asks for its piece of the medium with a layer of its
 * neighbours' cells, casts that, and hands on the part of the picture that it was asked for: that of the whole, to
 * rounding. Rays that bend, are reflected or meet a table go from rank to rank, and lamps throw shadows from piece to
 * piece; what a piece lacks beside it (for the index, angular moments, light at the surface of thick voxels) comes from
 * the other ranks. The whole is put together on every rank where ranks have other properties than each other, pieces
 * overlap without flags, or cells `g` are the same in all voxels of one piece and not in all of another.
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
    LINEAR = 0, ///< radiance times exposure, cut at white
    FILMIC = 1  ///< bright parts are compressed as film does it
  };

  enum SurfaceReflections
  {
    NONE = 0,
    FRESNEL = 1, ///< of unpolarised light
    FIXED = 2    ///< SurfaceReflectance
  };

  enum Qualities
  {
    DRAFT = 0, ///< to look at while the camera moves
    USUAL = 1, ///< every property as it stands
    FINE = 2,
    REFERENCE = 3 ///< to compare others with
  };

  ///@{
  /// How exact the picture is to be: chooses StepSize and RectangleSamples where they have their default value, and
  /// leaves those that have another one. DRAFT, USUAL (default), FINE or REFERENCE; with USUAL both are taken as they
  /// stand.
  tyndallRangeMacro(Quality, int, DRAFT, REFERENCE);
  ///@}

  ///@{
  /// Columns and rows of the picture, pixels. Default 800 x 600, valid from 1 on.
  tyndallSetRange2Macro(ImageSize, int, 1, VTK_INT_MAX);
  vtkGetVector2Macro(ImageSize, int);
  ///@}

  ///@{
  /// Where the camera is and what it looks at, as vtkCamera has it. Default (0, 0, 0) both: while they are equal, the
  /// camera frames the medium. Valid up to 1e15 voxels from it.
  tyndallSetRange3Macro(CameraPosition, double, tyndall::AnyLow, tyndall::AnyHigh);
  vtkGetVector3Macro(CameraPosition, double);
  tyndallSetRange3Macro(CameraFocalPoint, double, tyndall::AnyLow, tyndall::AnyHigh);
  vtkGetVector3Macro(CameraFocalPoint, double);
  ///@}

  ///@{
  /// What is upwards in the picture. Default (0, 0, 1), valid what is not along the view.
  tyndallSetRange3Macro(CameraViewUp, double, tyndall::AnyLow, tyndall::AnyHigh);
  vtkGetVector3Macro(CameraViewUp, double);
  ///@}

  ///@{
  /// Angle between the picture's lower and upper edge, degrees. Default 30, valid (0, 180).
  tyndallRangeMacro(CameraViewAngle, double, tyndall::AboveZero, 180.0);
  ///@}

  ///@{
  /// Whether rays are parallel, and then half the picture's height, length. Default off; 1, valid (0, infinity). A
  /// camera that frames the medium finds the height itself.
  tyndallFlagMacro(CameraParallelProjection);
  tyndallRangeMacro(CameraParallelScale, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Voxels that a ray advances between two samples. Default 0.5, valid [0.01, 10]. The error falls with its square.
  tyndallRangeMacro(StepSize, double, 0.01, 10.0);
  ///@}

  ///@{
  /// Whether to show only light that was scattered once. Default off.
  tyndallFlagMacro(SingleScatteringOnly);
  ///@}

  ///@{
  /// Whether to follow the lights' direct light by shadow rays, scattered by the medium's phase function. Default off:
  /// it is in `fluence`, scattered evenly or as `mean_direction` says. Where no lamp and no sun shines the picture is
  /// the same and no time goes into it; `left_out` says so.
  tyndallFlagMacro(ShadowRays);
  ///@}

  ///@{
  /// Samples along each edge of a rectangular light. Default 3, valid [1, 32].
  tyndallRangeMacro(RectangleSamples, int, 1, 32);
  ///@}

  ///@{
  /// Whether the environment, or else BackgroundRadiance or BackgroundColor, is seen behind the medium. Default on:
  /// `color` is opaque. Off: laid over black it looks as before black; its own alpha is that of the array `alpha`, and
  /// larger where bright thin smoke would be more than white.
  tyndallFlagMacro(ShowBackground);
  ///@}

  ///@{
  /// Colour behind the medium where there is no environment, red, green, blue, as the array color is to have it (sRGB),
  /// at any exposure and tone curve: radiance is what shows it so. The exposure is chosen as if it were black. Default
  /// (0, 0, 0), valid [0, 1].
  tyndallSetRange3Macro(BackgroundColor, double, 0.0, 1.0);
  vtkGetVector3Macro(BackgroundColor, double);
  ///@}

  ///@{
  /// Radiance behind the medium where there is no environment, red, green, blue, W/(length^2 sr): instead of
  /// BackgroundColor where it is not 0, the default. Valid [0, 1e37].
  tyndallSetRange3Macro(BackgroundRadiance, double, 0.0, 1e37);
  vtkGetVector3Macro(BackgroundRadiance, double);
  ///@}

  ///@{
  /// What the surface of refractive objects mirrors of a ray that meets it from the side of the smaller index: NONE
  /// (default), FRESNEL or FIXED. Without an `ior` that varies there is no surface.
  tyndallRangeMacro(SurfaceReflection, int, NONE, FIXED);
  ///@}

  ///@{
  /// The surface is where n has this value. Default 0: midway between the least and the largest n. Valid [0, infinity).
  tyndallRangeMacro(SurfaceIndex, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Part that the surface mirrors if SurfaceReflection is FIXED. Default 0.1, valid [0, 1].
  tyndallRangeMacro(SurfaceReflectance, double, 0.0, 1.0);
  ///@}

  ///@{
  /// Face of the box that is a table, seen from within: 0 to 5 for -x, +x, -y, +y, -z, +z. Default -1: none.
  tyndallRangeMacro(TableFace, int, -1, 5);
  ///@}

  ///@{
  /// Diffuse reflectance of the table, red, green, blue, lit by the light in the voxels on it. Default (0.6, 0.6, 0.6),
  /// valid [0, 1].
  tyndallSetRange3Macro(TableColor, double, 0.0, 1.0);
  vtkGetVector3Macro(TableColor, double);
  ///@}

  ///@{
  /// Part that the table mirrors. Default 0.1, valid from 0 to 1 less TableColor.
  tyndallRangeMacro(TableReflectance, double, 0.0, 1.0);
  ///@}

  ///@{
  /// MiB of the device's memory that the filter may take, with what it keeps from update to update; what is needed
  /// beyond is one error that says how much. Default 0: what the device has. Valid [0, 2^31).
  tyndallRangeMacro(MemoryBudget, int, 0, VTK_INT_MAX);
  ///@}

  ///@{
  /// Whether to leave out what the scene does not need. Default on; off computes everything, for comparison: the same
  /// picture, later.
  tyndallFlagMacro(LeaveOut);
  ///@}

  ///@{
  /// What radiance is multiplied by for `color`. Default 0: so that the mean of the picture's lit part becomes a medium
  /// grey. Valid [0, 1e30].
  tyndallRangeMacro(Exposure, double, 0.0, 1e30);
  ///@}

  enum AutoExposures
  {
    EACH_PICTURE = 0,
    FIRST_PICTURE = 1
  };

  ///@{
  /// What an Exposure of 0 is found from: EACH_PICTURE (default), or the FIRST_PICTURE after this was chosen, whose
  /// exposure all later ones have, so that an animation does not flicker.
  tyndallRangeMacro(AutoExposure, int, EACH_PICTURE, FIRST_PICTURE);
  ///@}

  ///@{
  /// How `color` follows radiance: LINEAR, or FILMIC (default).
  tyndallRangeMacro(ToneCurve, int, LINEAR, FILMIC);
  ///@}

  ///@{
  /// What came of the last update: seconds in which rays were cast and the picture was read, the exposure used, whether
  /// medium and light were on the device from an earlier picture, the device's name, and what the scene did not need,
  /// one per line.
  vtkGetMacro(Seconds, double);
  vtkGetMacro(UsedExposure, double);
  vtkGetMacro(SceneKept, bool);
  vtkGetCharFromStdStringMacro(DeviceName);
  vtkGetCharFromStdStringMacro(LeftOut);
  vtkGetCharFromStdStringMacro(SettingsUsed); ///< "Name = value" of what Quality chooses, one per line
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
  /// A picture of another camera and size, of the inputs as they are: for the mapper, which has updated them.
  /// @return false where it failed: there was an error, and there is none again until something has changed
  bool See(const tyndall::AskedView& view, tyndall::Picture& picture);

  /// Whether a background is in a picture that was made for its exposure: BackgroundColor is not, which is as bright on
  /// the screen whatever the exposure.
  bool SeesRadianceBehind();

  enum class Use
  {
    Whole,
    Piece, ///< seen alone, or with others but for what goes from one to another
    Block  ///< of ranks that see the whole together
  };
  void ForgetOldScene();
  /// @param block  of the larger image of which the medium is a block; null: of none
  tyndall::InputsKey KeyOf(vtkInformationVector** inputs, Use use, const tyndall::GridBlock* block);
  std::unique_ptr<tyndall::CasterScene> TakeKept(const tyndall::InputsKey& key, const tyndall::ViewSettings& settings);
  std::unique_ptr<tyndall::CasterScene> FindScene(
    vtkInformationVector** inputs, const tyndall::ViewSettings& settings, const tyndall::GridBlock* block = nullptr);
  void SayDoubts(tyndall::CasterScene& scene);

  struct Shot;
  struct Taking;
  void Expose(const Taking& taking, Shot& shot);
  Shot SeeWhole(vtkInformationVector** inputs, double exposure);
  /// @param held  becomes, by rank, the voxels of the casters
  std::unique_ptr<tyndall::CasterScene> FindSceneOfBlock(
    const tyndall::RankPieces& pieces, vtkInformationVector** inputs, std::vector<tyndall::VoxelBox>& held);
  std::optional<Shot> SeeBlocks(
    vtkMultiProcessController* ranks, tyndall::WholeInputs& inputs, double exposure, const std::array<int, 6>& asked);
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
  bool SingleScatteringOnly;
  bool ShadowRays;
  int RectangleSamples;
  bool ShowBackground;
  double BackgroundColor[3] = { 0.0, 0.0, 0.0 };
  double BackgroundRadiance[3];
  double Exposure = 0.0;
  int AutoExposure = EACH_PICTURE;
  double FirstExposure = 0.0; ///< found from the first picture; 0: not yet
  int ToneCurve = FILMIC;
  int SurfaceReflection = NONE;
  double SurfaceIndex;
  double SurfaceReflectance;
  int TableFace;
  double TableColor[3];
  double TableReflectance;
  bool LeaveOut;
  int MemoryBudget = 0;

  std::shared_ptr<tyndall::Device> Within;    ///< MemoryBudget, where there is one
  std::unique_ptr<tyndall::CasterScene> Kept; ///< of the last picture, if it succeeded

  double Seconds = 0.0;
  double UsedExposure = 0.0;
  bool SceneKept = false;
  std::string DeviceName;
  std::string LeftOut;
  std::string SettingsUsed;
};

#endif
