#ifndef vtkLitVolumeRepresentation_h
#define vtkLitVolumeRepresentation_h

#include "vtkImageVolumeRepresentation.h"
#include "vtkTyndallRepresentationModule.h" // for export macro

class vtkMediumRayCaster;

/**
 * @class vtkLitVolumeRepresentation
 * @brief a medium with its light in ParaView's 3D view
 *
 * Shows vtkImageData by vtkLitVolumeMapper. Like the volumes of its superclass it is drawn where the data are: with a
 * server by the server, in pieces by several ranks. Input 1: lights, input 2: environment, both optional, as
 * vtkMediumRayCaster has them. The setters are those of vtkMediumRayCaster.
 *
 * Several ranks show what one would show of the whole (vtkLitVolumeMapper::SetPiece): before each frame they tell each
 * other what is seen of their pieces. With Exposure 0 they agree on one when their data change.
 *
 * Transfer functions and the other properties of the superclass that colour a volume are not used.
 */
class TYNDALLREPRESENTATION_EXPORT vtkLitVolumeRepresentation : public vtkImageVolumeRepresentation
{
public:
  static vtkLitVolumeRepresentation* New();
  vtkTypeMacro(vtkLitVolumeRepresentation, vtkImageVolumeRepresentation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// See vtkMediumRayCaster. SetShowBackground is off by default.
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

  /// What radiance was multiplied by in the last frame; 0 before.
  double GetUsedExposure();

  ///@{
  /// Disconnect inputs 1 and 2.
  void RemoveLights();
  void RemoveEnvironment();
  ///@}

  /// See vtkLitVolumeMapper.
  void SetFrameTime(double seconds);

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

  vtkMediumRayCaster* RayCaster();
  void SharePieces(vtkDataObject* surrounded);
  void BeforeFrame(vtkObject* renderer, unsigned long event, void* data);

  unsigned long Observer = 0;
};

#endif
