#ifndef vtkEnvironmentReader_h
#define vtkEnvironmentReader_h

#include "PropertyRange.h"
#include "vtkImageAlgorithm.h"
#include "vtkTyndallModule.h" // for export macro

/**
 * @class vtkEnvironmentReader
 * @brief reads a picture of the light from all around: OpenEXR (.exr) or Radiance (.hdr)
 *
 * Output: vtkImageData of width x height x 1 points, one per pixel, with the point array `radiance` (float, RGB,
 * W / (length^2 sr)), in latitude-longitude layout with z up: the centre of pixel (i, j) looks along azimuth
 * phi = 2 pi (i + 1/2) / width about +z from +x towards +y, and polar angle theta = pi (1 - (j + 1/2) / height) from
 * +z, that is along (sin theta cos phi, sin theta sin phi, cos theta). Row 0 is the picture's bottom row, straight
 * down.
 *
 * Files: OpenEXR with R, G, B (at the root or in a layer), Y, or Y, RY, BY; scan lines or tiles; the display window is
 * the picture, black where the data window does not reach. Radiance with RGBE or XYZE pixels in any order of axes; the
 * header's exposure is divided out. Primaries are taken as they are.
 *
 * Errors, each one message, with empty output: a file that is not there, truncated or corrupt, of another kind, a cube
 * map, a deep picture; a pixel that is not finite (named). Negative values, which filters leave in photographs, become
 * 0, with a warning that counts them. Formats without check sums do not tell a changed pixel.
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
  /// The .exr or .hdr file; which it is says its content.
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /// Whether the file begins as an OpenEXR or Radiance file does.
  virtual int CanReadFile(const char* fileName);

  ///@{
  /// Stops by which the light is brightened: radiance times 2^Exposure. Default 0, valid [-64, 64].
  tyndallRangeMacro(Exposure, double, -64.0, 64.0);
  ///@}

  ///@{
  /// Pixels whose brightest channel is above this are scaled down to it (the hue stays), after Exposure,
  /// W / (length^2 sr). Tames a sun that is a few pixels. Default 0: no limit. Valid [0, infinity).
  tyndallRangeMacro(MaximumRadiance, double, 0.0, tyndall::AnyHigh);
  ///@}

  ///@{
  /// Most pixels around. A wider picture is averaged over the solid angle of the wider pixels, so that the power from
  /// every part of the sky stays. Default 0: no limit.
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
