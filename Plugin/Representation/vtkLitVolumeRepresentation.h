#ifndef vtkLitVolumeRepresentation_h
#define vtkLitVolumeRepresentation_h

#include "vtkImageVolumeRepresentation.h"
#include "vtkTyndallRepresentationModule.h" // for export macro

class vtkLitVolumeMapper;
class vtkMediumRayCaster;
class vtkParticipatingMedium;

/**
 * @class vtkLitVolumeRepresentation
 * @brief ParaView representation of a medium with its light in a 3D view
 *
 * Shows vtkImageData by vtkLitVolumeMapper. Like the superclass, the representation renders where the data are: on the
 * server if there is one, with one piece per rank on several ranks. Input 1: lights, input 2: environment, both
 * optional, as in vtkMediumRayCaster. The setters are those of vtkMediumRayCaster.
 *
 * Several ranks show the same picture as a single rank (vtkLitVolumeMapper::SetPiece): before each frame the ranks
 * exchange the pixels of their pieces. With Exposure 0 the ranks choose a common exposure when their data change.
 *
 * An image without `sigma_a` and `sigma_s` is shown by the superclass's array, transfer functions and unit distance, in
 * the light of the view (vtkLitVolumeMapper::SetLightScalars). Other images do not use these properties.
 */
class TYNDALLREPRESENTATION_EXPORT vtkLitVolumeRepresentation : public vtkImageVolumeRepresentation
{
public:
  static vtkLitVolumeRepresentation* New();
  vtkTypeMacro(vtkLitVolumeRepresentation, vtkImageVolumeRepresentation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Properties of vtkMediumRayCaster; see there. SetShowBackground is off by default.
  void SetQuality(int quality);
  void SetSingleScatteringOnly(bool only);
  void SetShadowRays(bool cast);
  void SetStepSize(double voxels);
  void SetSurfaceReflection(int reflection);
  void SetSurfaceIndex(double index);
  void SetSurfaceReflectance(double reflectance);
  void SetTableFace(int face);
  void SetTableColor(double red, double green, double blue);
  void SetTableReflectance(double reflectance);
  void SetShowBackground(bool show);
  void SetBackgroundColor(double red, double green, double blue);
  void SetBackgroundRadiance(double red, double green, double blue);
  void SetEnvironmentUp(int axis);
  void SetEnvironmentAzimuth(double degrees);
  void SetExposure(double exposure);
  void SetToneCurve(int curve);
  void SetMemoryBudget(int mebibytes);
  void SetDevice(const char* name);
  ///@}

  ///@{
  /// Properties of vtkParticipatingMedium for images without `sigma_a` and `sigma_s`; see there.
  void SetColorMeans(int meaning);
  void SetMeanCosine(double g);
  void SetExtinctionScale(double factor);
  ///@}

  /// Exposure of the last frame: factor by which radiance was multiplied; 0 before the first frame.
  double GetUsedExposure();

  ///@{
  /// Disconnects input 1 (lights), or input 2 (environment).
  void RemoveLights();
  void RemoveEnvironment();
  ///@}

  ///@{
  /// Properties of vtkLitVolumeMapper; see there.
  void SetFrameTime(double seconds);
  void SetLightsFollowCamera(bool follow);
  ///@}

protected:
  vtkLitVolumeRepresentation();
  ~vtkLitVolumeRepresentation() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  void UpdateMapperParameters() override;
  bool AddToView(vtkView* view) override;
  bool RemoveFromView(vtkView* view) override;

private:
  vtkLitVolumeRepresentation(const vtkLitVolumeRepresentation&) = delete;
  void operator=(const vtkLitVolumeRepresentation&) = delete;

  vtkLitVolumeMapper* LitMapper();
  vtkMediumRayCaster* RayCaster();
  vtkParticipatingMedium* Medium();
  void SharePieces(vtkDataObject* surrounded);
  void BeforeFrame(vtkObject* renderer, unsigned long event, void* data);

  unsigned long Observer = 0;
};

#endif
