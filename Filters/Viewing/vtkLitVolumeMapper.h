#ifndef vtkLitVolumeMapper_h
#define vtkLitVolumeMapper_h

#include "PropertyRange.h"
#include "vtkNew.h"
#include "vtkTimeStamp.h"
#include "vtkTyndallModule.h" // for export macro
#include "vtkVolumeMapper.h"

#include <functional>
#include <memory>
#include <vector>

class vtkAlgorithmOutput;
class vtkImageData;
class vtkLightPropagationMaps;
class vtkMediumRayCaster;
class vtkMultiProcessController;
class vtkParticipatingMedium;

namespace tyndall
{
class Communicator;
class PictureOverlay;
class VolumeLight;
struct AskedView;
struct Picture;
struct ToneMapping;
}

/**
 * @class vtkLitVolumeMapper
 * @brief volume mapper that renders a medium and its solved light in a VTK scene
 *
 * Renders by vtkMediumRayCaster with the renderer's camera. Rays end at the opaque surfaces that the renderer has
 * already drawn, and the radiance of the rays is blended over these surfaces: the medium attenuates surfaces behind it,
 * but does not illuminate them. The volume may be rotated, translated and scaled uniformly.
 *
 * An image without arrays `sigma_a` and `sigma_s` may be shown by the transfer functions of the volume's property
 * (LightScalars): the mapper then makes a medium of them by vtkParticipatingMedium and solves its light by
 * vtkLightPropagationMaps, with the lights and the environment of RayCaster, or without such lights with those of the
 * renderer, whenever the view is still. The scalars are those of SelectScalarArray and SetScalarMode, or else those
 * that GetMedium() reads. Otherwise the property is not used.
 *
 * Input: vtkImageData with the arrays of vtkMediumRayCaster. The properties of RayCaster control rendering, and lights
 * and environment are inputs of RayCaster; ImageSize, camera and first input of RayCaster are not used. ShowBackground
 * is off by default here; if it is on, the environment hides the renderer's background.
 *
 * With Exposure 0 (default) the exposure is chosen once per scene, from four small pictures of the medium from
 * different directions, so that it stays the same while the camera moves; UsedExposure reports it.
 *
 * If the renderer allows less than a second for a frame (vtkRenderWindow::SetDesiredUpdateRate, as interactors set it),
 * fewer rays are cast, so that a frame takes FrameTime; else one ray per pixel.
 *
 * @sa vtkMediumRayCaster
 */
