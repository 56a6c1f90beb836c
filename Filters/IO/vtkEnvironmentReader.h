#ifndef vtkEnvironmentReader_h
#define vtkEnvironmentReader_h

#include "PropertyRange.h"
#include "vtkImageAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

/**
 * @class vtkEnvironmentReader
 * @brief reads an environment (light from all directions) from a picture: OpenEXR (.exr) or Radiance (.hdr)
 *
 * Output: vtkImageData of width x height x 1 points, one per pixel, with the point array `radiance` (float, RGB,
 * W / (length^2 sr)), in latitude-longitude layout with z up: the centre of pixel (i, j) looks along azimuth
 * phi = 2 pi (i + 1/2) / width about +z from +x towards +y, and polar angle theta = pi (1 - (j + 1/2) / height) from
 * +z, that is along (sin theta cos phi, sin theta sin phi, cos theta). Row 0 is the picture's bottom row, straight
 * down.
 *
 * Files: OpenEXR with R, G, B (at the root or in a layer), Y, or Y, RY, BY; scan lines or tiles; the picture is the
 * display window, black outside of the data window. Radiance with RGBE or XYZE pixels in any order of axes; values are
 * divided by the header's exposure. Colours are not converted between primaries.
 *
 * Errors, each with one message and an empty output: a file that does not exist, is truncated, corrupt or of another
 * type, a cube map, a deep picture; a pixel that is not finite (named). Negative values, which image filters leave in
 * photographs, become 0, with a warning that states their number. A changed pixel is not detected in formats without
 * check sums.
 *
 * @sa vtkLightPropagationMaps vtkMediumRayCaster
 */
class TYNDALL_EXPORT vtkEnvironmentReader : public vtkImageAlgorithm
{
public:
  static vtkEnvironmentReader* New();
  vtkTypeMacro(vtkEnvironmentReader, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Path of the .exr or .hdr file; its content, not its name, determines the format.
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /// Whether a file starts like an OpenEXR or Radiance file.
  virtual int CanReadFile(const char* fileName);

  ///@{
  /// Exposure in stops: radiance is multiplied by 2^Exposure. Default 0, valid [-64, 64].
  tyndallRangeMacro(Exposure, double, -64.0, 64.0);
  ///@}

  ///@{
  /// Upper limit of the brightest channel of a pixel, applied after Exposure, W / (length^2 sr): brighter pixels are
  /// scaled down to it, which keeps their hue. Limits a sun of a few pixels. Default 0: no limit. Valid [0, infinity).
  tyndallRangeMacro(MaximumRadiance, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Maximum width in pixels. A wider picture is averaged over the solid angle of the larger pixels, which conserves
  /// the power from each region of the sky. Default 0: no limit.
  tyndallRangeMacro(Width, int, 0, VTK_INT_MAX);
  ///@}

protected:
  vtkEnvironmentReader() { this->SetNumberOfInputPorts(0); }
  ~vtkEnvironmentReader() override;

  int RequestInformation(vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

private:
  vtkEnvironmentReader(const vtkEnvironmentReader&) = delete;
  void operator=(const vtkEnvironmentReader&) = delete;

  char* FileName = nullptr;
  double Exposure = 0.0;
  double MaximumRadiance = 0.0;
  int Width = 0;
};

#endif
