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
class vtkMediumRayCaster;
class vtkMultiProcessController;

namespace tyndall
{
class Communicator;
class PictureOverlay;
struct AskedView;
struct Picture;
struct ToneMapping;
}

/**
 * @class vtkLitVolumeMapper
 * @brief a medium whose light is known, in a scene of VTK
 *
 * A volume's mapper whose pixels are those of vtkMediumRayCaster, cast with the camera of the renderer. Rays end at the
 * opaque surfaces that the renderer has drawn before, and what they gathered until there lies over these: a surface is
 * dimmed by the medium before it, and lit by none of it. The volume may be turned, moved and scaled alike along all
 * axes; its property (transfer functions) is not used.
 *
 * Input: vtkImageData with the arrays of vtkMediumRayCaster. How light is seen is what the properties of RayCaster say,
 * and lights and environment are connected there; its ImageSize, camera and first input are not used. Its
 * ShowBackground is off here unless it is switched on; the environment then hides what the renderer has as background.
 *
 * With Exposure 0, as it is at first, the exposure is chosen once for a scene, from four small pictures around it, so
 * that it stays the same while the camera moves; UsedExposure tells it.
 *
 * While the renderer has little time for a frame (vtkRenderWindow::SetDesiredUpdateRate, as interactors set it), fewer
 * rays are cast, so that a frame takes FrameTime. When it has more than a second, there is one for each pixel.
 *
 * @sa vtkMediumRayCaster
 */
class TYNDALL_EXPORT vtkLitVolumeMapper : public vtkVolumeMapper
{
public:
  static vtkLitVolumeMapper* New();
  vtkTypeMacro(vtkLitVolumeMapper, vtkVolumeMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// What casts the rays: light and environment go in here, and its properties say how light is seen.
  vtkMediumRayCaster* GetRayCaster();

  ///@{
  /// Seconds that the rays of a frame are to take while the camera moves. Default 0.025, valid [0.001, 10].
  tyndallRangeMacro(FrameTime, double, 0.001, 10.0);
  ///@}

  ///@{
  /// Where the medium is spread over ranks, each of which has a mapper for its piece, and lays what that draws over or
  /// under what the others draw, in the order in which the pieces are seen: the ranks, and this rank's piece with a
  /// layer of its neighbours' cells, flagged as duplicates; the input is the piece without that. Then all ranks have to
  /// call AgreeOnExposure when the medium has changed, and SeePieces before each frame, also those that have no piece.
  /// Collective they show what one mapper would show of the whole.
  ///
  /// Where rays bend or meet a table, or pieces are no parts of one grid, they cannot: each mapper then shows its piece
  /// alone, radiance divided by alpha, and multiplies the screen's value by alpha, so that there is no seam.
  void SetPiece(vtkMultiProcessController* ranks, vtkImageData* surrounded);
  void AgreeOnExposure();
  void SeePieces(vtkRenderer* renderer, vtkVolume* volume);
  ///@}

  ///@{
  /// Of the last frame: what radiance was multiplied by, columns and rows of rays, and seconds in all.
  vtkGetMacro(UsedExposure, double);
  vtkGetVector2Macro(CastSize, int);
  vtkGetMacro(Seconds, double);
  ///@}

  ///@{
  /// The input's. Of the piece that shows the background beside the medium those of all that may be seen: IceT takes
  /// nothing of a rank from outside of its bounds.
  double* GetBounds() override;
  using Superclass::GetBounds;
  ///@}

  /// That of this and of RayCaster.
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
  double FrameTime = 0.025;
  double CommonExposure = 0.0; ///< of all pieces, for Exposure 0; 0: it is to be chosen
  std::unique_ptr<Pieces> Spread;

  std::unique_ptr<tyndall::PictureOverlay> Overlay;
  double AutomaticExposure = 0.0;
  vtkTimeStamp ExposureTime; ///< when it was chosen
  double SecondsOfRay = 0.0; ///< in the last frame; 0: not known yet

  double UsedExposure = 0.0;
  int CastSize[2] = { 0, 0 };
  double Seconds = 0.0;
};

#endif