class TYNDALL_EXPORT vtkLitVolumeMapper : public vtkVolumeMapper
{
public:
  static vtkLitVolumeMapper* New();
  vtkTypeMacro(vtkLitVolumeMapper, vtkVolumeMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Filter that casts the rays. Connect lights and environment to its inputs, and set properties of rendering on it.
  vtkMediumRayCaster* GetRayCaster();

  ///@{
  /// Whether images without `sigma_a` and `sigma_s` are shown by the transfer functions of the volume's property, in
  /// the light of the renderer. Default off: such an image is an error.
  tyndallFlagMacro(LightScalars);
  ///@}

  ///@{
  /// Whether headlight and camera lights of the renderer illuminate LightScalars from where they are in each still
  /// frame. Default on. Off: from where they were when a property of the lights, or the place of the volume, last
  /// changed, so that a moved camera needs no solve.
  tyndallFlagMacro(LightsFollowCamera);
  ///@}

  ///@{
  /// The filters that make medium and light for LightScalars, to set ColorMeans, MeanCosine, Tolerance and so on. The
  /// mapper sets inputs, VolumeProperty and UseTransferFunctions; device, memory budget and orientation of the
  /// environment are those of RayCaster.
  vtkParticipatingMedium* GetMedium();
  vtkLightPropagationMaps* GetSolver();
  ///@}

  ///@{
  /// Target time for the rays of a frame while the camera moves, seconds. Default 0.025, valid [0.001, 10].
  tyndallRangeMacro(FrameTime, double, 0.001, 10.0);
  ///@}

  ///@{
  /// Rendering of a medium that is distributed over ranks: each rank has a mapper for its piece, and the pictures are
  /// composited in depth order. SetPiece sets the ranks, and this rank's piece with one layer of ghost cells, flagged
  /// as duplicates; the mapper's input is the piece without ghost cells. All ranks, also those without a piece, must
  /// then call AgreeOnExposure when the medium has changed, and SeePieces before each frame; both are collective. The
  /// composited picture equals that of one mapper with the whole medium.
  ///
  /// If rays bend or a face of the box is a reflecting table (TableFace of the ray caster), or the pieces do not tile
  /// one grid, each mapper renders its piece alone. It then divides radiance by alpha before tone mapping and
  /// multiplies the pixel value by alpha, so that no seam is visible.
  void SetPiece(vtkMultiProcessController* ranks, vtkImageData* surrounded);
  void AgreeOnExposure();
  void SeePieces(vtkRenderer* renderer, vtkVolume* volume);
  ///@}

  ///@{
  /// Results of the last frame: factor by which radiance was multiplied, columns and rows of rays, and total time in
  /// seconds.
  vtkGetMacro(UsedExposure, double);
  vtkGetVector2Macro(CastSize, int);
  vtkGetMacro(Seconds, double);
  ///@}

  ///@{
  /// Bounds of the input. For the piece that draws the background beside the medium, bounds of everything that may be
  /// visible, because IceT discards pixels of a rank outside the bounds of its props.
  double* GetBounds() override;
  using Superclass::GetBounds;
  ///@}

  /// Time of the latest modification of this object or of RayCaster.
  vtkMTimeType GetMTime() override;

  void Render(vtkRenderer* renderer, vtkVolume* volume) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;

protected:
  vtkLitVolumeMapper();
  ~vtkLitVolumeMapper() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;

private:
  vtkLitVolumeMapper(const vtkLitVolumeMapper&) = delete;
  void operator=(const vtkLitVolumeMapper&) = delete;

  struct Pieces;

  bool UpdateInputs(vtkAlgorithmOutput* medium);
  bool HasScalarsToLight();
  void ConnectLights();
  vtkAlgorithmOutput* LitConnection(vtkRenderer* renderer, vtkVolume* volume);
  vtkImageData* UpdateSurrounded();
  bool IsPiece() const;
  double EstimateExposure();
  void AddSeen(const tyndall::Picture& picture, std::vector<float>& radiance, std::vector<float>& alpha);
  void WithOthers(const std::function<void(tyndall::Communicator&)>& act);
  void SeePieces(tyndall::Communicator& others, vtkRenderer* renderer, vtkVolume* volume);
  void AgreeOnExposure(tyndall::Communicator& others);
  double ExposureOfPieces(tyndall::Communicator& others);
  bool IsExposureOld(tyndall::Communicator& others);
  bool FindExposure();
  double RaysApart(const int drawn[2], double allowed) const;
  void ChooseCastSize(const int drawn[2], double apart);
  bool Cast(const tyndall::AskedView& view, tyndall::Picture& picture);
  tyndall::ToneMapping Tones();
  bool ShowsBackgroundColor();
  bool DrawPiece(vtkRenderer* renderer, vtkVolume* volume);

  vtkNew<vtkMediumRayCaster> RayCaster;
  bool LightScalars = false;
  bool LightsFollowCamera = true;
  std::unique_ptr<tyndall::VolumeLight> OwnLight; ///< for LightScalars
  vtkAlgorithmOutput* Shown = nullptr;            ///< connection of the medium of the last frame
  double FrameTime = 0.025;
  double CommonExposure = 0.0; ///< automatic exposure of all pieces (Exposure 0); 0: not chosen yet
  std::unique_ptr<Pieces> Spread;

  std::unique_ptr<tyndall::PictureOverlay> Overlay;
  double AutomaticExposure = 0.0;
  vtkTimeStamp ExposureTime; ///< time at which AutomaticExposure or CommonExposure was chosen
  double SecondsOfRay = 0.0; ///< seconds per ray in the last frame; 0: not known yet

  double UsedExposure = 0.0;
  int CastSize[2] = { 0, 0 };
  double Seconds = 0.0;
};

#endif
